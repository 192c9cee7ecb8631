"""The proposing network: boxes of whatever stands in a room, with a first idea of what it is.

A small fully convolutional detector without anchors (FCOS, Tian et al. 2019) whose score learns the overlap of its own
box (VarifocalNet, Zhang et al. 2021). Trained from scratch; input 0 to 1 RGB of any size that 32 divides.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float, Float32, Int
from torch import Tensor, nn
from torch.nn import functional

from diorama_core.models.recogniser import STRIDES, places
from diorama_core.training.layers import Residual, convolution

SIDES_PX = ((0.0, 72.0), (48.0, 144.0), (104.0, 1e9))
"""Lengths of the larger side of the boxes that each level answers for; neighbours overlap."""
CENTRE = 1.5
"""Cells from a box's centre within which a place answers for it."""


class Detector(nn.Module):
    """Input: pictures `[b, 3, h, w]`. Output: a row for every place: score, distances to the four sides, kinds.

    Args:
        kinds: number of categories.
        width: channels of the first stage.
    """

    def __init__(self, kinds: int, width: int = 48) -> None:
        super().__init__()
        w = width
        self.stem = nn.Sequential(convolution(3, w // 2, 3, 2), convolution(w // 2, w, 3, 2), Residual(w))
        self.stages = nn.ModuleList(
            (
                nn.Sequential(convolution(w, 2 * w, 3, 2), Residual(2 * w), Residual(2 * w)),
                nn.Sequential(convolution(2 * w, 4 * w, 3, 2), Residual(4 * w), Residual(4 * w), Residual(4 * w)),
                nn.Sequential(convolution(4 * w, 6 * w, 3, 2), Residual(6 * w), Residual(6 * w), Residual(6 * w)),
            )
        )
        self.lateral = nn.ModuleList(convolution(n * w, 2 * w, 1) for n in (2, 4, 6))
        self.smooth = nn.ModuleList(convolution(2 * w, 2 * w) for _ in STRIDES)
        self.box_tower = nn.Sequential(convolution(2 * w, 2 * w), convolution(2 * w, 2 * w))
        self.kind_tower = nn.Sequential(convolution(2 * w, 2 * w), convolution(2 * w, 2 * w))
        self.box = nn.Conv2d(2 * w, 5, 3, padding=1)
        self.kind = nn.Conv2d(2 * w, kinds, 1)
        assert self.box.bias is not None
        nn.init.constant_(self.box.bias[:1], -4.0)  # few places hold anything
        nn.init.constant_(self.box.bias[1:], 0.7)

    def forward(self, pictures: Float[Tensor, "b 3 h w"]) -> Float[Tensor, "b n c"]:
        """Rows of all levels, finest first, row by row of the grid."""
        x, levels = self.stem(pictures - 0.5), []
        for stage in self.stages:
            x = stage(x)
            levels.append(x)
        joined = [lateral(level) for lateral, level in zip(self.lateral, levels, strict=True)]
        for k in (1, 0):
            joined[k] = joined[k] + functional.interpolate(joined[k + 1], scale_factor=2.0, mode="nearest")
        rows = []
        for smooth, level in zip(self.smooth, joined, strict=True):
            y = smooth(level)
            both = torch.cat([self.box(self.box_tower(y)), self.kind(self.kind_tower(y))], dim=1)
            rows.append(both.flatten(2).transpose(1, 2))
        return torch.cat(rows, dim=1)


def assigned(boxes: Float32[np.ndarray, "k 4"], width: int, height: int) -> Int[np.ndarray, "n"]:
    """For every place the box that it answers for (the smallest of several), or -1."""
    centres, strides = places(width, height)
    if not len(boxes):
        return np.full(len(centres), -1)
    middle, longest = (boxes[:, :2] + boxes[:, 2:]) / 2, (boxes[:, 2:] - boxes[:, :2]).max(axis=1)
    inside = ((centres[:, None] > boxes[:, :2]) & (centres[:, None] < boxes[:, 2:])).all(axis=2)
    near = (np.abs(centres[:, None] - middle) < CENTRE * strides[:, None, None]).all(axis=2)
    low, high = (np.array([dict(zip(STRIDES, SIDES_PX, strict=True))[int(s)][k] for s in STRIDES]) for k in (0, 1))
    level = np.searchsorted(STRIDES, strides)
    fits = (longest >= low[level][:, None]) & (longest < high[level][:, None])
    area = np.where(inside & near & fits, np.prod(boxes[:, 2:] - boxes[:, :2], axis=1), np.inf)
    return np.where(np.isfinite(area.min(axis=1)), area.argmin(axis=1), -1)


@dataclass(frozen=True)
class DetectorLoss:
    """Terms of one batch's loss."""

    score: Tensor
    box: Tensor
    kind: Tensor

    @property
    def total(self) -> Tensor:
        """What is made small."""
        return self.score + 2.0 * self.box + 0.5 * self.kind


def detector_loss(
    rows: Float[Tensor, "b n c"],
    target_boxes: Float[Tensor, "b n 4"],
    target_kinds: Int[Tensor, "b n"],
    centres: Float[Tensor, "n 2"],
    strides: Float[Tensor, "n"],
) -> DetectorLoss:
    """Loss of a batch.

    Args:
        rows: the network's output.
        target_boxes: for every place the box it answers for, pixels; anything where there is none.
        target_kinds: category of that box, the one after the last where nobody knows it; -1 where there is none.
        centres: of the places, pixels.
        strides: of the places, pixels.
    """
    rows = rows.float()
    positive = target_kinds >= 0
    count = positive.sum().clamp(min=1)
    boxes = decoded(rows[..., 1:5], centres, strides)[positive]
    wanted = target_boxes[positive]
    iou, generalised = _overlaps(boxes, wanted)
    quality = torch.zeros_like(rows[..., 0])
    quality[positive] = iou.detach().clamp(0, 1)
    probability = rows[..., 0].sigmoid()
    weight = torch.where(positive, quality, 0.75 * probability.detach() ** 2)
    score = functional.binary_cross_entropy_with_logits(rows[..., 0], quality, weight, reduction="sum") / count
    kinds = rows[..., 5:][positive]
    kind = functional.cross_entropy(kinds, target_kinds[positive], reduction="sum", ignore_index=kinds.shape[1]) / count
    return DetectorLoss(score, (1 - generalised).sum() / count, kind)


def decoded(
    sides: Float[Tensor, "b n 4"], centres: Float[Tensor, "n 2"], strides: Float[Tensor, "n"]
) -> Float[Tensor, "b n 4"]:
    """Corner boxes in pixels from logarithms of the distances to the four sides, in strides."""
    distance = sides.clamp(max=5.0).exp() * strides[:, None]
    return torch.cat([centres - distance[..., :2], centres + distance[..., 2:]], dim=-1)


def _overlaps(a: Float[Tensor, "k 4"], b: Float[Tensor, "k 4"]) -> tuple[Float[Tensor, "k"], Float[Tensor, "k"]]:
    """Intersection over union, plain and generalised (Rezatofighi et al. 2019)."""
    low, high = torch.maximum(a[:, :2], b[:, :2]), torch.minimum(a[:, 2:], b[:, 2:])
    shared = (high - low).clamp(min=0).prod(dim=1)
    union = (a[:, 2:] - a[:, :2]).prod(dim=1) + (b[:, 2:] - b[:, :2]).prod(dim=1) - shared
    hull = (torch.maximum(a[:, 2:], b[:, 2:]) - torch.minimum(a[:, :2], b[:, :2])).prod(dim=1)
    iou = shared / union.clamp(min=1e-6)
    return iou, iou - (hull - union) / hull.clamp(min=1e-6)
