"""Shapes that hold what was seen on them: of the retrieved alternatives, one with a board where each load was observed.

Retrieval compares a bookshelf with the picture as a whole; where its boards are, it hardly sees. What stands on them
says it better: a shape without a place near a load would take it to another level.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from diorama_core.layout.fitted_boards import fitted_shape
from diorama_core.arrangement.noise import ObservationNoise
from diorama_core.arrangement.surfaces import is_soft, misfit, object_surfaces
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.frames import UP_WORLD
from diorama_core.scene.types import Candidate, Scene, SceneObject

BOARD_M = 0.03
"""Usual distance of a shape's board from that of the thing it stands for, beside the observation's noise."""
MAX_LOAD_COST = 6.0
"""Most that one load says against a shape: it may not stand there at all."""
MIN_SCORE = 1e-3
"""Of candidates, so that a logarithm exists."""


def holding_shapes(scene: Scene, library: ShapeLibrary, noise: ObservationNoise) -> tuple[Scene, tuple[str, ...]]:
    """The scene with supporters in the retrieved shapes that agree best with picture and loads, and what was changed.

    Costs are negative logarithms of likelihoods: of the retrieval's score, and of each load's gap. Objects of one shape
    stay of one shape. Supporters whose loads agree with them within the noise, and those that are locked, stay.

    Args:
        scene: as observed, before any layout, with its support graph.
        library: where shapes come from.
        noise: of the observed positions.
    """
    reasons = []
    for members in of_one_shape(scene):
        loads = {o.id: loads_of(scene, o.id) for o in members}
        if not any(loads.values()) or any(o.locked for o in members) or _agree(members, loads, library, scene, noise):
            continue
        common = set.intersection(*({c.shape_id for c in o.candidates} for o in members))
        options = [
            (sum(cost_of_shape(o, candidate_of(o, shape), loads[o.id], library, scene, noise) for o in members), shape)
            for shape in sorted(common | {members[0].shape_id})
            if all(any(c.shape_id == shape for c in o.candidates) for o in members)
        ]
        if not options or min(options)[1] == members[0].shape_id:
            continue
        for o in members:
            scene = reshaped(scene, o, candidate_of(o, min(options)[1]))
            loaded = f"has a place where {_names(loads[o.id])} seen" if loads[o.id] else "is of one shape with others"
            reasons.append(f"shape changed: {o.label} {loaded}")
    return scene, tuple(reasons)


def reshaped(scene: Scene, item: SceneObject, candidate: Candidate) -> Scene:
    """The scene with an object in another shape, and its loads where they were seen."""
    new = replace(item, shape_id=candidate.shape_id, shape_size_m=candidate.shape_size_m, pose=candidate.pose)
    edges = tuple(replace(s, parent_surface=None) if s.parent == item.id else s for s in scene.supports)
    objects = tuple(new if other.id == item.id else other for other in scene.objects)
    return replace(scene, objects=objects, supports=edges)


def of_one_shape(scene: Scene) -> list[list[SceneObject]]:
    """The objects of a scene, those of one shape together."""
    groups: dict[str, list[SceneObject]] = {}
    for item in scene.objects:
        groups.setdefault(item.shape_id, []).append(item)
    return list(groups.values())


def loads_of(scene: Scene, object_id: str) -> list[SceneObject]:
    """What is placed on an object and keeps its form there."""
    edges = [s for s in scene.supports if s.parent == object_id and s.relation == "placed on"]
    return [item for s in edges if not is_soft(item := scene.object(s.child))]


def candidate_of(item: SceneObject, shape_id: str) -> Candidate:
    """The retrieved alternative of an object that is of this shape."""
    return next(c for c in item.candidates if c.shape_id == shape_id)


def gaps_m(
    item: SceneObject, candidate: Candidate, loads: Sequence[SceneObject], library: ShapeLibrary, scene: Scene
) -> list[float]:
    """How badly each load agrees with standing on an object in another shape, its boards set for them."""
    size_m, pose = candidate.shape_size_m, candidate.pose
    other = replace(item, shape_id=candidate.shape_id, shape_size_m=size_m, pose=pose)
    fitted = fitted_shape(scene, other, library, reasoned=False)
    surfaces = [s.in_world(pose) for s in object_surfaces(library.shape(fitted or candidate.shape_id), other)]
    return [min(misfit(load, surface) for surface in surfaces) for load in loads]


def _sigma_m(scene: Scene, load: SceneObject, noise: ObservationNoise) -> float:
    return float(np.hypot(0.5 * noise.tolerance_m(scene.camera, load.pose.position, UP_WORLD), BOARD_M))


def cost_of_shape(
    item: SceneObject,
    candidate: Candidate,
    loads: Sequence[SceneObject],
    library: ShapeLibrary,
    scene: Scene,
    noise: ObservationNoise,
) -> float:
    """What a shape's score and the gaps of its loads say against it: a negative logarithm."""
    gaps = gaps_m(item, candidate, loads, library, scene) if loads else []
    deviations = [gap / _sigma_m(scene, load, noise) for gap, load in zip(gaps, loads, strict=True)]
    return sum(min(0.5 * d * d, MAX_LOAD_COST) for d in deviations) - float(np.log(max(candidate.score, MIN_SCORE)))


def _agree(
    members: Sequence[SceneObject],
    loads: Mapping[str, Sequence[SceneObject]],
    library: ShapeLibrary,
    scene: Scene,
    noise: ObservationNoise,
) -> bool:
    """Whether every load is within the noise of a place on its supporter as it is."""
    for item in members:
        current = Candidate(item.shape_id, item.shape_size_m, 1.0, item.pose)
        gaps = gaps_m(item, current, loads[item.id], library, scene) if loads[item.id] else []
        if any(gap > 2.0 * _sigma_m(scene, load, noise) for gap, load in zip(gaps, loads[item.id], strict=True)):
            return False
    return True


def _names(loads: Sequence[SceneObject]) -> str:
    labels = [load.label for load in loads]
    return f"{labels[0]} was" if len(labels) == 1 else f"{', '.join(labels[:-1])} and {labels[-1]} were"
