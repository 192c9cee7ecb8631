"""The head that tells the room behind its furniture, and the rendered rooms from which it learns."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import cv2
import numpy as np
import torch
from jaxtyping import Float, Float32, UInt8
from torch import Tensor, nn
from torch.nn import functional

from diorama_core.errors import InputError, LibraryError, SceneError
from diorama_core.io.arrays import npz_bytes
from diorama_core.library.record import ShapeLibrary
from diorama_core.models.efficientnet import MAP_CHANNELS
from diorama_core.models.room_surfaces import CELL_PX, OUTPUTS, backbone_maps, elevation_sines
from diorama_core.progress import SILENT, Progress
from diorama_core.scene.types import Camera, Plane
from diorama_core.scene.values import ArrayValue
from diorama_core.synthesis import sample_cameras
from diorama_core.synthesis.cameras import CameraRanges
from diorama_core.synthesis.truth import Studio
from diorama_core.training.augment import photograph
from diorama_core.training.networks import Residual, convolution
from diorama_core.training.pictures import decode_picture, encode_picture, make_files
from diorama_core.training.rooms import random_room

SIZE = (512, 384)
"""Width and height of the pictures; surfaces are known in half of that."""
VIEWS = 4
CAMERAS = CameraRanges(height_m=(0.9, 1.9), pitch_rad=(-0.35, 0.45), roll_rad=0.03, fov_rad=(0.75, 1.6))
LARGEST, STRETCH, TURN_RAD = 0.5, 0.05, 0.02
"""Crops of a picture: greatest logarithm of their enlargement; deviations of proportions and turn."""
CROPPED = 0.5
"""Share of the pictures that are cropped; the others are whole."""
NONE = 3
"""Beside floor, wall and ceiling (`models.room_surfaces.OUTPUTS`)."""


@dataclass(frozen=True, eq=False)
class SurfacePicture(ArrayValue):
    """A picture and the empty room in it, at half its size."""

    rgb: UInt8[np.ndarray, "h w 3"]
    surface: UInt8[np.ndarray, "h2 w2"]
    """Index into `OUTPUTS`; `NONE` where the picture shows no surface."""
    rise: Float32[np.ndarray, "h2 w2"]
    """Sine of the elevation of the line of sight."""


def make_surfaces(folder: Path, library: ShapeLibrary, seeds: range, progress: Progress = SILENT) -> int:
    """Render the rooms of some seeds that are not in the folder yet.

    Args:
        folder, library, seeds, progress: as of `pictures.make_pictures`, like the number that is returned.
    """
    return make_files(
        folder, seeds, "surfaces_{:06d}.npz".format, lambda seed: _pack(_photograph(seed, library)), progress
    )


def _photograph(seed: int, library: ShapeLibrary) -> tuple[SurfacePicture, ...]:
    """No picture where the room cannot be furnished or photographed; it is not tried again."""
    try:
        scene = random_room(seed, library)
        cameras = sample_cameras(scene, library, seed, VIEWS, SIZE, CAMERAS)
    except (SceneError, LibraryError):
        return ()
    studio, planes = Studio(scene, library), scene.architecture.planes
    return tuple(_picture(studio, planes, Camera(c.intrinsics.resize(*SIZE), c.T_world_camera)) for c in cameras)


def _picture(studio: Studio, planes: tuple[Plane, ...], camera: Camera) -> SurfacePicture:
    half = Camera(camera.intrinsics.resize(SIZE[0] // 2, SIZE[1] // 2), camera.T_world_camera)
    shown = studio.empty_room_planes(half)
    surface = np.array([*(OUTPUTS.index(p.role) for p in planes), NONE], np.uint8)[shown]
    return SurfacePicture(studio.photograph(camera, SIZE)[0], surface, elevation_sines(half, shown.shape))


def _pack(pictures: tuple[SurfacePicture, ...]) -> bytes:
    arrays: dict[str, np.ndarray] = {"count": np.array(len(pictures))}
    for k, picture in enumerate(pictures):
        arrays |= {f"jpeg_{k}": encode_picture(picture.rgb), f"surface_{k}": picture.surface}
        arrays |= {f"rise_{k}": picture.rise.astype(np.float16)}
    return npz_bytes(arrays, compressed=True)


@lru_cache(maxsize=1000)
def read_surfaces(path: Path) -> tuple[SurfacePicture, ...]:
    """The pictures of one room's file."""
    with np.load(path, allow_pickle=False) as saved:
        return tuple(
            SurfacePicture(
                decode_picture(saved[f"jpeg_{k}"], path),
                saved[f"surface_{k}"],
                saved[f"rise_{k}"].astype(np.float32),
            )
            for k in range(int(saved["count"]))
        )


