"""The detector that learnt from rendered rooms adapted to photos: a few steps on annotated photos, then halfway back.

Weights halfway between those before and after keep what was learnt from rooms (Wortsman et al., Robust fine-tuning of
zero-shot models, CVPR 2022).
"""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import onnx
import torch
from onnx import numpy_helper
from torch import nn

from diorama_core.evaluation.adapters.photo_annotations import picture_of, read_annotations
from diorama_core.evaluation.benchmarks.recognition import read_annotated_photo
from diorama_core.library.form import MEASURED
from diorama_core.models.recogniser import places
from diorama_core.progress import SILENT, Progress
from diorama_core.training.export import export_detector
from diorama_core.training.networks import Detector, detector_loss
from diorama_core.training.pictures import LabelledPicture, PictureFiles
from diorama_core.training.train import SIZE, Schedule, detector_batch

LONGEST_PX = 1000
"""Longest side of the photos that are learnt from."""


SCHEDULE = Schedule(steps=300, batch=8, rate=3e-4, seed=100)


@dataclass(frozen=True)
class Adaptation:
    """How far the detector is adapted; chosen on photos held back."""

    schedule: Schedule = SCHEDULE
    of_photos: float = 0.7
    """Share of the pictures that are photos; the others are rendered."""
    kept: float = 0.5
    """Share of the way back to the weights before."""
    rise_steps: int = 30
    average: float = 0.99
    """Share of the averaged weights that a step leaves."""


@dataclass(frozen=True)
class MixedPictures:
    """Annotated photos and rendered rooms, drawn by chance."""

    photos: tuple[LabelledPicture, ...]
    rendered: PictureFiles
    of_photos: float

    def draw(self, rng: np.random.Generator) -> LabelledPicture:
        """A picture of chance."""
        if rng.random() >= self.of_photos:
            return self.rendered.draw(rng)
        return self.photos[int(rng.integers(len(self.photos)))]


def read_photos(annotations: Path, folder: Path, categories: Sequence[str]) -> dict[str, LabelledPicture]:
    """By id the annotated photos that a folder has; the category after the last stands for what has none."""
    index = {name: k for k, name in enumerate(categories)}
    photos = {}
    for name, about in read_annotations(annotations).items():
        path = picture_of(folder, name)
        if path is None:
            continue
        inputs, boxes = read_annotated_photo(path, about)
        rgb = inputs.photo.rgb
        scale = min(1.0, LONGEST_PX / max(rgb.shape[:2]))
        if scale < 1.0:
            rgb = cv2.resize(rgb, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
        kinds = np.array([index.get(o.kind, len(categories)) for o in about.objects], dtype=np.int64)
        unknown = np.full((len(kinds), len(MEASURED)), -1, np.int8)
        photos[name] = LabelledPicture(rgb, (boxes * scale).astype(np.float32), kinds, np.ones_like(kinds), unknown)
    return photos


def adapt_detector(
    graph: Path,
    photos: Sequence[LabelledPicture],
    rendered: PictureFiles,
    kinds: int,
    output: Path,
    how: Adaptation | None = None,
    progress: Progress = SILENT,
) -> None:
    """Write the detector adapted to photos.

    Args:
        graph: the detector before.
        photos: what it is adapted to.
        rendered: rooms, so that it does not forget what no photo shows.
        kinds: number of categories.
        output: where the adapted detector is written.
        how: schedule and shares.
        progress: reports and cancellation.
    """
    how = how or Adaptation()
    before = load_detector(graph, kinds)
    network, pictures = copy.deepcopy(before), MixedPictures(tuple(photos), rendered, how.of_photos)
    averaged, schedule = copy.deepcopy(network), how.schedule
    torch.manual_seed(schedule.seed)
    centres, strides = (torch.from_numpy(a) for a in places(*SIZE))
    optimiser = torch.optim.AdamW(network.parameters(), lr=schedule.rate, weight_decay=0.02)
    for step in range(schedule.steps):
        for group in optimiser.param_groups:
            fall = min(1.0, (schedule.steps - step) / (schedule.decay_share * schedule.steps))
            group["lr"] = schedule.rate * min(1.0, (step + 1) / how.rise_steps) * fall
        rgb, boxes, wanted = detector_batch(pictures, schedule.batch, np.random.default_rng((schedule.seed, step)))
        loss = detector_loss(network(rgb), boxes, wanted, centres, strides)
        optimiser.zero_grad(set_to_none=True)
        loss.total.backward()  # type: ignore[no-untyped-call]  # torch annotates its result only
        nn.utils.clip_grad_norm_(network.parameters(), 10.0)
        optimiser.step()
        _approach(averaged, network, 1.0 - min(how.average, (step + 1) / (step + 10)))
        progress.report((step + 1) / schedule.steps, f"step {step + 1}: loss {float(loss.total.detach()):.3f}")
    _approach(averaged, before, how.kept)
    export_detector(averaged, output)


@torch.no_grad()
def _approach(network: nn.Module, other: nn.Module, share: float) -> None:
    """Move weights a share of the way to another network's."""
    for parameter, target in zip(network.parameters(), other.parameters(), strict=True):
        parameter.lerp_(target, share)


def load_detector(graph: Path, kinds: int) -> nn.Module:
    """The detector with the weights of an exported graph; its normalisations are folded into its convolutions."""
    nodes = onnx.load(str(graph)).graph
    values = {w.name: numpy_helper.to_array(w).astype(np.float32) for w in nodes.initializer}
    for node in nodes.node:
        if node.op_type in ("Cast", "Identity") and node.input[0] in values:
            values[node.output[0]] = values[node.input[0]]
    convolutions = [(values[n.input[1]], values[n.input[2]]) for n in nodes.node if n.op_type == "Conv"]
    network = _without_normalisation(Detector(kinds, width=2 * len(convolutions[0][1]))).eval()
    for part, (kernel, bias) in zip(_convolutions_in_order(network), convolutions, strict=True):
        part.weight.data, part.bias = torch.from_numpy(kernel.copy()), nn.Parameter(torch.from_numpy(bias.copy()))
    return network


def _without_normalisation(network: nn.Module) -> nn.Module:
    """The network with normalisations that change nothing."""
    for name, part in network.named_children():
        if isinstance(part, nn.BatchNorm2d):
            setattr(network, name, nn.Identity())
        else:
            _without_normalisation(part)
    return network


def _convolutions_in_order(network: nn.Module) -> list[nn.Conv2d]:
    """Convolutions as often and in the order in which a picture meets them; shared ones come again."""
    order: list[nn.Conv2d] = []
    parts = [part for part in network.modules() if isinstance(part, nn.Conv2d)]
    hooks = [part.register_forward_hook(lambda part, *_: order.append(part)) for part in parts]
    with torch.no_grad():
        network(torch.zeros(1, 3, 64, 64))
    for hook in hooks:
        hook.remove()
    return order
