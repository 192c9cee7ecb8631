"""The room from measured depth: floor, walls and ceiling fitted to the points and closed at their corners."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diorama_core.architecture.supports import resolve_supports
from diorama_core.architecture.texture.colours import colour_planes, object_pixels
from diorama_core.architecture.walls.ceilings import CeilingPiece, find_ceilings
from diorama_core.architecture.walls.closed_room import GUESS_CONFIDENCE, room_planes
from diorama_core.architecture.walls.openings import WallOpening, counts, find_openings, is_shut
from diorama_core.architecture.walls.passages import is_passage, with_passages
from diorama_core.architecture.walls.settings import SETTINGS, WallSettings
from diorama_core.architecture.walls.surface import MeasuredSurface, measure_surface
from diorama_core.architecture.walls.wall_candidates import find_walls, tolerance_m
from diorama_core.architecture.walls.wall_path import heading
from diorama_core.architecture.walls.wall_sequence import WallPiece, outline
from diorama_core.artefacts import ArchitectureEstimate, DetectedObject, Inputs, ObjectGeometry
from diorama_core.geometry.openings import DOOR
from diorama_core.progress import Progress
from diorama_core.provenance import RoomMethod, RoomSource
from diorama_core.scene.types import Architecture, Camera


@dataclass(frozen=True)
class PlanarRoom:
    """PlainRecon (Diorama, section 3.1) on measured points, with walls checked by visibility.

    Directions that much vertical surface shares give parallel wall candidates; a candidate through which farther
    objects are measured is furniture and dropped. The walls that lead in each heading form a chain whose neighbours
    meet in corners or are joined by hidden pieces.
    """

    settings: WallSettings = SETTINGS

    def reconstruct(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> ArchitectureEstimate:
        """Floor always, at least one wall always, ceiling where it is measured.

        Args:
            inputs, objects, geometry, progress: as documented in `protocols.ArchitectureStage`.

        Raises:
            ValueError: when the inputs hold no measured depth.
        """
        if inputs.depth_m is None:
            raise ValueError("PlanarRoom needs measured depth; use PhotoRoom for a photo alone")
        progress.report(0.0, "Looking for planes in the measured depth")
        # A door shows where its wall is, also where nothing else of that is seen.
        solid = tuple(o for o in objects if not is_passage(o) and o.category != DOOR)
        hidden = object_pixels((inputs.photo.height, inputs.photo.width), solid)
        surface = measure_surface(inputs.depth_m, geometry.camera, hidden, self.settings)
        ceilings = find_ceilings(surface)
        top_m = _top(surface, ceilings, self.settings)
        walls = find_walls(surface, top_m)
        progress.report(0.6, "Closing the room at its corners")
        pieces = outline(surface, walls, view_headings(geometry.camera), top_m, self.settings)
        pieces = pieces or (_guess_wall(surface, geometry.camera),)
        floor_seen = _floor_share(surface) > self.settings.min_flat_share
        openings: tuple[tuple[WallOpening, ...], ...] = ((),) * len(pieces)
        pointed: tuple[str, ...] = ()
        if all(c.is_flat for c in ceilings):
            measured = tuple(find_openings(surface, p, top_m, self.settings) for p in pieces)
            openings, pointed = with_passages(
                measured,
                objects,
                pieces,
                geometry.camera,
                top_m,
                lambda wall, opening: is_shut(surface, pieces[wall], opening, top_m, self.settings),
                self.settings,
            )
        sure = 0.95 if floor_seen else GUESS_CONFIDENCE
        planes = room_planes(pieces, ceilings, geometry.camera, top_m, sure, openings, self.settings)
        planes = colour_planes(planes, inputs.photo.rgb, geometry.camera, objects)
        architecture = Architecture(planes)
        progress.report(1.0, "The room is closed")
        return ArchitectureEstimate(
            architecture=architecture,
            supports=resolve_supports(geometry, architecture),
            confidence=float(np.mean([p.confidence for p in architecture.planes])),
            source=_source(pieces, floor_seen, top_m, ceilings, openings),
            openings=pointed,
        )


def _top(surface: MeasuredSurface, ceilings: tuple[CeilingPiece, ...], settings: WallSettings) -> float:
    """Top of the walls: the flat ceiling, else the usual height or above all measured points."""
    flat = [-c.offset for c in ceilings if c.is_flat]
    seen = float(np.quantile(surface.points[:, 2], 0.99)) + 0.05 if len(surface.points) else 0.0
    return flat[0] if flat else max(settings.usual_ceiling_m, seen)


def _floor_share(surface: MeasuredSurface) -> float:
    """Share of the points on the floor."""
    near = np.abs(surface.points[:, 2]) < 0.05 + tolerance_m(surface.depth_m)
    return float((near & (surface.normals[:, 2] > 0.85)).mean()) if len(near) else 0.0


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


def _guess_wall(surface: MeasuredSurface, camera: Camera) -> WallPiece:
    """A wall behind all measured points, perpendicular to the room axis that the camera faces."""
    origin = camera.position[:2]
    reach = surface.points[:, 1] - origin[1]
    y = origin[1] + (max(float(np.quantile(reach, 0.98)) + 0.05, 1.0) if len(reach) else 3.5)
    left, right = view_headings(camera)
    span = (y - origin[1]) * np.tan(np.clip([left, right], -1.2, 1.2))
    return WallPiece(np.array([origin[0] + span[0] - 0.3, y]), np.array([origin[0] + span[1] + 0.3, y]), None)


def _source(
    pieces: tuple[WallPiece, ...],
    floor_seen: bool,
    top_m: float,
    ceilings: tuple[CeilingPiece, ...],
    openings: tuple[tuple[WallOpening, ...], ...],
) -> RoomSource:
    seen = sum(p.candidate is not None for p in pieces)
    doorways, windows = counts(openings)
    return RoomSource(
        RoomMethod.DEPTH_PLANES,
        walls_found=seen,
        walls_assumed=len(pieces) - seen,
        floor_found=floor_seen,
        wall_height_m=float(top_m),
        ceilings_m=tuple(-float(c.offset) for c in ceilings if c.is_flat),
        sloped_ceilings=sum(not c.is_flat for c in ceilings),
        doorways=doorways,
        windows=windows,
    )
