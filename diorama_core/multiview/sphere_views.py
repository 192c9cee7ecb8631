"""Perspective views of a 360 degree photo, and its objects in all of them: things at a seam are one.

A thing is known by its middle's azimuth, half its width, and the elevations of its upper and lower end there. So a
box that was drawn in the equirectangular picture, and one that a detector found in a view, become boxes in all views.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product

import cv2
import numpy as np
from jaxtyping import Float, Float32, UInt8
from scipy.special import softmax

from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.geometry.projection import box_iou
from diorama_core.geometry.sphere import directions, directions_at, level_axes, perspective, sphere_pixels
from diorama_core.library.taxonomy import broad
from diorama_core.models.room_surfaces import CELL_PX, SIDE_PX, SurfaceReader
from diorama_core.multiview.rooms import PosedInputs
from diorama_core.scene.types import Camera, Intrinsics, rigid


@dataclass(frozen=True)
class SphereViewsSettings:
    """Numbers by which a sphere is divided into views."""

    count: int = 8
    """Views: neighbours share half of what they show, so that what is narrower than half a view is whole in one."""
    aside_deg: float = 45.0
    up_deg: float = 45.0
    down_deg: float = 60.0
    """Borders of a view: what stands a step away has its foot in it."""
    max_width_px: int = 1000
    min_shown: float = 0.3
    """Share of a thing's width within a view for it to be marked there."""
    same_box: float = 0.4
    """Intersection over union from which boxes of one kind in different views are one thing."""
    inside: float = 0.7
    """Share of the smaller of two boxes of one kind in the other from which they are one thing, cut in one view."""
    seam: float = 0.005
    """Boxes that end so near the picture's sides, as a share of its width, may go on beyond the seam."""
    min_px: float = 2.0
    """Smallest side of a box."""
    surface_fov_rad: float = 1.35
    surface_elevations_rad: tuple[float, ...] = (-0.6, 0.0, 0.6)
    surfaces_width_px: int = 512
    """Views in which floor, wall and ceiling are told: as wide as pictures that the head learnt from, as high and low
    as it learnt; and the width of the map of all of them."""
    widest_deg: float = 160.0
    """Widest half angle of an object: a wider one is below the camera or behind it, and no view shows it."""


SETTINGS = SphereViewsSettings()


@dataclass(frozen=True)
class SphereBox:
    """A thing on the sphere, in the level frame of the room; radians."""

    azimuth: float
    half_width: float
    low: float
    high: float
    """Elevations at its middle."""
    labelled: LabelledBox
    """Its name; the box is the picture's that it was marked in."""

    def azimuth_from(self, azimuth: float) -> float:
        """Azimuth of its middle relative to another one, half a turn at most."""
        return float(np.angle(np.exp(1j * (self.azimuth - azimuth))))

    def rectangle(self, azimuth: float) -> Float[np.ndarray, "4"]:
        """Its extent in azimuths and elevations, azimuths counted from another one."""
        middle = self.azimuth_from(azimuth)
        return np.array([middle - self.half_width, self.low, middle + self.half_width, self.high])


def to_sphere_boxes(
    boxes: Sequence[LabelledBox], size: tuple[int, int], R_room_sphere: Float[np.ndarray, "3 3"]
) -> tuple[SphereBox, ...]:
    """Boxes of an equirectangular picture, those that meet across its seam as one.

    Args:
        boxes: in pixels.
        size: width and height of the picture.
        R_room_sphere: from the picture's frame to the room's.
    """
    boxes_on_sphere = []
    for labelled in _across_seam(boxes, size[0]):
        x1, y1, x2, y2 = labelled.box
        middle = np.array([(x1 + x2) / 2, (y1 + y2) / 2])
        sides = np.array([[x1, middle[1]], [x2, middle[1]], [middle[0], y1], [middle[0], y2], middle])
        away = directions_at(sides, size) @ R_room_sphere.T
        azimuth, elevation = np.arctan2(away[:, 1], away[:, 0]), np.arctan2(away[:, 2], np.hypot(*away[:, :2].T))
        half = np.pi * (x2 - x1) / size[0]
        boxes_on_sphere.append(SphereBox(float(azimuth[4]), half, float(elevation[3]), float(elevation[2]), labelled))
    return tuple(boxes_on_sphere)


def _across_seam(boxes: Sequence[LabelledBox], width: int) -> tuple[LabelledBox, ...]:
    """Boxes, the two parts of a thing at the picture's sides as one that reaches beyond its right side."""
    near, left = SETTINGS.seam * width, list(boxes)
    for first in boxes:
        for second in boxes:
            a, b = first.box, second.box
            meet = abs(a[2] - width) <= near and b[0] <= near and first is not second
            shared = min(a[3], b[3]) - max(a[1], b[1])
            if (
                meet
                and first.category == second.category
                and shared > 0.5 * min(a[3] - a[1], b[3] - b[1])
                and first in left
                and second in left
            ):
                whole = (a[0], min(a[1], b[1]), b[2] + width, max(a[3], b[3]))
                left = [x for x in left if x is not first and x is not second] + [replace(first, box=whole)]
    return tuple(left)


