"""A room to begin with: four walls of given lengths, a floor and a ceiling."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_core.errors import EditRefused
from diorama_core.scene.types import Architecture, Plane, PlaneRole, Scene, SurfaceFinish

SHORTEST_M, LONGEST_M = 1.0, 30.0
LOWEST_M, HIGHEST_M = 1.8, 10.0
FLOOR = SurfaceFinish("boards", (0.70, 0.54, 0.37))
WALLS = SurfaceFinish("paint", (0.93, 0.92, 0.89))
CEILING_COLOUR = (0.96, 0.96, 0.95)


def empty_room(width_m: float, depth_m: float, height_m: float) -> Scene:
    """A rectangular room on a boarded floor with painted walls; the origin is in the middle of the floor.

    Walls are numbered as one sees them from the middle: `wall_1` is far (+y), then right, near and left.

    Args:
        width_m: along x.
        depth_m: along y.
        height_m: of the ceiling above the floor.

    Raises:
        EditRefused: a length is no room's.
    """
    for name, length, low, high in (
        ("width", width_m, SHORTEST_M, LONGEST_M),
        ("depth", depth_m, SHORTEST_M, LONGEST_M),
        ("height", height_m, LOWEST_M, HIGHEST_M),
    ):
        if not low <= length <= high:
            raise EditRefused(f"a room cannot have a {name} of {length:g} m; give {low:g} to {high:g} m")
    x, y = width_m / 2, depth_m / 2
    return Scene(architecture=room_of_outline(np.array([[x, y], [-x, y], [-x, -y], [x, -y]]), height_m))


def room_of_outline(outline: Float[np.ndarray, "n 2"], height_m: float, floor_m: float = 0.0) -> Architecture:
    """A boarded floor, painted walls and a ceiling over an outline.

    Walls are numbered as one sees them from the middle, turning to the right from the outline's first side.

    Args:
        outline: Corners of the floor (world x and y), counter-clockwise seen from above.
        height_m: Of the ceiling above the floor.
        floor_m: z of the floor.
    """
    floor = np.column_stack([outline, np.full(len(outline), floor_m)])
    up = np.array([0.0, 0.0, height_m])
    sides = list(zip(floor, np.roll(floor, -1, axis=0), strict=True))
    walls = (
        _finished(f"wall_{n}", "wall", np.stack([b, a, a + up, b + up]), WALLS)
        for n, (a, b) in enumerate((sides[0], *sides[:0:-1]), start=1)
    )
    ceiling = Plane("ceiling", "ceiling", (floor + up)[::-1], colour=CEILING_COLOUR)
    return Architecture((_finished("floor", "floor", floor, FLOOR), *walls, ceiling))


def _finished(plane_id: str, role: PlaneRole, polygon: np.ndarray, finish: SurfaceFinish) -> Plane:
    return Plane(plane_id, role, polygon, colour=finish.colour, finish=finish, photo_colour=Plane.colour)
