"""Where the boxes of a file lie in the photo: as it states, or as agrees best with the edges of the picture."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from diorama_core.errors import InputError
from diorama_core.perception.inputs.boxes.agreement import EdgeMap
from diorama_core.perception.inputs.boxes.entry import BoxFile, Corners, Layout, Size, from_layout
from diorama_core.perception.inputs.photos.frame import ASPECT_TOLERANCE
from diorama_core.perception.inputs.photos.reading import DecodedPhoto

MIN_BOXES = 3
"""Fewer boxes do not tell by the picture's edges where they belong."""
MARGIN_OF_ONE = 0.25
"""By which another reading of a single box would have to agree better; of several, less by the root of their number."""
MIN_MARGIN = 0.06
MIN_AGREEMENT = 1.1
"""Agreement of boxes that do not fit as given: over 23 photos, right readings reach 1.17, wrong ones at most 1.14."""
CLEAR_AGREEMENT = 1.25
"""At which boxes are right as they are, without a look at other readings: wrong ones never reach it."""
SMALL_EXTENT = 0.6
"""Boxes that all end before this share of both sides may belong to a smaller copy."""
FULL_EXTENT = 0.7
"""Boxes that end behind it in percent of both sides are in percent."""
FRACTIONS = (1 / 2, 1 / 3, 1 / 4, 2 / 3, 3 / 4, 1 / 8, 2.0, 3.0, 4.0)
LONG_SIDES = (
    224, 256, 320, 384, 416, 448, 480, 512, 518, 560, 600, 640, 672, 720, 768, 800, 896, 960, 1000, 1008,
    1024, 1080, 1120, 1200, 1280, 1333, 1344, 1365, 1440, 1500, 1536, 1600, 1920, 2000, 2016, 2048, 2560,
    2592, 3000, 3024, 3264, 3840, 4000, 4032, 4080, 4096, 4128, 4160, 4608, 4624, 5184, 5472, 5712, 6000,
    6016, 8000, 8064, 9248,
)  # fmt: skip
"""Picture sides of the copies that networks and programs make, and of phones' and cameras' originals."""

_LAYOUTS: dict[Layout, str] = {
    "sized": "x, y, width, height",
    "centred": "the middle, width and height",
    "rows": "y1, x1, y2, x2",
}
_UNIT_SIDES = {"shares": 1.0, "percent": 100.0, "thousandths": 1000.0}


@dataclass(frozen=True)
class _Reading:
    """One way to lay the boxes over the upright file."""

    corners: list[Corners]
    note: str = ""


def place_boxes(name: str, file: BoxFile, photo: DecodedPhoto) -> tuple[list[Corners], tuple[str, ...]]:
    """The boxes in pixels of the upright original without its border, and what was done to them.

    Raises:
        InputError: the annotated picture has other proportions than the photo.
    """
    if not file.entries:
        return [], ()
    corners = [e.corners for e in file.entries]
    frame = photo.frame
    unit, notes = _unit_of(file, corners, photo)
    if unit != "pixels":
        side = _UNIT_SIDES[unit]
        stored = file.size is not None and file.size == frame.stored_size != frame.full_size
        width, height = frame.stored_size if stored else frame.full_size
        corners = _scale(corners, width / side, height / side)
        others = _other_layouts(corners) if file.ambiguous_layout else ()
        readings = (
            [_turn_upright(corners, photo)]
            if stored
            else [_Reading(corners), *others, *_readings_of_stored_pixels(corners, photo)]
        )
    elif file.size is not None:
        readings = [_reading_of_stated_size(name, corners, file.size, photo)]
    else:
        readings = [_Reading(corners), *_others(corners, photo, file.ambiguous_layout)]
    chosen = _best(readings, photo)
    moved = _within_border(chosen.corners, photo)
    hint = _small_copy_hint(chosen, file, photo) if unit == "pixels" and not chosen.note else ""
    return moved, tuple(note for note in (*notes, chosen.note, hint) if note)


