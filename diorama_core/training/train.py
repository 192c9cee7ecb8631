"""Training loops: a batch for every step from the step's own seed, so that a run goes on where it stopped."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np
import torch
from jaxtyping import Float32, UInt8
from torch import Tensor, nn
from torch.utils.data import DataLoader, Dataset

from diorama_core.models.images import box_crop, box_geometry
from diorama_core.models.recogniser import places
from diorama_core.progress import Progress
from diorama_core.training.augment import MOSAIC_SHARE, photograph, training_picture
from diorama_core.training.networks import (
    Detector,
    Namer,
    OutlineNetwork,
    assign,
    detector_loss,
    naming_loss,
    outline_loss,
)
from diorama_core.training.pictures import BoxStatistics, LabelledPicture, PictureFiles
from diorama_core.training.shape_views import ShapeViewFiles, crop_before
from diorama_core.training.surfaces import SurfaceFiles, SurfaceHead, surface_loss
from diorama_core.training.windows import WindowFiles

SIZE = (320, 256)
"""Width and height of the detector's training pictures; 32 divides both."""
AHEAD = 3
"""Batches that each worker prepares while others are learnt from."""


@runtime_checkable
class Pictures(Protocol):
    """What pictures are drawn from."""

    def draw(self, rng: np.random.Generator) -> LabelledPicture:
        """A picture of chance."""
        ...


@dataclass(frozen=True)
class Schedule:
    """How long and how fast to learn."""

    steps: int
    batch: int
    rate: float = 2e-3
    decay_share: float = 0.5
    """Share of the steps, at the end, over which the rate falls to zero."""
    seed: int = 15
    save_every: int = 200

    def lasting(self, steps: int | None) -> Schedule:
        """This schedule over another number of steps; None leaves it."""
        return self if steps is None else replace(self, steps=steps)

    def rate_at(self, step: int) -> float:
        """Learning rate: a short rise, a plateau, and a linear fall to zero."""
        rise = min(1.0, (step + 1) / 200)
        fall = min(1.0, (self.steps - step) / max(1.0, self.decay_share * self.steps))
        return self.rate * rise * max(fall, 0.0)


@dataclass(frozen=True)
class TrainingRun:
    """The length and the place of one network's training."""

    schedule: Schedule
    checkpoint: Path
    """File where the state is saved, and read from where it exists."""
    device: str = "cpu"
    """Where it learns: "cpu" or "cuda"."""
    workers: int = 1
    """Processes that prepare batches; the result does not depend on them."""


@dataclass(frozen=True)
class Batches(Dataset[tuple[Tensor, ...]]):
    """The batch of every step, made from the step's own generator."""

    batch_of: Callable[[np.random.Generator], tuple[Tensor, ...]]
    seed: int

    def __getitem__(self, step: int) -> tuple[Tensor, ...]:
        return self.batch_of(np.random.default_rng((self.seed, step)))


