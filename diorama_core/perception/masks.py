"""Masks of objects in boxes without networks: GrabCut inside each box.

Several starts (margins around the box, and an oval inside it) vote; how far they agree is the confidence. Masks that
the user gave are taken as they are.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, UInt8

from diorama_core.artefacts import Box, DetectedObject, Inputs, LabelledBox
from diorama_core.progress import Progress

_MIN_SHARE = 0.1
"""A vote that keeps less of the box than this has lost the object."""
LOST_CONFIDENCE = 0.1
_MAX_CONFIDENCE = 0.98
"""Only masks that a person drew are sure."""
_SEED = 7
_CORE = 0.12
"""Reach of the middle of a box that is taken to be object, so that a thing of its surroundings' colour is not lost."""


@dataclass(frozen=True)
class EmbeddedMasks:
    """The object stage without networks."""

    crop_px: int = 176
    """Longest side at which a crop is segmented."""
    margins: tuple[float, ...] = (0.2, 0.4)
    """Surroundings shown to GrabCut, as shares of the box, one start each."""
    iterations: int = 3
    workers: int = 2

    def segment(self, inputs: Inputs, progress: Progress) -> tuple[DetectedObject, ...]:
        """One object per instance the user masked and per box no mask belongs to, in the order given.

        Returns:
            Objects with ids such as "night_stand_2", unique mask ids from 1, and masks of the photo's size that are
            never empty.
        """
        return outlined(inputs, self._segment_boxes, progress)

    def _segment_boxes(self, rgb: UInt8[np.ndarray, "h w 3"], boxes: list[LabelledBox], progress: Progress) -> Outlined:
        results = []
        with ThreadPoolExecutor(self.workers) as pool:
            jobs = [pool.submit(self.inside_box, rgb, box.box) for box in boxes]
            try:
                for done, job in enumerate(jobs):
                    progress.report(done / len(jobs), f"Outlining objects ({done + 1} of {len(jobs)})")
                    results.append(job.result())
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise
        return results

    def inside_box(self, rgb: UInt8[np.ndarray, "h w 3"], box: Box) -> tuple[Bool[np.ndarray, "h w"], float]:
        """The object inside a box, and how far the starts agree about it (0 to 1).

        Where nothing can be told apart, the mask is the box and the confidence low.
        """
        crops = [_Crop.around(rgb.shape[:2], box, margin, self.crop_px) for margin in self.margins]
        wide = crops[-1]
        starts = [(crop, crop.rectangle()) for crop in crops] + [(crops[0], None)]
        votes = [wide.carried(crop, self._grabcut(crop.of(rgb), crop, start)) for crop, start in starts]
        retained = [vote for vote in votes if vote.sum() >= _MIN_SHARE * wide.inner().sum()]
        if not retained:
            return filled_box(rgb.shape[:2], box), LOST_CONFIDENCE
        agreed = np.mean(retained, axis=0) >= 0.5
        mask = wide.to_photo(agreed, box)
        if mask.sum() < _MIN_SHARE * filled_box(rgb.shape[:2], box).sum():
            return filled_box(rgb.shape[:2], box), LOST_CONFIDENCE
        agreement = float(np.mean([_iou(vote, agreed) for vote in votes]))
        return mask, float(np.clip(agreement, LOST_CONFIDENCE, _MAX_CONFIDENCE))

    def _grabcut(
        self, picture: UInt8[np.ndarray, "ch cw 3"], crop: _Crop, rectangle: tuple[int, int, int, int] | None
    ) -> Bool[np.ndarray, "ch cw"]:
        """One start: everything in the rectangle may be object, or, without one, an oval inside the box probably is."""
        labels = np.full(picture.shape[:2], cv2.GC_BGD, np.uint8)
        inner = crop.inner()
        labels[inner] = cv2.GC_PR_FGD if rectangle is not None else cv2.GC_PR_BGD
        if rectangle is None:
            labels[crop.oval(0.45)] = cv2.GC_PR_FGD
            labels[crop.oval(_CORE)] = cv2.GC_FGD
        hopeful = (labels == cv2.GC_PR_FGD) | (labels == cv2.GC_FGD)
        if min(hopeful.sum(), (~hopeful).sum()) < 16:
            return inner
        models = np.zeros((2, 1, 65))
        cv2.setRNGSeed(_SEED)
        try:
            cv2.grabCut(picture, labels, None, models[0], models[1], self.iterations, cv2.GC_INIT_WITH_MASK)
        except cv2.error:  # too few different colours to tell object and background apart
            return inner
        return (labels == cv2.GC_FGD) | (labels == cv2.GC_PR_FGD)