def _unit_of(file: BoxFile, corners: list[Corners], photo: DecodedPhoto) -> tuple[str, tuple[str, ...]]:
    """What the coordinates are of, seen by their size where the form leaves it open."""
    values = np.array(corners)
    if file.unit != "pixels":
        return file.unit, ()
    if values.min() >= -0.01 and values.max() <= 1.01:
        return "shares", ("the boxes are in shares of the picture",)
    width, height = photo.frame.full_size
    wide = values[:, 2].max(), values[:, 3].max()
    percent = values.min() >= 0 and max(wide) <= 100.5 and min(wide) > 100 * FULL_EXTENT
    if percent and len(corners) >= MIN_BOXES and min(width, height) > 300 and file.size is None:
        return "percent", ("the boxes are in percent of the picture",)
    return "pixels", ()


def _reading_of_stated_size(name: str, corners: list[Corners], size: Size, photo: DecodedPhoto) -> _Reading:
    """The boxes of a picture of the stated size."""
    frame = photo.frame
    if size == frame.full_size or _is_rounded(size, frame.full_size):
        return _Reading(corners)
    if any(frame.margins) and size == frame.inner_size:
        left, top = frame.margins[:2]
        return _Reading([(x1 + left, y1 + top, x2 + left, y2 + top) for x1, y1, x2, y2 in corners])
    for target, turns in ((frame.full_size, False), (frame.stored_size, True)):
        if abs((size[0] / size[1]) / (target[0] / target[1]) - 1.0) > ASPECT_TOLERANCE:
            continue
        scaled = _scale(corners, target[0] / size[0], target[1] / size[1])
        note = f"the boxes are of a copy of {size[0]} x {size[1]} pixels; they were scaled to the photo"
        turned = _turn_upright(scaled, photo)
        return turned if turns and size == target else _Reading(turned.corners if turns else scaled, note)
    width, height = frame.full_size
    raise InputError(
        f"{name}: the boxes are of a picture of {size[0]} x {size[1]} pixels, the photo {width} x {height}; "
        "give the annotations of this very photo"
    )


def _is_rounded(size: Size, other: Size) -> bool:
    return max(abs(size[0] - other[0]), abs(size[1] - other[1])) <= 1


def _others(corners: list[Corners], photo: DecodedPhoto, ambiguous: bool) -> Iterator[_Reading]:
    """Further readings of boxes without a stated size: other numbers, unturned, of a smaller or larger copy."""
    width, height = photo.frame.full_size
    if ambiguous:
        yield from _other_layouts(corners)
    yield from _readings_of_stored_pixels(corners, photo)
    largest = 1.0 if _fits(corners, photo) else np.inf  # boxes of a larger copy reach beyond the photo
    for scale in sorted({*FRACTIONS, *(side / max(width, height) for side in LONG_SIDES)}):
        # A copy's pixels are whole: sizes that the same scale does not give are no copy of this photo.
        size = round(width * scale), round(height * scale)
        if scale <= largest and abs(scale - 1.0) > ASPECT_TOLERANCE and min(size) >= 32 and _ends(corners, *size):
            extent = "x < {:.0f} %, y < {:.0f} %".format(*_extent_percent(corners, width, height))
            note = (
                f"all boxes lie in {extent} of the picture, and agree with it as those of a copy of "
                f"{size[0]} x {size[1]} pixels; they were scaled"
            )
            yield _Reading(_scale(corners, 1 / scale, 1 / scale), note)


def _other_layouts(corners: list[Corners]) -> Iterator[_Reading]:
    """Four numbers read as something else than corners."""
    for layout, words in _LAYOUTS.items():
        note = f"the four numbers of the boxes are {words}: so they agree with the picture"
        yield _Reading([from_layout(c, layout) for c in corners], note)


def _readings_of_stored_pixels(corners: list[Corners], photo: DecodedPhoto) -> Iterator[_Reading]:
    if photo.frame.orientation > 1:
        yield _turn_upright(corners, photo)


