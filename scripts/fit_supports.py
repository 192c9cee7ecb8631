#!/usr/bin/env python3
"""Fits `diorama_core/arrangement/support_weights.json`: fit_supports.py ANNOTATIONS PHOTOS [...] --stages DIR

Photos tell what carries what as people annotated it; rendered rooms (`synthesis`) tell it exactly, from their picture
alone and with depth, and which walls things stand against. Folds keep a photo or a room whole. The file says what
was fitted on, how often a held-out supporter is right, and what leaving out each term costs.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import numpy as np
from jaxtyping import Bool, Float
from scipy.optimize import minimize

from diorama_core.arrangement.support_hypotheses import (
    MEASURED,
    REASONED,
    ObservationNoise,
    SupportEvidence,
    SupportHypothesis,
    support_hypotheses,
    visible_shares_below,
)
from diorama_core.arrangement.support_terms import PATH, TERMS, place_name
from diorama_core.arrangement.supports import LEAST_ODDS, STANDING_TERMS, wall_relation
from diorama_core.artefacts import Inputs
from diorama_core.evaluation.adapters.photo_annotations import AnnotatedPhoto
from diorama_core.evaluation.benchmarks.cases import SEEDS, make_views, recipe
from diorama_core.evaluation.benchmarks.photo_build import read_annotated_inputs
from diorama_core.evaluation.benchmarks.photos import PhotoSource, plan
from diorama_core.evaluation.benchmarks.system import WAYS
from diorama_core.evaluation.metrics.scene import Matched
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import ShapeLibrary
from diorama_core.pipeline.plan import assemble, evaluate
from diorama_core.pipeline.runner import Runner
from diorama_core.pipeline.stages import embedded_stages
from diorama_core.progress import Progress
from diorama_core.scene.types import Scene
from diorama_core.synthesis.artefacts import true_supports
from diorama_core.synthesis.splits import split_library
from diorama_core.synthesis.truth import TruthView

T = TypeVar("T")
FOLDS = 5
RIDGE = 0.3
"""Precision of the weights' Gaussian prior, which keeps those that few cases ask for small."""
SAME_WALL = 0.9
"""Cosine from which on two walls' normals are of one wall."""
TOUCHES_M = 0.06
"""An object so near to a true wall stands against it."""


@dataclass(frozen=True, eq=False)
class Question:
    """One object: its hypotheses' values of all terms, and which of them are right."""

    group: str
    source: str
    values: Float[np.ndarray, "h t"]
    right: Bool[np.ndarray, " h"]


@dataclass(frozen=True, eq=False)
class Standing:
    """One object and one wall: the terms' values, and whether it stands against it."""

    group: str
    measured: bool
    values: Float[np.ndarray, " t"]
    right: bool


def posed_scene(inputs: Inputs, library: ShapeLibrary, cache: Path) -> tuple[Scene, SupportEvidence]:
    """A build up to the posed objects, and what the choice of supports knows besides."""
    found = evaluate(
        embedded_stages(inputs, library), {"given": inputs}, ("furniture", "posed"), Runner(cache), Progress()
    )
    objects, geometry = found["furniture"]
    scene = assemble(objects, geometry, found["architecture"], found["posed"], library, {})
    believed = {edge.child: edge for edge in scene.supports}
    return scene, SupportEvidence(believed, visible_shares_below({o.id: o.mask for o in objects}))


def photo_questions(
    annotated: Path, photos: Path, library: ShapeLibrary, cache: Path, columns: Sequence[str]
) -> Iterator[Question]:
    """Questions about every annotated object whose supporter is annotated."""
    for task in plan([PhotoSource(annotated, photos)]).tasks:
        scene, evidence = posed_scene(read_annotated_inputs(task).inputs, library, cache / f"{photos.name}-{task.name}")
        right = _annotated(task.annotation, scene)
        yield from _questions(task.name, photos.name, scene, library, REASONED, evidence, right, columns)


def _questions(
    group: str,
    source: str,
    scene: Scene,
    library: ShapeLibrary,
    noise: ObservationNoise,
    evidence: SupportEvidence,
    right: Mapping[str, frozenset[str]],
    columns: Sequence[str],
) -> Iterator[Question]:
    for name, hypotheses in support_hypotheses(scene, library, noise, evidence).items():
        answers = np.array([h.edge.parent in right.get(name, ()) for h in hypotheses])
        if answers.any():
            yield Question(group, source, np.array([values_of(h, columns) for h in hypotheses]), answers)


def values_of(h: SupportHypothesis, columns: Sequence[str]) -> list[float]:
    """The value of every column, terms first and then places."""
    return [*(term.value(h) for term in TERMS), *(float(place_name(h) == c) for c in columns[len(TERMS) :])]