Outlined = list[tuple[Bool[np.ndarray, "h w"], float]]
"""A mask and its confidence for every box."""


def outlined(
    inputs: Inputs,
    segment_boxes: Callable[[UInt8[np.ndarray, "h w 3"], list[LabelledBox], Progress], Outlined],
    progress: Progress,
) -> tuple[DetectedObject, ...]:
    """Objects from the user's own masks, and from boxes that no mask belongs to, outlined by `segment_boxes`."""
    given = _given(inputs)
    taken = {box for _, box, _ in given}
    boxed = [box for box in inputs.boxes if box not in taken]
    segmented = segment_boxes(inputs.photo.rgb, boxed, progress)
    first_free = max((mask_id for mask_id, _, _ in given), default=0) + 1
    found = [(i, box, mask, 1.0) for i, box, mask in given]
    found += [
        (first_free + n, box, mask, confidence)
        for n, (box, (mask, confidence)) in enumerate(zip(boxed, segmented, strict=True))
    ]
    ids = _ids([box.category for _, box, _, _ in found])
    progress.report(1.0, "Objects outlined")
    return tuple(
        DetectedObject(name, box.category, box.label, box.box, mask, mask_id, confidence)
        for name, (mask_id, box, mask, confidence) in zip(ids, found, strict=True)
    )


