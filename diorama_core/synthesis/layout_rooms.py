"""Generated rooms with a known truth: furniture on the floor, chairs tucked under tables, shelves with books, things on
tables, objects on walls. Shapes are compounds of boxes, so convex parts are exact.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from typing import Any

import numpy as np
import trimesh

from diorama_core.errors import EditRefused, LibraryError
from diorama_core.geometry.rotations import rotation_from_vector
from diorama_core.library.record import Shape, SupportSurface
from diorama_core.scene import edits
from diorama_core.scene.types import Architecture, Plane, Pose, Relation, Scene, SceneObject, Support, yaw_rotation

Boxes = tuple[tuple[tuple[float, float, float], tuple[float, float, float]], ...]
"""(lower, upper) corners of the boxes of a compound."""


@dataclass(frozen=True)
class BoxShape:
    """A shape made of boxes, with its support surfaces as (x0, y0, x1, y1, z, clearance, interior)."""

    category: str
    boxes: Boxes
    tops: tuple[tuple[float, float, float, float, float, float, bool], ...] = ()

    @property
    def word(self) -> str:
        """The category as one word."""
        return self.category.replace(" ", "_")


@dataclass(frozen=True)
class BoxLibrary:
    """A shape library of box compounds."""

    compounds: tuple[BoxShape, ...] = field(repr=False)

    @cached_property
    def _records(self) -> dict[str, tuple[Shape, trimesh.Trimesh]]:
        return {s.id: (s, m) for s, m in (_record(k, c) for k, c in enumerate(self.compounds))}

    def shapes(self) -> tuple[Shape, ...]:
        """All records."""
        return tuple(s for s, _ in self._records.values())

    def shape(self, shape_id: str) -> Shape:
        """One record; raises `LibraryError` when unknown."""
        if shape_id not in self._records:
            raise LibraryError(f"there is no shape {shape_id!r} in the generated rooms' library")
        return self._records[shape_id][0]

    def in_category(self, category: str) -> tuple[Shape, ...]:
        """Records of one category."""
        return tuple(s for s in self.shapes() if s.category == category)

    def mesh(self, shape_id: str) -> trimesh.Trimesh:
        """The boxes as one mesh."""
        self.shape(shape_id)
        return self._records[shape_id][1]

    def parts(self, shape_id: str) -> trimesh.Scene:
        """The mesh as a scene."""
        return trimesh.Scene(self.mesh(shape_id))

    def glb(self, shape_id: str) -> bytes:
        """The mesh as GLB."""
        return bytes(self.parts(shape_id).export(file_type="glb"))


def _record(number: int, compound: BoxShape) -> tuple[Shape, trimesh.Trimesh]:
    corners = np.array(compound.boxes)
    low, high = corners[:, 0].min(axis=0), corners[:, 1].max(axis=0)
    centre = (low + high) / 2
    boxes = [trimesh.creation.box(bounds=np.array(b) - centre) for b in compound.boxes]
    surfaces = tuple(
        SupportSurface(np.array([[x0, y0, z], [x1, y0, z], [x1, y1, z], [x0, y1, z]]) - centre, clearance, interior)
        for x0, y0, x1, y1, z, clearance, interior in compound.tops
    )
    digest = hashlib.sha256(np.ascontiguousarray(corners).tobytes()).hexdigest()[:16]
    depth, width, height = high - low
    shape = Shape(
        id=f"{compound.word}_{number}",
        category=compound.category,
        caption=f"{compound.category} of boxes",
        source="boxes",
        size_m=(float(depth), float(width), float(height)),
        surfaces=surfaces,
        content_hash=f"boxes-{digest}",
    )
    return shape, trimesh.util.concatenate(boxes)


def table(x: float, y: float, z: float, leg: float = 0.05, top: float = 0.03) -> BoxShape:
    """A table top on four legs.

    Args:
        x: length, metres.
        y: width.
        z: height.
        leg: thickness of the legs.
        top: thickness of the top.
    """
    legs = tuple(
        ((a, b, 0.0), (a + leg, b + leg, z - top)) for a in (-x / 2, x / 2 - leg) for b in (-y / 2, y / 2 - leg)
    )
    slab = ((-x / 2, -y / 2, z - top), (x / 2, y / 2, z))
    return BoxShape("table", (slab, *legs), ((-x / 2, -y / 2, x / 2, y / 2, z, np.inf, False),))


def chair(seat: float = 0.45, width: float = 0.44, height: float = 0.9, leg: float = 0.04) -> BoxShape:
    """A chair with a thin back; +X is its front.

    Args:
        seat: height of the seat, metres.
        width: of the seat.
        height: in all.
        leg: thickness of the legs.
    """
    w = width / 2
    legs = tuple(((a, b, 0.0), (a + leg, b + leg, seat - 0.04)) for a in (-w, w - leg) for b in (-w, w - leg))
    plate = ((-w, -w, seat - 0.04), (w, w, seat))
    back = ((-w, -w, seat), (-w + 0.03, w, height))
    return BoxShape("chair", (plate, back, *legs), ((-w + 0.03, -w, w, w, seat, np.inf, False),))


def bookshelf(width: float = 0.9, depth: float = 0.32, height: float = 1.8, boards: int = 5) -> BoxShape:
    """An open bookcase; +X is its front.

    Args:
        width: metres.
        depth: metres.
        height: metres.
        boards: how many.
    """
    t, d, w = 0.02, depth / 2, width / 2
    step = (height - t) / (boards - 1)
    levels = [k * step for k in range(boards)]
    shelves = tuple(((-d + t, -w + t, z), (d, w - t, z + t)) for z in levels)
    sides = (((-d, -w, 0.0), (d, -w + t, height)), ((-d, w - t, 0.0), (d, w, height)))
    back = ((-d, -w + t, 0.0), (-d + t, w - t, height))
    tops = tuple(
        (-d + t, -w + t, d, w - t, z + t, step - t if k < boards - 1 else np.inf, k < boards - 1)
        for k, z in enumerate(levels)
    )
    return BoxShape("bookshelf", (*shelves, *sides, back), tops)


def sofa(width: float = 1.9, depth: float = 0.9) -> BoxShape:
    """A sofa with arms; +X is its front."""
    d, w = depth / 2, width / 2
    boxes = (
        ((-d, -w, 0.0), (d, w, 0.42)),
        ((-d, -w, 0.42), (-d + 0.2, w, 0.85)),
        ((-d + 0.2, -w, 0.42), (d, -w + 0.18, 0.62)),
        ((-d + 0.2, w - 0.18, 0.42), (d, w, 0.62)),
    )
    return BoxShape("sofa", boxes, ((-d + 0.2, -w + 0.18, d, w - 0.18, 0.42, np.inf, False),))


def block(category: str, x: float, y: float, z: float, *, top: bool = False) -> BoxShape:
    """One box.

    Args:
        category: what it is.
        x: length, metres.
        y: width.
        z: height.
        top: whether things may stand on it.
    """
    surface = ((-x / 2, -y / 2, x / 2, y / 2, z, np.inf, False),) if top else ()
    return BoxShape(category, (((-x / 2, -y / 2, 0.0), (x / 2, y / 2, z)),), surface)


def lamp(height: float = 0.5) -> BoxShape:
    """A table lamp: foot, stem and shade."""
    return BoxShape(
        "lamp",
        (
            ((-0.08, -0.08, 0.0), (0.08, 0.08, 0.02)),
            ((-0.012, -0.012, 0.02), (0.012, 0.012, height - 0.2)),
            ((-0.13, -0.13, height - 0.2), (0.13, 0.13, height)),
        ),
    )


COMPOUNDS: tuple[BoxShape, ...] = (
    table(0.9, 1.4, 0.74), table(0.8, 0.8, 0.72), table(0.6, 1.1, 0.42), table(0.45, 0.45, 0.55),
    chair(), chair(0.46, 0.48, 1.0), bookshelf(), bookshelf(1.2, 0.3, 1.2, 4), sofa(), sofa(1.5),
    block("cabinet", 0.45, 1.0, 0.8, top=True), block("night stand", 0.4, 0.45, 0.5, top=True),
    block("wardrobe", 0.6, 1.2, 2.0), block("picture", 0.03, 0.7, 0.5), block("picture", 0.04, 0.5, 0.7),
    block("television", 0.06, 1.0, 0.6), lamp(), lamp(0.4), block("books", 0.17, 0.12, 0.24),
    block("books", 0.2, 0.15, 0.04), block("vase", 0.12, 0.12, 0.28), block("cup", 0.09, 0.09, 0.1),
    block("laptop", 0.25, 0.34, 0.03), block("plant", 0.35, 0.35, 0.8), block("box", 0.35, 0.45, 0.3, top=True),
    block("microwave", 0.36, 0.48, 0.28),
)  # fmt: skip


@cache
def box_library() -> BoxLibrary:
    """The library that the generated rooms draw from."""
    return BoxLibrary(COMPOUNDS)


@dataclass(frozen=True)
class Noise:
    """What observation does to a true layout: standard deviations."""

    pitch_rad: float = float(np.deg2rad(10.0))
    offset_m: float = 0.08
    scale: float = 0.08

    def times(self, factor: float) -> Noise:
        """This noise, stronger or weaker."""
        return Noise(self.pitch_rad * factor, self.offset_m * factor, self.scale * factor)


@dataclass(frozen=True)
class GeneratedRoom:
    """A true layout and what was observed of it."""

    truth: Scene
    observed: Scene


def room_box(width: float, depth: float, height: float = 2.6) -> Architecture:
    """A rectangular room around the origin; walls face inward."""
    x, y = width / 2, depth / 2
    corners = np.array([[-x, -y, 0.0], [x, -y, 0.0], [x, y, 0.0], [-x, y, 0.0]])
    up = np.array([0.0, 0.0, height])
    planes = [Plane("floor", "floor", corners)]
    for k in range(4):
        a, b = corners[k], corners[(k + 1) % 4]
        planes.append(Plane(f"wall_{k}", "wall", np.array([b, a, a + up, b + up])))
    return Architecture(tuple(planes))


def generate_room(seed: int, count: int, noise: Noise | None = None) -> GeneratedRoom:
    """A furnished room of `count` objects without overlaps, and a noisy observation of it. Deterministic."""
    rng = np.random.default_rng((seed, count))
    builder = _Builder(rng, count)
    truth = builder.furnish()
    return GeneratedRoom(truth, observe(truth, noise or Noise(), rng))


def observe(truth: Scene, noise: Noise, rng: np.random.Generator) -> Scene:
    """Every pose tilted, shifted and stretched at random."""
    return replace(truth, objects=tuple(replace(o, pose=_noisy(o.pose, noise, rng)) for o in truth.objects))


def _noisy(pose: Pose, noise: Noise, rng: np.random.Generator) -> Pose:
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    angle = noise.pitch_rad * abs(rng.normal())
    turn = rotation_from_vector(angle * axis)
    position = pose.position + rng.normal(0.0, noise.offset_m / np.sqrt(3.0), 3)
    return Pose(turn @ pose.R_world_object, position, pose.scale * np.exp(rng.normal(0.0, noise.scale, 3)))


def perturb_graph(scene: Scene, share: float, seed: int) -> Scene:
    """A share of the support edges made wrong or missing, half each; stays acyclic."""
    rng = np.random.default_rng((seed, 77))
    chosen = rng.permutation(len(scene.supports))[: round(share * len(scene.supports))]
    changed = scene
    for turn, k in enumerate(chosen):
        edge = scene.supports[int(k)]
        if turn % 2:
            changed = edits.detach(changed, edge.child)
            continue
        others = [o.id for o in scene.objects if o.id not in (edge.child, edge.parent)]
        try:
            changed = edits.attach(changed, Support(edge.child, str(rng.choice(others))))
        except EditRefused:
            changed = edits.detach(changed, edge.child)
    return changed


class _Builder:
    """Places objects one by one where they fit."""

    def __init__(self, rng: np.random.Generator, count: int) -> None:
        self.rng, self.count = rng, count
        side = float(np.sqrt(count) * 0.58 + 1.2)
        self.half_x, self.half_y = side * 0.55, side * 0.45
        self.library = box_library()
        self._empty(1.0)

    def _empty(self, growth: float) -> None:
        self.half_x, self.half_y = self.half_x * growth, self.half_y * growth
        self.objects: list[SceneObject] = []
        self.supports: list[Support] = []
        self.floor_boxes: list[np.ndarray] = []
        self.resting: dict[tuple[str, int], list[np.ndarray]] = {}
        self.hung: dict[str, list[np.ndarray]] = {}

    def furnish(self) -> Scene:
        """Until the room holds `count` objects."""
        rng, tries = self.rng, 0
        while len(self.objects) < self.count:
            tries += 1
            if tries % (20 * self.count) == 0:
                # Full: what stands against walls would be left behind by a larger room, so begin again.
                self._empty(1.15)
            kind = rng.choice(["table", "chair", "shelf", "floor", "wall", "small", "small", "small", "book", "book"])
            getattr(self, f"_add_{kind}")()
        return Scene(
            architecture=room_box(2 * self.half_x, 2 * self.half_y),
            objects=tuple(self.objects),
            supports=tuple(self.supports),
        )

    def _pick(self, *categories: str) -> Shape:
        options = [s for c in categories for s in self.library.in_category(c)]
        return options[int(self.rng.integers(len(options)))]

    def _put(self, shape: Shape, pose: Pose, parent: str, relation: Relation = "placed on", **edge: Any) -> str:
        name = f"{shape.category.replace(' ', '_')}_{len(self.objects):03d}"
        self.objects.append(SceneObject(name, name, shape.category, shape.id, shape.size_m, pose))
        self.supports.append(Support(name, parent, relation, **edge))
        return name

    def _free_floor(self, half: np.ndarray, *, margin: float = 0.02) -> np.ndarray | None:
        if half[0] >= self.half_x or half[1] >= self.half_y:
            return None
        for _ in range(40):
            x = self.rng.uniform(-self.half_x + half[0], self.half_x - half[0])
            y = self.rng.uniform(-self.half_y + half[1], self.half_y - half[1])
            box = np.array([x - half[0] - margin, y - half[1] - margin, x + half[0] + margin, y + half[1] + margin])
            if not _overlaps(box, self.floor_boxes):
                self.floor_boxes.append(box)
                return np.array([x, y])
        return None

    def _stand(self, shape: Shape, *, extra: float = 0.0) -> tuple[str, Pose] | None:
        yaw = float(self.rng.integers(4)) * np.pi / 2
        half = np.abs(yaw_rotation(yaw)[:2, :2]) @ (np.array(shape.size_m[:2]) / 2 + extra)
        at = self._free_floor(half)
        if at is None:
            return None
        pose = Pose.upright([at[0], at[1], shape.size_m[2] / 2], yaw)
        return self._put(shape, pose, "floor"), pose

    def _add_table(self) -> None:
        shape = self._pick("table")
        tucked = shape.size_m[2] > 0.6
        placed = self._stand(shape, extra=0.35 if tucked else 0.0)
        if placed is None or not tucked:
            return
        for side in self.rng.permutation([-1.0, 1.0])[: int(self.rng.integers(1, 3))]:
            if len(self.objects) < self.count:
                self._tuck(shape, placed[1], float(side))

    def _tuck(self, shape: Shape, pose: Pose, side: float) -> None:
        seat = self._pick("chair")
        into = float(self.rng.uniform(0.1, 0.3))
        x = side * (shape.size_m[0] / 2 + seat.size_m[0] / 2 - into)
        at = pose.apply(np.array([x, float(self.rng.uniform(-0.1, 0.1)), 0.0]))
        yaw = pose.yaw_rad + (np.pi if side > 0 else 0.0)
        self._put(seat, Pose.upright([at[0], at[1], seat.size_m[2] / 2], yaw), "floor")

    def _add_chair(self) -> None:
        self._stand(self._pick("chair"))

    def _add_floor(self) -> None:
        self._stand(self._pick("sofa", "cabinet", "night stand", "wardrobe", "plant", "box"))

    def _add_shelf(self) -> None:
        shape = self._pick("bookshelf")
        wall, along, yaw = self._wall_spot(shape.size_m[1] / 2)
        depth = shape.size_m[0] / 2
        at = along + np.array([np.cos(yaw), np.sin(yaw)]) * depth
        half = np.abs(yaw_rotation(yaw)[:2, :2]) @ (np.array(shape.size_m[:2]) / 2)
        box = np.concatenate([at - half - 0.05, at + half + 0.05])
        if _overlaps(box, self.floor_boxes) or self._hangs_near(wall, along, shape.size_m[1] / 2, 0.0, shape.size_m[2]):
            return
        self.floor_boxes.append(box)
        self._put(shape, Pose.upright([*at, shape.size_m[2] / 2], yaw), "floor", adheres_to=(wall,))

    def _wall_spot(self, half_width: float) -> tuple[str, np.ndarray, float]:
        """A wall's id, a point on its foot, and the heading away from it."""
        k = int(self.rng.integers(4))
        yaw = [np.pi / 2, np.pi, -np.pi / 2, 0.0][k]
        reach = (self.half_x if k % 2 == 0 else self.half_y) - half_width - 0.05
        t = float(self.rng.uniform(-max(reach, 0.0), max(reach, 0.0)))
        foot = [(t, -self.half_y), (self.half_x, t), (t, self.half_y), (-self.half_x, t)][k]
        return f"wall_{k}", np.array(foot), yaw

    def _hangs_near(self, wall: str, along: np.ndarray, half: float, low: float, high: float) -> bool:
        t = float(along[0] if wall in ("wall_0", "wall_2") else along[1])
        box = np.array([t - half - 0.05, low - 0.05, t + half + 0.05, high + 0.05])
        if _overlaps(box, self.hung.setdefault(wall, [])):
            return True
        self.hung[wall].append(box)
        return False

    def _add_wall(self) -> None:
        shape = self._pick("picture", "television")
        wall, along, yaw = self._wall_spot(shape.size_m[1] / 2)
        z = float(self.rng.uniform(1.3, 1.9))
        outward = np.array([np.cos(yaw), np.sin(yaw)])
        at = along + outward * shape.size_m[0] / 2
        half = np.abs(yaw_rotation(yaw)[:2, :2]) @ (np.array(shape.size_m[:2]) / 2)
        tall = [o for o in self.objects if o.pose.position[2] + o.size_m[2] / 2 > z - 0.5]
        if any(np.linalg.norm(o.pose.position[:2] - at) < np.linalg.norm(o.size_m[:2]) / 2 + half.max() for o in tall):
            return
        if self._hangs_near(wall, along, shape.size_m[1] / 2, z - shape.size_m[2] / 2, z + shape.size_m[2] / 2):
            return
        self._put(shape, Pose.upright([*at, z], yaw), wall, "mounted on")

    def _add_small(self) -> None:
        self._rest_on(self._pick("lamp", "vase", "cup", "laptop", "books", "microwave"), interior=False)

    def _add_book(self) -> None:
        self._rest_on(self._pick("books", "vase", "cup"), interior=True)

    def _rest_on(self, shape: Shape, *, interior: bool) -> None:
        hosts = [
            (o, k, s)
            for o in self.objects
            for k, s in enumerate(self.library.shape(o.shape_id).surfaces)
            if s.interior == interior and o.category != "chair" and s.clearance_m > shape.size_m[2] + 0.01
        ]
        if not hosts:
            return
        host, k, surface = hosts[int(self.rng.integers(len(hosts)))]
        low, high = surface.polygon.min(axis=0), surface.polygon.max(axis=0)
        yaw = 0.0 if interior else float(self.rng.uniform(-0.5, 0.5))
        half = np.abs(yaw_rotation(yaw)[:2, :2]) @ (np.array(shape.size_m[:2]) / 2) + 0.005
        if (high[:2] - low[:2] <= 2 * half).any():
            return
        at = self.rng.uniform(low[:2] + half, high[:2] - half)
        box = np.concatenate([at - half, at + half])
        resting = self.resting.setdefault((host.id, k), [])
        if _overlaps(box, resting):
            return
        resting.append(box)
        centre = host.pose.apply(np.array([at[0], at[1], surface.height_m + shape.size_m[2] / 2]))
        if self._hits_wall_objects(centre, shape):
            resting.pop()
            return
        self._put(shape, Pose.upright(centre, host.pose.yaw_rad + yaw), host.id, parent_surface=k)

    def _hits_wall_objects(self, centre: np.ndarray, shape: Shape) -> bool:
        radius = float(np.linalg.norm(shape.size_m)) / 2
        hung = [o for o in self.objects if o.category in ("picture", "television")]
        return any(np.linalg.norm(o.pose.position - centre) < radius + np.linalg.norm(o.size_m) / 2 for o in hung)


def _overlaps(box: np.ndarray, others: Sequence[np.ndarray]) -> bool:
    return any(box[0] < o[2] and o[0] < box[2] and box[1] < o[3] and o[1] < box[3] for o in others)