def picture_boxes(
    things: Sequence[SphereBox], size: tuple[int, int], R_room_sphere: Float[np.ndarray, "3 3"]
) -> tuple[LabelledBox, ...]:
    """Boxes of an equirectangular picture around things, two for one that goes on beyond its seam.

    Args:
        things: on the sphere.
        size: width and height of the picture, pixels.
        R_room_sphere: from the picture's frame to the room's.
    """
    boxes = []
    for thing in things:
        middle = (thing.low + thing.high) / 2
        azimuth = thing.azimuth + np.array([thing.half_width, -thing.half_width, 0.0, 0.0])
        elevation = np.array([middle, middle, thing.high, thing.low])
        across = np.cos(elevation)
        away = np.column_stack([across * np.cos(azimuth), across * np.sin(azimuth), np.sin(elevation)])
        at = sphere_pixels(away @ R_room_sphere, size[0])
        (x1, x2), (y1, y2) = at[:2, 0], np.clip(at[2:, 1], 0.0, size[1])
        parts = [(x1, x2)] if x1 < x2 else [(x1, float(size[0])), (0.0, x2)]
        sides = [part for part in parts if part[1] - part[0] >= SETTINGS.min_px]
        boxes += [replace(thing.labelled, box=(float(a), float(y1), float(b), float(y2))) for a, b in sides]
    return tuple(boxes)


@dataclass(frozen=True, eq=False)
class SphereView:
    """A level perspective view."""

    azimuth: float
    intrinsics: Intrinsics

    def camera(self, height_m: float) -> Camera:
        """Camera of the view in the room, the floor at 0 and the sphere's middle at the origin of the plan."""
        return Camera(self.intrinsics, rigid(level_axes(self.azimuth), np.array([0.0, 0.0, height_m])))

    def project(self, thing: SphereBox) -> LabelledBox | None:
        """A thing's box in the view; None where too little of it is there."""
        k, off = self.intrinsics, thing.azimuth_from(self.azimuth)
        if thing.half_width > np.deg2rad(SETTINGS.widest_deg) / 2:
            return None
        aside = np.deg2rad(SETTINGS.aside_deg)
        left, right = min(off + thing.half_width, aside), max(off - thing.half_width, -aside)
        if left - right < 2 * SETTINGS.min_shown * thing.half_width:
            return None
        middle = np.cos(np.clip(off, -aside, aside))
        x1, x2 = (k.cx - k.fx * np.tan(a) for a in (left, right))
        y1, y2 = (
            float(np.clip(k.cy - k.fy * np.tan(np.clip(e, -1.5, 1.5)) / middle, 0, k.height))
            for e in (thing.high, thing.low)
        )
        if min(y2 - y1, x2 - x1) < SETTINGS.min_px:
            return None
        return replace(thing.labelled, box=(float(x1), y1, float(x2), y2))

    def to_sphere(self, labelled: LabelledBox) -> SphereBox:
        """A box of the view as a thing."""
        k, (x1, y1, x2, y2) = self.intrinsics, labelled.box
        left, right = (float(np.arctan((k.cx - x) / k.fx)) for x in (x1, x2))
        middle = (left + right) / 2
        high, low = (float(np.arctan((k.cy - y) / k.fy * np.cos(middle))) for y in (y1, y2))
        return SphereBox(self.azimuth + middle, (left - right) / 2, low, high, labelled)


def sphere_views(width_px: int) -> tuple[SphereView, ...]:
    """Views all round, as sharp in their middle as a picture of so many pixels around."""
    focal = min(width_px / (2 * np.pi), SETTINGS.max_width_px / 2 / np.tan(np.deg2rad(SETTINGS.aside_deg)))
    aside, up, down = (focal * np.tan(np.deg2rad(a)) for a in (SETTINGS.aside_deg, SETTINGS.up_deg, SETTINGS.down_deg))
    k = Intrinsics(round(2 * aside), round(up + down), focal, focal, round(2 * aside) / 2, float(up))
    return tuple(SphereView(turn * 2 * np.pi / SETTINGS.count, k) for turn in range(SETTINGS.count))


