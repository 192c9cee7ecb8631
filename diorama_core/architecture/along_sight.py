"""Objects moved along their lines of sight: mounted ones to their wall or ceiling, and those whose lower ends are not
seen before the walls behind them.

Where something hides an object's foot, its size alone tells how far away it is, and that not well; a wall that is seen
says how far it can be at most. The object stays what the picture shows: it becomes nearer and smaller about the camera,
and reaches down to the floor behind what hides it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import ArchitectureEstimate, Cuboid, ObjectGeometry
from diorama_core.scene.types import Camera, Plane, Support

MIN_SCALE, MAX_SCALE = 0.7, 1.4
"""Limit of rescaling an object to reach its wall; layout covers the rest."""
MEASURED_SCALE = 1.15
"""With measured depth, what would have to be rescaled by more was not measured on that wall, and stays where it was."""
LONGEST_CORD = 1.8
"""A lamp that does not reach the ceiling is stretched upwards to at most this multiple of its height."""
CLEAR_OF_WALL_M = 0.05


def snap_mounted_objects(geometry: ObjectGeometry, room: ArchitectureEstimate) -> ObjectGeometry:
    """Objects with those mounted on a wall or the ceiling moved to touch it."""
    return snap_to_ceiling(snap_to_walls(geometry, room), room)


def snap_to_ceiling(geometry: ObjectGeometry, room: ArchitectureEstimate) -> ObjectGeometry:
    """Objects with those mounted on the ceiling moved to touch it.

    A cuboid is scaled about the camera as far as the walls leave room; a cord bridges what is left.
    """
    ceilings = {p.id: p for p in room.architecture.by_role("ceiling")}
    attached = {s.child for s in room.supports if s.relation == "mounted on" and s.parent in ceilings}
    if not attached:
        return geometry
    level = min(float(p.polygon[:, 2].mean()) for p in ceilings.values())
    walls = room.architecture.by_role("wall")
    cuboids = tuple(
        _extend_to_ceiling(_scale_to_ceiling(c, level, walls, geometry.camera), level) if c.object_id in attached else c
        for c in geometry.cuboids
    )
    return replace(geometry, cuboids=cuboids)


def _scale_to_ceiling(cuboid: Cuboid, level: float, walls: tuple[Plane, ...], camera: Camera) -> Cuboid:
    eye = camera.position
    top = float(cuboid.corners_world[:, 2].max() - eye[2])
    if top <= 1e-6 or level <= eye[2]:
        return cuboid
    scale = min(max((level - float(eye[2])) / top, MIN_SCALE), MAX_SCALE)
    for wall in walls:
        toward = float(((cuboid.corners_world - eye) @ wall.normal).min())
        room = wall.offset + CLEAR_OF_WALL_M - float(eye @ wall.normal)
        if toward < -1e-6 and room < 0 and ahead_of(cuboid, wall, eye):
            scale = min(scale, max(room / toward, 1.0))
    return replace(cuboid, centre=eye + scale * (cuboid.centre - eye), size_m=scale * cuboid.size_m)


def ahead_of(cuboid: Cuboid, wall: Plane, eye: Float[np.ndarray, "3"]) -> bool:
    """Whether the sight through a cuboid meets the wall, and not only the plane that it is part of."""
    sight = cuboid.centre - eye
    along = np.array([-wall.normal[1], wall.normal[0], 0.0])
    met = eye + (wall.offset - float(eye @ wall.normal)) / min(float(sight @ wall.normal), -1e-6) * sight
    ends, half = wall.polygon @ along, 0.5 * float(np.linalg.norm(cuboid.size_m[:2]))
    return bool(ends.min() - half <= met @ along <= ends.max() + half)


def _extend_to_ceiling(cuboid: Cuboid, level: float) -> Cuboid:
    base, height = float(cuboid.corners_world[:, 2].min()), float(cuboid.size_m[2])
    drawn = float(np.clip(level - base, 0.5 * height, LONGEST_CORD * height))
    centre = np.array([*cuboid.centre[:2], base + drawn / 2])
    return replace(cuboid, centre=centre, size_m=np.array([*cuboid.size_m[:2], drawn]))


def snap_to_walls(geometry: ObjectGeometry, room: ArchitectureEstimate) -> ObjectGeometry:
    """Objects with those mounted on a wall moved to touch it.

    A cuboid is scaled about the camera, so that it looks the same in the photo, and ends at the floor.
    """
    planes = {p.id: p for p in room.architecture.by_role("wall")}
    wall_of = {s.child: planes[s.parent] for s in room.supports if s.relation == "mounted on" and s.parent in planes}
    most = MEASURED_SCALE if geometry.source.is_measured else np.inf
    cuboids = tuple(
        _scale_to_wall(c, wall_of[c.object_id], geometry.camera, most) if c.object_id in wall_of else c
        for c in geometry.cuboids
    )
    return replace(geometry, cuboids=cuboids)


def _scale_to_wall(cuboid: Cuboid, wall: Plane, camera: Camera, most: float) -> Cuboid:
    eye = camera.position
    nearest = float(((cuboid.corners_world - eye) @ wall.normal).min())
    if nearest > -1e-6:
        return cuboid
    scale = (wall.offset - float(eye @ wall.normal)) / nearest
    if not 1.0 / most <= scale <= most:
        return cuboid
    scale = min(max(scale, MIN_SCALE), MAX_SCALE)
    base, height = _base(cuboid), float(eye[2])
    stands = base < REACH_M
    if not stands or base + float(cuboid.size_m[2]) < height:
        scale = min(scale, max(1.0, height / max(height - base, 1e-6)))
    brought = _nearer(cuboid, scale, camera)
    # Furniture may hide the foot of a door, but not its sides and its top, which is above the camera.
    return _down_to(brought, 0.0) if stands else brought


def _base(cuboid: Cuboid) -> float:
    return float(cuboid.corners_world[:, 2].min())


MIN_CONFIDENCE = 0.3
"""Walls that are less sure are guesses: nothing has to be before them."""
REACH_M = 0.02
"""So far behind a wall is no contradiction."""


def move_in_front_of_walls(geometry: ObjectGeometry, room: ArchitectureEstimate) -> ObjectGeometry:
    """Objects with unseen feet brought before the walls, with what they carry."""
    floors = {p.id for p in room.architecture.by_role("floor")}
    walls = tuple(w for w in room.architecture.by_role("wall") if w.confidence >= MIN_CONFIDENCE)
    standing = {s.child for s in room.supports if s.parent in floors}
    cuboids = {c.object_id: c for c in geometry.cuboids}
    for unseen in [c for c in geometry.cuboids if not c.foot_seen and c.object_id in standing]:
        factor = nearer_by(unseen, walls, geometry.camera)
        if factor < 1.0:
            cuboids[unseen.object_id] = _down_to(_nearer(unseen, factor, geometry.camera), _base(unseen))
            for child in _descendants(unseen.object_id, room.supports):
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


def _descendants(parent: str, supports: tuple[Support, ...]) -> list[str]:
    """What an object carries, and what that carries."""
    carried = [s.child for s in supports if s.parent == parent]
    return carried + [lower for child in carried for lower in _descendants(child, supports)]


def _nearer(cuboid: Cuboid, factor: float, camera: Camera) -> Cuboid:
    eye = camera.position
    return replace(cuboid, centre=eye + factor * (cuboid.centre - eye), size_m=factor * cuboid.size_m)


def _down_to(cuboid: Cuboid, base_m: float) -> Cuboid:
    """The cuboid with its top where it is and its base at a height."""
    top = cuboid.centre[2] + cuboid.size_m[2] / 2
    centre, size = cuboid.centre.copy(), cuboid.size_m.copy()
    centre[2], size[2] = (base_m + top) / 2, top - base_m
    return replace(cuboid, centre=centre, size_m=size)
