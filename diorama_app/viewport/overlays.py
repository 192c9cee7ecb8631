"""Overlays on the photo: masks of detected objects, edges of the room's planes."""

from __future__ import annotations

import colorsys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, UInt8

from diorama_app.viewport.client_view import PLANE_COLOURS
from diorama_core.artefacts import DetectedObject
from diorama_core.scene.types import Camera, Intrinsics, Plane, Scene, SceneObject

LONGEST_PX = 1280
FILL_ALPHA, SELECTED_ALPHA = 70, 120
LINE_PX = 2
SELECTED_COLOUR = (255, 122, 26)
NEAR_M = 0.05
SAME_BOX_PX = 1.5
GRID_M, GROUND_M = 0.5, 8.0
"""Mesh and extent of the grid on the floor."""

Colour = tuple[int, int, int]


@dataclass(frozen=True, eq=False)
class Seen:
    """Where in the photo an object of the scene was found."""

    object_id: str
    box: tuple[float, float, float, float]
    mask: Bool[np.ndarray, "h w"] | None
    """None where its box was drawn anew since the photo was outlined."""
    colour: Colour


def visible_objects(scene: Scene, detected: Sequence[DetectedObject]) -> tuple[Seen, ...]:
    """The scene's visible objects that were found in the photo, with the outlines that still hold."""
    by_id = {obj.id: obj for obj in detected}
    return tuple(
        Seen(item.id, item.box_px, _mask(item, by_id), hue(number))
        for number, item in enumerate(scene.objects)
        if item.box_px is not None and not item.hidden
    )


def _mask(item: SceneObject, detected: Mapping[str, DetectedObject]) -> Bool[np.ndarray, "h w"] | None:
    obj = detected.get(item.id)
    if obj is None or item.box_px is None or np.abs(np.subtract(obj.box, item.box_px)).max() > SAME_BOX_PX:
        return None
    return obj.mask


def hue(number: int) -> Colour:
    """Colours that differ from those before them (golden angle)."""
    red, green, blue = colorsys.hsv_to_rgb((number * 0.618034) % 1.0, 0.72, 0.92)
    return round(255 * red), round(255 * green), round(255 * blue)


def mask_picture(
    size_px: tuple[int, int], items: Iterable[Seen], selection: Sequence[str]
) -> UInt8[np.ndarray, "h w 4"]:
    """A transparent image with every object tinted and outlined; selected ones in orange, on top.

    Args:
        size_px: width and height of the photo.
        items: objects to draw; those without a mask as their box.
        selection: ids of what is selected.
    """
    scale = min(1.0, LONGEST_PX / max(size_px))
    width, height = max(1, round(size_px[0] * scale)), max(1, round(size_px[1] * scale))
    picture = np.zeros((height, width, 4), dtype=np.uint8)
    for obj in sorted(items, key=lambda t: t.object_id in selection):
        chosen = obj.object_id in selection
        colour = SELECTED_COLOUR if chosen else obj.colour
        small = _small(obj, (width, height), scale)
        picture[small > 0] = (*colour, SELECTED_ALPHA if chosen else FILL_ALPHA)
        outlines, _ = cv2.findContours(small, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)
        cv2.drawContours(picture, outlines, -1, (*colour, 255), 2 * LINE_PX if chosen else LINE_PX)
    return picture


def _small(obj: Seen, size: tuple[int, int], scale: float) -> UInt8[np.ndarray, "h w"]:
    if obj.mask is not None:
        return cv2.resize(obj.mask.astype(np.uint8), size, interpolation=cv2.INTER_NEAREST)
    small = np.zeros((size[1], size[0]), dtype=np.uint8)
    x1, y1, x2, y2 = (round(v * scale) for v in obj.box)
    small[y1:y2, x1:x2] = 1
    return small


def draw_planes(picture: UInt8[np.ndarray, "h w 4"], planes: Iterable[Plane], camera: Camera) -> None:
    """Draw the edges of planes into a picture of the photo's proportions, as the photo's camera sees them."""
    scaled = camera.intrinsics.resize(picture.shape[1], picture.shape[0])
    for plane in planes:
        for start, end in zip(plane.polygon, np.roll(plane.polygon, -1, axis=0), strict=True):
            _draw_line(picture, camera, scaled, np.stack([start, end]), (*PLANE_COLOURS[plane.role], 255))


def draw_ground(picture: UInt8[np.ndarray, "h w 4"], camera: Camera, floor_m: float) -> None:
    """Draw a grid on the floor as a camera would see it, half a metre wide, in front of its feet."""
    scaled = camera.intrinsics.resize(picture.shape[1], picture.shape[0])
    ahead = camera.T_world_camera[:3, 2] * (1.0, 1.0, 0.0)
    ahead = ahead / max(float(np.linalg.norm(ahead)), 1e-9)
    across = np.array([ahead[1], -ahead[0], 0.0])
    foot = camera.position * (1.0, 1.0, 0.0) + (0.0, 0.0, floor_m)
    steps = np.arange(0.0, GROUND_M + GRID_M / 2, GRID_M)
    sideways = steps - GROUND_M / 2
    lines = [(foot + s * across, foot + s * across + GROUND_M * ahead) for s in sideways]
    lines += [(foot + t * ahead + sideways[0] * across, foot + t * ahead + sideways[-1] * across) for t in steps]
    for start, end in lines:
        _draw_line(picture, camera, scaled, np.stack([start, end]), (*SELECTED_COLOUR, 230))


def _draw_line(
    picture: UInt8[np.ndarray, "h w 4"],
    camera: Camera,
    scaled: Intrinsics,
    ends_world: Float[np.ndarray, "2 3"],
    colour: tuple[int, int, int, int],
) -> None:
    ends = _clip_to_front(camera.to_camera(ends_world))
    if ends is None:
        return
    uv = ends[:, :2] / ends[:, 2:] * (scaled.fx, scaled.fy) + (scaled.cx, scaled.cy)
    a, b = (np.clip(np.round(p), -30_000, 30_000).astype(int).tolist() for p in uv)
    cv2.line(picture, a, b, colour, LINE_PX, cv2.LINE_AA)


def _clip_to_front(ends: Float[np.ndarray, "2 3"]) -> Float[np.ndarray, "2 3"] | None:
    """The part of a line (camera axes) that is in front of the camera."""
    near = ends[:, 2] < NEAR_M
    if near.all():
        return None
    if near.any():
        a, b = ends[near][0], ends[~near][0]
        share = (NEAR_M - a[2]) / (b[2] - a[2])
        return np.stack([a + share * (b - a), b])
    return ends
