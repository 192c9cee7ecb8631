"""One annotation as a JSON object: where its box, its name and its score are, whatever the program calls them.

Values of parsed JSON with the type that a reader needs, or none where a file holds something else.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from diorama_core.errors import InputError
from diorama_core.io.bounded import shorten
from diorama_core.perception.inputs.boxes.entry import UNNAMED, Corners, Layout, from_layout

MAX_COORDINATE = 1e9
MAX_WORD = 200
MAX_SIDE = 1e6
"""In pixels: no picture is larger, so that what is larger is no side of one."""
_SCORE = re.compile(r"\s*(?:\(\s*[01]?\.\d+\s*\)|\s[01]?\.\d+)\s*$")
"""Behind a word, as in "chair(0.45)" of Grounding DINO and "chair 0.87" of drawn labels."""
_LISTS: tuple[tuple[str, Layout], ...] = (
    ("bbox", "corners"), ("box", "corners"), ("xyxy", "corners"), ("bboxxyxy", "corners"), ("boxxyxy", "corners"),
    ("bbox2d", "corners"), ("box2d", "corners"), ("rect", "corners"), ("xywh", "sized"), ("bboxxywh", "sized"),
    ("boundingbox", "sized"),
    ("boundingrect", "sized"), ("cxcywh", "centred"), ("coordinates", "corners"), ("bndbox", "corners"),
)  # fmt: skip
"""Keys (lower case, letters and digits only) of four numbers. fiftyone's `bounding_box` holds width and height."""
_SCALARS: tuple[tuple[tuple[str, str, str, str], Layout], ...] = (
    (("xmin", "ymin", "xmax", "ymax"), "corners"), (("x1", "y1", "x2", "y2"), "corners"),
    (("x0", "y0", "x1", "y1"), "corners"), (("xtl", "ytl", "xbr", "ybr"), "corners"),
    (("left", "top", "right", "bottom"), "corners"), (("startx", "starty", "endx", "endy"), "corners"),
    (("originx", "originy", "width", "height"), "sized"), (("left", "top", "width", "height"), "sized"),
    (("xcenter", "ycenter", "width", "height"), "centred"), (("xcentre", "ycentre", "width", "height"), "centred"),
    (("cx", "cy", "width", "height"), "centred"), (("cx", "cy", "w", "h"), "centred"),
    (("x", "y", "width", "height"), "sized"), (("x", "y", "w", "h"), "sized"),
)  # fmt: skip
_CORNERS = (
    ("topleft", "bottomright"), ("lefttop", "rightbottom"), ("tl", "br"), ("min", "max"), ("start", "end"),
    ("p1", "p2"), ("pt1", "pt2"),
)  # fmt: skip
"""Keys of two opposite corners, each [x, y] or {"x":, "y":}."""
_NESTED = (
    "bbox", "box", "boundingbox", "bndbox", "rect", "rectangle", "coordinates", "value", "shapeattributes",
    "boundingpoly", "polygon", "bounds", "points", "regionshapeattributes", "box2d",
)  # fmt: skip
_POINTS = ("points", "polygon", "vertices", "normalizedvertices", "exterior", "segmentation", "contour")
_WORDS = (
    "class", "label", "name", "category", "categoryname", "classname", "labelname", "classtitle", "type", "tag",
    "object", "text", "caption", "phrase", "title", "rectanglelabels", "polygonlabels", "labels",
)  # fmt: skip
FIGURES = frozenset({"rectangle", "rect", "bbox", "box", "polygon", "rectanglelabels", "bounding_box", "bounding box"})
"""What tools say of the drawn figure under `type`, not of what is in it: elsewhere a box is a box."""
_SCORES = ("score", "confidence", "conf", "probability", "prob", "predictediou", "certainty")


def objects_of(value: object) -> list[dict[str, Any]]:
    """The entries of a list of objects; none where it is no list, or one that holds anything else."""
    return value if isinstance(value, list) and all(isinstance(v, dict) for v in value) else []


def size_of(width: object, height: object) -> tuple[int, int] | None:
    """Width and height of a picture; None where they are no numbers, or no sides of a picture."""
    if not isinstance(width, int | float) or not isinstance(height, int | float):
        return None
    return (int(width), int(height)) if 1 < width < MAX_SIDE and 1 < height < MAX_SIDE else None


def keys_of(entry: Mapping[str, Any]) -> dict[str, Any]:
    """The values by their keys in lower case with letters and digits only, so that `boundingBox` is `bounding_box`."""
    if not isinstance(entry, Mapping):
        return {}  # a damaged file has anything here
    return {re.sub(r"[^a-z0-9]", "", str(key).lower()): value for key, value in entry.items()}