def _annotated(photo: AnnotatedPhoto, scene: Scene) -> dict[str, frozenset[str]]:
    """What may hold each object; of walls those that the annotated front looks away from."""
    by_index = {o.mask_id - 1: o for o in scene.objects if o.mask_id is not None}
    found = {}
    for index, item in by_index.items():
        annotated = photo.objects[index]
        if isinstance(annotated.on, int) and annotated.on in by_index:
            found[item.id] = frozenset({by_index[annotated.on].id})
        elif isinstance(annotated.on, str):
            planes = scene.architecture.by_role(annotated.on)
            facing = [p for p in planes if annotated.on != "wall" or _faces(scene, p.normal, annotated.front)]
            found[item.id] = frozenset(p.id for p in facing or planes)
    return found


def _faces(scene: Scene, normal: Float[np.ndarray, "3"], front_deg: float | None) -> bool:
    if front_deg is None or scene.camera is None:
        return True
    right, forward = scene.camera.T_world_camera[:2, 0], scene.camera.T_world_camera[:2, 2]
    angle = np.deg2rad(front_deg)
    front = -np.cos(angle) * forward / np.linalg.norm(forward) + np.sin(angle) * right / np.linalg.norm(right)
    return bool(normal[:2] @ front > np.cos(np.deg2rad(45.0)))


def _rendered(view: TruthView, scene: Scene) -> dict[str, frozenset[str]]:
    matched = Matched.of(view, scene)
    there, names, found = matched.scene, {true: item.id for true, item in matched.counterparts.items()}, {}
    for edge in true_supports(view):
        if edge.child not in names:
            continue
        if view.scene.has_plane(edge.parent):
            plane = view.scene.plane(edge.parent)
            alike = there.architecture.by_role(plane.role)
            same = [p for p in alike if plane.role != "wall" or float(p.normal @ plane.normal) > SAME_WALL]
            found[names[edge.child]] = frozenset(p.id for p in same or alike)
        elif edge.parent in names:
            found[names[edge.child]] = frozenset({names[edge.parent]})
    return found


def _standings(group: str, view: TruthView, scene: Scene, noise: ObservationNoise) -> Iterator[Standing]:
    """How every object on the floor stands to every wall that was found."""
    matched = Matched.of(view, scene)
    there, built = matched.scene, matched.counterparts
    floors = {p.id for p in view.scene.architecture.by_role("floor")}
    for true in (view.scene.objects[k] for k in view.indices):
        edge = view.scene.support_of(true.id)
        if true.id not in built or edge is None or edge.parent not in floors:
            continue
        touched = [
            w.normal
            for w in view.scene.architecture.by_role("wall")
            if abs(float((true.corners_world @ w.normal).min()) - w.offset) < TOUCHES_M
            and float(np.abs(w.normal @ true.pose.R_world_object).max()) > SAME_WALL
        ]
        for wall, in_truth in zip(scene.architecture.by_role("wall"), there.architecture.by_role("wall"), strict=True):
            relation = wall_relation(scene, scene.object(built[true.id].id), wall, noise)
            if relation is not None:
                values = np.array([term(relation) for term in STANDING_TERMS.values()])
                right = any(float(n @ in_truth.normal) > SAME_WALL for n in touched)
                yield Standing(group, noise.measured, values, right)


def room_questions(
    rooms: int, library: ShapeLibrary, cache: Path, columns: Sequence[str]
) -> tuple[list[Question], list[Standing]]:
    """Questions about rooms of the series for development, from the picture alone and with depth."""
    tested, searched = split_library(library, "test"), split_library(library, "train", "validation")
    questions: list[Question] = []
    standings: list[Standing] = []
    for case in (case for seed in SEEDS["development"] for case in recipe(rooms, 1, seed)):
        for _, view in make_views((case,), tested, []):
            for way, noise in (("photo", REASONED), ("depth", MEASURED)):
                scene, evidence = posed_scene(WAYS[way].inputs(view), searched, cache / f"{case.name}-{way}")
                right = _rendered(view, scene)
                source = f"rooms, {way}"
                questions += _questions(case.name, source, scene, searched, noise, evidence, right, columns)
                standings += _standings(case.name, view, scene, noise)
        print(f"{case.name}: {len(questions)} objects, {len(standings)} walls", file=sys.stderr)
    return questions, standings


