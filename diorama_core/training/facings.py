"""Weights of the terms that decide which way objects face: fitted to photos in which people annotated fronts.

Every photo's headings have probabilities by sum-product messages (`arrangement.solve`), here in torch for all photos at
once; the weights are those with which what was annotated is likeliest, not far from where they began (L2 of their
logarithms). What a fit is worth is told on photos that it did not see.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Bool
from torch import Tensor

from diorama_core.arrangement.facing.evidence import HEADINGS, STEP_RAD, FacingRoom
from diorama_core.arrangement.facing.solve import DAMPING, PICTURE, ROUNDS, Factors
from diorama_core.arrangement.facing.terms import TERMS
from diorama_core.evaluation.adapters.photo_annotations import AnnotatedPhoto
from diorama_core.evaluation.benchmarks.photo_build import read_annotated_inputs
from diorama_core.evaluation.benchmarks.photos import PhotoPlan
from diorama_core.evaluation.metrics.annotated import FRONT_TOLERANCE_DEG
from diorama_core.library.record import ShapeLibrary
from diorama_core.pipeline.plan import evaluate
from diorama_core.pipeline.runner import Runner
from diorama_core.pipeline.stages import embedded_stages
from diorama_core.pose import RenderAndCompare
from diorama_core.pose.posing_tasks import PosingTask
from diorama_core.pose.room_evidence import TriedShape, likelihood
from diorama_core.progress import Progress
from diorama_core.scene.types import Camera

NAMES = (PICTURE, *(term.name for term in TERMS))
START, TOLD = 0.7, 2.0
"""Nats of every term before it is fitted, and of what is told by a person or by the wall that a thing hangs on, which
is not fitted: it decides more than fronts."""
AS_TOLD = ("as_told", "out_of_wall")
STIFFNESS = 0.01
"""L2 of the logarithms of weights beside the mean log-likelihood; .005 to .1 gave the same on photos not seen."""
SHAPES, POSES = 2, 8
"""Shapes of an object, and poses of each, that are compared finely: more were not chosen."""
STEPS = 15
"""Steps of L-BFGS; the loss hardly changes after them."""
_IMPOSSIBLE = -1e9


@dataclass(frozen=True, eq=False)
class FacingCase:
    """One photo: what was known before fronts were decided, and which headings are right."""

    name: str
    room: FacingRoom
    right: Mapping[int, Bool[np.ndarray, "24"]]
    """By object with an annotated front the headings within the benchmark's tolerance, up to symmetry."""


def gather(asked: PhotoPlan, library: ShapeLibrary, progress: Progress) -> list[FacingCase]:
    """The photos of a plan; caches of stages are those of `bench photos`."""
    cases, wanted = [], ("inputs", "furniture_objects", "geometry", "depth", "shapes")
    for k, task in enumerate(asked.tasks):
        step = progress.part(k / len(asked.tasks), (k + 1) / len(asked.tasks))
        step.report(0.0, task.title)
        case = read_annotated_inputs(task)
        have = evaluate(embedded_stages(case.inputs, library), {"given": case.inputs}, wanted, Runner(task.cache), step)
        stage = RenderAndCompare(library)
        inputs, objects, geometry, depth, shapes = (have[name] for name in wanted)
        trials = stage.trials(inputs, objects, geometry, depth, shapes, step)
        trials = trials.with_shapes([_finely(stage, *one) for one in zip(trials.tasks, trials.tried, strict=True)])
        mask_ids = {o.id: o.mask_id for o in objects}
        cases.append(_case(task.title, trials.room, trials.folds(), mask_ids, case.annotation, geometry.camera))
    return cases


def _finely(stage: RenderAndCompare, task: PosingTask, tried: Sequence[TriedShape]) -> list[TriedShape]:
    """An object's shapes, the likeliest with refined poses: what decides in the end."""
    best = sorted(tried, key=lambda t: -likelihood(task.item.label, t))[:SHAPES]
    return [stage.refine_best(task, t, POSES) if t in best else t for t in tried]


