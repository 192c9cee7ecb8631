"""A floor plan: walls cut at their openings, footprints of the furniture, lengths. Metres, world x and y."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import manifold3d
import numpy as np
import shapely
from jaxtyping import Float

from diorama_core.export.door_swings import DoorSwing, door_swings
from diorama_core.export.footprints import Outline, footprints
from diorama_core.export.gathering import ExportObject, ExportScene
from diorama_core.geometry.openings import OPENING_CATEGORIES, faces_behind
from diorama_core.geometry.planes import signed_area
from diorama_core.geometry.rooms import part_of_home, storeys_of
from diorama_core.geometry.wall_lines import DrawnWall, Opening, wall_lines
from diorama_core.library.furniture.articulation import articulation
from diorama_core.scene.types import Plane, Scene, SceneObject

UNNAMED = ("rug",)
CORNER_M = 0.15
"""Ends of walls nearer than this meet in a corner."""
OVERHEAD_M = 1.7
"""Objects whose lower side is higher hang above the section and are drawn dashed."""
DIMENSION_GAP_M = 0.3
"""Between a wall's outer side and its first dimension line, and between two lines."""
ARC_POINTS = 13
MIN_AREA_M2 = 0.5
"""Smaller pieces of floor are niches and thresholds."""
LETTER = 0.56
"""Mean width of a letter, in text heights."""
FINE_M = 0.05
"""How exactly the freest place is found."""
LEVEL_M = 0.05
"""Objects whose lower sides differ by less stand on one level."""
REACH_M = 1e-3
"""By so much more than a wall is thick, what lies behind it is cut away."""


@dataclass(frozen=True, eq=False)
class Piece:
    """One object seen from above."""

    id: str
    label: str
    """Empty for what lies under other furniture and needs no name."""
    outlines: tuple[Outline, ...]
    size_m: tuple[float, float]
    """Along its own front (depth) and across (width)."""
    height_m: float
    overhead: bool
    on_floor: bool
    """Whether it stands on the floor, rather than on other furniture or on a wall."""
    bottom_m: float
    upright: bool = False
    """Whether it is seen from before, rather than from above."""

    @property
    def extent_m(self) -> tuple[float, float]:
        """Width, and depth or height, whichever is seen."""
        return self.size_m[1], self.height_m if self.upright else self.size_m[0]


@dataclass(frozen=True, eq=False)
class Dimension:
    """A length with its line, set off from the points it measures."""

    start: Float[np.ndarray, "2"]
    end: Float[np.ndarray, "2"]
    offset: Float[np.ndarray, "2"]
    """From the measured points to the dimension line."""

    @property
    def length_m(self) -> float:
        """What it measures."""
        return float(np.linalg.norm(self.end - self.start))

    @property
    def text_angle_deg(self) -> float:
        """Angle of the line for text that is read from below or from the right."""
        along = self.end - self.start
        return (float(np.degrees(np.arctan2(along[1], along[0]))) + 89.9) % 180.0 - 89.9

    @property
    def text(self) -> str:
        """The length in metres as it is written."""
        return f"{self.length_m:.2f}"


@dataclass(frozen=True, eq=False)
class Area:
    """A floor's area and the point where it is written."""

    at: Float[np.ndarray, "2"]
    area_m2: float
    room: str = ""
    """Name of the room of a home."""

    @property
    def text(self) -> str:
        """The area as it is written, after the room's name."""
        return f"{self.room} {self.area_m2:.1f} m²".lstrip()


