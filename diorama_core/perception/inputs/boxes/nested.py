"""Annotations as JSON objects, and where they are within a JSON value.

Of one, where its box, its name and its score are, whatever the program calls them; of a value, which lists hold boxes,
of which picture, and what class numbers mean.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from diorama_core.errors import InputError
from diorama_core.io.bounded import shorten
from diorama_core.perception.inputs.boxes.entry import (
    UNNAMED,
    BoxText,
    Corners,
    Layout,
    Size,
    from_layout,
    rows_of_picture,
)

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
