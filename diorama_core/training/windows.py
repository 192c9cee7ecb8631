"""Rendered objects in the windows of their boxes, with the pixels that are theirs, one file for each room."""

from __future__ import annotations

import io
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
import torch
from jaxtyping import Bool, UInt8
from torch import Tensor

from diorama_core.errors import InputError, LibraryError, SceneError
from diorama_core.library.record import ShapeLibrary
from diorama_core.models.outliner import FILL, SIDE, resample
from diorama_core.progress import SILENT, Progress
from diorama_core.scene.values import ArrayValue
from diorama_core.synthesis import sample_cameras
from diorama_core.synthesis.truth import Studio
from diorama_core.training.augment import photograph
from diorama_core.training.pictures import CAMERAS, make_files, visible_boxes
from diorama_core.training.rooms import random_room

SIZE = (512, 384)
"""Width and height of the rendered pictures."""
VIEWS = 7
MOST = 14
"""Objects of a picture that are taken; large ones more often."""
MIN_SIDE_PX = 22.0
"""Geometric mean of a box's sides: what is smaller has no outline to learn from."""
JITTER = 0.025
"""Standard deviation of a box's sides, as a share of its size: people and detectors draw them a little wrong."""


@dataclass(frozen=True, eq=False)
class Windows(ArrayValue):
    """Objects of one room."""

    rgb: UInt8[np.ndarray, "n s s 3"]
    share: UInt8[np.ndarray, "n s s"]
    """Share of each cell that is the object's, 0 to 255."""
    inside: Bool[np.ndarray, "n s s"]
    """Where there is a picture."""


def make_windows(folder: Path, library: ShapeLibrary, seeds: range, progress: Progress = SILENT) -> int:
    """Render the rooms of some seeds that are not in the folder yet.

    Args:
        folder, library, seeds, progress: as of `pictures.make_pictures`, like the number that is returned.
    """
    return make_files(
        folder, seeds, "windows_{:06d}.npz".format, lambda seed: _pack(_room_windows(seed, library)), progress
    )


@dataclass(frozen=True)
class WindowFiles:
    """The files of a folder of windows."""

    paths: tuple[Path, ...]

    @classmethod
    def of(cls, folder: Path) -> WindowFiles:
        """All rooms of a folder that have objects.

        Raises:
            InputError: where there is none.
        """
        paths = tuple(p for p in sorted(folder.glob("windows_*.npz")) if len(read_windows(p).rgb))
        if not paths:
            raise InputError(
                f"{folder}: no windows are there; make some: python -m diorama_core.training windows {folder}"
            )
        return cls(paths)

    def batch(self, count: int, rng: np.random.Generator) -> tuple[Tensor, Tensor]:
        """Windows as the network takes them, `[b, 4, s, s]`, and the shares to learn, `[b, s, s]`, 0 to 1."""
        inputs, shares = [], []
        for _ in range(count):
            windows = read_windows(self.paths[int(rng.integers(len(self.paths)))])
            k = int(rng.integers(len(windows.rgb)))
            rgb, share, inside = windows.rgb[k], windows.share[k], windows.inside[k]
            if rng.random() < 0.5:
                rgb, share, inside = (np.ascontiguousarray(a[:, ::-1]) for a in (rgb, share, inside))
            colours = np.where(inside[..., None], photograph(rgb, rng), FILL).astype(np.float32) / np.float32(255)
            inputs.append(np.concatenate([colours, inside[..., None].astype(np.float32)], axis=2).transpose(2, 0, 1))
            shares.append(share.astype(np.float32) / np.float32(255))
        return torch.from_numpy(np.stack(inputs)), torch.from_numpy(np.stack(shares))


@lru_cache(maxsize=1000)
def read_windows(path: Path) -> Windows:
    """The objects of one room's file."""
    with np.load(path, allow_pickle=False) as saved:
        count = len(saved["rgb"])
        inside = np.unpackbits(saved["inside"], count=count * SIDE * SIDE).reshape(count, SIDE, SIDE).astype(bool)
        return Windows(saved["rgb"], saved["share"], inside)


def _room_windows(seed: int, library: ShapeLibrary) -> Windows:
    """Windows of a room; none where it cannot be furnished or photographed; it is not tried again."""
    rng = np.random.default_rng(seed)
    rgb, share, inside = [], [], []
    try:
        scene = random_room(seed, library)
        cameras = sample_cameras(scene, library, seed, VIEWS, SIZE, CAMERAS)
    except (SceneError, LibraryError):
        cameras = ()
    studio = Studio(scene, library) if cameras else None
    for camera in cameras:
        assert studio is not None
        picture, ids = studio.photograph(camera, SIZE)
        boxes, visible, _ = visible_boxes(ids, len(scene.objects))
        sides = np.sqrt(np.prod(boxes[:, 2:] - boxes[:, :2], axis=1))
        large = np.flatnonzero(sides > MIN_SIDE_PX)
        if len(large) > MOST:
            large = rng.choice(large, MOST, replace=False, p=sides[large] / sides[large].sum())
        for k in large:
            x1, y1, x2, y2 = boxes[k]
            drawn = boxes[k] + rng.normal(0.0, JITTER, 4) * np.array([x2 - x1, y2 - y1, x2 - x1, y2 - y1])
            box = (float(drawn[0]), float(drawn[1]), float(drawn[2]), float(drawn[3]))
            mine = (ids == visible[k]).astype(np.float32)
            rgb.append(resample(picture, box))
            share.append((resample(mine, box) * 255).astype(np.uint8))
            inside.append(resample(np.ones_like(mine), box) > 0.5)
    return Windows(
        np.array(rgb, np.uint8).reshape(-1, SIDE, SIDE, 3),
        np.array(share, np.uint8).reshape(-1, SIDE, SIDE),
        np.array(inside, bool).reshape(-1, SIDE, SIDE),
    )


def _pack(windows: Windows) -> bytes:
    buffer = io.BytesIO()
    np.savez_compressed(buffer, rgb=windows.rgb, share=windows.share, inside=np.packbits(windows.inside))
    return buffer.getvalue()
