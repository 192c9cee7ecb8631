"""Lists of annotations as detectors and Diorama write them, alone or within an object, bare boxes, and columns."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from diorama_core.errors import InputError
from diorama_core.io.bounded import shorten
from diorama_core.library.labels import names_a_kind
from diorama_core.perception.inputs.boxes.entry import (
    UNNAMED,
    BoxEntry,
    BoxFile,
    BoxText,
    Layout,
    Size,
    Unit,
    from_layout,
    picture_of,
)
from diorama_core.perception.inputs.boxes.nested import (
    FIGURES,
    box_numbers,
    class_names_in,
    find_unused_words,
    has_box,
    has_class_number,
    keys_of,
    lists_in,
    numbers,
    objects_of,
    picture_name,
    pictures_in,
    rows_of_photo,
    score_of,
    size_in,
    word_of,
)

_COLUMNS = ("boxes", "bboxes", "predboxes", "xyxy", "detectionboxes", "bbox")
_COLUMN_WORDS = (
    "labels", "classnames", "names", "textlabels", "phrases", "classes", "bboxeslabels", "categories",
    "detectionclassentities", "predclasses", "detectionclasses",
)  # fmt: skip
_COLUMN_SCORES = ("scores", "confidences", "confidence", "logits", "detectionscores", "conf")
_FORMATS: dict[str, Layout] = {
    "xywh": "sized",
    "coco": "sized",
    "xyxy": "corners",
    "pascalvoc": "corners",
    "voc": "corners",
    "yxyx": "rows",
    "cxcywh": "centred",
}


def is_list(text: BoxText) -> bool:
    """A JSON list of objects with a box each."""
    return any(has_box(r) for r in objects_of(text.document))


def read_list(text: BoxText) -> BoxFile:
    """The annotations of a list."""
    return read_entries(rows_of_photo(objects_of(text.document), text), text.source.name)


def read_entries(
    rows: Sequence[Mapping[str, Any]],
    name: str,
    *,
    layout: Layout | None = None,
    size: Size | None = None,
    names: Mapping[int, str] | None = None,
) -> BoxFile:
    """Annotations whose keys may be any program's.

    Args:
        rows: the annotations.
        name: of the file.
        layout: how four numbers are to be read, where the file says so.
        size: of the annotated picture, where the file says so.
        names: of the numbers that stand for classes, where the file says so.

    Raises:
        InputError: an entry has no box, or none of four finite numbers.
    """
    boxes, ambiguous = [], True
    unit: Unit = "pixels"
    rows = [r for r in rows if has_box(r) or word_of(r).lower() != "background"]  # Grounded-SAM lists it as well
    for index, row in enumerate(rows):
        box = box_numbers(row, f"{name}: entry {index}")
        if box is None:
            raise InputError(
                f"{name}: entry {index} has no box ({_keys(row)}); boxes are a JSON list of "
                '{"bbox": [x1, y1, x2, y2], "class": "chair"}'
            )
        values, is_own_layout, open_ = box
        ambiguous = ambiguous and open_ and layout is None
        turned = isinstance(keys_of(row).get("box2d"), list)
        values = (values[1], values[0], values[3], values[2]) if turned else values
        boxes.append(BoxEntry(from_layout(values, layout or is_own_layout), word_of(row, names), score_of(row)))
        unit = "thousandths" if turned else unit
    words, notes = _words(rows, boxes)
    entries = tuple(BoxEntry(e.corners, w, e.score) for e, w in zip(boxes, words, strict=True))
    return BoxFile(entries, size, unit, ambiguous, notes)


def is_bare(text: BoxText) -> bool:
    """A JSON list of lists of four numbers or more."""
    return bool(_rows_of_four(text.document))


def read_bare(text: BoxText) -> BoxFile:
    """Boxes without names; a fifth number is a score, and a word anywhere a name."""
    entries = []
    for index, row in enumerate(_rows_of_four(text.document)):
        words = [v for v in row if isinstance(v, str)]
        values = [v for v in row if not isinstance(v, str)]
        corners = numbers(values[:4], f"{text.source.name}: box {index}")
        score = values[4] if len(values) > 4 and isinstance(values[4], float) and 0 <= values[4] <= 1 else 1.0
        entries.append(BoxEntry(corners, words[0] if words else UNNAMED, float(score)))
    note = f"{text.source.name} holds bare boxes; they were read as [x1, y1, x2, y2]"
    unnamed = all(e.word == UNNAMED for e in entries)
    return BoxFile(tuple(entries), ambiguous_layout=True, notes=(note + (" without names" if unnamed else ""),))


def is_columns(text: BoxText) -> bool:
    """A JSON object with a list of boxes, and lists of their names and scores beside it."""
    return _columns(text.document) is not None or any(_columns(d) is not None for d in objects_of(text.document))


def read_columns(text: BoxText) -> BoxFile:
    """Boxes with the names and scores of the same place in their lists."""
    document = _picture_in(objects_of(text.document), text)
    keys = keys_of(_columns(document) or {})
    name = text.source.name
    boxes = next(rows for k in _COLUMNS if (rows := _rows_of_four(keys.get(k))))
    columns = [keys[k] for k in _COLUMN_WORDS if isinstance(keys.get(k), list)]
    words = next((c for c in columns if len(c) == len(boxes)), columns[0] if columns else None)
    scores = next((keys[k] for k in _COLUMN_SCORES if isinstance(keys.get(k), list)), None)
    for what, column in (("names", words), ("scores", scores)):
        if column is not None and len(column) != len(boxes):
            raise InputError(f"{name}: {len(boxes)} boxes have {len(column)} {what}; give one for each")
    # TensorFlow's object detection has the rows of the picture before its columns.
    layout = _layout(keys) or ("rows" if "detectionboxes" in keys else None)
    names = class_names_in(document)
    entries = tuple(
        BoxEntry(
            from_layout(numbers(row[:4], f"{name}: box {index}"), layout or "corners"),
            word_of({"class": words[index]}, names) if words is not None else UNNAMED,
            score_of({"score": scores[index]}) if scores is not None else 1.0,
        )
        for index, row in enumerate(boxes)
    )
    notes = () if any(e.word != UNNAMED for e in entries) else (f"{name} names no class; the boxes have no names",)
    return BoxFile(entries, size_in(document), ambiguous_layout=layout is None, notes=notes)


def is_wrapped(text: BoxText) -> bool:
    """A JSON object, or a list of pictures, that holds such a list somewhere."""
    document = text.document
    inside = isinstance(document, dict) or bool(pictures_in(document))
    return inside and next(lists_in(document), None) is not None


def read_wrapped(text: BoxText) -> BoxFile:
    """The longest list of annotations within an object, with the picture's size that stands beside it."""
    document = _picture_in(pictures_in(text.document), text)
    lists = list(lists_in(document))
    if not lists:
        return BoxFile(())
    rows, holder = max(lists, key=lambda pair: len(pair[0]))
    layout = _layout(keys_of(holder)) or _layout(keys_of(document))
    first = keys_of(rows[0])
    if layout is None and {"x", "y", "width", "height", "class", "confidence"} <= first.keys():
        layout = "centred"  # Roboflow's x and y are the middle
    if layout is None and "coordinates" in first and isinstance(first["coordinates"], dict) and "label" in first:
        layout = "centred"  # CreateML's as well
    size = size_in(holder) or size_in(document)
    return read_entries(rows, text.source.name, layout=layout, size=size, names=class_names_in(text.document))