@dataclass(frozen=True, eq=False)
class FloorPlan:
    """What a plan shows."""

    name: str
    floors: tuple[Outline, ...]
    walls: tuple[Outline, ...]
    """Cut walls as filled outlines; holes run clockwise."""
    door_leaves: tuple[Outline, ...]
    """Open lines: leaf and swing of each door, or the shut leaf of one that does not open."""
    window_panes: tuple[Outline, ...]
    """Open lines in the thickness of the wall."""
    pieces: tuple[Piece, ...]
    """The lowest first, so that what lies on top is drawn over it."""
    dimensions: tuple[Dimension, ...]
    rooms: tuple[tuple[str, Outline], ...] = ()
    """Names and floors of the rooms of a home."""
    kind: str = "Floor plan"

    def move(self, by: Float[np.ndarray, "2"]) -> FloorPlan:
        """The plan elsewhere (m), as storeys lie beside each other on one sheet."""

        def lines(given: tuple[Outline, ...]) -> tuple[Outline, ...]:
            return tuple(o + by for o in given)

        return replace(
            self,
            floors=lines(self.floors),
            walls=lines(self.walls),
            door_leaves=lines(self.door_leaves),
            window_panes=lines(self.window_panes),
            pieces=tuple(replace(p, outlines=lines(p.outlines)) for p in self.pieces),
            dimensions=tuple(replace(d, start=d.start + by, end=d.end + by) for d in self.dimensions),
            rooms=tuple((name, outline + by) for name, outline in self.rooms),
        )

    @property
    def areas(self) -> tuple[Area, ...]:
        """Each floor's area, to be written where the most floor is free."""
        named_areas = []
        for floor in map(_polygon, self.floors):
            inside = floor.representative_point()
            named = (name for name, outline in self.rooms if _polygon(outline).covers(inside))
            named_areas.append(Area(np.asarray(inside.coords[0]), floor.area, next(named, "")))
        taken = [o for p in self.pieces for o in p.outlines]
        places = freest_places(self.floors, taken, [a.text for a in named_areas])
        named_areas = [replace(area, at=at) for area, at in zip(named_areas, places, strict=True)]
        return tuple(area for area in named_areas if area.area_m2 >= MIN_AREA_M2)

    @property
    def bounds(self) -> Float[np.ndarray, "2 2"]:
        """Least and largest x and y of everything, dimension lines included."""
        points = [*self.floors, *self.walls, *self.door_leaves, *(o for p in self.pieces for o in p.outlines)]
        points += [np.stack([d.start + d.offset, d.end + d.offset]) for d in self.dimensions]
        every = np.concatenate(points) if points else np.array([[-0.5, -0.5], [0.5, 0.5]])
        return np.stack([every.min(axis=0), every.max(axis=0)])


@dataclass(frozen=True, eq=False)
class RoomLines:
    """What a plan shows of the room itself; see `FloorPlan`."""

    floors: tuple[Outline, ...]
    walls: tuple[Outline, ...]
    door_leaves: tuple[Outline, ...]
    window_panes: tuple[Outline, ...]
    lines: tuple[DrawnWall, ...]


def room_lines(planes: Sequence[Plane], items: Sequence[SceneObject], scene: Scene) -> RoomLines:
    """Floors, cut walls, doors and windows.

    Args:
        planes: Of the room, whole.
        items: Objects; doors and windows among them cut their walls.
        scene: Says what hangs on what.
    """
    walls = wall_lines(planes, items, scene)
    floors = _floors_within_walls([p.polygon[:, :2] for p in planes if p.role == "floor"], walls)
    openings = [(w, o) for w in walls for o in w.openings]
    swings = door_swings(items, articulation)
    return RoomLines(
        floors,
        _cut_walls(walls, floors),
        tuple(line for w, o in openings if o.is_door and o.object_id for line in _door(w, o, swings.get(o.object_id))),
        tuple(line for w, o in openings if not o.is_door for line in _window(w, o)),
        walls,
    )


def floor_plans(scene: ExportScene) -> tuple[FloorPlan, ...]:
    """The plan of a gathered scene; of a home one for each storey, the lowest first."""
    storeys = storeys_of(scene.scene)
    if len(storeys) < 2:
        return (floor_plan(scene),)
    plans = []
    for number, rooms in storeys.items():
        part = part_of_home(scene.scene, [r.id for r in rooms])
        planes = tuple(p for p in scene.planes if part.has_plane(p.id))
        objects = tuple(o for o in scene.objects if part.has_object(o.id))
        name = f"{scene.name}, storey {number}"
        plans.append(floor_plan(replace(scene, name=name, scene=part, planes=planes, objects=objects)))
    return tuple(plans)


def floor_plan(scene: ExportScene) -> FloorPlan:
    """The plan of a gathered scene as one."""
    room = room_lines([p.plane for p in scene.planes], [o.item for o in scene.objects], scene.scene)
    covered = footprints(scene)
    drawn = [o for o in scene.objects if o.item.category not in OPENING_CATEGORIES]
    pieces = [(drawing_order(o.item), _piece(scene, o, covered[o.id])) for o in drawn]
    return FloorPlan(
        name=scene.name,
        floors=room.floors,
        walls=room.walls,
        door_leaves=room.door_leaves,
        window_panes=room.window_panes,
        pieces=tuple(piece for _, piece in sorted(pieces, key=lambda row: row[0])),
        dimensions=_dimensions(room.lines, room.floors),
        rooms=tuple((r.name, scene.scene.plane(r.floor).polygon[:, :2]) for r in scene.scene.rooms),
    )


