"""Reading boxes: the table of their forms, where they lie in the photo, and what their words mean."""

from __future__ import annotations

import json
import re
from xml.etree.ElementTree import Element, ParseError, XMLParser

from diorama_core.artefacts import Box, LabelledBox
from diorama_core.errors import InputError
from diorama_core.io.bounded import megabytes, parse_json, shorten
from diorama_core.library.labels import understand_label
from diorama_core.library.taxonomy import ARCHITECTURE_WORDS, UNKNOWN
from diorama_core.perception.inputs.boxes import lines, lists, markup, tools
from diorama_core.perception.inputs.boxes.entry import BoxFile, BoxText, Size
from diorama_core.perception.inputs.boxes.placing import place_boxes
from diorama_core.perception.inputs.photos.reading import DecodedPhoto
from diorama_core.perception.inputs.source import Form, Source, form_of

EXAMPLE = 'a JSON list of {"bbox": [x1, y1, x2, y2], "class": "chair"}'
_JSON_LINES = b"{"
_FENCE = re.compile(rb"```(?:json)?\s*\n([\[{].*?)\n\s*```", re.DOTALL)

BOX_FORMS: tuple[Form[BoxText, BoxFile], ...] = (
    Form(
        "COCO data set",
        "COCO, CVAT, Roboflow, Label Studio, fiftyone",
        "boxes (x, y, width, height) with their categories, of the photo's file name; scaled by the stated size",
        tools.is_data_set,
        tools.read_data_set,
    ),
    Form(
        "LabelMe",
        "LabelMe, AnyLabeling",
        "rectangles and the bounds of polygons and circles; scaled by the stated size",
        tools.is_labelme,
        tools.read_labelme,
    ),
    Form(
        "Label Studio",
        "Label Studio (JSON, JSON-MIN)",
        "rectangles and polygons in percent, of the photo's task",
        tools.is_label_studio,
        tools.read_label_studio,
    ),
    Form("VGG Image Annotator", "VIA", "rectangles and polygons of the photo", tools.is_via, tools.read_via),
    Form(
        "COCO results",
        "COCO API, Detectron2, MMDetection",
        "boxes (x, y, width, height); names only with the data set's file (`categories`) beside",
        tools.is_results,
        tools.read_results,
    ),
    Form(
        "list of boxes",
        "Diorama, Transformers, Ultralytics, Florence, Gemini, Qwen-VL, fiftyone",
        '`{"bbox": [x1, y1, x2, y2], "class": "chair"}`, or other keys for box, name and score',
        lists.is_list,
        lists.read_list,
    ),
    Form(
        "columns of boxes",
        "torchvision, Florence-2, Grounding DINO",
        "`boxes`, `labels` and `scores` side by side",
        lists.is_columns,
        lists.read_columns,
    ),
    Form(
        "object with a list of boxes",
        "Roboflow, CreateML, Supervisely, Rekognition, Vision API",
        "the longest list of annotations within, scaled by a size that stands beside it",
        lists.is_wrapped,
        lists.read_wrapped,
    ),
    Form(
        "boxes by name",
        "pandas, scripts",
        "an object with a box or a list of boxes under each name, or a column under each of the four numbers",
        lists.is_keyed,
        lists.read_keyed,
    ),
    Form("bare boxes", "scripts", "lists of x1, y1, x2, y2 without names", lists.is_bare, lists.read_bare),
    Form(
        "Pascal VOC",
        "labelImg, CVAT, Roboflow",
        "boxes counted from pixel 1, bounds of polygons; scaled by the stated size",
        markup.is_voc,
        markup.read_voc,
    ),
    Form(
        "CVAT",
        "CVAT for images and video",
        "boxes and bounds of polygons of the photo, or of the first frame of tracks",
        markup.is_cvat,
        markup.read_cvat,
    ),
    Form(
        "YOLO",
        "Ultralytics, Darknet, Roboflow, Label Studio",
        "boxes and polygons in shares of the picture; names from classes.txt or data.yaml beside",
        lines.is_yolo,
        lines.read_yolo,
    ),
    Form(
        "table of boxes",
        "TensorFlow, Open Images, pandas (CSV, TSV)",
        "columns that name a box, a class and perhaps a picture and its size",
        lines.is_table,
        lines.read_table,
    ),
    Form(
        "words and numbers",
        "KITTI, detectors' text output",
        "a word and four numbers a line",
        lines.is_words,
        lines.read_words,
    ),
)


