"""The outliner that comes with Diorama: which pixels in a box are the object's, with nothing downloaded.

A small network trained by `diorama_core.training` on rendered rooms; `assets/models` has its weights, how they were
made and how good they are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Float32, Shaped, UInt8
from scipy.special import expit

from diorama_core.errors import UnavailableError
from diorama_core.io import assets
from diorama_core.io.assets import OUTLINER
from diorama_core.models.runtime import GraphNetwork
from diorama_core.models.store import sha256_of

Box = tuple[float, float, float, float]

SIDE = 96
"""Side of a window, in cells."""
MARGIN = 0.25
"""Share of the box's size on every side of a window: what is around an object tells what is not the object."""
FILL = 114
"""Grey of what is outside the photo."""
_BATCH = 16
"""Windows a run."""
_SKIPPED = 1.2
"""Pixels a cell above which linear interpolation alone would skip some."""
_BLUR = 0.45


@dataclass(frozen=True)
class BoxOutliner(GraphNetwork):
    """Input: an upright RGB picture, eight bits, any size, and boxes in its pixels. Output: shares of their windows."""

    weights: str = "outliner"

    @classmethod
    def of(cls, folder: Path) -> BoxOutliner:
        """The outliner of a folder.

        Raises:
            UnavailableError: when it is not there.
        """
        path = folder / OUTLINER
        if not path.is_file():
            raise UnavailableError(f"{folder}: {OUTLINER} is missing; restore it from the repository")
        return cls(path, sha256_of(path)[:8])

    def outlines(self, rgb: UInt8[np.ndarray, "h w 3"], boxes: Sequence[Box]) -> list[Float32[np.ndarray, "h2 w2"]]:
        """For every box how likely each pixel of its rectangle in the photo (`pixels_of`) is the object's, 0 to 1."""
        shares = self.windows(rgb, boxes)
        return [warp_to_photo(share, box, box, rgb.shape[:2]) for share, box in zip(shares, boxes, strict=True)]

    def windows(self, rgb: UInt8[np.ndarray, "h w 3"], boxes: Sequence[Box]) -> list[Float32[np.ndarray, "s s"]]:
        """For every box how likely each cell of its window is the object's, 0 to 1; looked at as it is and mirrored."""
        shares: list[Float32[np.ndarray, "s s"]] = []
        for first in range(0, len(boxes), _BATCH):
            windows = np.stack([window(rgb, box) for box in boxes[first : first + _BATCH]])
            both = self._logits(windows) + self._logits(np.ascontiguousarray(windows[..., ::-1]))[..., ::-1]
            shares += list(expit(both / 2).astype(np.float32))
        return shares

    def _logits(self, windows: Float32[np.ndarray, "b 4 s s"]) -> Float32[np.ndarray, "b s s"]:
        shapes = {"logits": (len(windows), SIDE, SIDE)}
        return self.session.run({"windows": windows}, shapes)["logits"].astype(np.float32)


@cache
def own_outliner() -> BoxOutliner:
    """The outliner whose weights come with Diorama.

    Raises:
        UnavailableError: when they are not there.
    """
    return BoxOutliner.of(assets.FOLDER)


def window(rgb: UInt8[np.ndarray, "h w 3"], box: Box) -> Float32[np.ndarray, "4 s s"]:
    """The box with its margin, stretched to a square: colours 0 to 1, and where there is a photo at all."""
    inside = resample(np.ones(rgb.shape[:2], np.float32), box) > 0.5
    colours = np.where(inside[..., None], resample(rgb, box), FILL).astype(np.float32) / np.float32(255)
    stacked = np.concatenate([colours, inside[..., None].astype(np.float32)], axis=2)
    return np.ascontiguousarray(stacked.transpose(2, 0, 1))


def resample(image: Shaped[np.ndarray, "h w *c"], box: Box) -> Shaped[np.ndarray, "s s *c"]:
    """An image of numbers at the cells of the box's window; 0 outside the photo."""
    left, top, per_x, per_y = _grid(box)
    reach = int(2 + max(per_x, per_y))
    x, y = max(0, int(left) - reach), max(0, int(top) - reach)
    right, bottom = int(left + SIDE * per_x) + reach, int(top + SIDE * per_y) + reach
    part = np.ascontiguousarray(image[y : max(bottom, y + 1), x : max(right, x + 1)])
    if not part.size:
        return np.zeros((SIDE, SIDE, *image.shape[2:]), image.dtype)
    if max(per_x, per_y) > _SKIPPED:
        edge = cv2.BORDER_ISOLATED
        part = cv2.GaussianBlur(part, (0, 0), sigmaX=_sigma(per_x), sigmaY=_sigma(per_y), borderType=edge)
    to_photo = np.array([[per_x, 0, left + per_x / 2 - 0.5 - x], [0, per_y, top + per_y / 2 - 0.5 - y]])
    how = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    return np.asarray(cv2.warpAffine(part, to_photo, (SIDE, SIDE), flags=how, borderMode=cv2.BORDER_CONSTANT))


def warp_to_photo(
    share: Float32[np.ndarray, "s s"], box: Box, part: Box, photo_shape: tuple[int, int]
) -> Float32[np.ndarray, "h2 w2"]:
    """Numbers of a box's window at the pixels of a part of the photo (`pixels_of`), interpolated.

    Args:
        share: a number for each cell of the window.
        box: whose window it is, in photo pixels.
        part: likewise; beyond the window its border is continued.
        photo_shape: rows and columns.
    """
    left, top, per_x, per_y = _grid(box)
    rows, columns = pixels_of(part, photo_shape)
    size = (columns.stop - columns.start, rows.stop - rows.start)
    to_window = np.array(
        [
            [1 / per_x, 0, (columns.start + 0.5 - left) / per_x - 0.5],
            [0, 1 / per_y, (rows.start + 0.5 - top) / per_y - 0.5],
        ]
    )
    how = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    return np.asarray(cv2.warpAffine(share, to_window, size, flags=how, borderMode=cv2.BORDER_REPLICATE), np.float32)


def pixels_of(box: Box, photo_shape: tuple[int, int]) -> tuple[slice, slice]:
    """Rows and columns of the pixels that a box touches inside the photo, at least one each."""
    height, width = photo_shape
    x, y = min(max(int(np.floor(box[0])), 0), width - 1), min(max(int(np.floor(box[1])), 0), height - 1)
    right = min(max(x + 1, int(np.ceil(box[2]))), width)
    bottom = min(max(y + 1, int(np.ceil(box[3]))), height)
    return slice(y, bottom), slice(x, right)


def _grid(box: Box) -> tuple[float, float, float, float]:
    """Left and top of the window, and the width and height of its cells, in photo pixels."""
    x1, y1, x2, y2 = box
    w, h = max(x2 - x1, 1.0), max(y2 - y1, 1.0)
    per_x, per_y = (1 + 2 * MARGIN) * w / SIDE, (1 + 2 * MARGIN) * h / SIDE
    return x1 - MARGIN * w, y1 - MARGIN * h, per_x, per_y


def _sigma(per_cell: float) -> float:
    return max(_BLUR * (per_cell - 0.2), 0.01) if per_cell > _SKIPPED else 0.01
