"""Where an object goes: candidates on floor, furniture, walls and ceiling, their costs, and the best that is free.

Deterministic. Relations and habits (backs to walls, doors and fronts free) are costs; that an object is inside the
room, is held up and meets no other mesh is required.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float

from diorama_core.editing.collisions import Collisions
from diorama_core.editing.footprints import footprint_of, lie_within
from diorama_core.editing.placement_candidates import Candidates, candidates_for
from diorama_core.editing.placement_costs import placement_costs
from diorama_core.editing.relations import Relation
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.scene import edits
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Pose, Scene, SceneObject, Support

MAX_TRIED = 500
"""Candidates, best first, that are tested exactly."""
STEPS_ASIDE_M = 1.2
"""How far an object that turned or grew goes to be free again."""


@dataclass(frozen=True, eq=False)
class Spot:
    """Where an object can be."""

    pose: Pose
    support: Support | None
    cost: float


@dataclass(frozen=True, eq=False)
class Positioner:
    """Finds places in scenes of one library; collision trees of shapes are kept between calls."""

    library: ShapeLibrary
    collisions: Collisions = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "collisions", Collisions(self.library))

    def best(
        self,
        scene: Scene,
        item: SceneObject,
        relations: Sequence[Relation] = (),
        *,
        usual: Sequence[Relation] = (),
        others: Mapping[str, Sequence[Relation]] | None = None,
        near: Float[np.ndarray, "3"] | None = None,
    ) -> Spot | None:
        """The best free place for an object, which may be in the scene already; what it holds up goes along.

        Args:
            scene: where; the object's present place in it does not count.
            item: what; its pose is not looked at, but its size is.
            relations: wishes for it.
            usual: how such objects stand where nobody says; they weigh less.
            others: wishes of other objects; those that name this one count too.
            near: a place that is preferred where nothing else decides.
        """
        frame = RoomFrame.of(scene)
        rest = _without(scene, item)
        best: Spot | None = None
        for candidates in candidates_for(rest, item, (*relations, *usual), frame, self.library):
            cost = placement_costs(rest, item, candidates, relations, usual, others or {}, frame, near)
            spot = self._first_free(rest, item, candidates, cost)
            if spot is not None and (best is None or spot.cost < best.cost):
                best = spot
        return best

    def put(self, scene: Scene, item: SceneObject, spot: Spot) -> Scene:
        """The scene with the object at a place, inserted where it is not there yet.

        Args:
            scene: as it is.
            item: the object.
            spot: where to.
        """
        if scene.has_object(item.id):
            moved = edits.move(scene, item.id, spot.pose)
            return moved if spot.support is None else edits.attach(moved, spot.support)
        return edits.insert(scene, replace(item, pose=spot.pose), spot.support)

    def is_inside(self, scene: Scene, object_id: str) -> bool:
        """True for an object whose outline is within the room."""
        quad = footprint_of(scene.object(object_id))
        return bool(lie_within(quad[None], RoomFrame.of(scene).outline, 0.02)[0])

    def nearby(self, scene: Scene, object_id: str) -> Spot | None:
        """The nearest free place on the same level, with the same heading."""
        item, frame = scene.object(object_id), RoomFrame.of(scene)
        moved_ids = (object_id, *descendants(scene, object_id))
        edge = scene.support_of(object_id)
        if edge is not None and edge.relation == "mounted on":
            return None
        for reach in np.arange(0.05, STEPS_ASIDE_M, 0.05):
            for angle in np.arange(16) * np.pi / 8:
                shift = reach * np.array([np.cos(angle), np.sin(angle), 0.0])
                trial = edits.move(scene, object_id, item.pose.move(shift))
                quad = footprint_of(trial.object(object_id))
                if bool(lie_within(quad[None], frame.outline)[0]) and not self.collisions.pairs(trial, moved_ids):
                    return Spot(trial.object(object_id).pose, edge, float(reach))
        return None

    def _first_free(
        self, scene: Scene, item: SceneObject, candidates: Candidates, cost: Float[np.ndarray, "n"]
    ) -> Spot | None:
        usable = np.flatnonzero(candidates.usable)
        order = usable[np.argsort(cost[usable], kind="stable")][:MAX_TRIED]
        for k in order:
            pose = candidates.pose(item, int(k))
            support = candidates.supports[int(k)]
            trial = edits.insert(scene, replace(item, pose=pose), support)
            if not self.collisions.pairs(trial, [item.id]):
                return Spot(pose, support, float(cost[k]))
        return None


def new_object(scene: Scene, shape: Shape, kind: str) -> SceneObject:
    """A shape as an object that a scene has not yet, with an id of a kind and a label of its own; it has no place."""
    label = f"{shape.category} {sum(o.category == shape.category for o in scene.objects) + 1}"
    nowhere = Pose.upright(np.zeros(3))
    return SceneObject(edits.fresh_id(scene, kind), label, shape.category, shape.id, shape.size_m, nowhere)


def _without(scene: Scene, item: SceneObject) -> Scene:
    removed_ids = {item.id, *(descendants(scene, item.id) if scene.has_object(item.id) else ())}
    return replace(
        scene,
        objects=tuple(o for o in scene.objects if o.id not in removed_ids),
        supports=tuple(s for s in scene.supports if s.child not in removed_ids),
    )
