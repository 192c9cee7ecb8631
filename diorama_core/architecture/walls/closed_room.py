"""From a chain of walls and the ceilings to bounded planes that meet: floor outline, wall tops, ceiling pieces."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from jaxtyping import Float
from scipy.spatial import ConvexHull, QhullError

from diorama_core.architecture.walls.ceilings import CeilingPiece
from diorama_core.architecture.walls.openings import WallOpening, with_openings
from diorama_core.architecture.walls.settings import SETTINGS, WallSettings
from diorama_core.architecture.walls.wall_sequence import WallPiece
from diorama_core.geometry.planes import clip_polygon
from diorama_core.scene.types import Camera, Plane

GUESS_CONFIDENCE = 0.15


def room_planes(
    pieces: tuple[WallPiece, ...],
    ceilings: tuple[CeilingPiece, ...],
    camera: Camera,
    top_m: float,
    floor_confidence: float,
    openings: tuple[tuple[WallOpening, ...], ...] = (),
    settings: WallSettings = SETTINGS,
) -> tuple[Plane, ...]:
    """Floor, walls and ceilings as planes that share their corners.

    Args:
        pieces: The walls, from left to right.
        ceilings: What bounds the room from above.
        camera: The photo's.
        top_m: Where walls end under no ceiling.
        floor_confidence: Of the floor.
        openings: Doorways and windows of each wall.
    """
    ground = floor_outline(pieces, camera, settings)
    base = np.concatenate([ground, np.zeros((len(ground), 1))], axis=1)
    planes = [Plane("floor", "floor", base, confidence=floor_confidence)]
    bounds = _bounds(ceilings, top_m)
    for piece, cut in zip(pieces, openings or ((),) * len(pieces), strict=True):
        polygon = wall_polygon(piece, bounds, settings)
        if len(polygon) >= 3:
            polygon = with_openings(polygon, cut)
            sure = GUESS_CONFIDENCE if piece.candidate is None else max(0.3, 0.95 - piece.candidate.seen_through)
            planes.append(Plane(f"wall_{len(planes)}", "wall", polygon, confidence=sure))
    polygons = [p for p in (_ceiling_polygon(c, ceilings, bounds, base) for c in ceilings) if len(p) >= 3]
    for number, polygon in enumerate(polygons, 1):
        name = "ceiling" if len(polygons) == 1 else f"ceiling_{number}"
        planes.append(Plane(name, "ceiling", polygon, confidence=settings.seen_confidence))
    return tuple(planes)


def _bounds(ceilings: tuple[CeilingPiece, ...], top_m: float) -> tuple[CeilingPiece, ...]:
    """The ceilings, and a height at which walls end where those leave the room open above."""
    if any(c.is_flat for c in ceilings) or _facing_each_other(ceilings):
        return ceilings
    return (*ceilings, CeilingPiece(np.array([0.0, 0.0, -1.0]), -top_m, 0.0))


def _facing_each_other(ceilings: tuple[CeilingPiece, ...]) -> bool:
    return any(float(a.normal[:2] @ b.normal[:2]) < -0.05 for a in ceilings for b in ceilings)


def wall_polygon(
    piece: WallPiece, bounds: tuple[CeilingPiece, ...], settings: WallSettings
) -> Float[np.ndarray, "n 3"]:
    """A wall from the floor up to the lowest ceiling above it; empty where that is below the floor."""
    (ax, ay), (bx, by) = piece.start, piece.end
    polygon = np.array(
        [[ax, ay, 0.0], [bx, by, 0.0], [bx, by, settings.highest_room_m], [ax, ay, settings.highest_room_m]]
    )
    for bound in bounds:
        polygon = clip_polygon(polygon, bound.normal, bound.offset)
        if len(polygon) < 3:
            return polygon
    return _without_doubles(polygon)


def _ceiling_polygon(
    piece: CeilingPiece,
    ceilings: tuple[CeilingPiece, ...],
    bounds: tuple[CeilingPiece, ...],
    base: Float[np.ndarray, "n 3"],
) -> Float[np.ndarray, "m 3"]:
    """The part of the floor's outline lifted to a ceiling that no other one cuts off."""
    outline = base[::-1].copy()
    outline[:, 2] = (piece.offset - outline[:, :2] @ piece.normal[:2]) / piece.normal[2]
    for other in bounds:
        if other is not piece and len(outline) >= 3:
            outline = clip_polygon(outline, other.normal, other.offset)
    ground = np.array([0.0, 0.0, 1.0])
    return _without_doubles(clip_polygon(outline, ground, 0.0)) if len(outline) >= 3 else outline


def _without_doubles(polygon: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "m 3"]:
    apart = np.linalg.norm(polygon - np.roll(polygon, 1, axis=0), axis=1) > 1e-6
    return polygon[apart]


def floor_outline(pieces: tuple[WallPiece, ...], camera: Camera, settings: WallSettings) -> Float[np.ndarray, "n 2"]:
    """Outline of the floor, counter-clockwise: the walls' feet, then back behind the camera."""
    chain = [pieces[0].start]
    for piece in pieces:
        chain += [piece.start, piece.end]
    x, y = camera.position[:2]
    behind = min(y - settings.behind_camera_m, *(float(p[1]) for p in (chain[0], chain[-1])))
    right = max(float(chain[-1][0]), x + settings.beside_camera_m)
    left = min(float(chain[0][0]), x - settings.beside_camera_m)
    corners = _distinct([*chain, np.array([right, behind]), np.array([left, behind])])
    outline = np.array(corners)[::-1]
    if is_simple(outline):
        return outline
    seen = tuple(p for p in pieces if p.candidate is not None)
    # Assumed pieces may cross each other behind narrow walls; without them the outline is cut short there.
    return floor_outline(seen, camera, settings) if 0 < len(seen) < len(pieces) else _hull(outline)


def _distinct(points: list[Float[np.ndarray, "2"]]) -> list[Float[np.ndarray, "2"]]:
    corners = [points[0]]
    for point in points[1:]:
        if min(float(np.linalg.norm(point - k)) for k in (corners[-1], corners[0])) > 1e-6:
            corners.append(point)
    return corners


def is_simple(outline: Float[np.ndarray, "n 2"]) -> bool:
    """Whether an outline is counter-clockwise and none of its edges crosses another."""
    after = np.roll(outline, -1, axis=0)
    if len(outline) < 3 or float((outline[:, 0] * after[:, 1] - after[:, 0] * outline[:, 1]).sum()) <= 1e-6:
        return False
    edges = list(pairwise([*outline, outline[0]]))
    for i, (a, b) in enumerate(edges):
        for j, (c, d) in enumerate(edges):
            apart = (i - j) % len(edges) not in (0, 1, len(edges) - 1)
            if apart and _crosses(a, b, c, d):
                return False
    return True


def _crosses(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> bool:
    def side(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> float:
        return float((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]))

    return side(a, b, c) * side(a, b, d) < -1e-12 and side(c, d, a) * side(c, d, b) < -1e-12


def _hull(points: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, "m 2"]:
    try:
        return points[ConvexHull(points).vertices]
    except QhullError:
        low, high = points.min(axis=0) - 0.1, points.max(axis=0) + 0.1
        return np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
