"""Which boxes of different photos are of one object, which of them agree, and which are cut short."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float
from scipy.optimize import linear_sum_assignment

from diorama_core.artefacts import DetectedObject
from diorama_core.geometry.projection import box_iou, cuboid_corners, visible_bounds
from diorama_core.library.taxonomy import PORTABLE, Category, broad
from diorama_core.multiview.joint_fit import JointCuboid, PosedBoxes, fit_jointly, meeting_point
from diorama_core.multiview.settings import SETTINGS
from diorama_core.perception.metrology.placement import FLOOR
from diorama_core.progress import SILENT, Progress

FARTHER = tuple(float(f) for f in np.geomspace(0.6, 1.67, 9))
FARTHER_PENALTY = tuple(float(np.exp(-0.5 * (np.log(f) / 0.3) ** 2)) for f in FARTHER)
"""Distances at which a thing that one photo shows is looked for in another, and how unlikely each is."""


Boxes = tuple[tuple[int, int], ...]
"""(photo, box)."""


@dataclass(frozen=True, eq=False)
class Sighted:
    """What one photo alone says of one of its objects."""

    kind: Category
    centre: Float[np.ndarray, "3"]
    """In the room."""
    yaw_rad: float
    size_m: Float[np.ndarray, "3"]
    supporter: int
    """As `metrology.placement.Placement.supporter`."""

    @property
    def cuboid(self) -> JointCuboid:
        """What it says at no cost."""
        return JointCuboid(self.centre, self.yaw_rad, self.size_m, 0.0)


@dataclass(frozen=True, eq=False)
class RoomPhoto:
    """A photo with what it says by itself."""

    boxes: PosedBoxes
    alone: tuple[Sighted, ...]
    """One for each box."""


@dataclass(frozen=True, eq=False)
class Track:
    """One object of the room: its boxes, by photo, and the cuboid that fits them."""

    boxes: Boxes
    kind: Category
    cuboid: JointCuboid
    left_out: Boxes = ()
    """Boxes of it that the cuboid does not fit (`agreement`)."""

    @property
    def inliers(self) -> Boxes:
        """The boxes that the cuboid fits."""
        return tuple(b for b in self.boxes if b not in self.left_out)

    def sightings(self, photos: Sequence[RoomPhoto]) -> list[tuple[PosedBoxes, int]]:
        """As `fit_jointly` takes them."""
        return [(photos[photo].boxes, box) for photo, box in self.inliers]


def join_objects(photos: Sequence[RoomPhoto], progress: Progress = SILENT) -> tuple[Track, ...]:
    """Join the boxes of all photos to objects: every box is of one of them, an object has one box at most in a photo.

    Photo by photo, known objects claim the boxes of their kind that their cuboids cover best; what is left is new. Then
    every photo's boxes are claimed again by cuboids that were fitted to all other photos.
    """
    joining = _Joining(photos)
    tracks: list[Track] = []
    count, rounds = len(photos), 1 + SETTINGS.rounds
    for step in range(count * rounds if count > 1 else count):
        turn, number = divmod(step, count)
        which = "again" if turn else f"of {count}"
        progress.report(step / (count * rounds), f"joining photo {number + 1} {which}")
        tracks = joining.with_photo(joining.without_photo(tracks, number), number)
    return tuple(sorted(tracks, key=lambda t: t.boxes))


class _Joining:
    """Tracks of some photos; what was fitted once is not fitted again."""

    def __init__(self, photos: Sequence[RoomPhoto]) -> None:
        self._photos = photos
        self._fits: dict[Boxes, Track] = {}

    def with_photo(self, tracks: list[Track], number: int) -> list[Track]:
        """The tracks with the boxes of one more photo."""
        alone = self._photos[number].alone
        shared = np.zeros((len(tracks), len(alone)))
        for k, track in enumerate(tracks):
            for box, one in enumerate(alone):
                if broad(track.kind.name) == broad(one.kind.name):
                    shared[k, box] = self._overlap(track, number, box)
        claimed = claims(shared)
        joined = list(tracks)
        for box in range(len(alone)):
            if box in claimed:
                k = claimed[box]
                joined[k] = self._fit(tuple(sorted((*tracks[k].boxes, (number, box)))))
            else:
                joined.append(self._fit(((number, box),)))
        return joined

    def without_photo(self, tracks: list[Track], number: int) -> list[Track]:
        """The tracks as the other photos have them."""
        left = [tuple(b for b in track.boxes if b[0] != number) for track in tracks]
        return [self._fit(boxes) for boxes in left if boxes]

    def _overlap(self, track: Track, number: int, box: int) -> float:
        only = track.boxes[0] if len(track.boxes) == 1 else None
        first = None if only is None else (self._photos[only[0]], only[1])
        return overlap(track.cuboid, first, self._photos[number], box)

    def _fit(self, boxes: Boxes) -> Track:
        if boxes not in self._fits:
            self._fits[boxes] = fit_track(boxes, self._photos)
        return self._fits[boxes]


def claims(shared: Float[np.ndarray, "t b"]) -> dict[int, int]:
    """Which object claims each box: the number of the one by the number of the other.

    Args:
        shared: how much of each object's outline is each box's (`overlap`); 0 where their kinds differ.
    """
    rows, columns = linear_sum_assignment(-shared) if shared.size else ((), ())
    return {int(c): int(r) for r, c in zip(rows, columns, strict=True) if shared[r, c] >= SETTINGS.min_overlap}


def overlap(cuboid: JointCuboid, only: tuple[RoomPhoto, int] | None, photo: RoomPhoto, box: int) -> float:
    """How much of an object's outline is a box's: intersection over union.

    Args:
        cuboid: the object.
        only: the one photo and box that the cuboid is known from: then it may be nearer or farther along its ray, and
            what the other box says by itself may be, too. None where its place is known.
        photo: another photo.
        box: a box of it.
    """
    if only is None:
        return _cuboid_box_iou(cuboid, photo, box)
    first, index = only
    moved = photo.alone[box].cuboid
    return max(
        penalty
        * max(
            _cuboid_box_iou(_scale_about_camera(cuboid, first, f), photo, box),
            _cuboid_box_iou(_scale_about_camera(moved, photo, f), first, index),
        )
        for f, penalty in zip(FARTHER, FARTHER_PENALTY, strict=True)
    )


def _scale_about_camera(cuboid: JointCuboid, photo: RoomPhoto, factor: float) -> JointCuboid:
    """The cuboid seen alike in its photo, so many times as far and as large."""
    eye = photo.boxes.camera.position
    return replace(cuboid, centre=eye + factor * (cuboid.centre - eye), size_m=factor * cuboid.size_m)


def _cuboid_box_iou(cuboid: JointCuboid, photo: RoomPhoto, box: int) -> float:
    """Intersection over union of a cuboid's outline in a photo with a box."""
    camera = photo.boxes.camera
    corners = cuboid_corners(cuboid.centre[None], np.array([cuboid.yaw_rad]), cuboid.size_m[None])
    bounds, visible = visible_bounds(camera.to_camera(corners), camera.intrinsics)
    if not visible[0]:
        return 0.0
    seen = photo.boxes.observations.box_px[box]
    # What goes on behind something nearer is compared as far as it can be seen.
    low, high = np.maximum(bounds[0], seen), np.minimum(bounds[0], seen)
    short = photo.boxes.hidden_px[box] > 0
    shown = np.where(short, np.where([True, True, False, False], low, high), bounds[0])
    return float(box_iou(shown, seen)) if (shown[2:] > shown[:2]).all() else 0.0