@dataclass(frozen=True)
class SurfaceFiles:
    """The files of a folder of rooms with known surfaces."""

    paths: tuple[Path, ...]

    @classmethod
    def read(cls, folder: Path) -> SurfaceFiles:
        """All rooms of a folder that have pictures.

        Raises:
            InputError: where there is none.
        """
        paths = tuple(p for p in sorted(folder.glob("surfaces_*.npz")) if read_surfaces(p))
        if not paths:
            raise InputError(
                f"{folder}: no rooms with surfaces; make some: python -m diorama_core.training surfaces {folder}"
            )
        return cls(paths)

    def batch(self, count: int, rng: np.random.Generator) -> tuple[Tensor, ...]:
        """Maps of the backbone, the elevations and, last, what is right, each with the batch first."""
        rows = []
        for _ in range(count):
            pictures = read_surfaces(self.paths[int(rng.integers(len(self.paths)))])
            picture = _crop(pictures[int(rng.integers(len(pictures)))], rng)
            maps = backbone_maps(photograph(picture.rgb, rng))
            rows.append((*(maps[name][0] for name in MAP_CHANNELS), _cells(picture.rise), _shares(picture)))
        return tuple(torch.from_numpy(np.stack(part).astype(np.float32)) for part in zip(*rows, strict=True))


def _crop(picture: SurfacePicture, rng: np.random.Generator) -> SurfacePicture:
    """A part of a picture, a little turned, or all of it; mirrored every other time."""
    width, height = SIZE
    if rng.random() < CROPPED:
        scale, stretch = np.exp(rng.uniform(0.0, LARGEST)), np.exp(rng.normal(0.0, STRETCH))
        sx, sy = max(scale * stretch, 1.0), max(scale / stretch, 1.0)
        turn = cv2.getRotationMatrix2D((width / 2, height / 2), float(np.rad2deg(rng.normal(0.0, TURN_RAD))), 1.0)
        M = np.array([[sx, 0, rng.uniform(width * (1 - sx), 0)], [0, sy, rng.uniform(height * (1 - sy), 0)], [0, 0, 1]])
        picture = _warp(picture, (turn @ M).astype(np.float64))
    if rng.random() < 0.5:
        parts = (picture.rgb, picture.surface, picture.rise)
        picture = SurfacePicture(*(np.ascontiguousarray(part[:, ::-1]) for part in parts))
    return picture


