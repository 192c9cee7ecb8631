"""Shapes that leave their neighbours room: of the retrieved alternatives, one that does not pass through what was
measured beside or below it.

A desk with a closed front and a computer below its top cannot both be right. Where the parts of two objects overlap at
their measured places, one of the two has another shape than the thing it stands for.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from diorama_core.arrangement.support_hypotheses import ObservationNoise
from diorama_core.arrangement.surfaces import is_soft, misfit, object_surfaces
from diorama_core.layout.problem.problem import build_problem
from diorama_core.layout.report import part_overlaps
from diorama_core.library.record import ShapeLibrary, record_of
from diorama_core.scene.frames import UP_WORLD
from diorama_core.scene.types import Candidate, Scene, SceneObject

CLEAR_M = 0.02
"""Overlaps that go less deep are left to moves."""
SHAPE_SIGMA_M = 0.03
"""Standard deviation of a shape's sides and boards from those of the thing it stands for."""
MAX_COST = 6.0
"""Most that one neighbour says against a shape: it may be wrong itself, or not stand there at all."""
MIN_SCORE = 1e-3
"""Least score of a candidate, so that its logarithm exists."""


def clear_shapes(scene: Scene, library: ShapeLibrary, noise: ObservationNoise) -> tuple[Scene, tuple[str, ...]]:
    """The scene with objects in the retrieved shapes that agree best with picture and neighbours, and what was changed.

    Costs are negative logarithms of likelihoods: of the retrieval's score, of each load's gap, and of each overlap's
    depth. Objects of one shape stay of one shape; what is locked stays as it is. The deepest overlaps are looked at
    first.
    """
    reasons: list[str] = []
    looked_at: set[tuple[str, str]] = set()
    while pairs := [pair for pair in _overlaps(scene, library) if pair not in looked_at]:
        looked_at.add(pairs[0])
        _, changed = min((_better(scene, library, noise, name) for name in pairs[0]), key=lambda option: option[0])
        for item in scene.objects:
            if changed.object(item.id).shape_id != item.shape_id:
                reasons.append(f"shape changed: {item.label} {_why(scene, item, pairs[0])}")
        scene = changed
    return scene, tuple(reasons)


def _why(scene: Scene, item: SceneObject, pair: tuple[str, str]) -> str:
    if item.id not in pair:
        return "is of one shape with others"
    return f"leaves room for {scene.object(pair[item.id == pair[0]]).label}"


def _overlaps(scene: Scene, library: ShapeLibrary) -> dict[tuple[str, str], float]:
    """Depth in metres by which parts of two objects overlap, by their ids, where it is not nothing, deepest first."""
    problem = build_problem(scene, library)
    overlaps = part_overlaps(problem)
    named = [(-depth, (problem.ids[a], problem.ids[b])) for (a, b), depth in overlaps.items() if depth > CLEAR_M]
    return {pair: -negative for negative, pair in sorted(named)}


def _better(scene: Scene, library: ShapeLibrary, noise: ObservationNoise, name: str) -> tuple[float, Scene]:
    """The gain (negative, in logarithms) and the scene of the best shape of its kind for an object and those alike."""
    members = [o for o in scene.objects if o.shape_id == scene.object(name).shape_id]
    if any(o.locked for o in members):
        return 0.0, scene
    kind = record_of(library, members[0].shape_id).category
    common = set.intersection(*({c.shape_id for c in o.candidates} for o in members))
    now = _cost(scene, library, noise, members)
    options = [(0.0, "", scene)]
    for shape in sorted(s for s in common - {members[0].shape_id} if record_of(library, s).category == kind):
        other = scene
        for o in members:
            other = _replace_shape(other, o, next(c for c in o.candidates if c.shape_id == shape))
        options.append((_cost(other, library, noise, [other.object(o.id) for o in members]) - now, shape, other))
    cost, _, best = min(options, key=lambda option: option[:2])
    return cost, best


def _cost(scene: Scene, library: ShapeLibrary, noise: ObservationNoise, members: Sequence[SceneObject]) -> float:
    names = {o.id for o in members}
    depths = [depth for pair, depth in _overlaps(scene, library).items() if names & set(pair)]
    overlap = sum(min(0.5 * (depth / SHAPE_SIGMA_M) ** 2, MAX_COST) for depth in depths)
    return overlap + sum(_cost_of_shape(o, library, scene, noise) for o in members)


def _replace_shape(scene: Scene, item: SceneObject, candidate: Candidate) -> Scene:
    """The scene with an object in another shape, and its loads where they were seen."""
    new = replace(item, shape_id=candidate.shape_id, shape_size_m=candidate.shape_size_m, pose=candidate.pose)
    edges = tuple(replace(s, parent_surface=None) if s.parent == item.id else s for s in scene.supports)
    objects = tuple(new if other.id == item.id else other for other in scene.objects)
    return replace(scene, objects=objects, supports=edges)


def _loads_of(scene: Scene, object_id: str) -> list[SceneObject]:
    """What is placed on an object and keeps its form there."""
    edges = [s for s in scene.supports if s.parent == object_id and s.relation == "placed on"]
    return [item for s in edges if not is_soft(item := scene.object(s.child))]


def _cost_of_shape(item: SceneObject, library: ShapeLibrary, scene: Scene, noise: ObservationNoise) -> float:
    """What the score of an object's shape and the gaps of its loads say against it: a negative logarithm."""
    surfaces = [s.to_world(item.pose) for s in object_surfaces(library.shape(item.shape_id), item)]
    costs = []
    for load in _loads_of(scene, item.id):
        gap_m = min(misfit(load, surface) for surface in surfaces)
        sigma_m = float(np.hypot(0.5 * noise.tolerance_m(scene.camera, load.pose.position, UP_WORLD), SHAPE_SIGMA_M))
        costs.append(min(0.5 * (gap_m / sigma_m) ** 2, MAX_COST))
    score = next((c.score for c in item.candidates if c.shape_id == item.shape_id), 1.0)
    return sum(costs) - float(np.log(max(score, MIN_SCORE)))
