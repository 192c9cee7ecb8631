"""Mask correction by clicks on object and background (GrabCut with fixed seeds)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from jaxtyping import Bool, UInt8

from diorama_core.artefacts import Box

SEED_SHARE = 0.035
"""Radius of a click, as a share of the box's diagonal."""
MARGIN = 0.25
LONGEST_PX = 320
ROUNDS = 4
LIKE = 14
"""Neighbouring pixels within so much of a click's colour probably belong together with it."""
_SEED = 7


@dataclass(frozen=True, eq=False)
class MaskDraft:
    """A mask in progress; every click is a new outline."""

    rgb: UInt8[np.ndarray, "h w 3"]
    box: Box
    mask: Bool[np.ndarray, "h w"]
    clicks: tuple[tuple[float, float, bool], ...] = ()
    """x, y in photo pixels, and whether it is part of the object."""

    def click(self, x: float, y: float, *, part: bool) -> MaskDraft:
        """The outline after one more click.

        Args:
            x: pixels of the photo.
            y: likewise.
            part: whether it is a part of the object.
        """
        more = replace(self, clicks=(*self.clicks, (x, y, part)))
        return replace(more, mask=more._cut())

    def _cut(self) -> Bool[np.ndarray, "h w"]:
        height, width = self.rgb.shape[:2]
        x1, y1, x2, y2 = self.box
        inside = [(x, y) for x, y, part in self.clicks if part]
        x1, x2 = min([x1, *(x for x, _ in inside)]), max([x2, *(x for x, _ in inside)])
        y1, y2 = min([y1, *(y for _, y in inside)]), max([y2, *(y for _, y in inside)])
        dx, dy = MARGIN * (x2 - x1) + 4, MARGIN * (y2 - y1) + 4
        left, top = max(int(x1 - dx), 0), max(int(y1 - dy), 0)
        right, bottom = min(int(x2 + dx) + 1, width), min(int(y2 + dy) + 1, height)
        crop = np.ascontiguousarray(self.rgb[top:bottom, left:right])
        scale = min(1.0, LONGEST_PX / max(crop.shape[:2]))
        size = (max(1, round(crop.shape[1] * scale)), max(1, round(crop.shape[0] * scale)))
        small = cv2.resize(crop, size, interpolation=cv2.INTER_AREA)
        before = cv2.resize(self.mask[top:bottom, left:right].astype(np.uint8), size, interpolation=cv2.INTER_NEAREST)
        labels = np.where(before > 0, cv2.GC_PR_FGD, cv2.GC_PR_BGD).astype(np.uint8)
        labels[0, :] = labels[-1, :] = labels[:, 0] = labels[:, -1] = cv2.GC_BGD
        radius = max(2, round(SEED_SHARE * float(np.hypot(x2 - x1, y2 - y1)) * scale))
        for x, y, part in self.clicks:
            centre = (
                min(max(round((x - left) * scale), 0), size[0] - 1),
                min(max(round((y - top) * scale), 0), size[1] - 1),
            )
            labels[_like(small, centre)] = cv2.GC_PR_FGD if part else cv2.GC_PR_BGD
            cv2.circle(labels, centre, radius, int(cv2.GC_FGD if part else cv2.GC_BGD), -1)
        hopeful = (labels == cv2.GC_FGD) | (labels == cv2.GC_PR_FGD)
        if hopeful.any() and not hopeful.all():
            models = np.zeros((2, 1, 65))
            cv2.setRNGSeed(_SEED)
            cv2.grabCut(small, labels, None, models[0], models[1], ROUNDS, cv2.GC_INIT_WITH_MASK)
        foreground = ((labels == cv2.GC_FGD) | (labels == cv2.GC_PR_FGD)).astype(np.float32)
        mask = np.zeros((height, width), dtype=bool)
        mask[top:bottom, left:right] = cv2.resize(foreground, (right - left, bottom - top)) >= 0.5
        return mask

    @property
    def bounds(self) -> Box:
        """The box around the mask; the drawn one while the mask is empty."""
        rows, columns = np.flatnonzero(self.mask.any(axis=1)), np.flatnonzero(self.mask.any(axis=0))
        if not len(rows):
            return self.box
        return float(columns[0]), float(rows[0]), float(columns[-1] + 1), float(rows[-1] + 1)


def _like(picture: UInt8[np.ndarray, "h w 3"], seed: tuple[int, int]) -> Bool[np.ndarray, "h w"]:
    """The connected surface of a click's colour."""
    height, width = picture.shape[:2]
    filled = np.zeros((height + 2, width + 2), dtype=np.uint8)
    reach = (LIKE, LIKE, LIKE)
    flags = 4 | cv2.FLOODFILL_MASK_ONLY | cv2.FLOODFILL_FIXED_RANGE | (1 << 8)
    cv2.floodFill(cv2.GaussianBlur(picture, (3, 3), 0), filled, seed, (0, 0, 0), reach, reach, flags)
    return filled[1:-1, 1:-1] > 0
