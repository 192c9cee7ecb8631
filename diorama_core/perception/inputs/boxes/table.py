"""The table of forms of boxes."""

from __future__ import annotations

import json
import re
from xml.etree.ElementTree import Element, ParseError, XMLParser

from diorama_core.errors import InputError
from diorama_core.io.bounded import parse_json
from diorama_core.perception.inputs.boxes import lines, lists, markup, tools
from diorama_core.perception.inputs.boxes.entry import BoxFile, BoxText, Size
from diorama_core.perception.inputs.source import Form, Source

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