def fit_track(boxes: Boxes, photos: Sequence[RoomPhoto]) -> Track:
    """Fit the cuboid of some boxes: of one box what its photo says, of more the joint fit."""
    alone = [photos[photo].alone[box] for photo, box in boxes]
    names = [a.kind.name for a in alone]
    kind = alone[names.index(max(sorted(set(names)), key=names.count))].kind
    if len(boxes) == 1:
        return Track(boxes, kind, alone[0].cuboid)
    sightings = [(photos[photo].boxes, box) for photo, box in boxes]
    standing = kind.name == "door" or (
        kind.mount == "floor" and 2 * sum(a.supporter == FLOOR for a in alone) > len(alone)
    )
    middle = np.median([a.centre for a in alone], axis=0)
    starts = [middle, meeting_point(sightings)]
    fitted = fit_jointly(sightings, kind, starts, on_floor=standing, upright_m=float(middle[2]))
    if standing and kind.name in PORTABLE and fitted.cost > SETTINGS.raised_cost:
        raised = fit_jointly(sightings, kind, starts[1:], on_floor=False)
        fitted = raised if raised.cost + SETTINGS.raised_cost < fitted.cost else fitted
    return Track(boxes, kind, fitted)


def visibility_score(photo: RoomPhoto, box: int) -> float:
    """How well a photo shows an object: the area of its box, less where edges are hidden or cut."""
    seen = photo.boxes.observations
    x1, y1, x2, y2 = seen.box_px[box]
    unseen = int((seen.is_hidden(box) | seen.truncated[box]).sum())
    k = photo.boxes.camera.intrinsics
    return float((x2 - x1) * (y2 - y1) / (k.width * k.height)) * SETTINGS.unseen_edge**unseen


