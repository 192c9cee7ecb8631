"""Detects problems of objects in the background: collisions, floating, outside the room."""

from __future__ import annotations

import logging
import threading
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping

import numpy as np
from jaxtyping import Float

from diorama_core.arrangement.surfaces import overhang_m
from diorama_core.editing.collisions import Collisions
from diorama_core.editing.placing import places_of
from diorama_core.errors import DioramaError
from diorama_core.geometry.rooms import rooms_of_objects, rooms_of_planes
from diorama_core.library import taxonomy
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.room_edits import floor_height
from diorama_core.scene.types import Plane, Scene, SceneObject

log = logging.getLogger(__name__)

FLOATING_M = 0.03
OUTSIDE_M = 0.06
BESIDE_M = 0.02
SETTLE_S = 0.15
"""Delay so that edits are displayed first and only the last of several quick edits is checked."""
COLLIDES, FLOATS, OUTSIDE = "collides", "floats", "outside"

Problems = Mapping[str, tuple[str, ...]]


def problems(scene: Scene, library: ShapeLibrary, collisions: Collisions) -> Problems:
    """By object id, what is wrong with it, in a word each; nothing for objects that are fine."""
    found = defaultdict[str, set[str]](set)
    for pair in collisions.pairs(scene, [o.id for o in scene.objects]):
        for object_id in pair:
            found[object_id].add(COLLIDES)
    rooms, planes = rooms_of_objects(scene), scene.architecture.planes
    faces: dict[str, list[Plane]] = {}
    for plane_id, room in rooms_of_planes(scene).items():
        faces.setdefault(room, []).append(scene.plane(plane_id))
    for item in scene.objects:
        if item.hidden:
            continue
        if floats(scene, library, item):
            found[item.id].add(FLOATS)
        if is_outside_room(faces.get(rooms.get(item.id, ""), planes), item):
            found[item.id].add(OUTSIDE)
    return {i: tuple(sorted(words)) for i, words in found.items()}


def floats(scene: Scene, library: ShapeLibrary, item: SceneObject) -> bool:
    """Whether there is a visible gap between an object and its support."""
    edge = scene.support_of(item.id)
    if taxonomy.resolve(item.category).category.soft:
        return False
    if edge is None:
        return bool(scene.architecture.planes) and item.corners_world[:, 2].min() > FLOATING_M
    if scene.has_plane(edge.parent):
        plane = scene.plane(edge.parent)
        return float((item.corners_world @ plane.normal).min()) - plane.offset > FLOATING_M
    if edge.relation == "mounted on":
        return False
    low = float(item.corners_world[:, 2].min())
    foot = item.pose.position
    parent = scene.object(edge.parent)
    tops = [
        p.surface.level
        for p in places_of(Scene(objects=(parent,)), library)
        if p.upward and overhang_m(p.surface, foot) < 0.05
    ]
    if not tops and _is_beside(foot, parent):
        return low - floor_height(scene) > FLOATING_M
    below = [t for t in tops if t <= low + FLOATING_M] or [float(parent.corners_world[:, 2].max())]
    return low - max(below) > FLOATING_M


def _is_beside(foot: Float[np.ndarray, 3], parent: SceneObject) -> bool:
    """Whether a foot is outside the box of what should carry it."""
    local = np.abs((foot - parent.pose.position) @ parent.pose.R_world_object)
    return bool((local[:2] > parent.size_m[:2] / 2 + BESIDE_M).any())


def is_outside_room(planes: Iterable[Plane], item: SceneObject) -> bool:
    """True if an object's middle is beyond the floor's outline, or it sticks far through a wall."""
    corners = item.corners_world
    for plane in planes:
        within = plane.polygon.min(axis=0) - 0.2 <= item.pose.position
        within &= item.pose.position <= plane.polygon.max(axis=0) + 0.2
        across = np.abs(plane.normal) > 0.9
        if not within[~across].all():
            continue
        if float((corners @ plane.normal).min()) - plane.offset < -OUTSIDE_M:
            return True
    return False


class Checker:
    """A thread that looks for problems in the newest scene and tells when they changed."""

    def __init__(self, library: ShapeLibrary, on_problems: Callable[[Problems], None]) -> None:
        self._library = library
        self._on_problems = on_problems
        self._collisions = Collisions(library)
        self._condition = threading.Condition()
        self._scene: Scene | None = None
        self._stopping = False
        self._busy = False
        self._thread: threading.Thread | None = None

    def look_at(self, scene: Scene) -> None:
        """Check this scene soon; replaces an older pending one."""
        with self._condition:
            self._scene = scene
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, daemon=True, name="checker")
                self._thread.start()
            self._condition.notify_all()

    def wait(self, timeout_s: float = 60.0) -> bool:
        """Block until the newest scene is checked."""
        with self._condition:
            return self._condition.wait_for(lambda: self._scene is None and not self._busy, timeout_s)

    def stop(self) -> None:
        """End the thread."""
        with self._condition:
            self._stopping = True
            self._condition.notify_all()
        if self._thread is not None:
            self._thread.join(timeout=5.0)

    def _work(self) -> None:
        last: Problems = {}
        while True:
            with self._condition:
                self._condition.wait_for(lambda: self._scene is not None or self._stopping)
                self._condition.wait_for(lambda: self._stopping, SETTLE_S)
                if self._stopping:
                    return
                scene, self._scene = self._scene, None
                self._busy = True
            assert scene is not None
            found: Problems = {}
            try:
                found = problems(scene, self._library, self._collisions)
            except DioramaError as error:
                log.warning("the scene cannot be checked: %s", error)
            except Exception:  # badges are missing then; the thread goes on with the next scene
                log.exception("the scene cannot be checked")
            if found != last:
                last = found
                self._on_problems(found)
            with self._condition:
                self._busy = False
                self._condition.notify_all()
