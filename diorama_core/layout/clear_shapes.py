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

    Args:
        scene: as measured, before any layout, with its support graph.
        library: where shapes come from.
        noise: of the observed positions.
    """
    reasons: list[str] = []
    looked_at: set[tuple[str, str]] = set()
    while pairs := [pair for pair in _deepest_first(scene, library) if pair not in looked_at]:
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


def _deepest_first(scene: Scene, library: ShapeLibrary) -> list[tuple[str, str]]:
    depths = _overlaps(scene, library)
    return sorted(depths, key=lambda pair: (-depths[pair], pair))


def _overlaps(scene: Scene, library: ShapeLibrary) -> dict[tuple[str, str], float]:
    """Depth in metres by which parts of two objects overlap, by their ids, where that is more than nothing."""
    problem = build_problem(scene, library)
    overlaps = part_overlaps(problem, problem.R, problem.p, problem.scale)
    return {(problem.ids[a], problem.ids[b]): depth for (a, b), depth in overlaps.items() if depth > CLEAR_M}


def _better(scene: Scene, library: ShapeLibrary, noise: ObservationNoise, name: str) -> tuple[float, Scene]:
    """The gain (negative, in logarithms) and the scene of the best shape of its kind for an object and those alike."""
    members = next(group for group in _objects_by_shape(scene) if any(o.id == name for o in group))
    if any(o.locked for o in members):
        return 0.0, scene
    kind = record_of(library, members[0].shape_id).category
    common = set.intersection(*({c.shape_id for c in o.candidates} for o in members))
    now = _cost(scene, library, noise, members)
    options = [(0.0, "", scene)]
    for shape in sorted(s for s in common - {members[0].shape_id} if record_of(library, s).category == kind):
        other = scene
        for o in members:
            other = _replace_shape(other, o, _candidate_of(o, shape))
        options.append((_cost(other, library, noise, [other.object(o.id) for o in members]) - now, shape, other))
    cost, _, best = min(options, key=lambda option: option[:2])
    return cost, best


def _cost(scene: Scene, library: ShapeLibrary, noise: ObservationNoise, members: Sequence[SceneObject]) -> float:
    names = {o.id for o in members}
    depths = [depth for pair, depth in _overlaps(scene, library).items() if names & set(pair)]
    overlap = sum(min(0.5 * (depth / SHAPE_SIGMA_M) ** 2, MAX_COST) for depth in depths)
    return overlap + sum(
        _cost_of_shape(o, _as_it_is(o), _loads_of(scene, o.id), library, scene, noise) for o in members
    )


def _as_it_is(item: SceneObject) -> Candidate:
    score = next((c.score for c in item.candidates if c.shape_id == item.shape_id), 1.0)
    return Candidate(item.shape_id, item.shape_size_m, score, item.pose)


def _replace_shape(scene: Scene, item: SceneObject, candidate: Candidate) -> Scene:
    """The scene with an object in another shape, and its loads where they were seen."""
    new = replace(item, shape_id=candidate.shape_id, shape_size_m=candidate.shape_size_m, pose=candidate.pose)
    edges = tuple(replace(s, parent_surface=None) if s.parent == item.id else s for s in scene.supports)
    objects = tuple(new if other.id == item.id else other for other in scene.objects)
    return replace(scene, objects=objects, supports=edges)


def _objects_by_shape(scene: Scene) -> list[list[SceneObject]]:
    """Objects of a scene, grouped by shape."""
    groups: dict[str, list[SceneObject]] = {}
    for item in scene.objects:
        groups.setdefault(item.shape_id, []).append(item)
    return list(groups.values())


def _loads_of(scene: Scene, object_id: str) -> list[SceneObject]:
    """What is placed on an object and keeps its form there."""
    edges = [s for s in scene.supports if s.parent == object_id and s.relation == "placed on"]
    return [item for s in edges if not is_soft(item := scene.object(s.child))]


def _candidate_of(item: SceneObject, shape_id: str) -> Candidate:
    """The retrieved alternative of an object that is of this shape."""
    return next(c for c in item.candidates if c.shape_id == shape_id)


def _gaps_m(
    item: SceneObject, candidate: Candidate, loads: Sequence[SceneObject], library: ShapeLibrary, scene: Scene
) -> list[float]:
    """How badly each load agrees with standing on an object in another shape."""
    size_m, pose = candidate.shape_size_m, candidate.pose
    other = replace(item, shape_id=candidate.shape_id, shape_size_m=size_m, pose=pose)
    surfaces = [s.to_world(pose) for s in object_surfaces(library.shape(candidate.shape_id), other)]
    return [min(misfit(load, surface) for surface in surfaces) for load in loads]


def _sigma_m(scene: Scene, load: SceneObject, noise: ObservationNoise) -> float:
    return float(np.hypot(0.5 * noise.tolerance_m(scene.camera, load.pose.position, UP_WORLD), SHAPE_SIGMA_M))


def _cost_of_shape(
    item: SceneObject,
    candidate: Candidate,
    loads: Sequence[SceneObject],
    library: ShapeLibrary,
    scene: Scene,
    noise: ObservationNoise,
) -> float:
    """What a shape's score and the gaps of its loads say against it: a negative logarithm."""
    gaps = _gaps_m(item, candidate, loads, library, scene) if loads else []
    deviations = [gap / _sigma_m(scene, load, noise) for gap, load in zip(gaps, loads, strict=True)]
    return sum(min(0.5 * d * d, MAX_COST) for d in deviations) - float(np.log(max(candidate.score, MIN_SCORE)))
