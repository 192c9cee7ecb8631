"""Brings objects whose lower ends are not seen before the walls behind them, along their lines of sight.

Where something hides an object's foot, its size alone tells how far away it is, and that not well; a wall that is seen
says how far it can be at most. The object stays what the picture shows: it becomes nearer and smaller about the camera,
and reaches down to the floor behind what hides it.
"""

from __future__ import annotations

from dataclasses import replace

from diorama_core.architecture.mounting import MIN_SCALE, ahead_of
from diorama_core.artefacts import ArchitectureEstimate, Cuboid, ObjectGeometry
from diorama_core.scene.types import Camera, Plane, Support

MIN_CONFIDENCE = 0.3
"""Walls that are less sure are guesses: nothing has to be before them."""
REACH_M = 0.02
"""So far behind a wall is no contradiction."""


def drawn_before_walls(geometry: ObjectGeometry, room: ArchitectureEstimate) -> ObjectGeometry:
    """Objects with unseen feet brought before the walls, with what they carry.

    Args:
        geometry: Of all objects.
        room: Walls with their confidence, and supports whose parents are objects or planes.
    """
    floors = {p.id for p in room.architecture.by_role("floor")}
    walls = tuple(w for w in room.architecture.by_role("wall") if w.confidence >= MIN_CONFIDENCE)
    standing = {s.child for s in room.supports if s.parent in floors}
    cuboids = {c.object_id: c for c in geometry.cuboids}
    for unseen in [c for c in geometry.cuboids if not c.foot_seen and c.object_id in standing]:
        factor = nearer_by(unseen, walls, geometry.camera)
        if factor < 1.0:
            cuboids[unseen.object_id] = _down_to(_nearer(unseen, factor, geometry.camera), unseen)
            for child in _carried_by(unseen.object_id, room.supports):
                if child in cuboids:
                    cuboids[child] = _nearer(cuboids[child], factor, geometry.camera)
    return replace(geometry, cuboids=tuple(cuboids[c.object_id] for c in geometry.cuboids))


def nearer_by(cuboid: Cuboid, walls: tuple[Plane, ...], camera: Camera) -> float:
    """The factor on a cuboid's distance that brings it before the walls it reaches through, at least `MIN_SCALE`."""
    eye, factor = camera.position, 1.0
    for wall in walls:
        farthest = float(((cuboid.corners_world - eye) @ wall.normal).min())
        away = wall.offset - float(eye @ wall.normal)
        if away < -1e-6 and farthest < away - REACH_M and ahead_of(cuboid, wall, eye):
            factor = min(factor, away / farthest)
    return max(factor, MIN_SCALE)


def _carried_by(parent: str, supports: tuple[Support, ...]) -> list[str]:
    """What an object carries, and what that carries."""
    carried = [s.child for s in supports if s.parent == parent]
    return carried + [lower for child in carried for lower in _carried_by(child, supports)]


def _nearer(cuboid: Cuboid, factor: float, camera: Camera) -> Cuboid:
    eye = camera.position
    return replace(cuboid, centre=eye + factor * (cuboid.centre - eye), size_m=factor * cuboid.size_m)


def _down_to(cuboid: Cuboid, before: Cuboid) -> Cuboid:
    """The cuboid extended down to where it stood before."""
    base, top = before.centre[2] - before.size_m[2] / 2, cuboid.centre[2] + cuboid.size_m[2] / 2
    centre, size = cuboid.centre.copy(), cuboid.size_m.copy()
    centre[2], size[2] = (base + top) / 2, top - base
    return replace(cuboid, centre=centre, size_m=size)
