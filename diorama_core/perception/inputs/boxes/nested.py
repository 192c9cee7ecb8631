"""Annotations deep within a JSON value: which lists hold boxes, of which picture, and what class numbers mean."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from diorama_core.errors import InputError
from diorama_core.perception.inputs.boxes.dictionaries import (
    box_numbers,
    has_class_number,
    keys_of,
    objects_of,
    size_of,
    word_of,
)
from diorama_core.perception.inputs.boxes.entry import UNNAMED, BoxText, Size, rows_of_picture

MAX_NESTING = 8
_PICTURES = (
    "image",
    "file",
    "imagename",
    "name",
    "filename",
    "filepath",
    "path",
    "externalid",
    "url",
    "imagepath",
    "id",
)
"""Keys under which an annotated picture has its name."""
_FILES = ("image", "imagename", "filename", "filepath", "imagepath", "file")
PICTURE_FILE = re.compile(r"\.(?:jpe?g|png|webp|bmp|tiff?|heic)$", re.IGNORECASE)
_CLASS_NAMES = ("classmap", "id2label", "classes", "names", "classnames", "labelmap", "categories", "labels")


def class_names_in(value: object, level: int = 0) -> dict[int, str]:
    """The names of class numbers that stand beside annotations: a list, or an object by number; none otherwise."""
    if not isinstance(value, dict) or level > 3:
        return {}
    for key, inner in keys_of(value).items():
        if key in _CLASS_NAMES and (names := _names_by_number(inner)):
            return names
    return next((names for inner in value.values() if (names := class_names_in(inner, level + 1))), {})


def _names_by_number(value: object) -> dict[int, str]:
    if isinstance(value, dict) and value and all(str(k).isdigit() and isinstance(v, str) for k, v in value.items()):
        return {int(k): str(v) for k, v in value.items()}
    if not isinstance(value, list) or not value:
        return {}
    if all(isinstance(v, str) for v in value):
        return dict(enumerate(value))
    rows = [r for r in objects_of(value) if isinstance(r.get("name"), str) and not has_box(r)]
    return {r["id"] if isinstance(r.get("id"), int) else k: r["name"] for k, r in enumerate(rows)}


def pictures_in(value: object, level: int = 0) -> list[dict[str, Any]]:
    """Annotated pictures, each with its own list of boxes; none where the boxes are of one picture."""
    if level > 3:
        return []
    if isinstance(value, dict) and len(value) > 1 and all(PICTURE_FILE.search(str(key)) for key in value):
        return [{"filename": name, "annotations": inner} for name, inner in value.items()]
    rows = objects_of(value)
    if rows and not any(has_box(r) for r in rows) and all(picture_name(r) for r in rows):
        inside = [pair[0] for r in rows if (pair := next(lists_in(r), None)) is not None]
        named = inside and all(word_of(b) != UNNAMED or has_class_number(b) for boxes in inside for b in boxes)
        return rows if named else []
    inner = value.values() if isinstance(value, dict) else rows
    return next((pictures for v in inner if (pictures := pictures_in(v, level + 1))), [])


def rows_of_photo(rows: Sequence[Mapping[str, Any]], text: BoxText) -> list[Mapping[str, Any]]:
    """The annotations of the photo, where each says of which picture it is."""
    key = next((k for k in _FILES if all(isinstance(keys_of(r).get(k), str) for r in rows)), None)
    return rows_of_picture(((None if key is None else keys_of(row)[key], row) for row in rows), text, "file")


def picture_name(row: Mapping[str, Any]) -> str:
    """The name of an annotated picture; empty where it has none."""
    keys = keys_of(row)
    return next((str(keys[k]) for k in _PICTURES if isinstance(keys.get(k), str | int) and str(keys[k])), "")


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


def has_box(row: Mapping[str, Any]) -> bool:
    """Whether an annotation has a box, be it of wrong numbers."""
    try:
        return box_numbers(row, "") is not None
    except InputError:
        return True  # it has one, of wrong numbers


def lists_in(value: Any, level: int = 0) -> Iterator[tuple[list[dict[str, Any]], dict[str, Any]]]:
    """Lists of objects with boxes, each with the object that holds it."""
    if level > MAX_NESTING or not isinstance(value, dict | list):
        return
    if isinstance(value, list):
        for inner in value[:64]:
            yield from lists_in(inner, level + 1)
        return
    for inner in value.values():
        if (rows := [r for r in objects_of(inner) if has_box(r)]) or (rows := _instances(objects_of(inner))):
            yield rows, value
        else:
            yield from lists_in(inner, level + 1)


def _instances(kinds: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Boxes that have no name of their own, in lists under the kind that each of them is of."""
    instances = []
    for kind in kinds:
        lists = [objects_of(v) for v in kind.values()]
        rows = next((rows for rows in lists if rows and all(has_box(r) for r in rows)), [])
        if any(word_of(r) != UNNAMED or has_class_number(r) for r in rows):
            return []
        instances += [{**row, "class": word_of(kind)} for row in rows]
    return instances
