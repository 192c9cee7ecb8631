"""COCO: data sets with their categories, and lists of results, whose boxes are x, y, width, height."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from diorama_core.errors import InputError
from diorama_core.io.bounded import parse_json, shorten
from diorama_core.perception.inputs.boxes.dictionaries import box_of, score_of, word_of
from diorama_core.perception.inputs.boxes.entry import UNNAMED, BoxEntry, BoxFile, BoxText, Size, picture_of
from diorama_core.perception.inputs.json_values import objects_of, size_of

_RESULT_KEYS = frozenset({"image_id", "category_id", "area", "iscrowd", "segmentation"})
MAX_CATEGORY_BYTES = 64_000_000


def is_data_set(text: BoxText) -> bool:
    """A JSON object with annotations and the images or categories that they belong to."""
    document = text.document
    if not isinstance(document, dict) or not objects_of(document.get("annotations")):
        return False
    return "images" in document or "categories" in document


def read_data_set(text: BoxText) -> BoxFile:
    """The boxes of the photo, by its file name where the data set holds several pictures."""
    document: Any = text.document
    image, rows = photo_of_data_set(text)
    count = len(objects_of(document.get("images")))
    named = f"{text.source.name} is of {count} pictures; the boxes of {(image or {}).get('file_name')} are used"
    notes = (named,) if count > 1 else ()
    file = _read(rows, _categories(document), text.source.name)
    return BoxFile(file.entries, _size(image), notes=(*notes, *file.notes))


def photo_of_data_set(text: BoxText) -> tuple[Mapping[str, Any] | None, list[Mapping[str, Any]]]:
    """The photo among a data set's pictures, None where it lists none, and its annotations.

    Raises:
        InputError: of several pictures none is the photo.
    """
    document: Any = text.document
    images = objects_of(document.get("images"))
    image = picture_of(images, [i.get("file_name", "") for i in images], text, "COCO file") if images else None
    return image, [a for a in _annotations(document) if image is None or a.get("image_id") == image.get("id")]


def _annotations(document: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    """One for each box: those of panoptic segmentation are segments within one for each picture."""
    for row in document["annotations"]:
        segments = objects_of(row.get("segments_info"))
        yield from [{**segment, "image_id": row.get("image_id")} for segment in segments] or [row]


def is_results(text: BoxText) -> bool:
    """A JSON list of boxes with keys that only COCO has."""
    return any("bbox" in r and _RESULT_KEYS & r.keys() for r in objects_of(text.document))


def read_results(text: BoxText) -> BoxFile:
    """The boxes of the photo; their names are in another file, which is looked for beside."""
    of_photo = rows_of_results(objects_of(text.document), text)
    names = _categories_beside(text)
    file = _read(of_photo, names, text.source.name)
    needs = not names and all(e.word == UNNAMED for e in file.entries)
    note = f"{text.source.name} holds COCO results: boxes are [x, y, width, height]"
    if needs:
        note += "; their names are unknown, category_id needs the file with `categories` beside it"
    return file.with_notes(note)


def _read(rows: Sequence[Mapping[str, Any]], names: Mapping[int, str], where: str) -> BoxFile:
    entries = []
    for index, row in enumerate(rows):
        corners = box_of(row, f"{where}: annotation {index}", "sized") if row.get("bbox") else box_of(row, where)
        if corners is not None:
            entries.append(BoxEntry(corners, word_of(row, names), score_of(row)))
    return BoxFile(tuple(entries))


def rows_of_results(rows: Sequence[Mapping[str, Any]], text: BoxText) -> list[Mapping[str, Any]]:
    """The results of the photo, by the number in its name.

    Raises:
        InputError: they are of several pictures, and none is the photo.
    """
    pictures = {str(r.get("image_id")) for r in rows}
    if len(pictures) < 2:
        return list(rows)
    digits = re.findall(r"\d+", Path(text.photo_name).stem)
    wanted = {Path(text.photo_name).stem, *digits, *(d.lstrip("0") for d in digits)}
    matches = [r for r in rows if str(r.get("image_id")) in wanted]
    if not matches:
        raise InputError(
            f"{text.source.name}: these COCO results are of {len(pictures)} pictures, and no image_id is that of "
            f"{shorten(text.photo_name, 60)}; keep the results of this photo"
        )
    return matches


def _categories(document: Mapping[str, Any]) -> dict[int, str]:
    pairs = [(r.get("id"), r.get("name")) for r in objects_of(document.get("categories"))]
    return {number: name for number, name in pairs if isinstance(number, int) and isinstance(name, str)}


def _categories_beside(text: BoxText) -> dict[int, str]:
    """The names of a data set's file beside the results."""
    for file in text.source.sibling_files("*.json"):
        if b'"categories"' not in file.data or len(file.data) > MAX_CATEGORY_BYTES:
            continue
        try:
            document = parse_json(file.data, file.name, InputError)
        except InputError:
            continue  # another file of the folder, which nobody asked to read
        if isinstance(document, dict) and (names := _categories(document)):
            return names
    return {}


def _size(image: Mapping[str, Any] | None) -> Size | None:
    return None if image is None else size_of(image.get("width"), image.get("height"))
