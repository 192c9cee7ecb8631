"""Puts objects into a room one at a time, each only where it is free, reachable and held up."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.editing.room_frame import WallLine
from diorama_core.layout.problem.parts import parts_of_shape
from diorama_core.library.record import Shape, ShapeLibrary, SupportSurface
from diorama_core.scene.types import Pose, SceneObject, Support, box_corners
from diorama_core.synthesis.bodies import Item, PlacedBodies, heights_below
from diorama_core.synthesis.plan import RoomPlan, footprint, quads_overlap

WALL_GAP_M = 0.012
"""Skirting boards keep furniture this far from walls."""
TRIES = 40


@dataclass(frozen=True, eq=False)
class Zone:
    """Floor that must stay free of anything higher than `above_m`: before doors, windows, beds and wardrobes."""

    quad: Float[np.ndarray, "4 2"]
    above_m: float = 0.0


@dataclass(frozen=True)
class Spread:
    """How much shapes vary in size: standard deviations of the logarithm, all axes together and each alone."""

    common: float = 0.03
    per_axis: float = 0.012


class Furnisher:
    """A room being furnished. Every method that places returns the new object's id, or None when nothing fits.

    Args:
        plan: The empty room.
        library: Where shapes come from; chosen by category.
        rng: The source of chance.
        spread: How much sizes vary.
    """

    def __init__(
        self, plan: RoomPlan, library: ShapeLibrary, rng: np.random.Generator, spread: Spread | None = None
    ) -> None:
        self.plan, self.library, self.rng = plan, library, rng
        self.spread = spread or Spread()
        self.objects: list[SceneObject] = []
        self.supports: list[Support] = []
        self.bodies = PlacedBodies(library)
        self.items: dict[str, Item] = {}
        self._standing: dict[str, np.ndarray] = {}
        self._zones: list[Zone] = []
        self._hung: dict[str, list[np.ndarray]] = {}
        self._lying: dict[tuple[str, int], list[np.ndarray]] = {}
        self._full: dict[str, Shape] = {}

    # choosing

    def pick(self, *categories: str, where: Callable[[Shape], bool] | None = None) -> Item | None:
        """A random shape of the categories, a little larger or smaller than made; None when there is none."""
        options = [s for c in categories for s in self.library.in_category(c) if where is None or where(s)]
        return self.scale(options[int(self.rng.integers(len(options)))]) if options else None

    def scale(self, shape: Shape) -> Item:
        """A shape at a random size near its own."""
        log = self.rng.normal(0.0, self.spread.common) + self.rng.normal(0.0, self.spread.per_axis, 3)
        if shape.symmetry >= 3:
            log[1] = log[0]
        sx, sy, sz = np.exp(np.clip(log, -0.1, 0.1))
        return Item(shape, (float(sx), float(sy), float(sz)))

    def chance(self, probability: float) -> bool:
        """True with the given probability."""
        return bool(self.rng.random() < probability)

    def object(self, object_id: str) -> SceneObject:
        """A placed object."""
        return next(o for o in self.objects if o.id == object_id)

    def surfaces(self, object_id: str) -> tuple[SupportSurface, ...]:
        """Support surfaces of a placed object's shape, canonical frame at scale 1."""
        shape_id = self.object(object_id).shape_id
        if shape_id not in self._full:
            self._full[shape_id] = self.library.shape(shape_id)
        return self._full[shape_id].surfaces

    # keeping free

    def keep_free(self, quad: Float[np.ndarray, "4 2"], above_m: float = 0.0) -> None:
        """Nothing higher than `above_m` may stand on this floor from now on."""
        self._zones.append(Zone(quad, above_m))

    def forget_last_zone(self) -> None:
        """Let the floor kept free for the last object be used by what belongs to it."""
        self._zones.pop()

    def is_free(self, item: Item, xy: Float[np.ndarray, "2"], yaw_rad: float) -> bool:
        """Whether the floor under an item is free of furniture and not kept free.

        Args:
            item: The shape.
            xy: Of its middle, metres.
            yaw_rad: Heading, 0 along +X.
        """
        return self._floor_free(item, footprint(item.size_m, xy, yaw_rad), ())

    # on the floor

    def stand(
        self,
        item: Item,
        xy: Float[np.ndarray, "2"],
        yaw_rad: float,
        *,
        free_front_m: float = 0.0,
        beside: Collection[str] = (),
        adheres_to: tuple[str, ...] = (),
        in_zone: bool = False,
    ) -> str | None:
        """On the floor, or on a rug that carries all of it, front toward `yaw_rad`.

        Args:
            item: What.
            xy: Centre of its footprint.
            yaw_rad: Heading of its front.
            free_front_m: Floor before it that stays free for people.
            beside: Ids whose footprints it may share (a chair under a table); meshes still must not meet.
            adheres_to: Walls it stands against.
            in_zone: Whether it may use floor that is kept free.
        """
        quad = footprint(item.size_m, xy, yaw_rad)
        if not self._floor_free(item, quad, beside, in_zone=in_zone):
            return None
        front = self._front(item, xy, yaw_rad, free_front_m)
        if free_front_m and (not self.plan.contains(front, 1e-3) or self._is_blocked(front, beside)):
            return None
        parent, base = self._ground(quad)
        pose = self._upright(item, xy, base, yaw_rad)
        if not self._fits_under_roof(item, pose) or self.bodies.hit_by(item, pose, ignore={parent}):
            return None
        placed = self._put(
            item, pose, Support("", parent, "placed on", 0 if parent != "floor" else None, "bottom", adheres_to)
        )
        if item.category != "rug":
            self._standing[placed] = quad
        if free_front_m:
            self._zones.append(Zone(front))
        return placed

    def against_wall(
        self,
        item: Item,
        *,
        walls: Sequence[WallLine] | None = None,
        t_m: float | None = None,
        free_front_m: float = 0.45,
        gap_m: float = WALL_GAP_M,
        corner: bool = False,
    ) -> str | None:
        """Back to a wall: at `t_m` along it, in a corner, or anywhere that is free.

        Args:
            item: The shape.
            walls: To choose from; all by default.
            t_m: Of its middle from the wall's left end; None for anywhere.
            free_front_m: Kept free before it.
            gap_m: To the wall.
            corner: Whether it stands in a corner.
        """
        width, depth = item.size_m[1], item.size_m[0]
        options = [w for w in (walls or self.plan.walls) if w.length_m > width + 2 * WALL_GAP_M]
        for _ in range(TRIES if t_m is None else 1):
            if not options:
                return None
            wall = options[int(self.rng.integers(len(options)))]
            low, high = width / 2 + WALL_GAP_M, wall.length_m - width / 2 - WALL_GAP_M
            t = float(self.rng.uniform(low, high)) if t_m is None else t_m
            if corner:
                t = low if self.chance(0.5) else high
            placed = self.stand(
                item,
                wall.point(t, depth / 2 + gap_m),
                wall.yaw_rad,
                free_front_m=free_front_m,
                adheres_to=(wall.id,),
            )
            if placed:
                return placed
        return None

    def anywhere(self, item: Item, *, margin_m: float = 0.0) -> str | None:
        """Somewhere on free floor, at any angle.

        Args:
            item: The shape.
            margin_m: Kept free around it.
        """
        low, high = self.plan.outline.min(axis=0), self.plan.outline.max(axis=0)
        reach = item.size_m[:2].max() / 2 + margin_m
        for _ in range(TRIES):
            if (high - low <= 2 * reach).any():
                return None
            xy = self.rng.uniform(low + reach, high - reach)
            placed = self.stand(item, xy, float(self.rng.uniform(-np.pi, np.pi)))
            if placed:
                return placed
        return None

    # on walls and ceiling

    def hang(self, item: Item, wall: WallLine, t_m: float, centre_z_m: float) -> str | None:
        """Back against a wall, centred `t_m` from its left end and `centre_z_m` above the floor.

        Args:
            item: The shape.
            wall: Where it is.
            t_m: Of its middle from the wall's left end.
            centre_z_m: Above the floor.
        """
        half = item.size_m[1] / 2
        low, high = centre_z_m - item.size_m[2] / 2, centre_z_m + item.size_m[2] / 2
        if t_m - half < 0.03 or t_m + half > wall.length_m - 0.03 or low < -1e-6:
            return None
        rectangle = np.array([t_m - half - 0.06, low - 0.04, t_m + half + 0.06, high + 0.04])
        if any(_rectangles_overlap(rectangle, other) for other in self._hung.get(wall.id, [])):
            return None
        xy = wall.point(t_m, item.size_m[0] / 2)
        pose = Pose.upright([*xy, centre_z_m], wall.yaw_rad, item.scale)
        outward = np.array([*wall.inward, 0.0]) * 1e-3
        if not self._fits_under_roof(item, pose) or self.bodies.hit_by(item, pose, lift=outward):
            return None
        self._hung.setdefault(wall.id, []).append(rectangle)
        return self._put(item, pose, Support("", wall.id, "mounted on", None, "back"))

    def hang_from_ceiling(self, item: Item, xy: Float[np.ndarray, "2"], yaw_rad: float = 0.0) -> str | None:
        """Top against the level part of the ceiling.

        Args:
            item: The shape.
            xy: Of its middle, metres.
            yaw_rad: Heading, 0 along +X.
        """
        quad = footprint(item.size_m, xy, yaw_rad)
        if not self.plan.contains(quad) or (self.plan.roof_m(quad) < self.plan.height_m).any():
            return None
        z = self.plan.height_m - item.size_m[2] / 2
        if z - item.size_m[2] / 2 < 1.5:
            return None
        pose = Pose.upright([*xy, z], yaw_rad, item.scale)
        if self.bodies.hit_by(item, pose, lift=(0.0, 0.0, -1e-3)):
            return None
        return self._put(item, pose, Support("", "ceiling", "mounted on", None, "top"))

    # on other objects

    def rest(
        self, item: Item, parent_id: str, surface: int, xy_local: Float[np.ndarray, "2"], turn_rad: float = 0.0
    ) -> str | None:
        """On a surface of a placed object.

        Args:
            item: What.
            parent_id: The object that carries it.
            surface: Index into the parent shape's support surfaces.
            xy_local: Where, metres along the parent's own axes (scaled) from its centre.
            turn_rad: Heading relative to the parent's.
        """
        parent = self.object(parent_id)
        face, scale = self.surfaces(parent_id)[surface], parent.pose.scale
        if item.size_m[2] > face.clearance_m * scale[2] - 0.01:
            return None
        quad = footprint(item.size_m, xy_local, turn_rad)
        if not _is_inside_convex(quad, face.polygon[:, :2] * scale[:2]):
            return None
        if any(quads_overlap(quad, other) for other in self._lying.get((parent_id, surface), [])):
            return None
        height = self._resting_height(parent, face, item, quad)
        if height is None:
            return None
        local = np.array([*xy_local, height + item.size_m[2] / 2])
        if self._is_shut_in(parent, local / scale):
            return None
        centre = parent.pose.R_world_object @ local + parent.pose.position
        pose = Pose.upright(centre, parent.pose.yaw_rad + turn_rad, item.scale)
        if not self._fits_under_roof(item, pose):
            return None
        if not self.plan.contains(footprint(item.size_m, centre[:2], pose.yaw_rad)) or self.bodies.hit_by(item, pose):
            return None
        self._lying.setdefault((parent_id, surface), []).append(quad)
        return self._put(item, pose, Support("", parent_id, "placed on", surface, "bottom"))

    def _is_shut_in(self, parent: SceneObject, point: Float[np.ndarray, "3"]) -> bool:
        """Whether a point of a shape's frame is behind its doors: what is closed is solid for everything else."""
        for part in parts_of_shape(self.library, self._full[parent.shape_id]):
            across, at = part.vertices @ part.normals.T, part.normals @ point
            if (across.min(axis=0) < at).all() and (at < across.max(axis=0)).all():
                return True
        return False

    def _resting_height(
        self, parent: SceneObject, face: SupportSurface, item: Item, quad: Float[np.ndarray, "4 2"]
    ) -> float | None:
        """Height (parent's frame, scaled) at which the item rests level, or None where it would tip."""
        scale = parent.pose.scale
        steps = np.array([0.12, 0.5, 0.88])
        a, b = np.meshgrid(steps, steps)
        spots = quad[0] + a.reshape(-1, 1) * (quad[1] - quad[0]) + b.reshape(-1, 1) * (quad[3] - quad[0])
        above = min(0.04, 0.5 * face.clearance_m)
        probes = np.column_stack([spots / scale[:2], np.full(len(spots), face.height_m + above)])
        heights = heights_below(self.library, parent.shape_id, probes, above + 0.03) * scale[2]
        top = heights.max()
        carried = heights > top - 0.004
        wide = (
            len({k % 3 for k in np.flatnonzero(carried)}) == 3 and len({k // 3 for k in np.flatnonzero(carried)}) == 3
        )
        return float(top) if np.isfinite(top) and carried.sum() >= 5 and wide else None

    # inner workings

    def _upright(self, item: Item, xy: Float[np.ndarray, "2"], base_m: float, yaw_rad: float) -> Pose:
        return Pose.upright([xy[0], xy[1], base_m + item.size_m[2] / 2], yaw_rad, item.scale)

    def _fits_under_roof(self, item: Item, pose: Pose) -> bool:
        return self.plan.fits_under_roof(box_corners(item.size_m) @ pose.R_world_object.T + pose.position)

    def _front(self, item: Item, xy: np.ndarray, yaw_rad: float, free_m: float) -> Float[np.ndarray, "4 2"]:
        ahead = np.array([np.cos(yaw_rad), np.sin(yaw_rad)]) * (item.size_m[0] + free_m) / 2
        return footprint(np.array([max(free_m, 1e-3), item.size_m[1] * 0.9, 0.0]), xy + ahead, yaw_rad)

    def _is_blocked(self, quad: Float[np.ndarray, "4 2"], beside: Collection[str] = ()) -> bool:
        return any(quads_overlap(quad, other) for name, other in self._standing.items() if name not in beside)

    def _floor_free(
        self, item: Item, quad: Float[np.ndarray, "4 2"], beside: Collection[str], *, in_zone: bool = False
    ) -> bool:
        if not self.plan.contains(quad):
            return False
        if item.category == "rug":
            return True
        if not in_zone and any(item.size_m[2] > z.above_m and quads_overlap(quad, z.quad) for z in self._zones):
            return False
        return not self._is_blocked(quad, beside)

    def _ground(self, quad: Float[np.ndarray, "4 2"]) -> tuple[str, float]:
        """What carries a footprint: a rug that holds all of it, or the floor; and its height."""
        for item in self.objects:
            if item.category == "rug":
                faces = self.surfaces(item.id)
                local = (quad - item.pose.position[:2]) @ item.pose.R_world_object[:2, :2]
                if faces and _is_inside_convex(local, faces[0].polygon[:, :2] * item.pose.scale[:2]):
                    return item.id, float(item.pose.position[2] + item.size_m[2] / 2)
        return "floor", 0.0

    def _put(self, item: Item, pose: Pose, edge: Support) -> str:
        count = sum(o.category == item.category for o in self.objects) + 1
        name = f"{item.category.replace(' ', '_')}_{count}"
        self.objects.append(
            SceneObject(name, f"{item.category} {count}", item.category, item.shape.id, item.shape.size_m, pose)
        )
        self.supports.append(replace(edge, child=name))
        self.items[name] = item
        self.bodies.add(name, item, pose)
        return name


def _rectangles_overlap(a: Float[np.ndarray, "4"], b: Float[np.ndarray, "4"]) -> bool:
    return bool(a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3])


def _is_inside_convex(points: Float[np.ndarray, "n 2"], polygon: Float[np.ndarray, "m 2"]) -> bool:
    """True if all points lie in a convex counter-clockwise polygon (to a tenth of a millimetre)."""
    edges = np.roll(polygon, -1, axis=0) - polygon
    offset = points[:, None] - polygon
    cross = edges[:, 0] * offset[..., 1] - edges[:, 1] * offset[..., 0]
    return bool((cross >= -1e-4 * np.maximum(np.linalg.norm(edges, axis=1), 1e-9)).all())
