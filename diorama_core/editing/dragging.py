"""Dragging an object itself: it slides over the floor, climbs onto a table, sticks to a wall.

Pure: built once when a drag begins, asked for every position of the hand.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float

from diorama_core.arrangement.surfaces import RestingSurface, plane_surface
from diorama_core.editing.placing import (
    SupportTarget,
    clamp_to_wall,
    fits,
    hits_along,
    nearest_point,
    places_of,
    to_wall,
)
from diorama_core.editing.stretching import new_poses
from diorama_core.errors import EditRefused
from diorama_core.geometry.rooms import part_of_home, rooms_of_objects
from diorama_core.layout.feasible.local import DragSolver
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import resolve
from diorama_core.scene import edits
from diorama_core.scene.frames import UP_WORLD
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Pose, Scene, SceneObject, yaw_rotation

GRID_M = 0.05
ANGLE_STEP_RAD = float(np.radians(15.0))


@dataclass(frozen=True, eq=False)
class Slide:
    """One drag, from where it began."""

    scene: Scene
    library: ShapeLibrary
    item: SceneObject
    grabbed: Float[np.ndarray, "3"]
    """The point of the object under the hand when the drag began, world."""
    along: tuple[str, ...] = ()
    """Other selected objects, which move by the same amount."""
    rooms: frozenset[str] = frozenset()
    """Ids of the rooms of a home that are seen, where the hand can put it; none: all."""
    _solvers: dict[str, DragSolver] = field(default_factory=dict)
    """Of a home's rooms that it came to so far."""

    @classmethod
    def begin(
        cls,
        scene: Scene,
        library: ShapeLibrary,
        object_id: str,
        grabbed: Float[np.ndarray, "3"],
        selection: tuple[str, ...] = (),
        rooms: frozenset[str] = frozenset(),
    ) -> Slide:
        """A drag of an object (and, when it is among several selected, of those too); refused when it is locked.

        Args:
            scene: as it is.
            library: where shapes come from.
            object_id: of the object.
            grabbed: point of it under the pointer, world, metres.
            selection: ids that are selected.
            rooms: ids of the rooms of a home that are seen; none: all.
        """
        item = scene.object(object_id)
        if item.locked:
            raise EditRefused(f"{item.label} is locked; unlock it first")
        riding = {object_id, *descendants(scene, object_id)}
        along = (
            [i for i in selection if i not in riding and not scene.object(i).locked] if object_id in selection else []
        )
        nested = {d for i in along for d in descendants(scene, i)}
        along = [i for i in along if i not in nested and object_id not in descendants(scene, i)]
        return cls(scene, library, item, np.asarray(grabbed, dtype=np.float64), tuple(along), rooms)

    @cached_property
    def places(self) -> tuple[SupportTarget, ...]:
        """Where it may go: what hangs stays on walls or ceiling, what stands on the floor leaves tables alone."""
        moved_ids = {self.item.id, *descendants(self.scene, self.item.id), *self.along}
        seen = part_of_home(self.scene, self.rooms) if self.rooms else self.scene
        places = places_of(seen, self.library, moved_ids)
        edge = self.scene.support_of(self.item.id)
        parent = None if edge is None else edge.parent
        if edge is not None and parent is not None and self.scene.has_plane(parent):
            role = self.scene.plane(parent).role
            if role != "floor":
                planes = {p.id for p in self.scene.architecture.by_role(role)}
                return tuple(p for p in places if p.parent in planes)
        climbs = resolve(self.item.category).category.mount != "floor"
        return tuple(p for p in places if p.upward and (climbs or not p.of_object or p.parent == parent))

    @cached_property
    def solver(self) -> DragSolver:
        """Prevents collisions with walls and other objects."""
        return DragSolver.prepare(self.scene, self.library, self.item.id)

    def to(
        self, eye: Float[np.ndarray, "3"], direction: Float[np.ndarray, "3"], *, snap: bool, slide: bool
    ) -> tuple[Scene, Mapping[str, Pose]]:
        """The scene with the drag at this pointer ray.

        Args:
            eye: where the person looks from, world.
            direction: through the pointer.
            snap: keep to the grid, and flush to a wall right behind.
            slide: go along what is in the way instead of into it.

        Returns:
            The scene as it would be committed, and the poses that differ from the start.
        """
        pose, place = self._target(np.asarray(eye), np.asarray(direction))
        if snap:
            pose = self._snap(pose, place)
        if slide and not self.along and (place is None or place.upward):
            scene = self._slide(pose, place)
        else:
            scene = self._move(pose, place)
        return scene, new_poses(self.scene, scene)

    def _slide(self, pose: Pose, place: SupportTarget | None) -> Scene:
        """The scene with the object as near to a pose as it can be; of a home only the room that it comes to counts."""
        if not self.scene.rooms:
            return self.solver.solve(pose)
        moved = self._move(pose, place)
        item = moved.object(self.item.id)
        room = rooms_of_objects(replace(moved, objects=(item,), supports=())).get(item.id)
        if room is None:
            return moved
        if room not in self._solvers:
            self._solvers[room] = DragSolver.prepare(part_of_home(moved, [room]), self.library, item.id)
        solved = self._solvers[room].solve(pose)
        moved, edge = edits.move(moved, item.id, solved.object(item.id).pose), solved.support_of(item.id)
        return moved if edge is None or edge == moved.support_of(item.id) else edits.attach(moved, edge)

    def _move(self, pose: Pose, place: SupportTarget | None) -> Scene:
        scene = edits.move(self.scene, self.item.id, pose)
        edge = self.scene.support_of(self.item.id)
        if place is not None and (edge is None or edge.parent != place.parent):
            scene = edits.attach(scene, place.edge(self.item.id))
        shift = pose.position - self.item.pose.position
        for other in self.along:
            scene = edits.move(scene, other, scene.object(other).pose.move(shift * (1.0, 1.0, 0.0)))
        return scene

    def _target(self, eye: np.ndarray, direction: np.ndarray) -> tuple[Pose, SupportTarget | None]:
        edge = self.scene.support_of(self.item.id)
        if edge is not None and self.places and not self.places[0].upward:
            return self._slide_on_walls(plane_surface(self.scene.plane(edge.parent)), eye, direction)
        return self._standing(eye, direction)

    def _standing(self, eye: np.ndarray, direction: np.ndarray) -> tuple[Pose, SupportTarget | None]:
        item = self.item
        base = item.pose.position - item.pose.R_world_object[:, 2] * item.size_m[2] / 2
        reach = self.grabbed - base
        lift = max(float(reach[2]), 0.0)
        for hit in hits_along(eye, direction, self.places, lift_m=lift):
            target = np.array([*(hit.point - reach)[:2], hit.place.surface.level])
            if fits(hit.place, item.size_m, target, item.pose.R_world_object):
                return item.pose.move(target - base), hit.place
        ground = [p for p in self.places if not p.of_object]
        for hit in hits_along(eye, direction, ground, lift_m=lift, slack_m=100.0):
            point = nearest_point(hit.place.surface, hit.point)
            target = np.array([*(point - reach)[:2], hit.place.surface.level])
            return item.pose.move(target - base), hit.place
        level = self._level(eye, direction)
        return (item.pose, None) if level is None else (item.pose.move(level - self.grabbed), None)

    def _level(self, eye: np.ndarray, direction: np.ndarray) -> np.ndarray | None:
        """The hand in the level plane of the grabbed point, where there is no floor."""
        if abs(float(direction[2])) < 1e-6:
            return None
        distance = (self.grabbed[2] - eye[2]) / direction[2]
        return eye + distance * direction if 0 < distance < 50.0 else None

    def _slide_on_walls(
        self, start: RestingSurface, eye: np.ndarray, direction: np.ndarray
    ) -> tuple[Pose, SupportTarget | None]:
        item = self.item
        lift = float(start.normal @ self.grabbed) - start.level
        hits = hits_along(eye, direction, self.places, lift_m=lift) or hits_along(
            eye, direction, self.places, lift_m=lift, slack_m=1.5
        )
        if not hits:
            return item.pose, None
        hit = hits[0]
        surface = hit.place.surface
        turn = _turn(start.normal, surface.normal)
        position = hit.point + lift * surface.normal + turn @ (item.pose.position - self.grabbed)
        pose = Pose(turn @ item.pose.R_world_object, _clamp_to(surface, position), item.pose.scale)
        wall = self.scene.plane(hit.place.parent) if self.scene.has_plane(hit.place.parent) else None
        return (pose if wall is None else clamp_to_wall(replace(item, pose=pose), wall)), hit.place

    def _snap(self, pose: Pose, place: SupportTarget | None) -> Pose:
        if place is not None and not place.upward and abs(float(place.surface.normal[2])) < 0.7:
            n = place.surface.normal
            across = np.array([-n[1], n[0], 0.0])
            return pose.move(_to_grid_m(across, pose) * across + _to_grid_m(UP_WORLD, pose) * UP_WORLD)
        x, y = np.eye(3)[:2]
        snapped = pose.move(_to_grid_m(x, pose) * x + _to_grid_m(y, pose) * y)
        walls = [plane_surface(p) for p in self.scene.architecture.by_role("wall")]
        return to_wall(replace(self.item, pose=snapped), walls)