def _case(
    name: str,
    room: FacingRoom,
    folds: Mapping[str, int],
    mask_ids: Mapping[str, int],
    photo: AnnotatedPhoto,
    camera: Camera,
) -> FacingCase:
    """Objects of a room with the fronts that were annotated, by the numbers of their masks."""
    right, forward = camera.T_world_camera[:2, 0], camera.T_world_camera[:2, 2]
    allowed = {}
    for k, item in enumerate(room.objects):
        front = photo.objects[mask_ids[item.object_id] - 1].front
        if front is None or item.object_id not in folds:
            continue
        direction = np.sin(np.deg2rad(front)) * right - np.cos(np.deg2rad(front)) * forward
        period = 2 * np.pi / folds[item.object_id]
        off = item.yaw_rad + STEP_RAD * np.arange(HEADINGS) - np.arctan2(direction[1], direction[0])
        off = np.abs(np.mod(off + period / 2, period) - period / 2)
        allowed[k] = np.rad2deg(off) <= FRONT_TOLERANCE_DEG + 1e-6
    return FacingCase(name, room, allowed)


class FacingModel:
    """All cases as one graph."""

    def __init__(self, cases: Sequence[FacingCase]) -> None:
        factors = [Factors.of(case.room) for case in cases]
        starts = np.cumsum([0, *(len(case.room.objects) for case in cases)])
        self.ones = torch.zeros(int(starts[-1]), len(NAMES), HEADINGS, dtype=torch.float64)
        tables: dict[tuple[int, int], list[tuple[int, np.ndarray]]] = {}
        for start, of_one in zip(starts, factors, strict=False):
            for name, i, values in of_one.ones:
                self.ones[start + i, NAMES.index(name)] += torch.from_numpy(values)
            for name, i, j, values in of_one.pairs:
                for a, b, table in ((i, j, values), (j, i, values.T)):
                    tables.setdefault((int(start + a), int(start + b)), []).append((NAMES.index(name), table))
        edges = list(tables)
        index = {edge: k for k, edge in enumerate(edges)}
        self.first, self.second = torch.tensor(edges, dtype=torch.long).reshape(-1, 2).T
        self.back = torch.tensor([index[b, a] for a, b in edges], dtype=torch.long)
        self.edge = torch.tensor([k for k, e in enumerate(edges) for _ in tables[e]], dtype=torch.long)
        self.term = torch.tensor([n for e in edges for n, _ in tables[e]], dtype=torch.long)
        self.tables = torch.from_numpy(
            np.array([t for e in edges for _, t in tables[e]]).reshape(-1, HEADINGS, HEADINGS)
        )
        asked = [(start + i, mask, case.name) for start, case in zip(starts, cases, strict=False)
                 for i, mask in case.right.items()]  # fmt: skip
        self.objects = torch.tensor([int(i) for i, _, _ in asked])
        self.right = torch.from_numpy(np.array([mask for _, mask, _ in asked]))
        self.photos = np.array([name for _, _, name in asked])
        self.names = [case.name for case in cases]
        kinds = [item.kind for case in cases for item in case.room.objects]
        self.kinds = [kinds[i] for i in self.objects.tolist()]

    def log_probabilities(self, weights: Tensor, largest: bool = False) -> Tensor:
        """Log-probabilities of the asked objects' headings; up to a constant their max-marginals where `largest`."""
        unary = (self.ones * weights[None, :, None]).sum(dim=1)
        terms = self.tables * weights[self.term][:, None, None]
        table = torch.zeros(len(self.first), HEADINGS, HEADINGS, dtype=torch.float64).index_add(0, self.edge, terms)
        messages, incoming = torch.zeros(len(self.first), HEADINGS, dtype=torch.float64), torch.zeros_like(unary)
        for _ in range(ROUNDS):
            joint = table + ((unary + incoming)[self.second] - messages[self.back])[:, None]
            new = joint.amax(dim=2) if largest else torch.logsumexp(joint, dim=2)
            messages = DAMPING * messages + (1 - DAMPING) * (new - new.amax(dim=1, keepdim=True))
            incoming = torch.zeros_like(unary).index_add(0, self.first, messages)
        return torch.log_softmax((unary + incoming)[self.objects], dim=1)

    def fit(self, start: Tensor, seen: Bool[np.ndarray, "n"]) -> Tensor:
        """Weights for the asked objects that are seen; those that begin at 0, and those of `AS_TOLD`, stay."""
        begin = torch.log(start.clamp_min(1e-6))
        logs, free = begin.clone().requires_grad_(True), (start > 0) & (torch.tensor([n not in AS_TOLD for n in NAMES]))
        optimiser = torch.optim.LBFGS([logs], max_iter=STEPS, line_search_fn="strong_wolfe")
        rows = torch.from_numpy(np.flatnonzero(seen))

        def loss() -> Tensor:
            optimiser.zero_grad()
            weights = torch.where(free, torch.exp(logs), start)
            log_probabilities = self.log_probabilities(weights).masked_fill(~self.right, _IMPOSSIBLE)
            value = -torch.logsumexp(log_probabilities[rows], dim=1).mean() + STIFFNESS * ((logs - begin) ** 2).sum()
            value.backward()  # type: ignore[no-untyped-call]
            return value

        optimiser.step(loss)  # type: ignore[no-untyped-call]
        return torch.where(free, torch.exp(logs), start).detach()

    def is_right(self, weights: Tensor) -> Bool[np.ndarray, "n"]:
        """Whether the heading that is decided on is right, for every asked object."""
        with torch.no_grad():
            chosen = self.log_probabilities(weights, largest=True).argmax(dim=1)
        return self.right[torch.arange(len(chosen)), chosen].numpy()

    def fold(self, k: int, folds: int) -> Bool[np.ndarray, "n"]:
        """Which of the asked objects are of a fold of the photos, dealt as `bench photos --folds` deals them."""
        return np.isin(self.photos, sorted(self.names)[k::folds])

    def cross_validated(self, start: Tensor, folds: int) -> Bool[np.ndarray, "n"]:
        """As `is_right`, each photo with weights fitted to the photos of the other folds."""
        is_right = np.zeros(len(self.photos), bool)
        for k in range(folds):
            test = self.fold(k, folds)
            is_right[test] = self.is_right(self.fit(start, ~test))[test]
        return is_right


