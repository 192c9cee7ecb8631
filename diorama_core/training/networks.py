"""The networks that are trained: the proposing one (boxes of whatever stands in a room, with a first idea of what it
is), the naming one (what stands in a box, from its pixels, a margin around it and where in the picture it is) and the
outlining one (which pixels in and around a box are the object's).

A small fully convolutional detector without anchors (FCOS, Tian et al. 2019) whose score learns the overlap of its own
box (VarifocalNet, Zhang et al. 2021). Trained from scratch; input 0 to 1 RGB of any size that 32 divides.

Beside the kind it tells the form: which top and base, whether with arms, how many doors and drawers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float, Float32, Int
from torch import Tensor, nn
from torch.nn import functional

from diorama_core.library.form import MEASURED, VALUES
from diorama_core.models.recogniser import STRIDES, places


def convolution(inputs: int, outputs: int, kernel: int = 3, stride: int = 1) -> nn.Sequential:
    """A convolution, batch normalisation and SiLU; the size stays, or shrinks by the stride.

    Args:
        inputs: channels.
        outputs: channels.
        kernel: its side.
        stride: of the kernel.
    """
    return nn.Sequential(
        nn.Conv2d(inputs, outputs, kernel, stride, kernel // 2, bias=False), nn.BatchNorm2d(outputs), nn.SiLU()
    )


class Residual(nn.Module):
    """Two convolutions through half the channels, added to the input.

    Args:
        channels: of input and output.
        dilation: cells between those that the second convolution joins.
    """

    def __init__(self, channels: int, dilation: int = 1) -> None:
        super().__init__()
        wide = convolution(channels // 2, channels)
        if dilation > 1:
            wide[0] = nn.Conv2d(channels // 2, channels, 3, padding=dilation, dilation=dilation, bias=False)
        self.inner = nn.Sequential(convolution(channels, channels // 2, 1), wide)

    def forward(self, x: Float[Tensor, "b c h w"]) -> Float[Tensor, "b c h w"]:
        """The sum."""
        out: Tensor = x + self.inner(x)
        return out


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


def assign(boxes: Float32[np.ndarray, "k 4"], width: int, height: int) -> Int[np.ndarray, "n"]:
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
    boxes = decode(rows[..., 1:5], centres, strides)[positive]
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


def decode(
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


FORM_WEIGHT = 0.15
"""Weight of one attribute of form beside the kind."""


class Namer(nn.Module):
    """Input: `box_crop`s `[b, 3, 96, 96]`, 0 to 1, and `box_geometry` `[b, 6]`. Output: logits of kinds and of forms.

    Args:
        kinds: number of categories.
        width: channels of the first stage.
    """

    def __init__(self, kinds: int, width: int = 64) -> None:
        super().__init__()
        w = width
        self.features = nn.Sequential(
            convolution(3, w, 3, 2),
            Residual(w),
            convolution(w, 2 * w, 3, 2),
            Residual(2 * w),
            Residual(2 * w),
            convolution(2 * w, 4 * w, 3, 2),
            Residual(4 * w),
            Residual(4 * w),
            convolution(4 * w, 6 * w, 3, 2),
            Residual(6 * w),
            nn.AdaptiveAvgPool2d(1),
            nn.Flatten(),
        )
        self.geometry = nn.Sequential(nn.Linear(6, 64), nn.SiLU(), nn.Linear(64, 64), nn.SiLU())
        self.joined = nn.Sequential(nn.Dropout(0.2), nn.Linear(6 * w + 64, 256), nn.SiLU())
        self.kind = nn.Linear(256, kinds)
        self.form = nn.Linear(256, sum(len(VALUES[name]) for name in MEASURED))

    def forward(
        self, crops: Float[Tensor, "b 3 s s"], geometry: Float[Tensor, "b 6"]
    ) -> tuple[Float[Tensor, "b k"], Float[Tensor, "b f"]]:
        """Logits of the kinds, and of all values of all attributes of form, those of `MEASURED` one after another."""
        features = torch.cat([self.features(crops - 0.5), self.geometry(geometry)], dim=1)
        joined = self.joined(features)
        return self.kind(joined), self.form(joined)


@dataclass(frozen=True, eq=False)
class NamingLoss:
    """How wrong a batch was named."""

    total: Tensor
    kind: float
    """Share of kinds that are right."""
    form: float
    """Share of attributes that are right, of those that things have."""


def naming_loss(
    logits: tuple[Float[Tensor, "b k"], Float[Tensor, "b f"]],
    kinds: Int[Tensor, "b"],
    forms: Int[Tensor, "b 7"],
    form_weights: Sequence[Float[Tensor, "_"]],
) -> NamingLoss:
    """Cross entropy of the kind and of every attribute of form.

    Args:
        logits: of the network.
        kinds: what is right.
        forms: what is right; -1 where an attribute is not asked.
        form_weights: of the values of each attribute.
    """
    of_kind, sizes = logits[0].float(), [len(VALUES[name]) for name in MEASURED]
    total = functional.cross_entropy(of_kind, kinds, label_smoothing=0.05)
    right, asked = 0.0, 0
    for k, values in enumerate(torch.split(logits[1].float(), sizes, dim=1)):
        has = forms[:, k] >= 0
        if has.any():
            total = total + FORM_WEIGHT * functional.cross_entropy(
                values[has], forms[has, k], form_weights[k], label_smoothing=0.05
            )
            right, asked = right + float((values[has].argmax(dim=1) == forms[has, k]).sum()), asked + int(has.sum())
    return NamingLoss(total, float((of_kind.argmax(dim=1) == kinds).float().mean()), right / max(asked, 1))


class OutlineNetwork(nn.Module):
    """Input: windows `[b, 4, s, s]` of `models.outliner`. Output: logits of the object's pixels `[b, s, s]`.

    An encoder of four levels and a decoder that joins them again, each twice as fine (Ronneberger et al. 2015).

    Args:
        width: channels of the finest level; `s` is a multiple of 16.
    """

    def __init__(self, width: int = 32) -> None:
        super().__init__()
        w = width
        self.fine = nn.Sequential(convolution(4, w, 5, 2), Residual(w))
        self.middle = nn.Sequential(convolution(w, 2 * w, 3, 2), Residual(2 * w), Residual(2 * w))
        self.coarse = nn.Sequential(convolution(2 * w, 3 * w, 3, 2), Residual(3 * w), Residual(3 * w))
        self.whole = nn.Sequential(convolution(3 * w, 4 * w, 3, 2), *(Residual(4 * w) for _ in range(3)))
        self.to_coarse = nn.Sequential(convolution(7 * w, 3 * w, 1), Residual(3 * w))
        self.to_middle = nn.Sequential(convolution(5 * w, 2 * w, 1), Residual(2 * w))
        self.to_fine = nn.Sequential(convolution(3 * w, w, 1), Residual(w), Residual(w))
        self.out = nn.Sequential(nn.Conv2d(w, 4, 3, padding=1), nn.PixelShuffle(2))

    def forward(self, windows: Float[Tensor, "b 4 s s"]) -> Float[Tensor, "b s s"]:
        """Logits."""
        fine = self.fine(windows - 0.5)
        middle = self.middle(fine)
        coarse = self.coarse(middle)
        features = self.whole(coarse)
        for skip, join in ((coarse, self.to_coarse), (middle, self.to_middle), (fine, self.to_fine)):
            enlarged = functional.interpolate(features, scale_factor=2.0, mode="nearest")
            features = join(torch.cat([enlarged, skip], dim=1))
        logits: Tensor = self.out(features)[:, 0]
        return logits


def outline_loss(logits: Float[Tensor, "b s s"], target: Float[Tensor, "b s s"]) -> Tensor:
    """Cross-entropy of the pixels, and one minus the soft Dice score of every object."""
    share = torch.sigmoid(logits)
    both = (share * target).sum(dim=(1, 2))
    dice = (2 * both + 1) / (share.sum(dim=(1, 2)) + target.sum(dim=(1, 2)) + 1)
    return functional.binary_cross_entropy_with_logits(logits, target) + (1 - dice).mean()
