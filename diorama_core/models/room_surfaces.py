"""The room behind its furniture, as a small network sees it: floor, wall and ceiling.

Maps of EfficientNet-Lite0, which learnt from photos, go through a head of our own that learnt from rendered rooms
(`diorama_core.training`; `assets/models` has its weights, how they were made and how good they are).
"""

from __future__ import annotations

import logging
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Float, Float32, UInt8

from diorama_core.errors import UnavailableError
from diorama_core.io import assets
from diorama_core.models.efficientnet import MAP_CHANNELS, lite0_maps
from diorama_core.models.images import IMAGENET_MEAN, IMAGENET_STD, normalise
from diorama_core.models.runtime import SHARED_SESSIONS, SessionPool
from diorama_core.models.store import sha256_of
from diorama_core.scene.types import Camera

log = logging.getLogger(__name__)

SIDE_PX = 512
"""Longer side of the pictures that the head learnt from."""
CELL_PX = 4
_COARSEST = 32
"""Both sides of a picture are multiples of the coarsest map's stride."""
OUTPUTS = ("floor", "wall", "ceiling")


RoomSurfaces = Float32[np.ndarray, "3 hc wc"]
"""Probabilities of `OUTPUTS` in the empty room, the whole picture divided into cells."""


@dataclass(frozen=True)
class SurfaceReader:
    """Input: an upright RGB picture, eight bits, any size, and its camera. Output: `RoomSurfaces`."""

    head: Path = field(repr=False)
    weights: str
    """Identity of the head, for cache keys."""
    pool: SessionPool = field(default=SHARED_SESSIONS, repr=False, compare=False)

    def read(self, rgb: UInt8[np.ndarray, "h w 3"], camera: Camera) -> RoomSurfaces:
        """The room's surfaces in a picture.

        Args:
            rgb: the picture, sRGB.
            camera: its intrinsics in the picture's pixels, and how it is turned in a world with +Z up.

        Raises:
            UnavailableError: when the backbone's weights are missing.
        """
        height, width = network_size(rgb.shape[:2])
        small = cv2.resize(rgb, (width, height), interpolation=cv2.INTER_AREA)
        rise = elevation_sines(camera, (height // CELL_PX, width // CELL_PX))
        found = self.pool.get(self.head).run(
            {**backbone_maps(small, self.pool), "rise": rise[None]},
            {"surfaces": (1, len(OUTPUTS), height // CELL_PX, width // CELL_PX)},
        )["surfaces"][0]
        return np.asarray(found, np.float32)


def network_size(size: tuple[int, int]) -> tuple[int, int]:
    """Height and width in which a picture is looked at, nearly of its proportions."""
    scale = SIDE_PX / max(size) / _COARSEST
    return max(1, round(size[0] * scale)) * _COARSEST, max(1, round(size[1] * scale)) * _COARSEST


def elevation_sines(camera: Camera, cells: tuple[int, int]) -> Float32[np.ndarray, "h w"]:
    """Sine of the elevation above the horizon of the line of sight in the middle of every cell of a whole picture.

    Args:
        camera: the picture's, in a world with +Z up.
        cells: rows and columns into which the picture is divided.
    """
    k = camera.intrinsics
    columns, rows = np.meshgrid(np.arange(cells[1]) + 0.5, np.arange(cells[0]) + 0.5)
    rays = camera.rays(np.stack([columns * k.width / cells[1], rows * k.height / cells[0]], axis=-1))
    return np.asarray(rays[..., 2] / np.linalg.norm(rays, axis=-1), np.float32)


def backbone_maps(
    rgb: UInt8[np.ndarray, "h w 3"], pool: SessionPool = SHARED_SESSIONS
) -> dict[str, Float[np.ndarray, "1 _c _h _w"]]:
    """Maps of EfficientNet-Lite0 by name (`MAP_CHANNELS`) of a picture whose sides 32 divides."""
    height, width = rgb.shape[:2]
    strides = {name: int(name.removeprefix("stride_")) for name in MAP_CHANNELS}
    shapes = {name: (1, MAP_CHANNELS[name], height // s, width // s) for name, s in strides.items()}
    return pool.get(lite0_maps()).run({"pictures": normalise(rgb, IMAGENET_MEAN, IMAGENET_STD)}, shapes)


@cache
def own_surface_reader() -> SurfaceReader | None:
    """The reader whose head comes with Diorama; None, with one line in the log, where a part of it is missing."""
    path = assets.FOLDER / assets.SURFACES
    try:
        lite0_maps()
        if not path.is_file():
            raise UnavailableError(f"{path}: is missing; restore it from the repository")
        return SurfaceReader(path, sha256_of(path)[:8])
    except UnavailableError as error:
        log.warning("rooms are seen less well: %s", error)
        return None