def view_photo(
    rgb: UInt8[np.ndarray, "h w 3"], R_room_sphere: Float[np.ndarray, "3 3"], view: SphereView, name: str
) -> Photo:
    """The picture of a view.

    Args:
        rgb: equirectangular.
        R_room_sphere: from the picture's own frame to the room's.
        view: where it looks.
        name: of the picture's file.
    """
    k = view.intrinsics
    picture = perspective(rgb, R_room_sphere.T @ level_axes(view.azimuth), k)
    return Photo(picture, name, (k.width, k.height))


def sphere_surfaces(level: UInt8[np.ndarray, "h w 3"], reader: SurfaceReader) -> Float32[np.ndarray, "3 h2 w2"]:
    """Probabilities of floor, wall and ceiling all round, from views that overlap by half; even odds where none looks.

    Args:
        level: equirectangular, +Z up.
        reader: tells the surfaces of a view.
    """
    towards = directions(SETTINGS.surfaces_width_px)
    total, weights = np.zeros((*towards.shape[:2], 3)), np.zeros(towards.shape[:2])
    k = Intrinsics.from_fov(SIDE_PX, SIDE_PX * 3 // 4, SETTINGS.surface_fov_rad)
    for azimuth, elevation in product(np.arange(8) * np.pi / 4, SETTINGS.surface_elevations_rad):
        axes = level_axes(float(azimuth), elevation)
        shares = reader.read(perspective(level, axes, k), Camera(k, rigid(axes, np.zeros(3))))
        local = towards @ axes
        z = np.where(local[..., 2] > 0.05, local[..., 2], np.inf)
        at = np.stack([k.fx * local[..., 0] / z + k.cx, k.fy * local[..., 1] / z + k.cy], axis=-1)
        # What is near a view's border is seen better by the next one.
        inside = np.minimum(at, (k.width, k.height) - at).min(axis=-1) / k.height * np.isfinite(z)
        weight = np.maximum(inside, 0.0)
        cells = (at / CELL_PX - 0.5).astype(np.float32)
        seen = cv2.remap(np.moveaxis(shares, 0, -1), cells, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        total += weight[..., None] * np.log(np.maximum(seen, 1e-6))
        weights += weight
    mean = total / np.maximum(weights, 1e-9)[..., None]
    return np.moveaxis(softmax(mean, axis=-1), -1, 0).astype(np.float32)


def merge_detections(boxes_by_view: Sequence[tuple[SphereView, Sequence[LabelledBox]]]) -> tuple[SphereBox, ...]:
    """Things that were found in views, each once: as the view has it that shows it whole, and nearest its middle."""
    rows = []
    for view, boxes in boxes_by_view:
        for labelled in boxes:
            x1, _, x2, _ = labelled.box
            cut = min(x1, view.intrinsics.width - x2) < SETTINGS.seam * view.intrinsics.width
            thing = view.to_sphere(labelled)
            rows.append((cut, -labelled.score * np.cos(thing.azimuth_from(view.azimuth)), thing))
    distinct: list[SphereBox] = []
    for _, _, thing in sorted(rows, key=lambda row: row[:2]):
        if not any(_is_same(thing, other) for other in distinct):
            distinct.append(thing)
    return tuple(distinct)


def _is_same(a: SphereBox, b: SphereBox) -> bool:
    if broad(a.labelled.category) != broad(b.labelled.category):
        return False
    one, two = a.rectangle(b.azimuth), b.rectangle(b.azimuth)
    both = np.maximum(np.minimum(one[2:], two[2:]) - np.maximum(one[:2], two[:2]), 0.0).prod()
    smaller = min((one[2:] - one[:2]).prod(), (two[2:] - two[:2]).prod())
    return bool(box_iou(one, two) > SETTINGS.same_box or both > SETTINGS.inside * smaller)


def project_to_views(
    photos: Sequence[tuple[SphereView, Photo]], things: Sequence[SphereBox], height_m: float
) -> tuple[tuple[PosedInputs, ...], tuple[tuple[tuple[int, int], ...], ...]]:
    """Views with the things that they show, and for each thing its (view, box), the view that shows it best first.

    Args:
        photos: the views with their pictures.
        things: on the sphere.
        height_m: of the camera above the floor.
    """
    sightings: list[list[tuple[int, int]]] = [[] for _ in things]
    posed = []
    for number, (view, photo) in enumerate(photos):
        boxes: list[LabelledBox] = []
        for thing, seen in zip(things, sightings, strict=True):
            box = view.project(thing)
            if box is not None:
                seen.append((number, len(boxes)))
                boxes.append(box)
        posed.append(PosedInputs(Inputs(photo, tuple(boxes), intrinsics=view.intrinsics), view.camera(height_m)))
    ordered = (
        tuple(sorted(seen, key=lambda s: abs(thing.azimuth_from(photos[s[0]][0].azimuth))))
        for thing, seen in zip(things, sightings, strict=True)
    )
    return tuple(posed), tuple(ordered)