def freest_places(
    floors: Sequence[Outline], taken: Sequence[Outline], texts: Sequence[str]
) -> list[Float[np.ndarray, "2"]]:
    """Where each floor has the most room for its text that nothing else covers.

    Args:
        floors: outlines.
        taken: outlines of what covers them.
        texts: one a floor.
    """
    covered, places = shapely.union_all([_polygon(o) for o in taken if len(o) > 2]), []
    for floor, text in zip(map(_polygon, floors), texts, strict=True):
        free = floor.difference(covered)
        wide = np.array([max(1.0, LETTER * len(text)), 1.0])
        # The largest ellipse as wide as the text is the largest circle where x is so much shorter.
        narrowed = shapely.transform(floor if free.is_empty else free, lambda points, wide=wide: points / wide)
        circle = shapely.maximum_inscribed_circle(narrowed, tolerance=FINE_M / wide[0])
        places.append(np.asarray(circle.coords[0]) * wide)
    return places


def drawing_order(item: SceneObject) -> tuple[int, float]:
    """Sorts objects as a plan paints them: by the level that they stand on, and of one level the flat ones first.

    A rug and the chair on it stand so nearly on one level that the lower side alone would leave it to chance.
    """
    heights = item.corners_world[:, 2]
    return round(float(heights.min()) / LEVEL_M), float(heights.max())


def _floors_within_walls(floors: Sequence[Outline], walls: Sequence[DrawnWall]) -> tuple[Outline, ...]:
    """Floors without the pieces that lie behind a wall and before none: what was measured through a door, a wedge."""
    barrier = manifold3d.CrossSection()
    for wall in walls:
        t = wall.plane.thickness
        barrier += _area(_strip(wall, -t, wall.length_m + t, 0.0, t))
    outlines: list[Outline] = []
    for floor in floors:
        whole = _area(floor)
        outside = [p for p in (whole - barrier).decompose() if not _is_before_a_wall(p, walls)] if walls else []
        if not outside or len(outside) == len((whole - barrier).decompose()):
            outlines.append(floor)
            continue
        for piece in outside:
            near = piece.offset(REACH_M, manifold3d.JoinType.Miter)
            for wall in walls:  # its tip may be so thin that it ends within the wall
                slab = _area(_strip(wall, 0.0, wall.length_m, 0.0, wall.plane.thickness))
                whole -= slab if (near ^ slab).area() > 0.0 else manifold3d.CrossSection()
            whole -= piece.offset(max(w.plane.thickness for w in walls) + REACH_M, manifold3d.JoinType.Miter)
        outlines += [np.asarray(o) for o in whole.to_polygons()]
    return tuple(outlines)


def _is_before_a_wall(piece: manifold3d.CrossSection, walls: Sequence[DrawnWall]) -> bool:
    """Whether a wall's inner side is straight ahead of the middle of a piece of floor, with no other wall between."""
    points = np.concatenate([np.asarray(o) for o in piece.to_polygons()])
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    for wall in walls:
        along, behind = (float((middle - wall.start) @ axis) for axis in (wall.direction, wall.outward))
        is_ahead = 0.0 <= along <= wall.length_m and behind < 0.0
        if is_ahead and not any(_crosses(middle, wall.point_at(along), w) for w in walls if w is not wall):
            return True
    return False


def _crosses(start: Float[np.ndarray, "2"], end: Float[np.ndarray, "2"], wall: DrawnWall) -> bool:
    """Whether the way from one point to another leads through a wall."""
    a, b = (float((p - wall.start) @ wall.outward) for p in (start, end))
    if a * b >= 0.0:
        return False
    at = float((start + a / (a - b) * (end - start) - wall.start) @ wall.direction)
    return 0.0 <= at <= wall.length_m


def _piece(scene: ExportScene, item: ExportObject, outlines: tuple[Outline, ...]) -> Piece:
    bottom = float(item.item.corners_world[:, 2].min())
    roles = {p.id: p.plane.role for p in scene.planes}
    on_floor = item.support is None or roles.get(item.support.parent) == "floor"
    depth, width, height = (float(v) for v in item.item.size_m)
    overhead = bottom - scene.floor_m > OVERHEAD_M
    label = "" if item.item.category in UNNAMED else item.item.label
    return Piece(item.id, label, outlines, (depth, width), height, overhead, on_floor, bottom)