def box_numbers(entry: Mapping[str, Any], where: str) -> tuple[Corners, Layout, bool] | None:
    """Four numbers, how they are to be read, and whether their key leaves that open; None where there is no box.

    Raises:
        InputError: there is a key of a box, but not four finite numbers under it.
    """
    keys = keys_of(entry)
    for names, layout in _SCALARS:
        if all(name in keys for name in names) and not any(isinstance(keys[n], list | dict) for n in names):
            return numbers([keys[name] for name in names], where), layout, False
    for name, layout in _LISTS:
        given = keys.get(name)
        given = re.split(r"[,\s]+", given.strip("[]() ")) if isinstance(given, str) else given
        if isinstance(given, list) and not _is_points(given):
            return numbers(given, where), layout, name in ("bbox", "box", "rect", "coordinates")
    for low, high in _CORNERS:
        if low in keys and high in keys and (extent := _extent([keys[low], keys[high]], where)) is not None:
            return extent, "corners", False
    for name in _POINTS:
        if name in keys and (extent := _extent(keys[name], where)) is not None:
            return extent, "corners", False
    for name in _NESTED:
        inner = keys.get(name)
        if isinstance(inner, Mapping) and (inner_box := box_numbers(inner, where)) is not None:
            return inner_box
        if isinstance(inner, list) and (extent := _extent(inner, where)) is not None:
            return extent, "corners", False
    return None


def box_of(entry: Mapping[str, Any], where: str, layout: Layout | None = None) -> Corners | None:
    """The corners of an annotation's box, its four numbers read as `layout` says; None where there is none."""
    numbers = box_numbers(entry, where)
    return None if numbers is None else from_layout(numbers[0], layout or numbers[1])


def word_of(entry: Mapping[str, Any], names: Mapping[int, str] | None = None) -> str:
    """The name of what is in the box, by `names` where its class is a number; "object" where there is none."""
    keys = keys_of(entry)
    for key in _WORDS:
        word = _word(keys.get(key))
        if word is not None and not (key == "type" and word.strip().lower() in FIGURES):
            return word
    for key in ("regionattributes", "attributes", "value"):
        inner = keys.get(key)
        if isinstance(inner, Mapping):
            inner_word = word_of(inner, names)
            words = [w for v in inner.values() if (w := _word(v)) is not None]
            if inner_word != UNNAMED or (key == "regionattributes" and words):
                return inner_word if inner_word != UNNAMED else words[0]
    number = next((keys[k] for k in ("categoryid", "classid", "class", "label", "labelid") if k in keys), None)
    return (names or {}).get(number, UNNAMED) if isinstance(number, int) else UNNAMED


def has_class_number(entry: Mapping[str, Any]) -> bool:
    """Whether its class is a number only."""
    keys = keys_of(entry)
    return any(isinstance(keys.get(k), int | float) for k in ("categoryid", "classid", "class", "label", "labelid"))


def find_unused_words(entries: Iterable[Mapping[str, Any]]) -> tuple[str, ...]:
    """Keys under which every entry holds a word that is not read as its class."""
    common: dict[str, None] | None = None
    for entry in entries:
        here = {str(k): None for k, v in entry.items() if isinstance(v, str) and v.strip()}
        common = here if common is None else {k: None for k in common if k in here}
    return tuple(common or ())


def score_of(entry: Mapping[str, Any]) -> float:
    """How sure the detector is, 0 to 1; 1 where it does not say."""
    keys = keys_of(entry)
    value = next((keys[k] for k in _SCORES if k in keys), 1.0)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value) or value < 0:
        return 1.0
    return float(value / 100.0 if 1.0 < value <= 100.0 else min(value, 1.0))


def numbers(values: Sequence[Any], where: str) -> Corners:
    """Four finite numbers.

    Raises:
        InputError: they are not.
    """
    try:
        if any(isinstance(v, bool) for v in values):
            raise ValueError
        a, b, c, d = (float(v) for v in values)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{where}: {shorten(str(values), 60)} are not the four numbers of a box") from None
    if not all(abs(v) <= MAX_COORDINATE for v in (a, b, c, d)):
        raise InputError(f"{where}: {shorten(str(values), 60)} are too large for a box")
    return a, b, c, d


def _word(value: Any) -> str | None:
    if isinstance(value, list) and len(value) == 1:
        value = value[0]
    if not isinstance(value, str) or not value.strip():
        return None
    return _SCORE.sub("", value[:MAX_WORD]) or value[:MAX_WORD]


def _is_points(values: list[Any]) -> bool:
    return bool(values) and all(isinstance(v, list | dict) for v in values)


def _extent(points: Any, where: str) -> Corners | None:
    """The bounds of points ([x, y], {"x":, "y":}, or one list of x, y, x, y...); None where it holds none."""
    if isinstance(points, Mapping):
        inner = keys_of(points)
        return next((e for k in _POINTS if k in inner and (e := _extent(inner[k], where)) is not None), None)
    if not isinstance(points, list) or not points:
        return None
    flat: list[Any] = []
    for point in points:
        if isinstance(point, Mapping) and "x" in (inner := keys_of(point)) and "y" in inner:
            flat += [inner["x"], inner["y"]]
        elif isinstance(point, list):
            flat += [v for p in point for v in p] if point and all(isinstance(p, list) for p in point) else point
        else:
            flat.append(point)
    if len(flat) < 4 or len(flat) % 2 or any(isinstance(v, bool) or not isinstance(v, int | float) for v in flat):
        return None
    return numbers((min(flat[::2]), min(flat[1::2]), max(flat[::2]), max(flat[1::2])), where)