def fitted(questions: Sequence[Question], used: Bool[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
    """Weights of the used terms that make the right supporters likeliest; 0 of the others."""

    def loss(w: np.ndarray) -> tuple[float, np.ndarray]:
        total, slope = RIDGE * float(w @ w), 2.0 * RIDGE * w
        for q in questions:
            x = q.values[:, used]
            likely = np.exp(-(x @ w) + (x @ w).min())
            right = likely * q.right
            total -= float(np.log(right.sum() / likely.sum()))
            slope = slope + x.T @ (right / right.sum() - likely / likely.sum())
        return total, slope

    weights = np.zeros(len(used))
    weights[used] = minimize(loss, np.zeros(int(used.sum())), jac=True, method="L-BFGS-B").x
    return weights


def held_out(questions: Sequence[Question], used: Bool[np.ndarray, " t"]) -> dict[str, float]:
    """Negative log-likelihood ("loss") and share of right supporters by source, each group fitted on the others."""
    loss, right, count = 0.0, Counter[str](), Counter[str]()
    for training, tested in _folds(questions, lambda q: q.group):
        w = fitted(training, used)
        for q in tested:
            cost = q.values @ w
            likely = np.exp(cost.min() - cost)
            loss -= float(np.log(likely[q.right].sum() / likely.sum()))
            right[q.source] += int(q.right[int(np.argmin(cost))])
            count[q.source] += 1
    return {"loss": round(loss, 2), **{source: round(right[source] / count[source], 3) for source in sorted(count)}}


def _folds(cases: Sequence[T], group: Callable[[T], str]) -> Iterator[tuple[list[T], list[T]]]:
    groups = sorted({group(c) for c in cases})
    for k in range(FOLDS):
        out = set(groups[k::FOLDS])
        yield [c for c in cases if group(c) not in out], [c for c in cases if group(c) in out]


def fitted_standing(cases: Sequence[Standing]) -> Float[np.ndarray, " t"]:
    """Logistic regression of standing against a wall."""
    x, sign = np.array([c.values for c in cases]), np.array([1.0 if c.right else -1.0 for c in cases])

    def loss(w: np.ndarray) -> tuple[float, np.ndarray]:
        margin = sign * (x @ w)
        away = 1.0 / (1.0 + np.exp(np.clip(margin, -50.0, 50.0)))
        return float(np.logaddexp(0.0, -margin).sum() + RIDGE * (w @ w)), -x.T @ (sign * away) + 2.0 * RIDGE * w

    return np.asarray(minimize(loss, np.zeros(x.shape[1]), jac=True, method="L-BFGS-B").x)


def standing_score(cases: Sequence[Standing]) -> dict[str, int]:
    """Held-out counts: walls that things stand against, those that are found, and those that are found wrongly."""
    found = wrong = 0
    for training, tested in _folds(cases, lambda c: c.group):
        w = fitted_standing(training)
        found += sum(c.right and float(c.values @ w) > LEAST_ODDS for c in tested)
        wrong += sum(not c.right and float(c.values @ w) > LEAST_ODDS for c in tested)
    return {"walls": len(cases), "true": sum(c.right for c in cases), "found": found, "wrong": wrong}


def main() -> None:
    """Fit, measure and write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("photos", nargs="*", type=Path, help="pairs of an annotation file and its folder of photos")
    parser.add_argument("--stages", type=Path, required=True, help="folder for stage results, to go on from")
    parser.add_argument("--rooms", type=int, default=4, help="rooms of each series for development")
    parser.add_argument("--output", type=Path, default=PATH)
    args = parser.parse_args()
    library = built_in_library()
    mounts, roles = ("floor", "surface", "wall", "ceiling"), ("floor", "wall", "ceiling", "object")
    columns = [*(t.name for t in TERMS), *(f"{m} kind on {r}" for m in mounts for r in roles)]
    questions, standings = room_questions(args.rooms, library, args.stages, columns)
    for annotated, photos in zip(args.photos[::2], args.photos[1::2], strict=True):
        questions += photo_questions(annotated, photos, library, args.stages, columns)
    everything = np.ones(len(columns), dtype=bool)
    weights = fitted(questions, everything).round(3).tolist()
    numbers = np.arange(len(columns))
    without = {name: held_out(questions, numbers != k) for k, name in enumerate(columns[: len(TERMS)])}
    without["usual places"] = held_out(questions, numbers < len(TERMS))
    walls = {"measured": [s for s in standings if s.measured], "reasoned": [s for s in standings if not s.measured]}
    certificate = {
        "command": "scripts/fit_supports.py ANNOTATIONS PHOTOS ... --stages DIR",
        "objects": dict(Counter(q.source for q in questions)),
        "held out": held_out(questions, everything),
        "without": without,
        "standing against walls, held out": {name: standing_score(cases) for name, cases in walls.items()},
    }
    fit = {
        "terms": dict(zip(columns, weights, strict=True)),
        "walls": {
            name: dict(zip(STANDING_TERMS, fitted_standing(cases).round(3).tolist(), strict=True))
            for name, cases in walls.items()
        },
    }
    places = {name: fit["terms"].pop(name) for name in columns[len(TERMS) :]}
    args.output.write_text(json.dumps({**fit, "places": places, "certificate": certificate}, indent=1) + "\n")
    print(json.dumps(certificate, indent=1))


if __name__ == "__main__":
    main()
