"""Planes that were moved, stretched or cut keep their pictures: what is new is continued, what is gone cut off."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from dataclasses import replace

import cv2
import numpy as np
from jaxtyping import UInt8

from diorama_core.architecture.texture.continuation import complete_texture
from diorama_core.architecture.texture.plane_textures import MAX_SIDE_PX
from diorama_core.geometry.planes import plane_axes, plane_rectangle
from diorama_core.scene.types import Plane, Scene

SAME_M = 1e-3
"""Rectangles that differ by less than this are the same."""
MARK = "@"
"""Before what a refitted picture's name adds to the original's."""

Pictures = Mapping[str, UInt8[np.ndarray, "_ _ 3"]]


def refit_textures(
    before: Scene, after: Scene, textures: Pictures
) -> tuple[Scene, dict[str, UInt8[np.ndarray, "_ _ 3"]]]:
    """The edited scene with every picture at the scale it had, and the pictures made for that, by name.

    Pictures belong to their planes' rectangles (`geometry.planes.plane_uv`), so one whose plane changed its rectangle
    would be stretched; it gets a new picture under a new name, and the old one stays for undo. A scene that was scaled
    as a whole, its camera with it, keeps its pictures.

    Args:
        before: The scene whose pictures are right.
        after: The same scene, edited.
        textures: The pictures of `before`, by name.
    """
    if _is_scaled(before, after):
        return after, {}
    made: dict[str, UInt8[np.ndarray, "_ _ 3"]] = {}
    planes = []
    for plane in after.architecture.planes:
        # Below a finish is the photo's picture, which follows; the finish itself is made anew for its new rectangle.
        name = plane.texture if plane.finish is None else plane.photo_texture
        old = before.plane(plane.id) if before.has_plane(plane.id) else _cut_from(before, name)
        if name is None or old is None or name not in textures or not _is_resized(old, plane):
            planes.append(plane)
            continue
        if name != (old.texture if old.finish is None else old.photo_texture):
            planes.append(plane)
            continue
        new = _name(name, plane)
        made[new] = refit_picture(textures[name], old, plane)
        planes.append(replace(plane, texture=new) if plane.finish is None else replace(plane, photo_texture=new))
    if not made:
        return after, {}
    return replace(after, architecture=replace(after.architecture, planes=tuple(planes))), made


def refit_picture(picture: UInt8[np.ndarray, "h w 3"], before: Plane, after: Plane) -> UInt8[np.ndarray, "h2 w2 3"]:
    """A plane's picture cut and continued to its new rectangle, with everything left where it was on the plane."""
    origin, axes, extents = plane_rectangle(before)
    origin_after, _, extents_after = plane_rectangle(after)
    height, width = picture.shape[:2]
    pixel_m = max(float(extents[0]) / width, float(extents_after.max()) / MAX_SIDE_PX)
    columns, rows = (max(2, int(np.ceil(e / pixel_m - 1e-6))) for e in extents_after)
    left, bottom = (origin_after - origin) @ axes
    across = (np.arange(columns) + 0.5) / columns * extents_after[0] + left
    up = (1.0 - (np.arange(rows) + 0.5) / rows) * extents_after[1] + bottom
    u, v = np.meshgrid(across / extents[0], up / extents[1])
    seen = (u >= 0) & (u <= 1) & (v >= 0) & (v <= 1)
    lookup = np.stack([u * width - 0.5, (1.0 - v) * height - 0.5], axis=-1).astype(np.float32)
    colours = cv2.remap(picture, lookup, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE).astype(np.float32)
    if seen.all() or not seen.any():
        return colours.round().astype(np.uint8)
    return complete_texture(colours, seen, after.colour, pixel_m, seen, ground=after.role == "floor")


def _cut_from(before: Scene, name: str | None) -> Plane | None:
    """The plane that had the picture of a new one: a new plane with a picture is a part of it."""
    planes = before.architecture.planes
    return next((p for p in planes if name == (p.texture if p.finish is None else p.photo_texture)), None)


def _is_resized(before: Plane, after: Plane) -> bool:
    """Whether the rectangle differs within the plane; one that only moved along its normal is the same."""
    turned = np.subtract(plane_axes(before.normal), plane_axes(after.normal))
    if float(np.abs(turned).max()) > SAME_M:
        return False  # turned: there is no telling what belongs where
    origin, axes, extents = plane_rectangle(before)
    origin_after, _, extents_after = plane_rectangle(after)
    shift = (origin_after - origin) @ axes
    return bool(np.abs(shift).max() > SAME_M or np.abs(extents_after - extents).max() > SAME_M)


def _is_scaled(before: Scene, after: Scene) -> bool:
    if before.camera is None or after.camera is None:
        return False
    return bool(np.abs(before.camera.position - after.camera.position).max() > 1e-9)


def _name(name: str, plane: Plane) -> str:
    origin, axes, extents = plane_rectangle(plane)
    place = np.round(np.concatenate([origin @ axes, extents]), 3) + 0.0
    return f"{name.split(MARK)[0]}{MARK}{zlib.crc32(place.tobytes()):08x}"