@dataclass(frozen=True)
class _Crop:
    """A box with its surroundings at reduced size; the box may touch the photo's border."""

    x: int
    y: int
    width: int
    height: int
    """Of the crop, in photo pixels."""
    scale: float
    """Crop pixels per photo pixel."""
    box: Box
    photo_shape: tuple[int, int]

    @classmethod
    def around(cls, photo_shape: tuple[int, ...], box: Box, margin: float, longest_px: int) -> _Crop:
        height, width = photo_shape[:2]
        x1, y1, x2, y2 = box
        dx, dy = margin * (x2 - x1) + 2, margin * (y2 - y1) + 2
        left, top = int(max(0, np.floor(x1 - dx))), int(max(0, np.floor(y1 - dy)))
        right, bottom = int(min(width, np.ceil(x2 + dx))), int(min(height, np.ceil(y2 + dy)))
        left, top = min(left, width - 1), min(top, height - 1)
        right, bottom = max(right, left + 1), max(bottom, top + 1)
        scale = min(1.0, longest_px / max(right - left, bottom - top))
        return cls(left, top, right - left, bottom - top, scale, box, (height, width))

    @property
    def size(self) -> tuple[int, int]:
        """Columns and rows of the reduced crop."""
        return max(1, round(self.width * self.scale)), max(1, round(self.height * self.scale))

    def of(self, rgb: UInt8[np.ndarray, "h w 3"]) -> UInt8[np.ndarray, "ch cw 3"]:
        part = np.ascontiguousarray(rgb[self.y : self.y + self.height, self.x : self.x + self.width])
        return cv2.resize(part, self.size, interpolation=cv2.INTER_AREA) if self.scale < 1 else part

    def rectangle(self) -> tuple[int, int, int, int]:
        """The box inside the crop, in crop pixels (x1, y1, x2, y2), at least one pixel large."""
        columns, rows = self.size
        x1 = min(max(round((self.box[0] - self.x) * columns / self.width), 0), columns - 1)
        y1 = min(max(round((self.box[1] - self.y) * rows / self.height), 0), rows - 1)
        x2 = min(max(round((self.box[2] - self.x) * columns / self.width), x1 + 1), columns)
        y2 = min(max(round((self.box[3] - self.y) * rows / self.height), y1 + 1), rows)
        return x1, y1, x2, y2

    def inner(self) -> Bool[np.ndarray, "ch cw"]:
        columns, rows = self.size
        mask = np.zeros((rows, columns), dtype=bool)
        x1, y1, x2, y2 = self.rectangle()
        mask[y1:y2, x1:x2] = True
        return mask

    def oval(self, reach: float) -> Bool[np.ndarray, "ch cw"]:
        """An ellipse in the middle of the box; `reach` 0.5 touches its sides."""
        columns, rows = self.size
        x1, y1, x2, y2 = self.rectangle()
        u = (np.arange(columns) + 0.5 - (x1 + x2) / 2) / (reach * (x2 - x1))
        v = (np.arange(rows) + 0.5 - (y1 + y2) / 2) / (reach * (y2 - y1))
        return u[None, :] ** 2 + v[:, None] ** 2 <= 1

    def carried(self, other: _Crop, mask: Bool[np.ndarray, "oh ow"]) -> Bool[np.ndarray, "ch cw"]:
        """Another crop's mask on this crop's grid, restricted to the box."""
        columns, rows = self.size
        x = self.x + (np.arange(columns) + 0.5) * self.width / columns
        y = self.y + (np.arange(rows) + 0.5) * self.height / rows
        i = np.floor((y - other.y) * mask.shape[0] / other.height).astype(int)
        j = np.floor((x - other.x) * mask.shape[1] / other.width).astype(int)
        known = ((i >= 0) & (i < mask.shape[0]))[:, None] & ((j >= 0) & (j < mask.shape[1]))[None]
        there = mask[np.clip(i, 0, mask.shape[0] - 1)[:, None], np.clip(j, 0, mask.shape[1] - 1)[None]]
        return known & there & self.inner()

    def to_photo(self, mask: Bool[np.ndarray, "ch cw"], box: Box) -> Bool[np.ndarray, "h w"]:
        """The crop's mask enlarged smoothly into the photo, inside the box."""
        photo = np.zeros(self.photo_shape, dtype=bool)
        large = cv2.resize(mask.astype(np.float32), (self.width, self.height), interpolation=cv2.INTER_LINEAR) >= 0.5
        photo[self.y : self.y + self.height, self.x : self.x + self.width] = large
        return photo & filled_box(self.photo_shape, box)


def _given(inputs: Inputs) -> list[tuple[int, LabelledBox, Bool[np.ndarray, "h w"]]]:
    """The user's instances that cover at least one pixel."""
    if inputs.instances is None:
        return []
    named = [(mask_id, box, inputs.instances == mask_id) for mask_id, box in inputs.instance_boxes]
    return [(mask_id, box, mask) for mask_id, box, mask in named if mask.any()]


def filled_box(shape: tuple[int, ...], box: Box) -> Bool[np.ndarray, "h w"]:
    """The box as a mask, at least one pixel large."""
    height, width = shape[:2]
    x1, y1 = min(max(int(np.floor(box[0])), 0), width - 1), min(max(int(np.floor(box[1])), 0), height - 1)
    x2, y2 = max(x1 + 1, int(np.ceil(box[2]))), max(y1 + 1, int(np.ceil(box[3])))
    mask = np.zeros((height, width), dtype=bool)
    mask[y1:y2, x1:x2] = True
    return mask


def _iou(a: np.ndarray, b: np.ndarray) -> float:
    union = float((a | b).sum())
    return float((a & b).sum()) / union if union else 0.0


def _ids(categories: list[str]) -> list[str]:
    """Snake-case names numbered within their category: chair_1, chair_2, night_stand_1."""
    seen: Counter[str] = Counter()
    names = []
    for category in categories:
        seen[category] += 1
        names.append(f"{category.replace(' ', '_')}_{seen[category]}")
    return names
