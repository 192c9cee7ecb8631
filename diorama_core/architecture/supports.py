"""Resolves the supporting plane of each object, and the walls it stands against."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.artefacts import Cuboid, ObjectGeometry
from diorama_core.scene.types import Architecture, Plane, Support

ADHERENCE_M = 0.25
"""A floor object whose back is nearer than this to a wall stands against it."""
PARALLEL_COSINE = 0.94
"""Roughly parallel: within 20 degrees."""


def resolve_supports(geometry: ObjectGeometry, architecture: Architecture) -> tuple[Support, ...]:
    """The support edges with "floor", "wall" and "ceiling" replaced by plane ids, and adherence to walls added.

    An object without an edge is put on the floor. "ceiling" needs a ceiling plane; without one the edge goes to the
    nearest wall, else to the floor.
    """
    edges = {s.child: s for s in geometry.supports}
    return tuple(
        _resolve(edges.get(c.object_id, Support(c.object_id, "floor")), c, architecture) for c in geometry.cuboids
    )


def _resolve(edge: Support, cuboid: Cuboid, architecture: Architecture) -> Support:
    walls, floor = architecture.by_role("wall"), architecture.floor
    ceilings = architecture.by_role("ceiling")
    if edge.parent == "ceiling" and ceilings:
        return replace(edge, parent=ceilings[0].id)
    if edge.parent in ("wall", "ceiling") and walls:
        return replace(edge, parent=nearest_wall(cuboid, walls).id, relation="mounted on")
    if edge.parent in ("floor", "wall", "ceiling") and floor is not None:
        return replace(edge, parent=floor.id, relation="placed on", adheres_to=adhering_walls(cuboid, walls))
    return edge


def nearest_wall(cuboid: Cuboid, walls: tuple[Plane, ...]) -> Plane:
    """The wall that fits an object hung on it best: near, parallel to a face, and behind the object."""

    def misfit(wall: Plane) -> float:
        gap = abs(float((cuboid.corners_world @ wall.normal).min()) - wall.offset)
        aslant = 1.0 - float(np.abs(cuboid.R_world_object[:, :2].T @ wall.normal).max())
        along = np.cross([0.0, 0.0, 1.0], wall.normal)
        reach, spread = cuboid.centre @ along, wall.polygon @ along
        beside = max(spread.min() - reach, reach - spread.max(), 0.0)
        return gap + 2.0 * aslant + beside + _thin_side_mismatch(cuboid, wall)

    return min(walls, key=misfit)


def _thin_side_mismatch(cuboid: Cuboid, wall: Plane) -> float:
    """A flat object hangs with its thin side along the wall's normal."""
    across, along = cuboid.size_m[:2]
    thin_axis = 0 if across <= along else 1
    flatness = 1.0 - min(across, along) / max(across, along)
    return float(flatness * (1.0 - abs(cuboid.R_world_object[:, thin_axis] @ wall.normal)))


def adhering_walls(cuboid: Cuboid, walls: tuple[Plane, ...]) -> tuple[str, ...]:
    """Walls that a face of the object nearly touches, nearest first; the back face only, where it is known."""
    axes = cuboid.R_world_object
    faces = [-axes[:, 0]] if cuboid.front_known else [sign * axes[:, i] for i in (0, 1) for sign in (1.0, -1.0)]
    walls_by_gap: list[tuple[float, str]] = []
    for wall in walls:
        if min(float(face @ wall.normal) for face in faces) > -PARALLEL_COSINE:
            continue
        gap = float((cuboid.corners_world @ wall.normal).min()) - wall.offset
        along = np.cross([0.0, 0.0, 1.0], wall.normal)
        spread = wall.polygon @ along
        beside = not spread.min() <= cuboid.centre @ along <= spread.max()
        if abs(gap) <= ADHERENCE_M and not beside:
            walls_by_gap.append((abs(gap), wall.id))
    return tuple(wall_id for _, wall_id in sorted(walls_by_gap))
