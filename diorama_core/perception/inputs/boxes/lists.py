"""Lists of annotations as detectors and Diorama write them, alone or within an object, bare boxes, and columns."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from diorama_core.errors import InputError
from diorama_core.io.bounded import shortened
from diorama_core.library.labels import names_a_kind
from diorama_core.perception.inputs.boxes.dictionaries import (
    box_numbers,
    has_class_number,
    keys_of,
    numbers,
    score_of,
    unused_words,
    word_of,
)
from diorama_core.perception.inputs.boxes.entry import (
    UNNAMED,
    BoxEntry,
    BoxFile,
    BoxText,
    Layout,
    Size,
    Unit,
    from_layout,
)
from diorama_core.perception.inputs.json_values import objects_of, size_of

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
    "cxcywh": "centred",
}
MAX_NESTING = 4


def is_list(text: BoxText) -> bool:
    """A JSON list of objects with a box each."""
    return any(_has_box(r) for r in objects_of(text.document))


def read_list(text: BoxText) -> BoxFile:
    """The annotations of a list."""
    return read_entries(objects_of(text.document), text.source.name)


def read_entries(
    rows: Sequence[Mapping[str, Any]],
    name: str,
    *,
    layout: Layout | None = None,
    size: Size | None = None,
    unit: Unit | None = None,
) -> BoxFile:
    """Annotations whose keys may be any program's.

    Args:
        rows: the annotations.
        name: of the file.
        layout: how four numbers are to be read, where the file says so.
        size: of the annotated picture, where the file says so.
        unit: of the coordinates, where the file says so.

    Raises:
        InputError: an entry has no box, or none of four finite numbers.
    """
    found, ambiguous = [], True
    for index, row in enumerate(rows):
        box = box_numbers(row, f"{name}: entry {index}")
        if box is None:
            raise InputError(
                f"{name}: entry {index} has no box ({_keys(row)}); boxes are a JSON list of "
                '{"bbox": [x1, y1, x2, y2], "class": "chair"}'
            )
        values, own, open_ = box
        ambiguous = ambiguous and open_ and layout is None
        turned = "box2d" in keys_of(row)
        values = (values[1], values[0], values[3], values[2]) if turned else values
        found.append(BoxEntry(from_layout(values, layout or own), word_of(row), score_of(row)))
        unit = "thousandths" if turned else unit
    words, notes = _words(rows, found)
    entries = tuple(BoxEntry(e.corners, w, e.score) for e, w in zip(found, words, strict=True))
    return BoxFile(entries, size, unit or "pixels", ambiguous, notes)


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
    return _columns(text.document) is not None


def read_columns(text: BoxText) -> BoxFile:
    """Boxes with the names and scores of the same place in their lists.

    Raises:
        InputError: the lists have different lengths.
    """
    keys = keys_of(_columns(text.document) or {})
    name = text.source.name
    boxes = next(rows for k in _COLUMNS if (rows := _rows_of_four(keys.get(k))))
    words = next((keys[k] for k in _COLUMN_WORDS if isinstance(keys.get(k), list)), None)
    scores = next((keys[k] for k in _COLUMN_SCORES if isinstance(keys.get(k), list)), None)
    for what, column in (("names", words), ("scores", scores)):
        if column is not None and len(column) != len(boxes):
            raise InputError(f"{name}: {len(boxes)} boxes have {len(column)} {what}; give one for each")
    layout = _layout(keys)
    entries = tuple(
        BoxEntry(
            from_layout(numbers(row[:4], f"{name}: box {index}"), layout or "corners"),
            word_of({"class": words[index]}) if words is not None else UNNAMED,
            score_of({"score": scores[index]}) if scores is not None else 1.0,
        )
        for index, row in enumerate(boxes)
    )
    notes = () if any(e.word != UNNAMED for e in entries) else (f"{name} names no class; the boxes have no names",)
    return BoxFile(entries, size_in(text.document), ambiguous_layout=layout is None, notes=notes)


def is_wrapped(text: BoxText) -> bool:
    """A JSON object that holds such a list somewhere."""
    return isinstance(text.document, dict) and next(_lists_in(text.document), None) is not None


def read_wrapped(text: BoxText) -> BoxFile:
    """The longest list of annotations within an object, with the picture's size that stands beside it."""
    document: Any = text.document
    rows, holder = max(_lists_in(document), key=lambda pair: len(pair[0]))
    layout = _layout(keys_of(holder)) or _layout(keys_of(document))
    first = keys_of(rows[0])
    if layout is None and {"x", "y", "width", "height", "class", "confidence"} <= first.keys():
        layout = "centred"  # Roboflow's x and y are the middle
    if layout is None and "coordinates" in first and isinstance(first["coordinates"], dict) and "label" in first:
        layout = "centred"  # CreateML's as well
    return read_entries(rows, text.source.name, layout=layout, size=size_in(holder) or size_in(document))