def _warp(picture: SurfacePicture, M: Float[np.ndarray, "2 3"]) -> SurfacePicture:
    half = M * np.array([1.0, 1.0, 0.5])
    size = (SIZE[0] // 2, SIZE[1] // 2)

    def warp(part: np.ndarray, how: int, outside: float) -> np.ndarray:
        return np.asarray(cv2.warpAffine(part, half, size, flags=how, borderValue=outside))

    return SurfacePicture(
        np.asarray(cv2.warpAffine(picture.rgb, M, SIZE, borderMode=cv2.BORDER_REFLECT_101), np.uint8),
        warp(picture.surface, cv2.INTER_NEAREST, NONE),
        warp(picture.rise, cv2.INTER_LINEAR, 0.0),
    )


def _cells(of_halves: Float[np.ndarray, "h2 w2 *c"]) -> Float[np.ndarray, "h w *c"]:
    """Means of the pixels of half the size over the cells of the network's outputs."""
    by = CELL_PX // 2
    height, width = of_halves.shape[:2]
    return np.asarray(of_halves.reshape(height // by, by, width // by, by, *of_halves.shape[2:]).mean(axis=(1, 3)))


def _shares(picture: SurfacePicture) -> Float[np.ndarray, "3 h w"]:
    """Shares of the surfaces in every cell."""
    return np.moveaxis(_cells(np.eye(NONE + 1)[picture.surface]), -1, 0)[:NONE]


class SurfaceHead(nn.Module):
    """Input: maps of the backbone (`MAP_CHANNELS`) and `rise` [b, h, w]. Output: `OUTPUTS` [b, 3, h, w].

    The coarsest map, of which some layers see far and one the whole picture, is made finer map by map.

    Args:
        width: channels at a stride of 8.
    """

    def __init__(self, width: int = 64) -> None:
        super().__init__()
        w, (c4, c8, c16, c32) = width, (channels + 1 for channels in MAP_CHANNELS.values())
        self.from_32 = convolution(c32, 2 * w, 1)
        self.far = nn.Sequential(*(Residual(2 * w, dilation) for dilation in (1, 2, 1, 2)))
        self.whole = nn.Linear(2 * w, 2 * w)
        self.from_16 = convolution(c16, w, 1)
        self.at_16 = nn.Sequential(convolution(3 * w, 3 * w // 2, 1), Residual(3 * w // 2), Residual(3 * w // 2, 2))
        self.from_8 = convolution(c8, w // 2, 1)
        self.at_8 = nn.Sequential(convolution(2 * w, w, 1), Residual(w), Residual(w, 2))
        self.from_4 = convolution(c4, w // 2, 1)
        self.at_4 = nn.Sequential(convolution(3 * w // 2, w // 2, 1), Residual(w // 2), Residual(w // 2))
        self.out = nn.Conv2d(w // 2, len(OUTPUTS), 3, padding=1)

    def forward(
        self,
        m4: Float[Tensor, "b c4 h w"],
        m8: Float[Tensor, "b c8 h2 w2"],
        m16: Float[Tensor, "b c16 h4 w4"],
        m32: Float[Tensor, "b c32 h8 w8"],
        rise: Float[Tensor, "b h w"],
    ) -> Float[Tensor, "b 3 h w"]:
        """Probabilities.

        Args:
            m4, m8, m16, m32: maps of the backbone by stride.
            rise: sines of the elevations, in cells.
        """
        return torch.softmax(self.logits(m4, m8, m16, m32, rise), dim=1)

    def logits(self, m4: Tensor, m8: Tensor, m16: Tensor, m32: Tensor, rise: Tensor) -> Float[Tensor, "b 3 h w"]:
        """The outputs before they are probabilities.

        Args:
            m4, m8, m16, m32: maps of the backbone by stride.
            rise: sines of the elevations, in cells.
        """
        rises = [4.0 * rise[:, None]]
        for _ in range(3):
            rises.append(functional.avg_pool2d(rises[-1], 2))
        m4, m8, m16, m32 = (torch.cat([m, r], dim=1) for m, r in zip((m4, m8, m16, m32), rises, strict=True))
        x = self.far(self.from_32(m32))
        x = x + self.whole(x.mean(dim=(2, 3)))[:, :, None, None]
        for m, before, at in (
            (m16, self.from_16, self.at_16),
            (m8, self.from_8, self.at_8),
            (m4, self.from_4, self.at_4),
        ):
            finer = functional.interpolate(x, scale_factor=2.0, mode="bilinear", align_corners=False)
            x = at(torch.cat([finer, before(m)], dim=1))
        logits: Tensor = self.out(x)
        return logits


def surface_loss(logits: Float[Tensor, "b 3 h w"], shares: Float[Tensor, "b 3 h w"]) -> tuple[Tensor, float]:
    """Cross-entropy of the surfaces, and the share of cells that are right.

    Args:
        logits: of `SurfaceHead.logits`.
        shares: true ones.
    """
    known = shares.sum(dim=1)
    loss = -(shares * functional.log_softmax(logits, dim=1)).sum() / known.sum()
    right = ((logits.argmax(dim=1) == shares.argmax(dim=1)) * known).sum() / known.sum()
    return loss, float(right.detach())