def _turn_upright(corners: list[Corners], photo: DecodedPhoto) -> _Reading:
    frame = photo.frame
    width, height = frame.stored_size
    note = (
        f"the boxes are of the photo's unturned pixels ({width} x {height}, EXIF orientation {frame.orientation}); "
        "they were turned with it"
    )
    return _Reading([frame.upright_box(c) for c in corners], note)


def _best(readings: Sequence[_Reading], photo: DecodedPhoto) -> _Reading:
    """The first reading, unless another one agrees clearly better with the picture."""
    first = readings[0]
    if len(readings) == 1:
        return first
    fits = _fits(first.corners, photo)
    if fits and len(first.corners) < MIN_BOXES:
        return first
    edges = EdgeMap(photo.photo.rgb)
    if fits and edges.agreement(_to_photo_pixels(first.corners, photo)) >= CLEAR_AGREEMENT:
        return first
    possible = [r for r in readings[1:] if _fits(r.corners, photo)]
    if not possible:
        return first
    if not fits and len(possible) == 1 and photo.frame.orientation > 1:
        return possible[0]
    agreements = [edges.agreement(_to_photo_pixels(r.corners, photo)) for r in possible]
    best = int(np.argmax(agreements))
    margin = max(MIN_MARGIN, MARGIN_OF_ONE / len(first.corners) ** 0.5)
    least = edges.agreement(_to_photo_pixels(first.corners, photo)) + margin if fits else MIN_AGREEMENT
    return possible[best] if agreements[best] > least and len(first.corners) >= MIN_BOXES else first


def _fits(corners: Sequence[Corners], photo: DecodedPhoto) -> bool:
    """Whether every box has an area and lies within the picture, all but a little."""
    width, height = photo.frame.full_size
    values, most = np.array(corners), np.array([width, height, width, height])
    areas = (values[:, 2:] - values[:, :2]).min(axis=1)
    inside = (values > -ASPECT_TOLERANCE * most) & (values < most + ASPECT_TOLERANCE * most)
    return bool((areas >= 1.0).all() and inside.all())


def _to_photo_pixels(corners: Sequence[Corners], photo: DecodedPhoto) -> list[Corners]:
    scale = photo.photo.width / photo.frame.inner_size[0]
    return _scale(_within_border(corners, photo), scale, scale)


def _within_border(corners: Sequence[Corners], photo: DecodedPhoto) -> list[Corners]:
    left, top = photo.frame.margins[:2]
    return [(x1 - left, y1 - top, x2 - left, y2 - top) for x1, y1, x2, y2 in corners]


def _scale(corners: Sequence[Corners], across: float, down: float) -> list[Corners]:
    return [(x1 * across, y1 * down, x2 * across, y2 * down) for x1, y1, x2, y2 in corners]


def _ends(corners: Sequence[Corners], width: float, height: float) -> bool:
    values = np.array(corners)
    return bool(values[:, 2].max() <= 1.01 * width and values[:, 3].max() <= 1.01 * height)


def _extent_percent(corners: Sequence[Corners], width: int, height: int) -> tuple[float, float]:
    values = np.array(corners)
    return float(np.ceil(100 * values[:, 2].max() / width)), float(np.ceil(100 * values[:, 3].max() / height))


def _small_copy_hint(chosen: _Reading, file: BoxFile, photo: DecodedPhoto) -> str:
    """A note where all boxes lie in one corner and no edges tell why."""
    width, height = photo.frame.full_size
    across, down = _extent_percent(chosen.corners, width, height)
    if file.size is not None or len(chosen.corners) < MIN_BOXES or max(across, down) >= 100 * SMALL_EXTENT:
        return ""
    share = next(f for f in (1 / 8, 1 / 4, 1 / 3, 1 / 2, 2 / 3) if 100 * f >= max(across, down))
    size = f"{round(width * share)} x {round(height * share)}"
    return (
        f"all boxes lie in x < {across:.0f} %, y < {down:.0f} % of the picture; they may be of a smaller copy ({size})"
    )
