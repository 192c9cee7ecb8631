"""Files of annotation tools that write JSON: LabelMe, Label Studio, VGG Image Annotator."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from diorama_core.errors import InputError
from diorama_core.io.bounded import shorten
from diorama_core.perception.inputs.boxes.dictionaries import box_of, keys_of, score_of, word_of
from diorama_core.perception.inputs.boxes.entry import BoxEntry, BoxFile, BoxText, entries_of, picture_of
from diorama_core.perception.inputs.boxes.nested import size_in

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