def parse_box_text(source: Source, photo_name: str, photo_size: Size) -> BoxText:
    """The file as JSON, XML or text.

    Raises:
        InputError: it is none of them, or damaged.
    """
    return BoxText(source, _document(source), photo_name, photo_size)


def _document(source: Source) -> object:
    data = _utf8(source.data)
    if fenced := _FENCE.search(data):
        data = fenced[1]  # language models answer so
    data = data.lstrip()
    if data[:1] in (b"[", _JSON_LINES):
        rows = _json_lines(data)
        return parse_json(data, source.name, InputError, advice=f"boxes are {EXAMPLE}") if rows is None else rows
    if data[:1] == b"<":
        return _xml(data, source.name)
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        raise InputError(f"{source.name}: this is no text; boxes are {EXAMPLE}") from None
    if "\0" in text:
        raise InputError(f"{source.name}: this is no text; boxes are {EXAMPLE}")
    return text


def _utf8(data: bytes) -> bytes:
    """Text as UTF-8 without a byte order mark."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        try:
            return data.decode("utf-16").encode()
        except UnicodeError:
            return data
    return data.removeprefix(b"\xef\xbb\xbf")


def _json_lines(data: bytes) -> list[object] | None:
    """The objects of a file with one a line; None where it is one JSON value."""
    lines_ = data.splitlines()
    if (
        data[:1] != _JSON_LINES
        or len(lines_) < 2
        or not all(r.strip()[:1] + r.strip()[-1:] in (b"{}", b"") for r in lines_)
    ):
        return None
    try:
        return [parse_json(row, "", InputError) for row in lines_ if row.strip()]
    except (InputError, json.JSONDecodeError):
        return None


def _xml(data: bytes, name: str) -> Element:
    if b"<!ENTITY" in data[:4096] or b"<!DOCTYPE html" in data[:4096] or b"<html" in data[:4096].lower():
        raise InputError(f"{name}: this is a web page or a document, no boxes; boxes are {EXAMPLE}")
    try:
        parser = XMLParser()
        parser.feed(data)
        return parser.close()
    except (ParseError, ValueError, LookupError) as error:
        raise InputError(f"{name}: the XML is truncated or damaged; export it again") from error


MAX_OBJECTS = 500
MAX_BOXES_BYTES = 4_000_000
"""Size of a boxes file: twenty times what five hundred boxes take; data sets of many pictures may be larger."""
MIN_BOX_PX = 2.0
CLIP_NOTICE_PX = 2.0


def read_boxes(source: Source, photo: DecodedPhoto) -> tuple[tuple[LabelledBox, ...], tuple[str, ...]]:
    """Boxes in photo pixels, and what was understood of their file.

    Raises:
        InputError: no boxes in any form, or a box that is degenerate or wholly outside the picture, named by its index.
    """
    file = _file(source, photo)
    if len(file.entries) > MAX_OBJECTS:
        raise InputError(
            f"{source.name}: {len(file.entries)} boxes are more than the {MAX_OBJECTS} accepted; keep the furniture"
        )
    corners, placing = place_boxes(source.name, file, photo)
    size = photo.photo.original_size
    scale = (photo.photo.width / size[0], photo.photo.height / size[1])
    boxes: list[LabelledBox] = []
    notes: list[str] = [*file.notes, *placing]
    for index, (entry, given) in enumerate(zip(file.entries, corners, strict=True)):
        word = _tidy(entry.word)
        if word.lower() in ARCHITECTURE_WORDS:
            notes.append(f"box {index} ('{word}') is part of the room itself and was left out")
            continue
        box, clipped = _clip_box(source.name, index, given, photo)
        if clipped:
            notes.append(f"box {index} ('{word}') reached outside the picture and was clipped")
        category, label, note = understand_word(word)
        notes += [note] if note else []
        scaled = (box[0] * scale[0], box[1] * scale[1], box[2] * scale[0], box[3] * scale[1])
        boxes.append(LabelledBox(scaled, category, label, entry.score))
    return tuple(boxes), tuple(dict.fromkeys(notes))


def understand_word(word: str) -> tuple[str, str, str]:
    """Category, label and a note for the user, of a word that was given as a class."""
    resolution = understand_label(word)
    label = UNKNOWN.name if resolution.exact and resolution.category is UNKNOWN else word
    return resolution.category.name, label, resolution.note


def _file(source: Source, photo: DecodedPhoto) -> BoxFile:
    """What the file says, by the first form that recognises it."""
    large = len(source.data) > MAX_BOXES_BYTES
    if large and b'"annotations"' not in source.data and b'"image_id"' not in source.data[:MAX_BOXES_BYTES]:
        raise InputError(
            f"{source.name}: {megabytes(len(source.data))} are more than {MAX_OBJECTS} boxes take; boxes are {EXAMPLE}"
        )
    text = parse_box_text(source, photo.photo.name, photo.frame.full_size)
    if isinstance(text.document, list) and not text.document:
        return BoxFile(())
    form = form_of(BOX_FORMS, text)
    try:
        if form is None:
            raise InputError(f"{source.name}: {_what_it_is(text.document)}")
        file = form.read(text)
    except InputError as error:
        advice = "" if "boxes are" in str(error) else f"; boxes are {EXAMPLE}"
        raise InputError(f"{error}{advice}") from error
    if not file.entries:
        raise InputError(f"{source.name}: this {form.name} file holds no box of the photo; boxes are {EXAMPLE}")
    return file


def _what_it_is(document: object) -> str:
    if isinstance(document, list):
        return f"entry 0 of this JSON list has no box ({shorten(repr(document[0]), 40)})"
    if isinstance(document, dict):
        return f"this JSON object holds no list of boxes (keys: {shorten(', '.join(map(str, document)), 60)})"
    if isinstance(document, Element):
        return f"this XML file ({shorten(document.tag, 40)}) is neither Pascal VOC nor CVAT"
    return "this text is in no form of boxes that is known (YOLO, CSV, KITTI), and is not valid JSON"


def _tidy(word: str) -> str:
    """One line, single spaces, no control characters: `night_stand` becomes `night stand`."""
    return re.sub(r"[\s_\x00-\x1f\x7f]+", " ", word).strip() or UNKNOWN.name


def _clip_box(name: str, index: int, bbox: tuple[float, float, float, float], photo: DecodedPhoto) -> tuple[Box, bool]:
    x1, y1, x2, y2 = bbox
    shown = "[" + ", ".join(f"{v:g}" for v in bbox) + "]"
    if x2 - x1 < MIN_BOX_PX or y2 - y1 < MIN_BOX_PX:
        raise InputError(f"{name}: box {index} {shown} has no area; give [x1, y1, x2, y2] with x1 < x2 and y1 < y2")
    width, height = photo.photo.original_size
    box = (min(max(x1, 0), width), min(max(y1, 0), height), min(max(x2, 0), width), min(max(y2, 0), height))
    if box[2] - box[0] < MIN_BOX_PX or box[3] - box[1] < MIN_BOX_PX:
        turned = f"; the photo's header turns it (orientation {photo.frame.orientation})" * (
            photo.frame.orientation > 1
        )
        raise InputError(
            f"{name}: box {index} {shown} lies outside the picture ({width} x {height} pixels){turned}; "
            "correct or remove it"
        )
    return box, max(abs(a - b) for a, b in zip(box, bbox, strict=True)) > CLIP_NOTICE_PX
