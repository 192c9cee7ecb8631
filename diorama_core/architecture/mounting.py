"""Moves mounted objects to their wall or ceiling along their lines of sight."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import ArchitectureEstimate, Cuboid, ObjectGeometry
from diorama_core.scene.types import Camera, Plane

MIN_SCALE, MAX_SCALE = 0.7, 1.4
"""Limit of rescaling an object to reach its wall; layout covers the rest."""
MEASURED_SCALE = 1.15
"""With measured depth, what would have to be rescaled by more was not measured on that wall, and stays where it was."""
LONGEST_CORD = 1.8
"""A lamp that does not reach the ceiling is stretched upwards to at most this multiple of its height."""
CLEAR_OF_WALL_M = 0.05


def snap_mounted_objects(geometry: ObjectGeometry, room: ArchitectureEstimate) -> ObjectGeometry:
    """Objects with those mounted on a wall or the ceiling moved to touch it."""
    return mounted_on_ceiling(mounted_on_walls(geometry, room), room)


def mounted_on_ceiling(geometry: ObjectGeometry, room: ArchitectureEstimate) -> ObjectGeometry:
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
        _drawn_up(_raised(c, level, walls, geometry.camera), level) if c.object_id in attached else c
        for c in geometry.cuboids
    )
    return replace(geometry, cuboids=cuboids)


def _raised(cuboid: Cuboid, level: float, walls: tuple[Plane, ...], camera: Camera) -> Cuboid:
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


def _drawn_up(cuboid: Cuboid, level: float) -> Cuboid:
    base, height = float(cuboid.corners_world[:, 2].min()), float(cuboid.size_m[2])
    drawn = float(np.clip(level - base, 0.5 * height, LONGEST_CORD * height))
    centre = np.array([*cuboid.centre[:2], base + drawn / 2])
    return replace(cuboid, centre=centre, size_m=np.array([*cuboid.size_m[:2], drawn]))


def mounted_on_walls(geometry: ObjectGeometry, room: ArchitectureEstimate) -> ObjectGeometry:
    """Objects with those mounted on a wall moved to touch it.

    A cuboid is scaled about the camera, so that it looks the same in the photo, but never below the floor.
    """
    planes = {p.id: p for p in room.architecture.by_role("wall")}
    wall_of = {s.child: planes[s.parent] for s in room.supports if s.relation == "mounted on" and s.parent in planes}
    most = MEASURED_SCALE if geometry.source.is_measured else np.inf
    cuboids = tuple(
        _brought_to(c, wall_of[c.object_id], geometry.camera, most) if c.object_id in wall_of else c
        for c in geometry.cuboids
    )
    return replace(geometry, cuboids=cuboids)


def _brought_to(cuboid: Cuboid, wall: Plane, camera: Camera, most: float) -> Cuboid:
    eye = camera.position
    nearest = float(((cuboid.corners_world - eye) @ wall.normal).min())
    if nearest > -1e-6:
        return cuboid
    scale = (wall.offset - float(eye @ wall.normal)) / nearest
    if not 1.0 / most <= scale <= most:
        return cuboid
    drop = float(eye[2] - cuboid.corners_world[:, 2].min())
    above_floor = max(1.0, float(eye[2]) / drop) if drop > 1e-6 else MAX_SCALE
    scale = min(max(scale, MIN_SCALE), MAX_SCALE, above_floor)
    return replace(cuboid, centre=eye + scale * (cuboid.centre - eye), size_m=scale * cuboid.size_m)
