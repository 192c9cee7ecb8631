"""Priors on headings where the photo is ambiguous: costs of a heading, 0 for the expected one.

Sofas, beds and cabinets turn their backs to a wall and their fronts to the room; chairs face the table they are
drawn up to; screens face whoever looks at them; books on a shelf show their spines.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import Cuboid, DepthMap, DetectedObject
from diorama_core.library.taxonomy import broad, with_kin
from diorama_core.scene.types import Camera

_TABLES = with_kin("table", "desk", "coffee table", "side table", "kitchen counter", "piano", "console table")
_AT_TABLES = with_kin("chair", "office chair", "stool", "bench", "armchair", "sofa")
_TOWARD_VIEWER = frozenset(
    {"monitor", "television", "laptop", "picture", "photo frame", "mirror", "clock", "keyboard", "microwave"}
)
_NO_FRONT = with_kin(
    *("plant", "vase", "bowl", "cup", "bottle", "basket", "trash can", "rug", "box", "pillow"),
    *("table", "coffee table", "side table", "ottoman", "lamp", "floor lamp", "ceiling lamp"),
    *("candle", "fruit", "kettle", "cooking pot", "utensils", "cutting board", "soap dispenser", "toilet brush"),
    *("sculpture", "globe", "blanket", "towel", "umbrella stand", "drum", "dumbbells", "exercise ball", "yoga mat"),
    "ceiling fan",
)
"""Set down any way round."""
_TOWARD_CAMERA = {
    "chair": 0.4,
    "office chair": 0.4,
    "stool": 0.3,
    "bench": 0.6,
    "armchair": 0.6,
    "sofa": 0.9,
    "desk": 0.8,
    "bed": 1.5,
    "object": 0.6,
    "toy": 0.8,
    "books": 0.8,
}
"""Log odds of an object showing its front rather than its back; cupboards are hardly seen from behind."""
_FRONTAL = 0.25
"""Share of that which is for facing the camera rather than only not turning the back to it."""
_STORAGE = with_kin(
    *("cabinet", "sideboard", "dresser", "wardrobe", "bookshelf", "shelves", "tv stand", "refrigerator"),
    *("kitchen counter", "night stand", "console table", "filing cabinet"),
)
_SHELVES = with_kin("bookshelf", "shelves")
_SPINES_OUT = 3.0
"""Books on shelves show their spines."""
_AGAINST_WALLS = 2.0
"""Storage has its back to a wall rather than other furniture."""
_ROW_GAP_M, _ROW_RATIO, _IN_A_ROW = 0.3, 1.5, 1.0
"""Storage beside storage that is so many times as long as deep faces as that does: a refrigerator at a counter."""
_DRAWN_UP_M = 0.9
_DRAWN_UP_COFFEE_M = 1.6
_LEANING = 3.0
_WALL_REACH_M = 0.7
_WALL_LATERAL_M = 3.0
_WALL_SAMPLES = 3000


@dataclass(frozen=True, eq=False)
class WallSamples:
    """Points of upright surfaces that belong to no object, with their headings, seen from above."""

    points_xy: Float[np.ndarray, "n 2"]
    normals_xy: Float[np.ndarray, "n 2"]


@dataclass(frozen=True, eq=False)
class Facing:
    """Wished headings of one object."""

    preferences: tuple[tuple[float, Float[np.ndarray, "2"]], ...]
    """(weight, unit direction seen from above) of every reason to face somewhere."""
    not_away: tuple[tuple[float, Float[np.ndarray, "2"]], ...] = ()
    """(weight, unit direction) of every reason not to turn the back there; sideways is as good as facing it."""

    def cost(self, R_world_object: Float[np.ndarray, "p 3 3"]) -> Float[np.ndarray, "p"]:
        """Sum of weight x (1 - cosine) / 2 over the preferences, and of what turns away, for every rotation's front."""
        front = R_world_object[:, :2, 0]
        front = front / np.maximum(np.linalg.norm(front, axis=1, keepdims=True), 1e-9)
        toward = sum((w * (1 - front @ d) / 2 for w, d in self.preferences), np.zeros(len(front)))
        return sum((w * np.maximum(-front @ d, 0.0) for w, d in self.not_away), toward)


