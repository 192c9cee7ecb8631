"""Where a robot that drives can be in a room: the free floor for a disc, and the map of what is occupied.

The map is what ROS nav2's map server reads: a grey picture whose first row lies farthest along +y, and a text.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely
from jaxtyping import Float
from shapely.geometry import LineString, MultiPoint, Point, Polygon
from shapely.geometry.base import BaseGeometry

from diorama_core.errors import ExportError
from diorama_core.export.bodies import PhysicalScene, Points
from diorama_core.export.colliders import physical_scene, world_parts
from diorama_core.export.files import write_package
from diorama_core.export.gathering import ExportScene
from diorama_core.export.overlaps import cut
from diorama_core.progress import SILENT, Progress

LOW_M, HIGH_M = 0.05, 1.5
"""What lies lower is driven over, what hangs higher is passed under."""
DOORWAY_M = 0.3
"""Floors of two rooms that are no farther apart than a thick wall are one."""
CELL_M = 0.05
"""Resolution of the map, nav2's own default."""
MARGIN_CELLS = 10
"""Unknown cells around the room."""
OCCUPIED, FREE, UNKNOWN = 0, 254, 205
"""Grey values that nav2's mode `trinary` tells apart by its usual thresholds."""


@dataclass(frozen=True, eq=False)
class BodyOutline:
    """A convex body seen from above."""

    owner: str | None
    """Id of its object; None for the room."""
    low: float
    high: float
    points: Points
    """Its corners in the world."""

    def section_between(self, low: float, high: float) -> BaseGeometry:
        """Floor that it covers between two heights of the world; empty where it is not there."""
        part: Points | None = self.points
        for normal, level in ((np.array([0.0, 0.0, 1.0]), low), (np.array([0.0, 0.0, -1.0]), -high)):
            part = None if part is None else cut(part, normal, level, np.inf)
        return Polygon() if part is None else MultiPoint(part[:, :2]).convex_hull


def outlines(physical: PhysicalScene) -> tuple[BodyOutline, ...]:
    """All convex bodies but the floor, those that joints move as they stand."""
    ceilings_and_walls = [(None, p) for s in physical.slabs if s.plane.role != "floor" for p in s.pieces]
    owned = [(b.node.id, p) for b in physical.bodies for p in world_parts(b)]
    return tuple(
        BodyOutline(i, float(p[:, 2].min()), float(p[:, 2].max()), p) for i, p in (*ceilings_and_walls, *owned)
    )


def floor_area(gathered: ExportScene) -> BaseGeometry:
    """All floors as one, joined where a wall's thickness parts them."""
    floors = [shapely.make_valid(Polygon(p.polygon[:, :2])) for p in gathered.scene.architecture.by_role("floor")]
    wider = shapely.unary_union(floors).buffer(DOORWAY_M / 2, join_style="mitre")
    return wider.buffer(-DOORWAY_M / 2, join_style="mitre")


def occupied_area(gathered: ExportScene, bodies: Iterable[BodyOutline]) -> BaseGeometry:
    """What stands in a robot's way, seen from above."""
    level = gathered.floor_m
    return shapely.unary_union([b.section_between(level + LOW_M, level + HIGH_M) for b in bodies])


def walkable(floor: BaseGeometry, occupied: BaseGeometry, radius_m: float) -> tuple[Polygon, ...]:
    """Where the middle of a disc may be, the largest part first; holes are what it drives around.

    The edge of the floor is kept clear, too: a room from a photo may lack a wall there.
    """
    middle = floor.buffer(-radius_m).difference(occupied.buffer(radius_m)).simplify(0.005)
    parts = [p for p in getattr(middle, "geoms", [middle]) if isinstance(p, Polygon) and not p.is_empty]
    return tuple(sorted(parts, key=lambda p: -p.area))


def standing_place(
    walk: Sequence[Polygon], target: BaseGeometry, radius_m: float, reach_m: float
) -> tuple[float, float, float] | None:
    """Where a disc stands to reach a place: x, y and its heading toward it; None where it comes no nearer.

    Args:
        walk: where its middle may be; only the largest part, from which it can come.
        target: the place, seen from above.
        radius_m: of the disc.
        reach_m: from its rim to the nearest point of the place.
    """
    if not walk or target.is_empty:
        return None
    line: LineString = shapely.shortest_line(walk[0], target)
    if line.length > radius_m + reach_m:
        return None
    (x, y), toward = line.coords[0], target.centroid
    return float(x), float(y), float(np.arctan2(toward.y - y, toward.x - x))


def write_occupancy(gathered: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write the map, its text beside its picture or both in a zip; raises `ExportError`, also without a floor."""
    progress.report(0.0, "preparing colliders")
    floor = floor_area(gathered)
    if floor.is_empty:
        raise ExportError("a map needs a floor, and this scene has none; draw a room first")
    occupied = occupied_area(gathered, outlines(physical_scene(gathered)))
    write_package(path, f"{path.stem}.yaml", map_files(floor, occupied, path.stem).items())


def map_files(floor: BaseGeometry, occupied: BaseGeometry, name: str = "map") -> dict[str, bytes]:
    """`NAME.pgm` and `NAME.yaml`: occupied where a cell's middle is, free on the rest of the floor, unknown beyond."""
    bounds = np.array(shapely.union(floor, occupied.intersection(floor.buffer(1.0))).bounds)
    low = np.floor(bounds[:2] / CELL_M) - MARGIN_CELLS
    columns, rows = (np.ceil(bounds[2:] / CELL_M) + MARGIN_CELLS - low).astype(int)
    x, y = ((low[k] + np.arange(n) + 0.5) * CELL_M for k, n in enumerate((columns, rows)))
    middles: Float[np.ndarray, "2 h w"] = np.stack(np.meshgrid(x, y[::-1]))
    grey = np.where(shapely.contains_xy(floor, *middles), FREE, UNKNOWN).astype(np.uint8)
    # Half a cell wider: thin walls and legs of tables must not fall between the middles.
    grey[shapely.contains_xy(occupied.buffer(CELL_M / 2), *middles)] = OCCUPIED
    text = (
        f"image: {name}.pgm\nmode: trinary\n"
        f"resolution: {CELL_M}\norigin: [{low[0] * CELL_M:.3f}, {low[1] * CELL_M:.3f}, 0.0]\n"
        "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    return {f"{name}.pgm": f"P5\n{columns} {rows}\n255\n".encode() + grey.tobytes(), f"{name}.yaml": text.encode()}


def rings(polygon: Polygon) -> dict[str, list]:
    """A polygon as JSON: its outer ring and its holes, metres in the world."""
    inner = [np.round(hole.coords, 4).tolist() for hole in polygon.interiors]
    return {"outline": np.round(polygon.exterior.coords, 4).tolist(), "holes": inner}


def free_spot(area: BaseGeometry) -> tuple[Point, float]:
    """Middle and radius of the largest free disc."""
    line = shapely.maximum_inscribed_circle(area, tolerance=0.005)
    return Point(line.coords[0]), float(line.length)
