"""How well boxes agree with the photo: their sides lie on edges of the picture, and things stand as they usually do,
which tells the way up.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.artefacts import LabelledBox, Photo
from diorama_core.library.taxonomy import UNKNOWN, broad, category
from diorama_core.perception.inputs.boxes.entry import Corners

WORKING_SIDE_PX = 512
"""Edges are read at no more than so many pixels a side."""
SLACK_SHARE = 0.008
"""Share of the longer side by which a drawn box may miss its object."""


class EdgeMap:
    """The strength of edges across and along the photo."""

    def __init__(self, rgb: UInt8[np.ndarray, "h w 3"]) -> None:
        import cv2  # the editor opens without it

        scale = min(1.0, WORKING_SIDE_PX / max(rgb.shape[:2]))
        size = max(8, round(rgb.shape[1] * scale)), max(8, round(rgb.shape[0] * scale))
        grey = cv2.cvtColor(cv2.resize(rgb, size, interpolation=cv2.INTER_AREA), cv2.COLOR_RGB2GRAY).astype(np.float32)
        across, along = (np.abs(cv2.Sobel(grey, cv2.CV_32F, dx, 1 - dx)) + 1.0 for dx in (1, 0))
        self._scale = np.array([size[0] / rgb.shape[1], size[1] / rgb.shape[0]])
        self._slack = max(1, round(SLACK_SHARE * max(size)))
        # The fourth root tempers strong edges: that a side lies on one counts more than how strong it is.
        tempered = (np.sqrt(np.sqrt(m)) for m in (across, along.T))
        self._across, self._along = (np.cumsum(np.pad(m, ((1, 0), (0, 0))), axis=0) for m in tempered)

    def agreement(self, boxes: Sequence[Corners]) -> float:
        """The mean strength of edges under the sides of boxes, over that of such lines anywhere; 1 says nothing."""
        sides = [s for box in boxes for s in self._sides(box)]
        return float(np.mean(sides)) if sides else 0.0

    def _sides(self, box: Corners) -> list[float]:
        x1, y1, x2, y2 = np.array(box) * np.tile(self._scale, 2)
        strengths = [self._strength(self._across, at, (y1, y2)) for at in (x1, x2)]
        strengths += [self._strength(self._along, at, (x1, x2)) for at in (y1, y2)]
        return [s for s in strengths if s is not None]

    def _strength(self, summed: Float[np.ndarray, "h w"], at: float, between: tuple[float, float]) -> float | None:
        """The strongest line near a side, over what such a line is anywhere; None at the picture's own side."""
        height, width = summed.shape
        low, high = max(0, round(between[0])), min(height - 1, round(between[1]))
        column, slack = round(at), self._slack
        if high - low < 2 or column < slack or column >= width - slack:
            return None
        line = summed[high] - summed[low]
        from scipy.ndimage import maximum_filter1d  # as cv2

        # The maximum over a window anywhere is what a side would find by chance.
        windows = maximum_filter1d(line, 2 * slack + 1)
        return float(windows[column] / windows.mean())


_USUAL = {"ceiling": (0.18, 0.14), "wall": (0.38, 0.15), "floor": (0.64, 0.14), "rug": (0.8, 0.12)}
"""Mean and deviation of the height in the picture (0 top, 1 bottom) of the middle of what is so held."""
CERTAIN = 6.0
"""Logarithm of the likelihoods' ratio from which a turned photo is said to be one: four hundred to one."""


def is_upside_down(boxes: Sequence[LabelledBox], height: int) -> bool:
    """Whether things lie as in a picture that was turned by 180 degrees; boxes without names say nothing.

    Args:
        boxes: with names; those without say nothing.
        height: of the photo, pixels.
    """
    ratio = 0.0
    for box in boxes:
        if box.category == UNKNOWN.name:
            continue
        mount = "rug" if broad(box.category) == "rug" else category(box.category).mount
        if mount not in _USUAL:
            continue
        mean, deviation = _USUAL[mount]
        at = (box.box[1] + box.box[3]) / 2 / height
        ratio += ((at - mean) ** 2 - (1.0 - at - mean) ** 2) / (2 * deviation**2)
    return ratio > CERTAIN


def rotate_box_180(marked: LabelledBox, photo: Photo) -> LabelledBox:
    """A box of a photo after that was turned by 180 degrees."""
    x1, y1, x2, y2 = marked.box
    return replace(marked, box=(photo.width - x2, photo.height - y2, photo.width - x1, photo.height - y1))