def with_agreeing_boxes(track: Track, photos: Sequence[RoomPhoto]) -> Track:
    """The object with the cuboid of those boxes that agree.

    One photo by itself says what it says at no cost. Of two that disagree the one that shows the object better counts,
    of more those that are left when the one goes without which the others agree best.
    """
    fitted = track
    while len(fitted.boxes) > 1 and fitted.cuboid.cost > SETTINGS.left_out_cost:
        fewer = [fit_track(tuple(b for b in fitted.boxes if b != out), photos) for out in fitted.boxes]
        best = min(fewer, key=lambda t: (t.cuboid.cost, -max(visibility_score(photos[p], box) for p, box in t.boxes)))
        if best.cuboid.cost + SETTINGS.left_out_cost >= fitted.cuboid.cost:
            break
        fitted = best
    left_out = tuple(b for b in track.boxes if b not in fitted.boxes)
    return replace(track, cuboid=fitted.cuboid, left_out=left_out)


def edges_cut_short(
    objects: Sequence[DetectedObject], boxes_px: Float[np.ndarray, "n 4"], distances_m: Float[np.ndarray, "n"]
) -> Bool[np.ndarray, "n 4"]:
    """For every object and edge (left, top, right, bottom) whether it may go on behind something nearer.

    Args:
        objects: of one photo.
        boxes_px: their boxes.
        distances_m: how far their middles are from the camera.
    """
    cut_short = np.zeros((len(objects), 4), dtype=bool)
    for i, box in enumerate(boxes_px):
        near = [o.mask for j, o in enumerate(objects) if j != i and distances_m[j] < SETTINGS.nearer * distances_m[i]]
        if not near:
            continue
        before = np.any(near, axis=0) & ~objects[i].mask
        for edge, rows, columns in _strips(box, before.shape):
            strip = before[rows, columns]
            cut_short[i, edge] = bool(strip.size) and strip.mean() >= SETTINGS.min_covered
    return cut_short


def _strips(box: Float[np.ndarray, "4"], shape: tuple[int, ...]) -> list[tuple[int, slice, slice]]:
    """The strips outside a box's edges, as far as they are in the picture."""
    x1, y1, x2, y2 = (round(float(v)) for v in box)
    wide, high = (max(SETTINGS.min_strip_px, round(SETTINGS.strip * side)) for side in (x2 - x1, y2 - y1))
    beside, across = slice(max(y1, 0), y2), slice(max(x1, 0), x2)
    return [
        (0, beside, slice(max(x1 - wide, 0), max(x1, 0))),
        (1, slice(max(y1 - high, 0), max(y1, 0)), across),
        (2, beside, slice(min(x2, shape[1]), x2 + wide)),
        (3, slice(min(y2, shape[0]), y2 + high), across),
    ]
