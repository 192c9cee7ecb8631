"""What the benchmark's rooms and pictures are like: valid, varied, and worth looking at."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import Scene, Support
from diorama_core.synthesis.bodies import LIFT_M, Item, PlacedBodies
from diorama_core.synthesis.truth import TruthView

MIN_FLOOR = 0.02
"""A picture with less floor than this says little about where objects stand."""
LARGEST_SHARE = 0.6
"""An object that fills more of the picture than this hides the room."""
NEAR_M = 0.6
NEAR_SHARE = 0.15
"""A picture with more than this nearer than `NEAR_M` was taken with the nose against something."""


@dataclass(frozen=True)
class RoomSurvey:
    """One room."""

    name: str
    outline: str
    """"4 walls", "6 walls", "5 walls" or "attic"."""
    objects: int
    depth: int
    """Longest chain of objects that stand on one another, the room itself not counted."""
    collisions: tuple[tuple[str, str], ...]
    """Pairs whose meshes cut each other."""
    outside: tuple[str, ...]
    """Objects that reach through floor, walls or ceiling."""


@dataclass(frozen=True)
class ViewSurvey:
    """One picture."""

    name: str
    asked: int
    """Objects that are asked for."""
    floor: float
    """Share of the picture that shows bare floor (or a rug)."""
    largest: float
    """Share of the object that fills most of it."""
    near: float
    """Share that is nearer than `NEAR_M`."""
    walls: int
    """Walls seen in at least a hundredth of the empty room's picture."""

    def faults(self, min_asked: int) -> tuple[str, ...]:
        """Why it is not a picture that people would take; empty when it is."""
        return tuple(
            fault
            for fault, cases in (
                ("few objects", self.asked < min_asked),
                ("no floor", self.floor < MIN_FLOOR),
                ("one object fills it", self.largest > LARGEST_SHARE),
                ("too near", self.near > NEAR_SHARE),
            )
            if cases
        )


def survey_room(name: str, scene: Scene, library: ShapeLibrary) -> RoomSurvey:
    """Check one room by exact collision of its meshes and count what is in it."""
    return RoomSurvey(
        name,
        _outline(scene),
        len(scene.objects),
        max((support_depth(scene, o.id) for o in scene.objects), default=0),
        colliding_pairs(scene, library),
        tuple(o.id for o in scene.objects if _leaves_room(scene, library, o.id)),
    )


def survey_view(name: str, view: TruthView) -> ViewSurvey:
    """What one picture shows."""
    assert view.inputs.depth_m is not None
    roles = [p.role for p in view.scene.architecture.planes]
    rugs = [k for k, o in enumerate(view.scene.objects) if o.category == "rug"]
    ids, planes = view.object_ids, view.plane_ids
    floors = np.isin(planes, [k for k, role in enumerate(roles) if role == "floor"])
    pixels = np.bincount(ids[ids >= 0], minlength=1)
    pixels[[k for k in rugs if k < len(pixels)]] = 0
    walls = [(view.room_plane_ids == k).mean() for k, role in enumerate(roles) if role == "wall"]
    return ViewSurvey(
        name,
        len(view.indices),
        float((floors | np.isin(ids, rugs)).mean()),
        float(pixels.max() / ids.size),
        float((view.inputs.depth_m < NEAR_M).mean()),
        sum(bool(share >= 0.01) for share in walls),
    )


def support_depth(scene: Scene, object_id: str) -> int:
    """1 for what stands on or hangs from the room, 2 for what stands on that, and so on."""
    depth, edge = 1, scene.support_of(object_id)
    while edge is not None and scene.has_object(edge.parent):
        depth, edge = depth + 1, scene.support_of(edge.parent)
    return depth


def colliding_pairs(scene: Scene, library: ShapeLibrary) -> tuple[tuple[str, str], ...]:
    """Pairs of objects whose meshes cut each other, each a millimetre off what carries it; rugs lie under all."""
    bodies, pairs = PlacedBodies(library), []
    rugs = {o.id for o in scene.objects if o.category == "rug"}
    for item in sorted(scene.objects, key=lambda o: support_depth(scene, o.id)):
        body = Item(library.shape(item.shape_id), tuple(item.pose.scale))
        edge = scene.support_of(item.id)
        ignored = rugs & {edge.parent} if edge else set[str]()
        while (other := bodies.hit_by(body, item.pose, ignore=ignored, lift=_off(scene, edge))) is not None:
            pairs.append((item.id, other))
            ignored = {*ignored, other}
        bodies.add(item.id, body, item.pose)
    return tuple(pairs)


def _off(scene: Scene, edge: Support | None) -> np.ndarray:
    """A millimetre away from what carries an object."""
    if edge is not None and scene.has_plane(edge.parent):
        return LIFT_M * scene.plane(edge.parent).normal
    return np.array([0.0, 0.0, LIFT_M])


def _outline(scene: Scene) -> str:
    if len(scene.architecture.by_role("ceiling")) > 1:
        return "attic"
    return f"{len(scene.architecture.by_role('wall'))} walls"


def _leaves_room(scene: Scene, library: ShapeLibrary, object_id: str) -> bool:
    """True if a vertex lies more than a millimetre outside floor, ceiling, or the walls of a convex room.

    A concave room's walls are checked from their own side only where the foot of the vertex is on the wall.
    """
    item = scene.object(object_id)
    points = item.pose.apply(np.asarray(library.mesh(item.shape_id).vertices))
    walls = scene.architecture.by_role("wall")
    planes = [*scene.architecture.by_role("floor"), *scene.architecture.by_role("ceiling")]
    convex = all((p.normal @ w.centre - p.offset > -1e-6) for p in walls for w in walls)
    planes += list(walls) if convex else []
    return any(bool((points @ p.normal < p.offset - 1e-3).any()) for p in planes)


def count(values: Sequence[int]) -> str:
    """How often each value occurs, as "1: 20, 2: 30"."""
    return ", ".join(f"{v}: {values.count(v)}" for v in sorted(set(values)))
