"""Files of annotation tools that write JSON: COCO, LabelMe, Label Studio, VGG Image Annotator.

COCO's are data sets with their categories, and lists of results; their boxes are x, y, width, height.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from diorama_core.errors import InputError
from diorama_core.io.bounded import parse_json, shorten
from diorama_core.perception.inputs.boxes.entry import UNNAMED, BoxEntry, BoxFile, BoxText, entries_of, picture_of
from diorama_core.perception.inputs.boxes.nested import box_of, keys_of, objects_of, score_of, size_in, size_of, word_of

MAX_NESTING = 8
"""Nesting depth of results: a task, its annotations, their results, each in a list."""


def is_labelme(text: BoxText) -> bool:
    """A JSON object with `shapes` that have points."""
    shapes = text.document.get("shapes") if isinstance(text.document, dict) else None
    return isinstance(shapes, list) and all(isinstance(s, dict) and "points" in s for s in shapes)


def read_labelme(text: BoxText) -> BoxFile:
    """Rectangles, and the bounds of polygons, circles and lines; points alone are left out."""
    entries, left_out = [], 0
    for index, shape in enumerate(text.document["shapes"]):
        shape = _circle_as_box(shape)
        corners = box_of(shape, f"{text.source.name}: shape {index}")
        if corners is None or shape.get("shape_type") == "point":
            left_out += 1
        else:
            entries.append(BoxEntry(corners, word_of(shape)))
    notes = (f"{left_out} of {text.source.name}'s shapes are points and were left out",) if left_out else ()
    return BoxFile(tuple(entries), size_in(text.document), notes=notes)


def is_label_studio(text: BoxText) -> bool:
    """Results in percent with the size of the picture beside them, in tasks or alone."""
    return next(_studio_results(text.document), None) is not None


def read_label_studio(text: BoxText) -> BoxFile:
    """Rectangles and the bounds of polygons of the photo's task."""
    results = list(_studio_results(_task_of(text)))
    boxes = []
    for index, result in enumerate(results):
        value = result.get("value", result)
        boxes.append((box_of(value, f"{text.source.name}: result {index}"), word_of(value), score_of(result)))
    return BoxFile(entries_of(boxes), next(filter(None, map(size_in, results)), None), "percent")


def is_via(text: BoxText) -> bool:
    """Regions with `shape_attributes`, by picture."""
    return bool(_via_pictures(text.document))


def read_via(text: BoxText) -> BoxFile:
    """The regions of the photo."""
    boxes = []
    for index, region in enumerate(regions_of(text)):
        shape = keys_of(region.get("shape_attributes") or {}) if isinstance(region, dict) else {}
        if isinstance(shape.get("allpointsx"), list) and isinstance(shape.get("allpointsy"), list):
            points = [[x, y] for x, y in zip(shape["allpointsx"], shape["allpointsy"], strict=False)]
            shape = {"points": points}
        boxes.append((box_of(shape, f"{text.source.name}: region {index}"), word_of(region), 1.0))
    return BoxFile(entries_of(boxes))


def regions_of(text: BoxText) -> list[Any]:
    """The regions of the photo."""
    pictures = _via_pictures(text.document)
    regions = picture_of([(p.get("filename", ""), p) for p in pictures], text, "VIA file")["regions"]
    return list(regions.values()) if isinstance(regions, dict) else list(regions)


def _circle_as_box(shape: Mapping[str, Any]) -> Mapping[str, Any]:
    """LabelMe's circles are a middle and a point on the line."""
    points = shape.get("points")
    if shape.get("shape_type") != "circle" or not isinstance(points, list) or len(points) != 2:
        return shape
    try:
        (x, y), (on_x, on_y) = points
        radius = ((on_x - x) ** 2 + (on_y - y) ** 2) ** 0.5
    except (TypeError, ValueError, OverflowError):
        return shape
    return {**shape, "points": [[x - radius, y - radius], [x + radius, y + radius]]}


def _task_of(text: BoxText) -> object:
    tasks = text.document
    if not isinstance(tasks, list) or sum(next(_studio_results(t), None) is not None for t in tasks) < 2:
        return tasks
    if all(isinstance(t, dict) and "value" in t for t in tasks):
        return tasks  # results, not tasks
    stem = Path(text.photo_name).stem
    named = [t for t in tasks if isinstance(t, dict) and stem in str(t.get("data", t.get("image", "")))]
    if len(named) != 1:
        raise InputError(
            f"{text.source.name}: it is of {len(tasks)} pictures, none of them called {shorten(text.photo_name, 60)}; "
            "keep what is of this photo"
        )
    return named[0]


def _studio_results(value: object, level: int = 0) -> Iterator[dict[str, Any]]:
    if level > MAX_NESTING:
        return
    if isinstance(value, list):
        for inner in value:
            yield from _studio_results(inner, level + 1)
    elif isinstance(value, dict):
        box = value.get("value", value)
        named = isinstance(box, dict) and any(k in box for k in ("rectanglelabels", "polygonlabels", "labels"))
        if named and "original_width" in value:
            yield value
            return
        # Corrected annotations come before the predictions that they were made from.
        for key in ("annotations", "completions", "result", "label", "bbox", "predictions"):
            results = list(_studio_results(value.get(key), level + 1))
            yield from results
            if results:
                return


def _via_pictures(document: object) -> list[dict[str, Any]]:
    if not isinstance(document, dict):
        return []
    pictures = document.get("_via_img_metadata", document)
    pictures_listed = list(pictures.values()) if isinstance(pictures, dict) else []
    is_via_file = pictures_listed and all(
        isinstance(p, dict) and isinstance(p.get("regions"), list | dict) for p in pictures_listed
    )
    return pictures_listed if is_via_file else []


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
