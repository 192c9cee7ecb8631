"""Reading boxes: what the file is, where its boxes lie in the photo, and what its words mean."""

from __future__ import annotations

import re
from xml.etree.ElementTree import Element

from diorama_core.artefacts import Box, LabelledBox
from diorama_core.errors import InputError
from diorama_core.io.bounded import megabytes, shorten
from diorama_core.library.labels import understand_label
from diorama_core.library.taxonomy import ARCHITECTURE_WORDS, UNKNOWN
from diorama_core.perception.inputs.boxes.entry import BoxFile
from diorama_core.perception.inputs.boxes.placing import place_boxes
from diorama_core.perception.inputs.boxes.table import BOX_FORMS, EXAMPLE, parse_box_text
from diorama_core.perception.inputs.photos.reading import DecodedPhoto
from diorama_core.perception.inputs.source import Source, form_of

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