@dataclass
class Trainer:
    """One network, its optimiser and its averaged weights.

    Args:
        network: what learns.
        loss: of a batch, and words about its terms; it finds both on the device.
        batch_of: makes the batch of a step from that step's generator.
        how: how long, and where.
    """

    network: nn.Module
    loss: Callable[[nn.Module, tuple[Tensor, ...]], tuple[Tensor, str]]
    batch_of: Callable[[np.random.Generator], tuple[Tensor, ...]]
    how: TrainingRun
    averaged: nn.Module = field(init=False)
    step: int = field(init=False, default=0)

    def __post_init__(self) -> None:
        self.network.to(self.how.device)
        for value in self.network.parameters():
            if value.dim() == 4:  # convolutions are faster with the channels last
                value.data = value.data.contiguous(memory_format=torch.channels_last)
        self.averaged = copy.deepcopy(self.network).eval()
        self._optimiser = torch.optim.AdamW(self.network.parameters(), lr=self.how.schedule.rate, weight_decay=0.02)
        if self.how.checkpoint.exists():
            saved = torch.load(self.how.checkpoint, map_location=self.how.device, weights_only=True)
            self.network.load_state_dict(saved["network"])
            self.averaged.load_state_dict(saved["averaged"])
            self._optimiser.load_state_dict(saved["optimiser"])
            self.step = int(saved["step"])

    def run(self, progress: Progress) -> nn.Module:
        """Learn until the schedule's end; returns the averaged network.

        Raises:
            Cancelled: on request; the next run goes on from the last checkpoint.
        """
        for batch in self._batches():
            words = self._learn(tuple(part.to(self.how.device, non_blocking=True) for part in batch))
            self.step += 1
            if self.step % 20 == 0:
                progress.report(self.step / self.how.schedule.steps, f"step {self.step}: {words}")
            if self.step % self.how.schedule.save_every == 0 or self.step == self.how.schedule.steps:
                self._save()
        return self.averaged

    def _batches(self) -> Iterable[tuple[Tensor, ...]]:
        return DataLoader(
            Batches(self.batch_of, self.how.schedule.seed),
            batch_size=None,
            sampler=range(self.step, self.how.schedule.steps),
            num_workers=self.how.workers,
            prefetch_factor=AHEAD,
            multiprocessing_context="fork",  # what makes batches is not copied
            pin_memory=self.how.device == "cuda",
        )

    def _learn(self, batch: tuple[Tensor, ...]) -> str:
        self.network.train()
        torch.manual_seed(self.how.schedule.seed + self.step)  # dropout goes on as if the run had not stopped
        for group in self._optimiser.param_groups:
            group["lr"] = self.how.schedule.rate_at(self.step)
        with torch.autocast(self.how.device, torch.bfloat16):
            total, words = self.loss(self.network, batch)
        self._optimiser.zero_grad(set_to_none=True)
        total.backward()  # type: ignore[no-untyped-call]  # torch annotates its result only
        nn.utils.clip_grad_norm_(self.network.parameters(), 10.0)
        self._optimiser.step()
        self._average()
        return words

    @torch.no_grad()
    def _average(self) -> None:
        share = min(0.998, (self.step + 1) / (self.step + 10))
        state = self.network.state_dict()
        for name, value in self.averaged.state_dict().items():
            if value.dtype.is_floating_point:
                value.lerp_(state[name], 1 - share)
            else:
                value.copy_(state[name])

    def _save(self) -> None:
        part = self.how.checkpoint.with_suffix(".part")
        state: dict[str, Any] = {
            "network": self.network.state_dict(),
            "averaged": self.averaged.state_dict(),
            "optimiser": self._optimiser.state_dict(),
            "step": self.step,
        }
        torch.save(state, part)
        part.replace(self.how.checkpoint)


def detector_trainer(files: PictureFiles, kinds: int, how: TrainingRun) -> Trainer:
    """Everything needed to train the detector.

    Args:
        files: pictures to learn from.
        kinds: number of categories.
        how: how long, and where.
    """
    torch.manual_seed(how.schedule.seed)
    centres, strides = (torch.from_numpy(a).to(how.device) for a in places(*SIZE))

    def loss(network: nn.Module, batch: tuple[Tensor, ...]) -> tuple[Tensor, str]:
        losses = detector_loss(network(batch[0]), batch[1], batch[2], centres, strides)
        return losses.total, f"score {losses.score:.3f}, box {losses.box:.3f}, kind {losses.kind:.3f}"

    return Trainer(Detector(kinds), loss, partial(detector_batch, files, how.schedule.batch), how)


def detector_batch(files: Pictures, count: int, rng: np.random.Generator) -> tuple[Tensor, Tensor, Tensor]:
    """Pictures, and for every place its box and category (-1 for none)."""
    pixels, boxes, kinds = [], [], []
    for _ in range(count):
        number = 4 if rng.random() < MOSAIC_SHARE else 1
        picture = training_picture([files.draw(rng) for _ in range(number)], SIZE, rng)
        owner = assign(picture.boxes, *SIZE)
        some = len(picture.boxes) > 0
        pixels.append(picture.rgb)
        boxes.append(picture.boxes[owner] if some else np.zeros((len(owner), 4), np.float32))
        kinds.append(np.where(owner >= 0, picture.categories[owner] if some else 0, -1))
    return _pictures_tensor(pixels), torch.from_numpy(np.stack(boxes)), torch.from_numpy(np.stack(kinds))


def namer_trainer(files: PictureFiles, shapes: ShapeViewFiles, kinds: int, how: TrainingRun) -> Trainer:
    """Everything needed to train the namer.

    Args:
        files: rendered rooms.
        shapes: rendered shapes.
        kinds: number of categories.
        how: how long, and where.
    """
    torch.manual_seed(how.schedule.seed + 1)
    statistics, of_forms = BoxStatistics.of(files, kinds), shapes.form_statistics(kinds)
    asked, weights = torch.from_numpy(of_forms.asked), [torch.from_numpy(w).to(how.device) for w in of_forms.weights]

    def batch_of(rng: np.random.Generator) -> tuple[Tensor, ...]:
        crops, geometry, right, forms = namer_batch(files, shapes, statistics, how.schedule.batch, rng)
        return crops, geometry, right, torch.where(asked[right], forms, -1)

    def loss(network: nn.Module, batch: tuple[Tensor, ...]) -> tuple[Tensor, str]:
        losses = naming_loss(network(batch[0], batch[1]), batch[2], batch[3], weights)
        return losses.total, f"loss {losses.total.detach():.3f}, kind right {losses.kind:.2f}, form {losses.form:.2f}"

    return Trainer(Namer(kinds), loss, batch_of, how)


