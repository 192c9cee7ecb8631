"""The room from measured depth: floor, walls and ceiling as planes of the points, closed at their corners."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial import ConvexHull, QhullError

from diorama_core.architecture.colours import coloured, object_pixels
from diorama_core.architecture.supports import resolve_supports
from diorama_core.architecture.surface import MeasuredSurface, measured_surface
from diorama_core.architecture.wall_candidates import find_walls, tolerance_m
from diorama_core.architecture.wall_path import heading
from diorama_core.architecture.wall_sequence import BEHIND_CAMERA_M, WallPiece, outline
from diorama_core.artefacts import ArchitectureEstimate, DetectedObject, Inputs, ObjectGeometry
from diorama_core.progress import Progress
from diorama_core.scene.types import Architecture, Camera, Plane

USUAL_CEILING_M = 2.6
GUESS_CONFIDENCE = 0.15
MIN_FLAT_SHARE = 0.004
"""Floor or ceiling count as seen when this share of the measured points lies on them."""
MAX_FLOOR_REACH_M = 8.0


@dataclass(frozen=True)
class PlanarRoom:
    """PlainRecon (Diorama, section 3.1) on measured points, with walls checked by visibility.

    Directions that much vertical surface shares give parallel wall candidates; a candidate through which farther
    things are measured is furniture and dropped. The walls that lead in each heading form a chain whose neighbours
    meet in corners or are joined by hidden pieces.
    """

    def reconstruct(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> ArchitectureEstimate:
        """Floor always, at least one wall always, ceiling where it is measured.

        Raises:
            ValueError: when the inputs hold no measured depth.
        """
        if inputs.depth_m is None:
            raise ValueError("PlanarRoom needs measured depth; use RoomBox for a photo alone")
        progress.report(0.0, "Looking for planes in the measured depth")
        hidden = object_pixels((inputs.photo.height, inputs.photo.width), objects)
        surface = measured_surface(inputs.depth_m, geometry.camera, hidden)
        ceiling_m = ceiling_height(surface)
        top_m = ceiling_m if ceiling_m is not None else _usual_top(surface)
        walls = find_walls(surface, top_m)
        progress.report(0.6, "Closing the room at its corners")
        pieces = outline(surface, walls, view_headings(geometry.camera), top_m)
        guessed = not pieces
        pieces = pieces or (_guessed_wall(surface, geometry.camera),)
        floor_seen = _share(surface, 0.0, 1.0) > MIN_FLAT_SHARE
        planes = _planes(
            pieces, geometry.camera, top_m, ceiling_m is not None, 0.95 if floor_seen else GUESS_CONFIDENCE
        )
        planes = coloured(planes, inputs.photo.rgb, geometry.camera, objects)
        architecture = Architecture(planes)
        progress.report(1.0, "The room is closed")
        return ArchitectureEstimate(
            architecture=architecture,
            supports=resolve_supports(geometry, architecture),
            confidence=float(np.mean([p.confidence for p in architecture.planes])),
            source=_source(len(pieces), guessed, floor_seen, ceiling_m),
        )


def ceiling_height(surface: MeasuredSurface) -> float | None:
    """Height of the highest large surface that faces down; none where there is none above the camera."""
    down = (surface.normals[:, 2] < -0.85) & (surface.points[:, 2] > max(1.7, surface.camera_position[2] + 0.2))
    if down.sum() < MIN_FLAT_SHARE * len(down) or len(down) == 0:
        return None
    heights, areas = surface.points[down, 2], surface.area_m2[down]
    index = (heights / 0.05).astype(int)
    histogram = np.convolve(np.bincount(index, weights=areas), np.ones(3), mode="same")
    strong = np.flatnonzero(histogram > 0.4 * histogram.max())
    centre = (strong.max() + 0.5) * 0.05
    core = np.abs(heights - centre) < 0.1
    return float(np.average(heights[core], weights=areas[core])) if core.any() else None


def _usual_top(surface: MeasuredSurface) -> float:
    """Where walls end when no ceiling is seen: the usual height, or above everything measured."""
    return max(USUAL_CEILING_M, float(np.quantile(surface.points[:, 2], 0.99)) + 0.05 if len(surface.points) else 0.0)


def _share(surface: MeasuredSurface, height_m: float, facing: float) -> float:
    """Share of the points on a horizontal plane that faces up (1) or down (-1)."""
    if len(surface.points) == 0:
        return 0.0
    near = np.abs(surface.points[:, 2] - height_m) < 0.05 + tolerance_m(surface.depth_m)
    return float((near & (surface.normals[:, 2] * facing > 0.85)).mean())


def view_headings(camera: Camera) -> tuple[float, float]:
    """Headings of the left and right side of the picture, where it looks about level."""
    k = camera.intrinsics
    rows = np.linspace(0, k.height, 9)
    sides = []
    for column in (0.0, float(k.width)):
        rays = camera.rays(np.stack([np.full_like(rows, column), rows], axis=-1))
        level = np.linalg.norm(rays[:, :2], axis=1) > 0.5 * np.linalg.norm(rays, axis=1)
        rays = rays[level] if level.any() else rays[:1]
        sides.append(heading(rays[:, :2], np.zeros(2)))
    return float(sides[0].min()), float(max(sides[1].max(), sides[0].min() + 0.1))


def _guessed_wall(surface: MeasuredSurface, camera: Camera) -> WallPiece:
    """A wall behind everything measured, square to the room axis that the camera faces."""
    origin = camera.position[:2]
    reach = surface.points[:, 1] - origin[1]
    y = origin[1] + (max(float(np.quantile(reach, 0.98)) + 0.05, 1.0) if len(reach) else 3.5)
    left, right = view_headings(camera)
    span = (y - origin[1]) * np.tan(np.clip([left, right], -1.2, 1.2))
    return WallPiece(np.array([origin[0] + span[0] - 0.3, y]), np.array([origin[0] + span[1] + 0.3, y]), None)


def _planes(
    pieces: tuple[WallPiece, ...], camera: Camera, top_m: float, with_ceiling: bool, floor_confidence: float
) -> tuple[Plane, ...]:
    ground = floor_outline(pieces, camera)
    base = np.concatenate([ground, np.zeros((len(ground), 1))], axis=1)
    planes = [Plane("floor", "floor", base, confidence=floor_confidence)]
    for number, piece in enumerate(pieces, 1):
        a, b = piece.start, piece.end
        corners = np.array([[*a, 0.0], [*b, 0.0], [*b, top_m], [*a, top_m]])
        sure = GUESS_CONFIDENCE if piece.candidate is None else max(0.3, 0.95 - piece.candidate.seen_through)
        planes.append(Plane(f"wall_{number}", "wall", corners, confidence=sure))
    if with_ceiling:
        planes.append(Plane("ceiling", "ceiling", base[::-1] + np.array([0.0, 0.0, top_m]), confidence=0.9))
    return tuple(planes)


def floor_outline(pieces: tuple[WallPiece, ...], camera: Camera) -> Float[np.ndarray, "n 2"]:
    """Convex outline of the floor, counter-clockwise: the walls' feet, the picture's lower corners, the camera."""
    feet = [p for piece in pieces for p in (piece.start, piece.end)]
    k, origin = camera.intrinsics, camera.position
    rays = camera.rays(np.array([[0.0, k.height], [k.width, k.height], [k.width / 2, k.height]]))
    nearest_wall_m = min(float(np.linalg.norm(p - origin[:2])) for p in feet)
    for ray in rays[rays[:, 2] < -1e-6]:
        hit = origin - ray * (origin[2] / ray[2])
        if np.linalg.norm(hit[:2] - origin[:2]) < min(max(nearest_wall_m, 1.0), MAX_FLOOR_REACH_M):
            feet.append(hit[:2])
    feet += [origin[:2] + np.array([side, -BEHIND_CAMERA_M]) for side in (-0.5, 0.5)]
    points = np.array(feet)
    try:
        return points[ConvexHull(points).vertices]
    except QhullError:
        low, high = points.min(axis=0) - 0.1, points.max(axis=0) + 0.1
        return np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])


def _source(count: int, guessed: bool, floor_seen: bool, ceiling_m: float | None) -> str:
    walls = "no wall was measured; one is assumed behind everything seen" if guessed else f"{count} walls"
    floor = "floor measured" if floor_seen else "floor not seen, its height assumed"
    ceiling = f"ceiling at {ceiling_m:.2f} m" if ceiling_m is not None else "ceiling not seen"
    return f"planes of the measured depth: {floor}, {walls}, {ceiling}"
