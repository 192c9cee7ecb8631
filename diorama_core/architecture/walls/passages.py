"""Open doorways that a person or a detector pointed at: holes in the wall they lie in, and no objects of their own.

Doors and windows themselves are objects that hang on their wall, which a photo alone leaves whole. Their panes and
leaves are opaque (a pane shows a painted sky), so a hole behind one would not be seen, and it would stay where it is
when its door or window is moved, deleted or exchanged for one of another outline.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from jaxtyping import Float
from scipy.optimize import least_squares

from diorama_core.architecture.walls.openings import WallOpening
from diorama_core.architecture.walls.settings import SETTINGS, WallSettings
from diorama_core.architecture.walls.wall_sequence import WallPiece
from diorama_core.artefacts import ArchitectureEstimate, DetectedObject, ObjectGeometry
from diorama_core.scene.types import Camera

NAMES = frozenset({"doorway", "archway", "passageway", "door opening"})


def is_passage(detected: DetectedObject) -> bool:
    """Whether an object was called by a name of something that one walks through."""
    words = re.findall(r"[a-z]+", detected.label.lower().removesuffix("s"))
    return bool(NAMES & {words[-1] if words else "", " ".join(words[-2:])})


def without_openings(
    objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, room: ArchitectureEstimate
) -> tuple[tuple[DetectedObject, ...], ObjectGeometry]:
    """The objects and the geometry without what became a hole in a wall."""
    gone = set(room.openings)
    cuboids = tuple(c for c in geometry.cuboids if c.object_id not in gone)
    return tuple(o for o in objects if o.id not in gone), replace(geometry, cuboids=cuboids)


def with_passages(
    measured: tuple[tuple[WallOpening, ...], ...],
    objects: tuple[DetectedObject, ...],
    pieces: tuple[WallPiece, ...],
    camera: Camera,
    top_m: float,
    is_shut: Callable[[int, WallOpening], bool] | None = None,
    settings: WallSettings = SETTINGS,
) -> tuple[tuple[tuple[WallOpening, ...], ...], tuple[str, ...]]:
    """Each wall's openings from left to right with those that were pointed at, and the ids of the latter.

    Args:
        measured: What was seen through; where it overlaps what was pointed at, it stays as measured.
        objects: Everything pointed at; only open doorways count.
        pieces: The walls.
        camera: The photo's.
        top_m: Height of the walls.
        is_shut: Tells of a wall and a rectangle of it that it was measured to be closed.
    """
    of_wall = [list(openings) for openings in measured]
    ids = []
    for detected in objects:
        place = _opening(detected, pieces, camera, top_m, settings) if is_passage(detected) else None
        if place is None:
            continue
        wall, opening = place
        if not any(opening.left < other.right and other.left < opening.right for other in of_wall[wall]):
            if is_shut is not None and is_shut(wall, opening):
                continue
            of_wall[wall].append(opening)
        ids.append(detected.id)
    return tuple(tuple(sorted(o, key=lambda opening: opening.left)) for o in of_wall), tuple(ids)


def _opening(
    detected: DetectedObject, pieces: tuple[WallPiece, ...], camera: Camera, top_m: float, settings: WallSettings
) -> tuple[int, WallOpening] | None:
    """The wall that a box lies in, and the rectangle of it that the box surrounds."""
    x1, y1, x2, y2 = detected.box
    columns, rows = np.array([x1, x2, (x1 + x2) / 2, (x1 + x2) / 2]), np.array([(y1 + y2) / 2] * 2 + [y1, y2])
    rays = camera.rays(np.stack([columns, rows], axis=-1))
    middle = camera.rays(np.array([[(x1 + x2) / 2, (y1 + y2) / 2]]))
    nearest: tuple[float, int] | None = None
    for index, piece in enumerate(pieces):
        reach, u, v = _intersect_wall(piece, camera, middle)
        on = reach[0] > 0 and 0 < u[0] < piece.length_m and 0 < v[0] < top_m
        if on and (nearest is None or reach[0] < nearest[0]):
            nearest = float(reach[0]), index
    if nearest is None:
        return None
    piece = pieces[nearest[1]]
    reach, u, v = _intersect_wall(piece, camera, rays)
    if (reach <= 0).any():
        return None
    start = np.array([u[0], u[1], v[3], v[2]])
    left, right, bottom, top = _fit_rectangle(start, detected, piece, camera, settings)
    left, right = max(left, settings.frame_m), min(right, piece.length_m - settings.frame_m)
    bottom, top = (0.0 if bottom < settings.sill_m else bottom), min(top, top_m - settings.frame_m)
    if min(right - left, top - bottom) < settings.min_side_m or (right - left) * (top - bottom) < settings.min_area_m2:
        return None
    return nearest[1], WallOpening(left, right, bottom, top)


def _intersect_wall(
    piece: WallPiece, camera: Camera, rays: Float[np.ndarray, "n 3"]
) -> tuple[Float[np.ndarray, "n"], Float[np.ndarray, "n"], Float[np.ndarray, "n"]]:
    """Where rays meet a wall's plane: their reach (below 0 behind the camera), metres along its foot, and heights."""
    along = (piece.end - piece.start) / max(piece.length_m, 1e-9)
    across = np.array([along[1], -along[0]])
    steep = rays[:, :2] @ across
    reach = ((piece.start - camera.position[:2]) @ across) / np.where(np.abs(steep) < 1e-9, 1e-9, steep)
    points = camera.position + reach[:, None] * rays
    return reach, (points[:, :2] - piece.start) @ along, points[:, 2]


def _fit_rectangle(
    start: Float[np.ndarray, "4"], detected: DetectedObject, piece: WallPiece, camera: Camera, settings: WallSettings
) -> tuple[float, float, float, float]:
    """Left, right, bottom and top of the rectangle whose picture the box surrounds.

    Edges seen aslant run through the photo at an angle, so a box's sides are touched by corners only.
    """
    along = np.array([*(piece.end - piece.start) / piece.length_m, 0.0])
    foot = np.array([*piece.start, 0.0])

    def misfit(edges: Float[np.ndarray, "4"]) -> Float[np.ndarray, "4"]:
        corners = np.array([foot + u * along + [0, 0, v] for u in edges[:2] for v in edges[2:]])
        pixels = camera.project(corners)
        return np.concatenate([pixels.min(axis=0), pixels.max(axis=0)]) - np.array(detected.box)

    found_edges = least_squares(misfit, start, max_nfev=30).x
    # A box that no upright rectangle of this wall fills is read along its middle lines.
    largest = settings.max_misfit_px * max(camera.intrinsics.width, camera.intrinsics.height)
    edges = found_edges if np.abs(misfit(found_edges)).max() < largest else start
    left, right, bottom, top = (float(e) for e in edges)
    return left, right, bottom, top