def size_in(document: object) -> Size | None:
    """The size of the annotated picture that an object states under one of the usual keys."""
    if not isinstance(document, dict):
        return None
    keys = keys_of(document)
    for name in ("image", "size", "imagesize", "picture", "metadata"):
        inner = keys.get(name)
        if isinstance(inner, list) and len(inner) == 1:
            inner = inner[0]
        if isinstance(inner, dict) and (size := size_in(inner)) is not None:
            return size
    pairs = (
        ("imagewidth", "imageheight"),
        ("originalwidth", "originalheight"),
        ("imgwidth", "imgheight"),
        ("width", "height"),
    )
    for w, h in pairs:
        if (size := size_of(keys.get(w), keys.get(h))) is not None:
            return size
    return None


def _words(rows: Sequence[Mapping[str, Any]], found: Sequence[BoxEntry]) -> tuple[list[str], tuple[str, ...]]:
    """The names of the boxes, and a note where they have none."""
    words = [e.word for e in found]
    if any(w != UNNAMED for w in words) or not rows or any("class" in r for r in rows):
        return words, ()
    unused = unused_words(rows)
    known = [k for k in unused if all(names_a_kind(str(r[k])) for r in rows)]
    if len(known) == 1:
        return [str(r[known[0]]) for r in rows], (f"the names of the boxes were read from '{shortened(known[0], 40)}'",)
    if unused:
        listed = ", ".join(f"'{shortened(k, 40)}'" for k in unused[:4])
        return words, (f"the boxes have no class; every entry holds a word under {listed}: call that key 'class'",)
    if any(has_class_number(r) for r in rows):
        return words, ("the classes of the boxes are numbers, and their names are in another file; give names instead",)
    return words, ("the boxes have no names; call what is in them under 'class'",)


def _layout(keys: Mapping[str, Any]) -> Layout | None:
    for key in ("format", "bboxformat", "boxformat", "bboxmode", "bboxtype", "mode"):
        value = keys.get(key)
        if isinstance(value, str) and (found := _FORMATS.get(value.lower().replace("_", "").replace(" ", ""))):
            return found
    return None


def _has_box(row: Mapping[str, Any]) -> bool:
    try:
        return box_numbers(row, "") is not None
    except InputError:
        return True  # it has one, of wrong numbers


def _lists_in(value: Any, level: int = 0) -> Iterator[tuple[list[dict[str, Any]], dict[str, Any]]]:
    """Lists of objects with boxes, each with the object that holds it."""
    if level > MAX_NESTING or not isinstance(value, dict | list):
        return
    if isinstance(value, list):
        for inner in value[:64]:
            yield from _lists_in(inner, level + 1)
        return
    for inner in value.values():
        if rows := [r for r in objects_of(inner) if _has_box(r)]:
            yield rows, value
        else:
            yield from _lists_in(inner, level + 1)


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
    return shortened("keys: " + ", ".join(map(str, row)), 80) if row else "it is empty"
