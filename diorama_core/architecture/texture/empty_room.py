"""The empty room: the interface of inpainting networks, and the photo with furniture removed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol, runtime_checkable

import cv2
import numpy as np
from jaxtyping import Bool, UInt8

from diorama_core.geometry.casting import camera_rays, cast_planes
from diorama_core.geometry.planes import plane_rectangle
from diorama_core.scene.types import Camera, Plane


@runtime_checkable
class EmptyRoomFiller(Protocol):
    """Inpaints a region of a photo, as LaMa and MI-GAN do (PlainRecon's first step)."""

    def fill(self, rgb: UInt8[np.ndarray, "h w 3"], hole: Bool[np.ndarray, "h w"]) -> UInt8[np.ndarray, "h w 3"]:
        """The photo with the room's surfaces where `hole` is true, and unchanged elsewhere.

        Args:
            rgb: The photo, sRGB.
            hole: Pixels of what stands in the room, with their margin.
        """
        ...


def empty_room(
    rgb: UInt8[np.ndarray, "h w 3"],
    hidden: Bool[np.ndarray, "h w"],
    planes: tuple[Plane, ...],
    camera: Camera,
    textures: Mapping[str, UInt8[np.ndarray, "_ _ 3"]],
) -> UInt8[np.ndarray, "h w 3"]:
    """The photo with hidden pixels repainted from the planes behind them: the embedded filler, in perspective.

    Args:
        rgb: The photo.
        hidden: What to paint out.
        planes: The room.
        camera: The photo's.
        textures: The planes' pictures by plane id (`texture.plane_textures`); others show their plain colour.
    """
    origin, rays = camera_rays(camera)
    painted = rgb.copy()
    depth, which = cast_planes(origin, rays, planes)
    for index, plane in enumerate(planes):
        mine = hidden & (which == index)
        if not mine.any():
            continue
        if plane.id not in textures:
            painted[mine] = np.round(np.array(plane.colour) * 255.0).astype(np.uint8)
            continue
        corner, axes, extents = plane_rectangle(plane)
        uv = (origin + depth[mine][:, None] * rays[mine] - corner) @ axes / extents
        picture = textures[plane.id]
        lookup = np.stack([uv[:, 0] * picture.shape[1] - 0.5, (1 - uv[:, 1]) * picture.shape[0] - 0.5], axis=-1)
        painted[mine] = cv2.remap(
            picture, lookup[:, None].astype(np.float32), None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
        )[:, 0]
    return painted
