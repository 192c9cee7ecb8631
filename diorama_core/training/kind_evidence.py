"""The small layer from features of EfficientNet-Lite0 to kinds, learnt on annotated photos.

It is a residual: of a multinomial logistic regression whose other terms are fixed (the namer of our own, the table of
ImageNet's classes, how often kinds are met), so that of kinds that no photo has it says next to nothing. How good it is
on other photos is told by folds: each holds some photos back.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.optimize import minimize
from scipy.special import log_softmax

from diorama_core.evaluation.adapters.photo_annotations import picture_of, read_annotations
from diorama_core.evaluation.benchmarks.recognition import read_annotated_photo
from diorama_core.io import assets
from diorama_core.io.derived import write_arrays
from diorama_core.library.labels import meanings
from diorama_core.library.taxonomy import UNKNOWN
from diorama_core.models.efficientnet import lite0_graph
from diorama_core.models.kind_evidence import (
    OWN_FLOOR,
    KindEvidence,
    KindReadings,
    read_class_table,
    table_likelihoods,
    unit_features,
    with_evidence,
)
from diorama_core.models.recogniser import Recogniser
from diorama_core.perception.foundation.proposals import rank_names
from diorama_core.progress import Progress
from diorama_core.retrieval.seen_kinds import TRUST
from diorama_core.scene.values import ArrayValue

DIRECTIONS, RIDGE = 32, 20.0
"""Principal directions of the features, and the weight of squared weights: by folds over 37 photos, where 24 to 300
directions with 15 to 60 do nearly as well."""
FOLDS, SEED, STEPS = 10, 0, 40
_NEVER = 1e-9


@dataclass(frozen=True, eq=False)
class AnnotatedLooks(ArrayValue):
    """What the networks say of the boxes of one photo that people annotated with kinds."""

    own: Float[np.ndarray, "n k"]
    """Probabilities of the namer by itself."""
    logits: Float[np.ndarray, "n c"]
    features: Float[np.ndarray, "n f"]
    kinds: Int[np.ndarray, "n"]
    boxes: Float[np.ndarray, "n 4"]


def looks_of(sources: Sequence[tuple[Path, Path]], alone: Recogniser, evidence: KindEvidence) -> list[AnnotatedLooks]:
    """What the networks say of every annotated photo.

    Args:
        sources: annotations, and the folder of their photos.
        alone: the namer, without evidence.
        evidence: looks at boxes; its readings are not used.
    """
    looks, column = [], {kind: k for k, kind in enumerate(alone.categories)}
    for marked, photos in sources:
        for name, about in read_annotations(marked).items():
            path = picture_of(photos, name)
            asked = [k for k, item in enumerate(about.objects) if item.kind in column and item.nameable]
            if path is None or not asked:
                continue
            inputs, boxes = read_annotated_photo(path, about)
            rgb, boxes = inputs.photo.rgb, boxes[asked]
            kinds = np.array([column[about.objects[k].kind] for k in asked])
            looks.append(AnnotatedLooks(alone.name(rgb, boxes), *evidence.look(rgb, boxes), kinds, boxes))
    return looks


@dataclass(frozen=True)
class NamingScore:
    """Names of annotated boxes, those of one photo together."""

    way: str
    first: float
    among_five: float
    log_loss: float
    """Loss of single boxes, in nats."""


def fit(looks: Sequence[AnnotatedLooks], kinds: tuple[str, ...], table: Path) -> KindReadings:
    """The readings that all photos together teach."""
    return _Fit.of(looks, kinds, table).readings(np.ones(sum(len(p.kinds) for p in looks), bool))


def scores(looks: Sequence[AnnotatedLooks], kinds: tuple[str, ...], table: Path) -> tuple[NamingScore, ...]:
    """The namer alone, with the table, and with the layer as well, each photo read by what the others taught."""
    fitted, photo = _Fit.of(looks, kinds, table), np.repeat(np.arange(len(looks)), [len(p.kinds) for p in looks])
    order = np.random.default_rng(SEED).permutation(len(looks))
    learnt = np.zeros_like(fitted.known)
    for k in range(FOLDS):
        is_held_out = np.isin(photo, order[k::FOLDS])
        if is_held_out.any():
            readings = fitted.readings(~is_held_out)
            learnt[is_held_out] = readings.log_likelihoods(fitted.logits[is_held_out], fitted.features[is_held_out])
    probabilities, of_table = np.concatenate([p.own for p in looks]), fitted.of_table
    ways = {
        "own": probabilities,
        "own, table": with_evidence(probabilities, of_table),
        "own, table, layer": with_evidence(probabilities, learnt),
    }
    return tuple(_score(way, looks, seen, kinds, fitted.log_frequency) for way, seen in ways.items())


def write_layer(readings: KindReadings, kinds: tuple[str, ...], path: Path) -> None:
    """The layer in half precision."""
    parts = {name: getattr(readings, name).astype(np.float16) for name in ("mean", "basis", "weights")}
    write_arrays(path, {"kinds": np.array(kinds), **parts})


@dataclass(frozen=True, eq=False)
class _Fit(ArrayValue):
    """All boxes of all photos."""

    classes: Float[np.ndarray, "k c"]
    of_table: Float[np.ndarray, "n k"]
    known: Float[np.ndarray, "n k"]
    """Logits of the kinds without the layer."""
    logits: Float[np.ndarray, "n c"]
    features: Float[np.ndarray, "n f"]
    truth: Int[np.ndarray, "n"]
    log_frequency: Float[np.ndarray, "k"]

    @classmethod
    def of(cls, looks: Sequence[AnnotatedLooks], kinds: tuple[str, ...], table: Path) -> _Fit:
        """Gather what the networks say of all annotated boxes, with the truth.

        Args:
            looks: what the networks say of annotated objects.
            kinds: names of the categories.
            table: file of the class table.
        """
        probabilities, logits, features = (
            np.concatenate([getattr(p, n) for p in looks]) for n in ("own", "logits", "features")
        )
        classes, shares = read_class_table(table, kinds), meanings(UNKNOWN.name, UNKNOWN.name)
        frequency = np.log([max(shares.get(kind, 0.0), _NEVER) for kind in kinds])
        of_table = table_likelihoods(classes, logits)
        known = TRUST * (np.log(probabilities + OWN_FLOOR) + of_table) + frequency
        truth = np.concatenate([p.kinds for p in looks])
        return cls(classes, of_table, known, logits, features, truth, frequency)

    def readings(self, learn: Bool[np.ndarray, "n"]) -> KindReadings:
        """What some boxes teach; directions come from the features of all, which need no annotation."""
        unit = unit_features(self.features)
        mean = unit.mean(axis=0)
        _, sizes, directions = np.linalg.svd(unit - mean, full_matrices=False)
        count = min(DIRECTIONS, len(directions))
        scale = float(np.sqrt((sizes[:count] ** 2).sum() / (len(unit) * count)))
        basis = directions[:count].T / scale
        along = (unit - mean) @ basis
        weights = _regression(self.known[learn], along[learn], self.truth[learn])
        return KindReadings(self.classes, mean, basis, weights / TRUST)


def _regression(
    known: Float[np.ndarray, "n k"], along: Float[np.ndarray, "n d"], truth: Int[np.ndarray, "n"]
) -> Float[np.ndarray, "d k"]:
    """Weights that explain best what is known already does not, penalised by their squares."""
    shape, rows = (along.shape[1], known.shape[1]), np.arange(len(truth))

    def loss(flat: Float[np.ndarray, "w"]) -> tuple[float, Float[np.ndarray, "w"]]:
        weights = flat.reshape(shape)
        logs = log_softmax(known + along @ weights, axis=1)
        wrong = np.exp(logs)
        wrong[rows, truth] -= 1.0
        gradient = along.T @ wrong + RIDGE * weights
        return float(-logs[rows, truth].sum() + RIDGE / 2 * (weights**2).sum()), gradient.ravel()

    solution = minimize(loss, np.zeros(shape[0] * shape[1]), jac=True, method="L-BFGS-B", options={"maxiter": STEPS})
    return solution.x.reshape(shape)


def _score(
    way: str,
    looks: Sequence[AnnotatedLooks],
    seen: Float[np.ndarray, "n k"],
    kinds: tuple[str, ...],
    log_frequency: Float[np.ndarray, "k"],
) -> NamingScore:
    truth = np.concatenate([p.kinds for p in looks])
    logs = log_softmax(TRUST * np.log(seen + _NEVER) + log_frequency, axis=1)
    names: list[tuple[str, ...]] = []
    start = 0
    for p in looks:
        names += rank_names(kinds, seen[start : start + len(p.kinds)], p.boxes)
        start += len(p.kinds)
    first = np.mean([n[0] == kinds[k] for n, k in zip(names, truth, strict=True)])
    five = np.mean([kinds[k] in n[:5] for n, k in zip(names, truth, strict=True)])
    return NamingScore(way, float(first), float(five), float(-logs[np.arange(len(truth)), truth].mean()))


def train(sources: Sequence[tuple[Path, Path]], output: Path, progress: Progress) -> tuple[NamingScore, ...]:
    """Fit the layer for the namer that comes with Diorama and write it; how good each way is on photos held back.

    Args:
        sources: annotations, and the folder of their photos.
        output: the file of the layer.
        progress: reports and cancellation.
    """
    alone = Recogniser.of(assets.FOLDER)
    table = assets.FOLDER / assets.CLASS_TABLE
    nothing = KindReadings(np.zeros((1, 1)), np.zeros(1), np.zeros((1, 1)), np.zeros((1, 1)))
    progress.report(0.0, "looking at photos")
    looks = looks_of(sources, alone, KindEvidence(lite0_graph(), nothing, "none"))
    progress.report(0.8, f"learning from {len(looks)} photos")
    write_layer(fit(looks, alone.categories, table), alone.categories, output)
    return scores(looks, alone.categories, table)