def namer_batch(
    files: PictureFiles, shapes: ShapeViewFiles, statistics: BoxStatistics, count: int, rng: np.random.Generator
) -> tuple[Tensor, Tensor, Tensor, Tensor]:
    """Crops of boxes drawn a little wrong, half of rooms and half of single shapes; geometry, kinds and forms.

    Args:
        files: what is learnt from.
        shapes: views of single shapes.
        statistics: how boxes are off.
        count: of crops.
        rng: chance, seeded.
    """
    drawn: list[tuple[np.ndarray, np.ndarray, int, np.ndarray]] = []
    counts = statistics.counts
    weight = 1.0 / np.sqrt(np.maximum(counts, counts[counts > 0].min()))
    while len(drawn) < count // 2:
        picture = files.draw(rng)
        if not len(picture.boxes):
            continue
        p = weight[picture.categories]
        for k in rng.choice(len(p), size=min(4, len(p), count // 2 - len(drawn)), replace=False, p=p / p.sum()):
            crop, where = _crop(picture, int(k), rng)
            drawn.append((crop, where, int(picture.categories[k]), picture.forms[k]))
    while len(drawn) < count:
        background = files.draw(rng).rgb
        for _ in range(min(4, count - len(drawn))):
            crop, sides, views = crop_before(background, shapes, rng)
            where = statistics.draw(views.category, sides, rng)
            drawn.append((*_as_photographed(crop, where, rng), views.category, views.form))
    crops, geometry, kinds, forms = zip(*drawn, strict=True)
    return (
        _pictures_tensor(crops),
        torch.from_numpy(np.stack(geometry)),
        torch.tensor(kinds),
        torch.from_numpy(np.stack(forms).astype(np.int64)),
    )


def outliner_trainer(files: WindowFiles, how: TrainingRun) -> Trainer:
    """Everything needed to train the outliner."""
    torch.manual_seed(how.schedule.seed + 2)

    def loss(network: nn.Module, batch: tuple[Tensor, ...]) -> tuple[Tensor, str]:
        value = outline_loss(network(batch[0]), batch[1])
        return value, f"loss {float(value.detach()):.3f}"

    return Trainer(OutlineNetwork(), loss, partial(files.batch, how.schedule.batch), how)


def _crop(picture: LabelledPicture, k: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    h, w = picture.rgb.shape[:2]
    box = picture.boxes[k].copy()
    size = np.maximum(box[2:] - box[:2], 2.0)
    box += np.tile(size, 2) * rng.normal(0.0, 0.05, 4).astype(np.float32)
    box = np.array([*np.minimum(box[:2], box[2:] - 1), *np.maximum(box[2:], box[:2] + 1)], np.float32)
    crop, where = box_crop(picture.rgb, box), box_geometry(box, w, h)
    return _as_photographed(crop, where, rng)


def _as_photographed(
    crop: UInt8[np.ndarray, "s s 3"], where: Float32[np.ndarray, "6"], rng: np.random.Generator
) -> tuple[UInt8[np.ndarray, "s s 3"], Float32[np.ndarray, "6"]]:
    """Either way round, in other light, the place a little wrong."""
    where = where.copy()
    if rng.random() < 0.5:
        crop, where[0] = np.ascontiguousarray(crop[:, ::-1]), -where[0]
    # Photos are framed otherwise: the place in the picture and the size say a little, not all.
    where += rng.normal(0.0, [0.05, 0.05, 0.05, 0.12, 0.12, 0.03]).astype(np.float32)
    return photograph(crop, rng), where


def _pictures_tensor(pictures: Sequence[np.ndarray]) -> Tensor:
    stacked = np.stack(pictures).transpose(0, 3, 1, 2)
    return torch.from_numpy(np.ascontiguousarray(stacked)).float() / 255.0


def surface_trainer(files: SurfaceFiles, how: TrainingRun) -> Trainer:
    """Everything needed to train the head that tells a room's surfaces."""
    torch.manual_seed(how.schedule.seed + 3)

    def loss(network: nn.Module, batch: tuple[Tensor, ...]) -> tuple[Tensor, str]:
        assert isinstance(network, SurfaceHead)
        with torch.autocast(how.device, enabled=False):  # dilated convolutions lose their gradients in bfloat16
            total, right = surface_loss(network.logits(*batch[:-1]), batch[-1])
        return total, f"loss {float(total.detach()):.3f}, surfaces right {right:.3f}"

    return Trainer(SurfaceHead(), loss, partial(files.batch, how.schedule.batch), how)
