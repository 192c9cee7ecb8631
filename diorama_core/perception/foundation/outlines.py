"""Masks from boxes, by SAM 2.1 or SlimSAM."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import UInt8

from diorama_core.artefacts import DetectedObject, Inputs, LabelledBox
from diorama_core.models.segment_anything import BoxSegmenter
from diorama_core.perception.masks import LOST_CONFIDENCE, Outlined, filled_box, outlined
from diorama_core.progress import Progress

_MARGIN = 0.05
"""Share of a box's size by which its object may extend beyond it."""
_MIN_SHARE = 0.02
"""A mask that covers less of its box has lost the object."""


@dataclass(frozen=True)
class PromptedMasks:
    """The object stage with a segmenter that boxes prompt; masks that the user gave are taken as they are."""

    segmenter: BoxSegmenter

    def segment(self, inputs: Inputs, progress: Progress) -> tuple[DetectedObject, ...]:
        """One object per instance the user masked and per box no mask belongs to, in the order given."""
        return outlined(inputs, self._inside_boxes, progress)

    def _inside_boxes(self, rgb: UInt8[np.ndarray, "h w 3"], boxes: list[LabelledBox], progress: Progress) -> Outlined:
        if not boxes:
            return []
        progress.report(0.0, "Outlining objects")
        results: Outlined = []
        masks = self.segmenter.masks(rgb, np.array([b.box for b in boxes]))
        for done, (box, prompted) in enumerate(zip(boxes, masks, strict=True)):
            progress.report(done / len(boxes), f"Outlining objects ({done + 1} of {len(boxes)})")
            mask = prompted.mask & filled_box(rgb.shape[:2], _widened(box, rgb.shape[1], rgb.shape[0]))
            whole = filled_box(rgb.shape[:2], box.box)
            lost = mask.sum() < _MIN_SHARE * whole.sum()
            results.append((whole, LOST_CONFIDENCE) if lost else (mask, max(prompted.quality, LOST_CONFIDENCE)))
        return results


def _widened(box: LabelledBox, width: int, height: int) -> tuple[float, float, float, float]:
    x1, y1, x2, y2 = box.box
    dx, dy = _MARGIN * (x2 - x1), _MARGIN * (y2 - y1)
    return max(0.0, x1 - dx), max(0.0, y1 - dy), min(float(width), x2 + dx), min(float(height), y2 + dy)