def snap_pose(start: Pose, pose: Pose) -> Pose:
    """A gizmo's pose on the grid: places to 5 cm, headings to 15 degrees, each only where the hand changed it."""
    if not np.allclose(start.position, pose.position, atol=1e-6):
        moved = np.abs(start.position - pose.position) > 1e-6
        position = np.where(moved, np.round(pose.position / GRID_M) * GRID_M, pose.position)
        pose = replace(pose, position=position)
    turn = pose.yaw_rad - start.yaw_rad
    if abs(np.arctan2(np.sin(turn), np.cos(turn))) > 1e-6:
        stepped = round(pose.yaw_rad / ANGLE_STEP_RAD) * ANGLE_STEP_RAD
        pose = replace(pose, R_world_object=yaw_rotation(stepped - pose.yaw_rad) @ pose.R_world_object)
    return pose


def _to_grid_m(axis: Float[np.ndarray, "3"], pose: Pose) -> float:
    """How far along an axis the next place on the grid is."""
    at = float(axis @ pose.position)
    return round(at / GRID_M) * GRID_M - at


def _turn(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """The turn about up that brings one level direction to another; none for ceilings."""
    if abs(float(before[2])) > 0.7 or abs(float(after[2])) > 0.7:
        return np.eye(3)
    return yaw_rotation(float(np.arctan2(after[1], after[0]) - np.arctan2(before[1], before[0])))


def _clamp_to(surface: RestingSurface, position: np.ndarray) -> np.ndarray:
    """The centre moved so that the object's middle stays over the surface."""
    foot = position - (float(surface.normal @ position) - surface.level) * surface.normal
    return position + nearest_point(surface, foot) - foot
