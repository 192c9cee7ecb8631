"""Masks of objects in boxes: the outliner that comes with Diorama, made exact by GrabCut.

The outliner knows which pixels may be the object's; GrabCut (Rother et al. 2004) decides about those of which it is
unsure, by the colours of those of which it is sure and by the picture's edges. Masks that the user gave are taken as
they are.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import cv2
import numpy as np
from jaxtyping import Bool, Float32, UInt8

from diorama_core.artefacts import Box, DetectedObject, Inputs, LabelledBox
from diorama_core.models.outliner import BoxOutliner, own_outliner, pixels_of, warp_to_photo
from diorama_core.perception.drawn_boxes import SETTINGS as DRAWN_BOXES
from diorama_core.perception.drawn_boxes import DrawnBoxSettings, ends_of_objects
from diorama_core.progress import Progress

_MIN_SHARE = 0.02
"""A mask that covers less of its box than this has lost the object."""
LOST_CONFIDENCE = 0.1
_MAX_CONFIDENCE = 0.98
"""Only masks that a person drew are sure."""
_SEED = 7
_SURE = 0.75
"""Probability of belonging or not belonging to the object beyond which a pixel is not asked again."""
_MIN_PIXELS = 16
"""Pixels of object and of surroundings that colours are learnt from."""


@dataclass(frozen=True)
class EmbeddedMasks:
    """The object stage without downloaded networks."""

    outliner: BoxOutliner = field(default_factory=own_outliner)
    crop_px: int = 240
    """Longest side at which a box is looked at by GrabCut."""
    drawing: DrawnBoxSettings = DRAWN_BOXES
    """How boxes that were drawn roughly become exact."""

    def segment(self, inputs: Inputs, progress: Progress) -> tuple[DetectedObject, ...]:
        """One object per instance the user masked and per box no mask belongs to, in the order given.

        Returns:
            Objects with ids such as "night_stand_2", unique mask ids from 1, and masks of the photo's size that are
            never empty.
        """
        return outline_objects(inputs, self._segment_boxes, progress)

    def _segment_boxes(self, rgb: UInt8[np.ndarray, "h w 3"], boxes: list[LabelledBox], progress: Progress) -> Outlined:
        drawn, shape = [box.box for box in boxes], (rgb.shape[0], rgb.shape[1])
        windows = self.outliner.windows(rgb, drawn)
        results: Outlined = []
        for done, (box, share, ends) in enumerate(
            zip(drawn, windows, ends_of_objects(drawn, windows, shape, self.drawing), strict=True)
        ):
            progress.report(done / len(boxes), f"Outlining objects ({done + 1} of {len(boxes)})")
            results.append((*self._segment(rgb, warp_to_photo(share, box, ends, shape), ends), ends))
        return results

    def segment_box(self, rgb: UInt8[np.ndarray, "h w 3"], box: Box) -> tuple[Bool[np.ndarray, "h w"], float]:
        """The object inside a box, and how sure its outline is (0 to 1).

        Where nothing can be told apart, the mask is the box and the confidence low.
        """
        return self._segment(rgb, self.outliner.outlines(rgb, [box])[0], box)

    def _segment(
        self, rgb: UInt8[np.ndarray, "h w 3"], probability: Float32[np.ndarray, "h2 w2"], box: Box
    ) -> tuple[Bool[np.ndarray, "h w"], float]:
        rows, columns = pixels_of(box, rgb.shape[:2])
        inside = refine_mask(np.ascontiguousarray(rgb[rows, columns]), probability, self.crop_px)
        if inside.mean() < _MIN_SHARE:
            return box_mask(rgb.shape[:2], box), LOST_CONFIDENCE
        mask = np.zeros(rgb.shape[:2], dtype=bool)
        mask[rows, columns] = inside
        expected = float((probability * inside).sum() / max(np.maximum(probability, inside).sum(), 1e-9))
        return mask, float(np.clip(np.sqrt(expected), LOST_CONFIDENCE, _MAX_CONFIDENCE))


def refine_mask(
    rgb: UInt8[np.ndarray, "h w 3"], probability: Float32[np.ndarray, "h w"], longest_px: int
) -> Bool[np.ndarray, "h w"]:
    """The likely pixels, the doubtful ones among them decided by colours and edges.

    Args:
        rgb: part of a photo.
        probability: how likely each pixel is the object's.
        longest_px: the longer side at which GrabCut works.
    """
    height, width = probability.shape
    scale = min(1.0, longest_px / max(height, width))
    size = max(1, round(width * scale)), max(1, round(height * scale))
    small, likely = (cv2.resize(a, size, interpolation=cv2.INTER_AREA) for a in (rgb, probability))
    labels = np.where(likely > 0.5, cv2.GC_PR_FGD, cv2.GC_PR_BGD).astype(np.uint8)
    labels[likely > _SURE], labels[likely < 1 - _SURE] = cv2.GC_FGD, cv2.GC_BGD
    object_like = (labels == cv2.GC_PR_FGD) | (labels == cv2.GC_FGD)
    if min(object_like.sum(), (~object_like).sum()) < _MIN_PIXELS:
        return np.asarray(probability > 0.5)
    models = np.zeros((2, 1, 65))
    cv2.setRNGSeed(_SEED)
    try:
        cv2.grabCut(small, labels, None, models[0], models[1], 1, cv2.GC_INIT_WITH_MASK)
    except cv2.error:  # too few different colours to tell object and background apart
        return np.asarray(probability > 0.5)
    foreground = ((labels == cv2.GC_FGD) | (labels == cv2.GC_PR_FGD)).astype(np.float32)
    return np.asarray(cv2.resize(foreground, (width, height), interpolation=cv2.INTER_LINEAR) >= 0.5)


Outlined = list[tuple[Bool[np.ndarray, "h w"], float, Box]]
"""A mask, its confidence and where the object ends, for every box."""


def outline_objects(
    inputs: Inputs,
    segment_boxes: Callable[[UInt8[np.ndarray, "h w 3"], list[LabelledBox], Progress], Outlined],
    progress: Progress,
) -> tuple[DetectedObject, ...]:
    """Objects from the user's own masks, and from boxes that no mask belongs to, outlined by `segment_boxes`."""
    given = _user_instances(inputs)
    taken = {box for _, box, _ in given}
    boxed = [box for box in inputs.boxes if box not in taken]
    segmented = segment_boxes(inputs.photo.rgb, boxed, progress)
    first_free = max((mask_id for mask_id, _, _ in given), default=0) + 1
    detected = [(i, box, mask, 1.0) for i, box, mask in given]
    detected += [
        (first_free + n, replace(box, box=at), mask, confidence)
        for n, (box, (mask, confidence, at)) in enumerate(zip(boxed, segmented, strict=True))
    ]
    ids = _ids([box.category for _, box, _, _ in detected])
    progress.report(1.0, "Objects outlined")
    return tuple(
        DetectedObject(name, box.category, box.label, box.box, mask, mask_id, confidence)
        for name, (mask_id, box, mask, confidence) in zip(ids, detected, strict=True)
    )


def _user_instances(inputs: Inputs) -> list[tuple[int, LabelledBox, Bool[np.ndarray, "h w"]]]:
    """The user's instances that cover at least one pixel."""
    if inputs.instances is None:
        return []
    named = [(mask_id, box, inputs.instances == mask_id) for mask_id, box in inputs.instance_boxes]
    return [(mask_id, box, mask) for mask_id, box, mask in named if mask.any()]


def box_mask(shape: tuple[int, ...], box: Box) -> Bool[np.ndarray, "h w"]:
    """The box as a mask, at least one pixel large."""
    mask = np.zeros(shape[:2], dtype=bool)
    mask[pixels_of(box, (shape[0], shape[1]))] = True
    return mask


def _ids(categories: list[str]) -> list[str]:
    """Snake-case names numbered within their category: chair_1, chair_2, night_stand_1."""
    seen: Counter[str] = Counter()
    names = []
    for category in categories:
        seen[category] += 1
        names.append(f"{category.replace(' ', '_')}_{seen[category]}")
    return names
