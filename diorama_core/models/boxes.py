"""Boxes that networks found, and the suppression of double ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int


@dataclass(frozen=True, eq=False)
class Detections:
    """Boxes in pixels of the picture that was given, best first."""

    boxes: Float[np.ndarray, "n 4"]
    """x1, y1, x2, y2, clipped to the picture."""
    scores: Float[np.ndarray, "n"]
    labels: Int[np.ndarray, "n"]
    """Index of the phrase or class."""

    def __len__(self) -> int:
        return len(self.scores)

    def rows(self, keep: np.ndarray) -> Detections:
        """A selection."""
        return Detections(self.boxes[keep], self.scores[keep], self.labels[keep])


def clip(boxes: Float[np.ndarray, "n 4"], width: int, height: int) -> Float[np.ndarray, "n 4"]:
    """Boxes within the picture."""
    return np.clip(boxes, 0, [width, height, width, height])


def corners(boxes: Float[np.ndarray, "n 4"]) -> Float[np.ndarray, "n 4"]:
    """Corner boxes from middles and sizes."""
    return np.concatenate([boxes[:, :2] - boxes[:, 2:] / 2, boxes[:, :2] + boxes[:, 2:] / 2], axis=1)


def areas(boxes: Float[np.ndarray, "n 4"]) -> Float[np.ndarray, "n"]:
    """In square pixels."""
    return np.maximum(boxes[:, 2] - boxes[:, 0], 0) * np.maximum(boxes[:, 3] - boxes[:, 1], 0)


def intersections(a: Float[np.ndarray, "4"], boxes: Float[np.ndarray, "n 4"]) -> Float[np.ndarray, "n"]:
    """Shared areas of one box with others."""
    low, high = np.maximum(a[:2], boxes[:, :2]), np.minimum(a[2:], boxes[:, 2:])
    return np.prod(np.maximum(high - low, 0), axis=1)


def overlaps(a: Float[np.ndarray, "n 4"], b: Float[np.ndarray, "k 4"]) -> Float[np.ndarray, "n k"]:
    """Intersection over union of every pair."""
    if not len(a) or not len(b):
        return np.zeros((len(a), len(b)))
    shared = np.stack([intersections(row, b) for row in a])
    union = areas(a)[:, None] + areas(b) - shared
    out: Float[np.ndarray, "n k"] = shared / np.maximum(union, 1e-9)
    return out


def without_doubles(detections: Detections, iou: float, *, across_classes: bool) -> Detections:
    """Non-maximum suppression: of boxes that overlap more than `iou`, the best stays.

    Args:
        detections: in any order.
        iou: intersection over union above which two boxes are the same thing.
        across_classes: whether boxes of different classes suppress one another.
    """
    order = np.argsort(-detections.scores, kind="stable")
    ranked = detections.rows(order)
    area = areas(ranked.boxes)
    stays = np.ones(len(order), dtype=bool)
    for i in range(len(order)):
        if not stays[i]:
            continue
        worse = slice(i + 1, None)
        shared = intersections(ranked.boxes[i], ranked.boxes[worse])
        union = area[worse] + area[i] - shared
        same = shared > iou * np.maximum(union, 1e-9)
        if not across_classes:
            same &= ranked.labels[worse] == ranked.labels[i]
        stays[worse] &= ~same
    return ranked.rows(stays)


def join(parts: Sequence[Detections]) -> Detections:
    """All boxes of all parts, one part after another."""
    every = [Detections(np.zeros((0, 4)), np.zeros(0), np.zeros(0, dtype=int)), *parts]
    columns = ([p.boxes for p in every], [p.scores for p in every], [p.labels for p in every])
    return Detections(*map(np.concatenate, columns))


def without_parts_of_same(detections: Detections, share: float) -> Detections:
    """Detections without those within others of their class.

    Where one lies within another by more than `share` of itself, the outer one stays when it is as good, the inner ones
    where the outer one merely lumps several together (paper, supplement A).
    """
    keep = np.ones(len(detections), dtype=bool)
    area = areas(detections.boxes)
    for i in np.argsort(-area, kind="stable"):
        same = keep & (detections.labels == detections.labels[i]) & (area < area[i])
        inside = np.flatnonzero(
            same & (intersections(detections.boxes[i], detections.boxes) > share * np.maximum(area, 1e-9))
        )
        if not len(inside):
            continue
        lumped = len(inside) > 1 and areas(detections.boxes[inside]).sum() > 0.5 * area[i]
        if lumped and detections.scores[inside].mean() > detections.scores[i]:
            keep[i] = False
        else:
            keep[inside] = False
    return detections.rows(np.flatnonzero(keep))