def beginning() -> Tensor:
    """All weights before they are fitted."""
    return torch.tensor([TOLD if name in AS_TOLD else START for name in NAMES], dtype=torch.float64)


def as_settings(weights: Tensor) -> dict[str, float]:
    """Weights by name."""
    return {name: round(float(w), 3) for name, w in zip(NAMES, weights, strict=True)}


def certificate(model: FacingModel, command: str, folds: int) -> dict[str, object]:
    """Weights fitted to all photos, and what they and every term are worth on photos not seen."""
    begin = beginning()
    weights = model.fit(begin, np.ones(len(model.photos), bool))
    whole = model.cross_validated(begin, folds)
    without = {}
    for k, name in enumerate(NAMES):
        lacking = begin.clone()
        lacking[k] = 0.0
        without[name] = round(float(model.cross_validated(lacking, folds).mean() - whole.mean()), 3)
    of_kind: dict[str, list[bool]] = {}
    for kind, right in zip(model.kinds, whole.tolist(), strict=True):
        of_kind.setdefault(kind, []).append(right)
    return {
        "command": command,
        "fronts": len(model.photos),
        "photos": len(model.names),
        "right, fitted to all": round(float(model.is_right(weights).mean()), 3),
        f"right, photos not seen, {folds} folds": round(float(whole.mean()), 3),
        "of them by kind": {k: f"{np.mean(v):.2f} of {len(v)}" for k, v in sorted(of_kind.items())},
        "change of that without a term": without,
        "weights": as_settings(weights),
    }
