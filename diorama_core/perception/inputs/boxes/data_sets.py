"""COCO: data sets with their categories, and lists of results, whose boxes are x, y, width, height."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from diorama_core.errors import InputError
from diorama_core.io.bounded import parse_json, shorten
from diorama_core.perception.inputs.boxes.dictionaries import box_of, objects_of, score_of, size_of, word_of
from diorama_core.perception.inputs.boxes.entry import UNNAMED, BoxFile, BoxText, entries_of, picture_of

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
    image, rows = photo_of_data_set(text)
    count = len(objects_of(text.document.get("images")))
    named = f"{text.source.name} is of {count} pictures; the boxes of {image.get('file_name')} are used"
    file = _read(rows, _categories(text.document), text.source.name)
    size = size_of(image.get("width"), image.get("height"))
    return BoxFile(file.entries, size, notes=(named,) if count > 1 else ())


def photo_of_data_set(text: BoxText) -> tuple[Mapping[str, Any], list[Mapping[str, Any]]]:
    """The photo among a data set's pictures, empty where it lists none, and its annotations."""
    images, rows = objects_of(text.document.get("images")), list(_annotations(text.document))
    if not images:
        return {}, rows
    image = picture_of([(i.get("file_name", ""), i) for i in images], text, "COCO file")
    return image, [a for a in rows if a.get("image_id") == image.get("id")]


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
    boxes = (
        box_of(row, f"{where}: annotation {index}", "sized") if row.get("bbox") else box_of(row, where)
        for index, row in enumerate(rows)
    )
    pairs = zip(boxes, rows, strict=True)
    return BoxFile(entries_of((corners, word_of(row, names), score_of(row)) for corners, row in pairs))


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
