"""Doors and windows put into walls."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from jaxtyping import Float

from diorama_core.arrangement.surfaces import plane_surface
from diorama_core.editing.placing import Hit, SupportTarget, insertion
from diorama_core.editing.plan_edits import wall_feet
from diorama_core.errors import EditRefused
from diorama_core.geometry.openings import DOOR, OPENING_CATEGORIES, wall_of
from diorama_core.geometry.wall_lines import DrawnWall
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene import edits
from diorama_core.scene.types import Plane, Scene, SceneObject

SILL_M = 0.9
"""Height of a new window's lower edge above the floor."""
BEFORE_M = 0.3
"""What is nearer to a wall would stand before what is put into it, or its door would not open."""
SLACK_M = 1e-6
"""Openings that touch do not overlap: rounding."""


def with_opening(
    scene: Scene, library: ShapeLibrary, category: str, wall_id: str, at: Float[np.ndarray, "2"]
) -> tuple[Scene, str]:
    """The scene with the most usual door or window in a wall, and its id.

    Args:
        scene: the room.
        library: where its shape comes from.
        category: door or window.
        wall_id: the wall.
        at: a point of the floor (world x and y) to which it is nearest, beside other openings and, where the wall
            has room, beside what stands at it.

    Raises:
        EditRefused: there is no such wall, it is too short or full, or the library has no such shape.
    """
    foot = next((f for f in wall_feet(scene) if f.id == wall_id), None)
    shapes = library.in_category(category)
    if foot is None or not shapes:
        raise EditRefused(f"{category}s stand in walls; choose a wall" if shapes else f"the library has no {category}")
    sizes = np.array([s.size_m for s in shapes])
    shape = shapes[int(np.abs(np.log(sizes / np.median(sizes, axis=0))).sum(axis=1).argmin())]
    half, sill = shape.size_m[1] / 2, 0.0 if category == DOOR else SILL_M
    if foot.length_m < 2 * half:
        raise EditRefused(f"a {category} is {2 * half:.2f} m wide, which is more than this wall; choose a longer one")
    wall = scene.plane(wall_id)
    level = float(wall.polygon[:, 2].min()) + sill + shape.size_m[2] / 2
    in_wall = [o for o in scene.objects if o.category in OPENING_CATEGORIES and wall_of(o, (wall,), scene) is wall]
    at_wall = [
        o for o in scene.objects if _is_before(o, wall, level - shape.size_m[2] / 2, level + shape.size_m[2] / 2)
    ]
    wanted = float((at - foot.start) @ foot.direction)
    spots = (_free_spot(wanted, half, foot, taken) for taken in ((*in_wall, *at_wall), in_wall))
    along = next((spot for spot in spots if spot is not None), None)
    if along is None:
        raise EditRefused(f"no part of this wall is free for a {category} of {2 * half:.2f} m; move what is in it")
    place = SupportTarget(plane_surface(wall), wall_id, of_object=False)
    hit = Hit(place, np.append(foot.start + along * foot.direction, level), 0.0)
    new_id = edits.fresh_id(scene, category)
    item, edge = insertion(scene, shape, new_id, hit, 0.0)
    return edits.insert(scene, item, edge), new_id


def _is_before(item: SceneObject, wall: Plane, low_m: float, high_m: float) -> bool:
    """Whether something stands or hangs at a wall between two heights."""
    corners = item.corners_world
    near = float((corners @ wall.normal).min()) - wall.offset < BEFORE_M
    return near and float(corners[:, 2].min()) < high_m and float(corners[:, 2].max()) > low_m


def _free_spot(wanted: float, half: float, foot: DrawnWall, taken: Iterable[SceneObject]) -> float | None:
    """The place along a wall, nearest to the wanted one, where nothing else is within half a width; None: nowhere."""
    sides = [np.sort((o.corners_world[:, :2] - foot.start) @ foot.direction)[[0, -1]] for o in taken]
    spots = [min(max(wanted, half), foot.length_m - half), *(s for a, b in sides for s in (a - half, b + half))]
    free = [
        float(s)
        for s in spots
        if half <= s + SLACK_M
        and s <= foot.length_m - half + SLACK_M
        and all(s + half <= low + SLACK_M or s - half >= high - SLACK_M for low, high in sides)
    ]
    return min(free, key=lambda s: abs(s - wanted), default=None)