def is_keyed(text: BoxText) -> bool:
    """A JSON object with a box, or a list of boxes, under each name; or with a column under each number of a box."""
    return bool(_rows_by_key(text.document))


def read_keyed(text: BoxText) -> BoxFile:
    """Boxes by name or by number."""
    return read_entries(_rows_by_key(text.document), text.source.name)


def _rows_by_key(document: object) -> list[dict[str, Any]]:
    if not isinstance(document, dict) or not document or has_box(document):
        return []
    columns = [list(v.values()) if isinstance(v, dict) else v for v in document.values()]
    if all(isinstance(c, list) for c in columns) and len({len(c) for c in columns}) == 1 and columns[0]:
        rows = [dict(zip(document, values, strict=True)) for values in zip(*columns, strict=True)]
        if has_box(rows[0]) and not isinstance(rows[0].get("bbox"), dict):
            return rows
    rows = []
    for key, value in document.items():
        word = re.sub(r"[\s_-]*\d+$", "", str(key)) or UNNAMED
        if isinstance(value, dict) and has_box(value):
            rows.append(value if word_of(value) != UNNAMED else {**value, "class": word})
        elif boxes := _rows_of_four(value) or _rows_of_four([value]):
            rows += [{"bbox": list(b[:4]), "class": word} for b in boxes]
        else:
            return []
    return rows


def _picture_in(pictures: Sequence[Mapping[str, Any]], text: BoxText) -> Any:
    """What the file says of the photo among several pictures; all that it says where there are none."""
    return picture_of([(picture_name(p), p) for p in pictures], text, "file") if pictures else text.document


def _words(rows: Sequence[Mapping[str, Any]], entries: Sequence[BoxEntry]) -> tuple[list[str], tuple[str, ...]]:
    """The names of the boxes, and a note where they have none."""
    words = [e.word for e in entries]
    if any(w != UNNAMED for w in words) or not rows or any("class" in r for r in rows):
        return words, ()
    unused = find_unused_words(rows)
    known = [k for k in unused if all(names_a_kind(str(r[k])) and str(r[k]).lower() not in FIGURES for r in rows)]
    if len(known) == 1:
        return [str(r[known[0]]) for r in rows], (f"the names of the boxes were read from '{shorten(known[0], 40)}'",)
    if unused:
        listed = ", ".join(f"'{shorten(k, 40)}'" for k in unused[:4])
        return words, (f"the boxes have no class; every entry holds a word under {listed}: call that key 'class'",)
    if any(has_class_number(r) for r in rows):
        return words, ("the classes of the boxes are numbers, and their names are in another file; give names instead",)
    return words, ("the boxes have no names; call what is in them under 'class'",)


def _layout(keys: Mapping[str, Any]) -> Layout | None:
    for key in ("format", "bboxformat", "boxformat", "bboxmode", "bboxtype", "mode"):
        value = keys.get(key)
        if isinstance(value, str) and (layout := _FORMATS.get(value.lower().replace("_", "").replace(" ", ""))):
            return layout
    return None


def _columns(value: object, level: int = 0) -> dict[str, Any] | None:
    if not isinstance(value, dict) or level > 2:
        return None
    keys = keys_of(value)
    if any(_rows_of_four(keys.get(k)) for k in _COLUMNS):
        return value
    return next((c for v in value.values() if (c := _columns(v, level + 1)) is not None), None)


def _rows_of_four(value: object) -> list[list[Any]]:
    """The rows of a list of lists with four entries or more each; none where it is something else."""
    return value if isinstance(value, list) and all(isinstance(r, list) and len(r) >= 4 for r in value) else []


def _keys(row: Mapping[str, Any]) -> str:
    return shorten("keys: " + ", ".join(map(str, row)), 80) if row else "it is empty"
