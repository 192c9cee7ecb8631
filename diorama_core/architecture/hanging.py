"""Things that hang on a wall, brought to it along their lines of sight once the wall is known."""

from __future__ import annotations

from dataclasses import replace

from diorama_core.artefacts import ArchitectureEstimate, Cuboid, ObjectGeometry
from diorama_core.scene.types import Camera, Plane

MIN_SCALE, MAX_SCALE = 0.7, 1.4
"""An object is not made smaller or larger than this to reach its wall; the rest of the way is left to layout."""


def hung_on_walls(geometry: ObjectGeometry, room: ArchitectureEstimate) -> ObjectGeometry:
    """The same objects, with those mounted on a wall moved to touch it.

    A cuboid is scaled about the camera, so that it looks the same in the photo, but never below the floor.
    """
    planes = {p.id: p for p in room.architecture.by_role("wall")}
    wall_of = {s.child: planes[s.parent] for s in room.supports if s.relation == "mounted on" and s.parent in planes}
    cuboids = tuple(
        _brought_to(c, wall_of[c.object_id], geometry.camera) if c.object_id in wall_of else c for c in geometry.cuboids
    )
    return replace(geometry, cuboids=cuboids)


def _brought_to(cuboid: Cuboid, wall: Plane, camera: Camera) -> Cuboid:
    eye = camera.position
    nearest = float(((cuboid.corners_world - eye) @ wall.normal).min())
    if nearest > -1e-6:
        return cuboid
    scale = (wall.offset - float(eye @ wall.normal)) / nearest
    drop = float(eye[2] - cuboid.corners_world[:, 2].min())
    above_floor = max(1.0, float(eye[2]) / drop) if drop > 1e-6 else MAX_SCALE
    scale = min(max(scale, MIN_SCALE), MAX_SCALE, above_floor)
    return replace(cuboid, centre=eye + scale * (cuboid.centre - eye), size_m=scale * cuboid.size_m)