def _cut_walls(walls: Sequence[DrawnWall], floors: Sequence[Outline]) -> tuple[Outline, ...]:
    """Slabs of all walls as one area, closed at corners, open at doors and windows, clear of the floor."""
    ends = [p for w in walls for p in (w.start, w.end)]
    solid = manifold3d.CrossSection()
    for wall in walls:
        t = wall.plane.thickness
        first, last = (t if _meets(p, ends) else 0.0 for p in (wall.start, wall.end))
        solid += _area(_strip(wall, -first, wall.length_m + last, 0.0, t))
    for floor in floors:
        solid -= _area(floor)
    for wall in walls:
        for opening in wall.openings:
            solid -= _area(_strip(wall, opening.from_m, opening.to_m, -0.01, wall.plane.thickness + 0.01))
    return tuple(np.asarray(p) for p in solid.to_polygons())


def _meets(point: Float[np.ndarray, "2"], ends: Sequence[Float[np.ndarray, "2"]]) -> bool:
    return sum(float(np.linalg.norm(point - e)) < CORNER_M for e in ends) > 1


def _strip(wall: DrawnWall, from_m: float, to_m: float, near_m: float, far_m: float) -> Outline:
    corners = ((from_m, near_m), (to_m, near_m), (to_m, far_m), (from_m, far_m))
    return np.stack([wall.point_at(along, behind) for along, behind in corners])


def _polygon(outline: Outline) -> shapely.Geometry:
    return shapely.make_valid(shapely.Polygon(outline))


def _area(outline: Outline) -> manifold3d.CrossSection:
    turned = outline if signed_area(outline) >= 0 else outline[::-1]
    return manifold3d.CrossSection([turned], manifold3d.FillRule.Positive)


def _door(wall: DrawnWall, opening: Opening, swing: DoorSwing | None) -> tuple[Outline, ...]:
    """Each leaf as far open as it goes and the arc it swings through; one that does not open is drawn shut."""
    if swing is None or not swing.can_open:
        return (np.stack([wall.point_at(opening.from_m), wall.point_at(opening.to_m)]),)
    angles = np.linspace(0, swing.free_rad, ARC_POINTS)
    lines: list[Outline] = []
    for leaf in swing.leaves:
        arc = np.concatenate([leaf.turn(leaf.tip[None], float(angle)) for angle in angles])
        lines += [np.stack([leaf.hinge, arc[-1]]), arc]
    return tuple(lines)


def _window(wall: DrawnWall, opening: Opening) -> tuple[Outline, ...]:
    t = wall.plane.thickness
    depths = (0.0, 0.4 * t, 0.6 * t, t)
    return tuple(np.stack([wall.point_at(opening.from_m, d), wall.point_at(opening.to_m, d)]) for d in depths)


def _dimensions(walls: Sequence[DrawnWall], floors: Sequence[Outline]) -> tuple[Dimension, ...]:
    """Lengths of the walls' faces, the parts between their openings, and the whole where no wall spans it."""
    faces = [w.plane for w in walls]
    # Behind a wall between two rooms is no place for its length; the other room's plan of that side has it.
    outer = [w for w in walls if not faces_behind(w.plane, w.plane.centre, faces)]
    sides = [d for w in outer for d in _wall_dimensions(w)]
    every = np.concatenate([*floors, *(np.stack([w.start, w.end]) for w in walls)]) if walls or floors else None
    if every is None:
        return ()
    (left, low), (right, high) = every.min(axis=0), every.max(axis=0)
    far = 3 * DIMENSION_GAP_M if sides else DIMENSION_GAP_M
    corner = np.array([left, low])
    whole = (
        Dimension(corner, np.array([right, low]), np.array([0.0, -far])),
        Dimension(np.array([left, high]), corner, np.array([-far, 0.0])),
    )
    return (*sides, *(d for d in whole if d.length_m > 0.01 and not _is_known(d, sides)))


def _wall_dimensions(wall: DrawnWall) -> list[Dimension]:
    first = (wall.plane.thickness + DIMENSION_GAP_M) * wall.outward
    stops = [0.0, *(v for o in wall.openings for v in (o.from_m, o.to_m)), wall.length_m]
    parts = [Dimension(wall.point_at(a), wall.point_at(b), first) for a, b in pairwise(stops) if b - a > 0.02]
    if len(parts) < 2:
        return [Dimension(wall.start, wall.end, first)]
    return [*parts, Dimension(wall.start, wall.end, first + DIMENSION_GAP_M * wall.outward)]


def _is_known(whole: Dimension, known: Sequence[Dimension]) -> bool:
    """Whether a wall's length says the same already."""
    along = (whole.end - whole.start) / whole.length_m
    return any(
        abs(d.length_m - whole.length_m) < 0.01 and abs(float((d.end - d.start) @ along)) > 0.99 * d.length_m
        for d in known
    )