def wall_samples(depth: DepthMap, camera: Camera, objects: Sequence[DetectedObject]) -> WallSamples:
    """Pixels outside all boxes whose surface is upright: the walls, as far as they are seen."""
    normals = depth.normals_world
    free = np.isfinite(depth.depth_m) & (depth.depth_m > 0) & (np.abs(normals[..., 2]) < 0.25)
    for item in objects:
        x1, y1, x2, y2 = (round(v) for v in item.box)
        free[max(y1, 0) : y2, max(x1, 0) : x2] = False
    rows, columns = np.nonzero(free)
    step = max(len(rows) // _WALL_SAMPLES, 1)
    rows, columns = rows[::step], columns[::step]
    rays = camera.rays(np.stack([columns + 0.5, rows + 0.5], axis=1))
    points = camera.position + rays * depth.depth_m[rows, columns, None].astype(np.float64)
    flat = normals[rows, columns, :2].astype(np.float64)
    length = np.linalg.norm(flat, axis=1)
    good = np.isfinite(points).all(axis=1) & (length > 0.5)
    return WallSamples(points[good, :2], flat[good] / length[good, None])


def facing_of(
    kind: str,
    cuboid: Cuboid,
    cuboids: Sequence[Cuboid],
    categories: dict[str, str],
    camera: Camera,
    walls: WallSamples,
    out_of_wall: Float[np.ndarray, "2"] | None,
    pillows: Sequence[Cuboid] = (),
    carrier: Cuboid | None = None,
) -> Facing:
    """Reasons to face somewhere for one object.

    Args:
        kind: Category of the object.
        cuboid: Its box in the world.
        cuboids: All boxes, its own included.
        categories: Category of every object id.
        camera: The photo's camera.
        walls: Where walls are seen.
        out_of_wall: Into the room, for objects that hang on a wall.
        pillows: What lies on it at its back or head.
        carrier: What it lies on, if that is an object.
    """
    toward_camera = _unit(camera.position[:2] - cuboid.centre[:2])
    if cuboid.front_known:
        return Facing(((3.0, _unit(cuboid.R_world_object[:2, 0])),))
    if out_of_wall is not None:
        return Facing(((4.0, _unit(out_of_wall)),))
    if kind == "pillow" and carrier is not None:
        return _leaning(cuboid, carrier, broad(categories.get(carrier.object_id, "")) == "bed", toward_camera)
    if kind == "books" and carrier is not None and categories.get(carrier.object_id) in _SHELVES:
        return Facing(((_SPINES_OUT, _front_of(carrier, toward_camera)),))
    if kind in _NO_FRONT:
        return Facing(())
    if kind in _TOWARD_VIEWER:
        return Facing(((2.0, toward_camera),))
    table = _nearest_table(kind, cuboid, cuboids, categories)
    if table is not None:
        return Facing(((1.2, _axis_toward(cuboid, table.centre[:2] - cuboid.centre[:2])), (0.1, toward_camera)))
    shown = _TOWARD_CAMERA.get(broad(kind), 2.0)
    preferences = [(_FRONTAL * shown, toward_camera)]
    against = _AGAINST_WALLS if broad(kind) in _STORAGE else 1.0
    preferences += [(against * weight, to) for weight, to in _away_from_walls(cuboid, walls) if weight > 0.05]
    preferences += _away_from_pillows(cuboid, pillows)
    if broad(kind) in _STORAGE:
        preferences += _in_a_row(cuboid, cuboids, categories, camera)
    middle = np.mean([c.centre[:2] for c in cuboids], axis=0) - cuboid.centre[:2]
    if len(cuboids) >= 3 and np.linalg.norm(middle) > 0.3:
        preferences.append((0.3, _unit(middle)))
    return Facing(tuple(preferences), (((1.0 - _FRONTAL) * shown, toward_camera),))


def _front_of(cuboid: Cuboid, toward_camera: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"]:
    """The end of a cuboid's depth that the camera sees."""
    front = _axes_xy(cuboid)[0][0]
    return front if front @ toward_camera >= 0 else -front


def _leaning(pillow: Cuboid, carrier: Cuboid, on_bed: bool, toward_camera: Float[np.ndarray, "2"]) -> Facing:
    """Pillows lean on the head of a bed and look to its foot; on a sofa they look where it does, across its length."""
    axes = _axes_xy(carrier)
    longest = max(half for _, half in axes)
    along = [axis for axis, half in axes if (half == longest) == on_bed] or [axis for axis, _ in axes]
    inward = carrier.centre[:2] - pillow.centre[:2] if on_bed else toward_camera
    return Facing(((_LEANING, max(along, key=lambda axis: float(axis @ inward))),))


def _in_a_row(
    cuboid: Cuboid, cuboids: Sequence[Cuboid], categories: dict[str, str], camera: Camera
) -> list[tuple[float, Float[np.ndarray, "2"]]]:
    """The way that long storage beside it faces: across its length, to the camera's side."""
    found = []
    for other in cuboids:
        beside = other.object_id != cuboid.object_id and _gap_m(cuboid, other) < _ROW_GAP_M
        sides = other.size_m[:2]
        if beside and broad(categories.get(other.object_id, "")) in _STORAGE and max(sides) > _ROW_RATIO * min(sides):
            across = [axis for axis, half in _axes_xy(other) if half == min(sides) / 2]
            found.append(max(across, key=lambda axis: float(axis @ (camera.position[:2] - other.centre[:2]))))
    return [(_IN_A_ROW / len(found), direction) for direction in found]


def _away_from_pillows(cuboid: Cuboid, pillows: Sequence[Cuboid]) -> list[tuple[float, Float[np.ndarray, "2"]]]:
    """Pillows lie at the head of a bed and the back of a sofa."""
    if not pillows:
        return []
    offset = np.mean([p.centre[:2] for p in pillows], axis=0) - cuboid.centre[:2]
    depth = max(float(cuboid.size_m[:2].mean()), 1e-6)
    strength = min(float(np.linalg.norm(offset)) / (0.3 * depth), 1.0)
    nearest = max(_axes_xy(cuboid), key=lambda axis: float(-offset @ axis[0]))[0]
    return [(1.5 * strength, nearest)]


def _unit(v: np.ndarray) -> Float[np.ndarray, "2"]:
    length = float(np.linalg.norm(v))
    return v / length if length > 1e-9 else np.array([0.0, -1.0])


def _axes_xy(cuboid: Cuboid) -> tuple[tuple[Float[np.ndarray, "2"], float], ...]:
    """The four horizontal directions of the cuboid's faces and how far each face is from the centre."""
    x, y = _unit(cuboid.R_world_object[:2, 0]), _unit(cuboid.R_world_object[:2, 1])
    half_x, half_y = cuboid.size_m[0] / 2, cuboid.size_m[1] / 2
    return ((x, half_x), (-x, half_x), (y, half_y), (-y, half_y))


def _axis_toward(cuboid: Cuboid, direction: np.ndarray) -> Float[np.ndarray, "2"]:
    """Halfway between the direction and the cuboid's own axis nearest to it: people sit square to a table."""
    unit = _unit(direction)
    nearest = max(_axes_xy(cuboid), key=lambda axis: float(axis[0] @ unit))[0]
    return _unit(unit + nearest)


def _gap_m(a: Cuboid, b: Cuboid) -> float:
    """Horizontal distance between two cuboids' upright bounding boxes."""
    low = np.maximum(a.corners_world[:, :2].min(axis=0), b.corners_world[:, :2].min(axis=0))
    high = np.minimum(a.corners_world[:, :2].max(axis=0), b.corners_world[:, :2].max(axis=0))
    return float(np.linalg.norm(np.clip(low - high, 0.0, None)))


def _nearest_table(
    category: str, cuboid: Cuboid, cuboids: Sequence[Cuboid], categories: dict[str, str]
) -> Cuboid | None:
    """The table that a seat is drawn up to, if one is near enough."""
    if category not in _AT_TABLES:
        return None
    lounge = broad(category) in ("sofa", "armchair")
    low = frozenset({"coffee table"})
    near = []
    for other in cuboids:
        kind = categories.get(other.object_id)
        if other.object_id != cuboid.object_id and kind in (low if lounge else _TABLES):
            gap = _gap_m(cuboid, other)
            if gap < (_DRAWN_UP_COFFEE_M if kind in low else _DRAWN_UP_M):
                near.append((gap, float(np.linalg.norm(other.centre - cuboid.centre)), other))
    return min(near, key=lambda found: (found[0], found[1]))[2] if near else None


def _away_from_walls(cuboid: Cuboid, walls: WallSamples) -> list[tuple[float, Float[np.ndarray, "2"]]]:
    """For each face direction, how strongly a wall behind the opposite face asks to face that way (0 to 1)."""
    preferences = []
    for direction, half in _axes_xy(cuboid):
        back = cuboid.centre[:2] - direction * half
        offset = walls.points_xy - back
        gap = -(offset @ direction)
        side = np.abs(offset @ np.array([-direction[1], direction[0]]))
        near = (walls.normals_xy @ direction > 0.9) & (gap > -0.3) & (gap < _WALL_REACH_M) & (side < _WALL_LATERAL_M)
        strength = np.exp(-np.abs(np.median(gap[near])) / 0.4) if near.sum() >= 10 else 0.0
        preferences.append((float(strength), direction))
    return preferences
