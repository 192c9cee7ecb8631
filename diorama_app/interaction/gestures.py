"""Mouse gestures in the 3D view: pick, rectangle, drag an object, drag the gizmo, click a place.

A drag shows a preview while it lasts and becomes one undo step when it ends; Esc restores the scene.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import viser
from jaxtyping import Float

from diorama_app.commands.insert import place_at
from diorama_app.commands.measure import measure_at
from diorama_app.commands.room_looks import surface_under
from diorama_app.interaction.resize_handles import SizeHandles
from diorama_app.session.client import Client, Measuring, Placing, Playing
from diorama_app.session.preferences import GizmoMode
from diorama_app.session.units import format_length
from diorama_app.strings import _
from diorama_core.editing.clearances import clearances
from diorama_core.editing.collisions import Collisions
from diorama_core.editing.dragging import Slide, snap_pose
from diorama_core.editing.stretching import new_poses
from diorama_core.geometry.rotations import quaternion_wxyz, rotation_from_quaternion
from diorama_core.scene import edits
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Pose, Scene

NODE = "/gizmo"
MIN_SHOWN_M = 0.005
"""Shorter distances are contact."""


@dataclass(frozen=True)
class GizmoDrag:
    """A gizmo drag in progress, with the scene at its start."""

    object_id: str
    scene: Scene


@dataclass
class _BodyDrag:
    """A drag of an object's body, with its current pose."""

    slide: Slide
    scene: Scene


class Gestures:
    """Turns one browser's pointer events into document edits. Used from the UI thread, except where it says so."""

    def __init__(self, client: Client, collisions: Collisions) -> None:
        self._client = client
        self._session = client.session
        self._collisions = collisions
        self._drag: GizmoDrag | _BodyDrag | None = None
        self._gizmo: viser.TransformControlsHandle | None = None
        self._gizmo_key: tuple[str, GizmoMode, float] | None = None
        self._last_pick: tuple[float, float] | None = None
        self._handles = SizeHandles(client, self._resizing, self._end_collisions)
        scene = client.viser_client.scene

        async def click(event: viser.SceneClickEvent) -> None:
            # A click on an object also arrives here, after the object's own event.
            ray = np.array(event.ray_origin), np.array(event.ray_direction)
            on_object = self._last_pick == event.screen_pos
            client.post(lambda: self._click(*ray, on_object=on_object))

        async def frame(event: viser.SceneRectSelectEvent) -> None:
            low, high = event.screen_min, event.screen_max
            client.post(lambda: self._frame(low, high))

        scene.on_click()(click)
        scene.on_rect_select(modifier="shift")(frame)

    # -- pointing ---------------------------------------------------------------------------------------------

    def pick(self, object_id: str, event: viser.SceneNodePointerEvent[Any]) -> None:
        """An object was clicked. Called from viser's event loop."""
        self._last_pick = event.screen_pos
        add, direction = event.modifier is not None, np.array(event.ray_direction)

        def pick() -> None:
            if isinstance(self._client.doing, Playing):
                self._client.doing.push(object_id, direction)
            if self._client.doing is not None:
                return  # the scene's own click says where
            if add:
                self._client.toggle(object_id)
            else:
                self._client.select((object_id,))

        self._client.post(pick)

    def _click(self, origin: np.ndarray, direction: np.ndarray, *, on_object: bool) -> None:
        doing = self._client.doing
        if self._client.view.canvas.is_open:
            return
        if isinstance(doing, Placing):
            place_at(self._client, doing.shape_id, origin, direction)
        elif isinstance(doing, Measuring):
            measure_at(self._client, doing, origin, direction)
        elif doing is None and not on_object:
            self._client.select_surface(surface_under(self._session.scene, origin, direction))

    def _frame(self, low: tuple[float, float], high: tuple[float, float]) -> None:
        client, camera = self._client, self._client.viser_client.camera
        if client.view.canvas.is_open:
            return
        inside = objects_in(
            self._session.scene,
            low,
            high,
            rotation_from_quaternion(np.asarray(camera.wxyz)),
            np.asarray(camera.position),
            float(camera.fov),
            float(camera.aspect),
        )
        client.select((*client.selection, *inside))

    # -- dragging an object ------------------------------------------------------------------------------------

    def drag(self, object_id: str, event: viser.SceneNodeDragEvent[Any]) -> None:
        """An object is dragged. Called from viser's event loop."""
        phase, inverted = event.phase, event.modifier == "alt"
        grabbed, hand = np.array(event.start_position), np.array(event.end_position)
        self._client.post(
            lambda: self._slide(object_id, phase, grabbed, hand, inverted),
            key="slide" if phase == "update" else None,
        )

    def _slide(self, object_id: str, phase: str, grabbed: np.ndarray, hand: np.ndarray, inverted: bool) -> None:
        client, session = self._client, self._session
        if phase == "start":
            if client.doing is not None or client.view.canvas.is_open or not session.scene.has_object(object_id):
                return
            if object_id not in client.selection:
                client.select((object_id,))
            slide = Slide.begin(session.scene, session.library, object_id, grabbed, client.selection, client.rooms)
            self._remove()
            self._handles.show(None)
            self._drag = _BodyDrag(slide, session.scene)
            return
        drag = self._drag
        if not isinstance(drag, _BodyDrag):
            return
        if phase == "update":
            eye = np.asarray(client.viser_client.camera.position, dtype=np.float64)
            snap = client.preferences.snap != inverted
            # Until every shape is prepared, objects go through each other (and are shown colliding).
            prepared = session.preparer.ready(o.shape_id for o in drag.slide.scene.objects)
            drag.scene, poses = drag.slide.to(eye, hand - eye, snap=snap, slide=client.preferences.slide and prepared)
            self._show(drag.slide.scene, poses, drag.scene)
            return
        self._drag = None
        self._end_collisions()
        label = drag.slide.item.label
        if drag.scene is drag.slide.scene:
            session.refresh()
            return
        start, now = drag.slide.scene, drag.scene
        before, after = start.support_of(object_id), now.support_of(object_id)
        moved = {o.id: o.pose for o in now.objects if o is not start.object(o.id)}

        def apply(scene: Scene) -> Scene:
            # Onto the scene as it is now: somebody else may have edited it meanwhile.
            scene = edits.place(scene, {i: p for i, p in moved.items() if scene.has_object(i)})
            if after is not None and after != before and scene.has_object(object_id):
                scene = edits.attach(scene, after)
            return scene

        session.edit(_("move {label}").format(label=label), apply, by=client, by_hand=True)

    def _show(self, start: Scene, poses: Mapping[str, Pose], scene: Scene) -> None:
        self._session.viewport.preview(poses)
        moving = [i for i in poses if i in {*self._moving()}] or list(poses)
        self._show_distances(scene)
        pairs = self._collisions.pairs(scene, moving)
        if self._client.marks.collide({i for pair in pairs for i in pair}):
            self._client.show_marks()

    def _show_distances(self, scene: Scene) -> None:
        """How far what is dragged is from walls and neighbours."""
        client, drag = self._client, self._drag
        if drag is None:
            client.view.show_distances(())
            return
        dragged = drag.slide.item.id if isinstance(drag, _BodyDrag) else drag.object_id
        client.view.show_distances(
            [
                (c.start, c.end, format_length(c.distance_m, client.preferences.unit))
                for c in clearances(scene, dragged)
                if c.distance_m > MIN_SHOWN_M
            ]
        )

    def _resizing(self, start: Scene, now: Scene) -> None:
        poses = new_poses(start, now)
        self._session.viewport.preview(poses)
        self._client.marks.collide({i for pair in self._collisions.pairs(now, list(poses)) for i in pair})
        self._client.show_marks(now)

    def _moving(self) -> Iterable[str]:
        drag = self._drag
        if isinstance(drag, _BodyDrag):
            item = drag.slide.item
            return (item.id, *descendants(drag.slide.scene, item.id), *drag.slide.along)
        return () if drag is None else (drag.object_id, *descendants(drag.scene, drag.object_id))

    def _end_collisions(self) -> None:
        self._client.view.show_distances(())
        if self._client.marks.collide(()):
            self._client.show_marks()

    # -- the gizmo --------------------------------------------------------------------------------------------

    def refresh(self) -> None:
        """Attach the gizmo to the selected object; remove it when nothing movable is selected."""
        item = self._client.last_selected
        if (
            item is None
            or item.locked
            or item.hidden
            or isinstance(self._drag, _BodyDrag)
            or self._client.doing is not None
        ):
            item = None
        sizing = self._client.preferences.gizmo == "size"
        if not self._handles.pulling:
            self._handles.show(item if sizing else None)
        if item is None or sizing:
            self._remove()
            return
        scale = float(np.clip(0.62 * max(item.size_m), 0.3, 1.1))
        key = (item.id, self._client.preferences.gizmo, round(scale, 2))
        if self._gizmo is None or self._gizmo_key != key:
            if self._drag is not None:
                return
            self._remove()
            self._gizmo = self._add(item.pose, scale)
            self._gizmo_key = key
        elif self._drag is None:
            self._gizmo.wxyz = quaternion_wxyz(item.pose.R_world_object)
            self._gizmo.position = item.pose.position

    def _add(self, pose: Pose, scale: float) -> viser.TransformControlsHandle:
        gizmo = self._client.viser_client.scene.add_transform_controls(
            NODE,
            scale=scale,
            line_width=3.0,
            active_axes=(True, True, self._client.preferences.gizmo == "free"),
            depth_test=False,
            opacity=0.85,
            wxyz=quaternion_wxyz(pose.R_world_object),
            position=pose.position,
        )

        async def drag(event: viser.TransformControlsEvent) -> None:
            wxyz, position, phase = np.array(event.target.wxyz), np.array(event.target.position), event.phase
            self._client.post(lambda: self._turn(phase, wxyz, position), key="gizmo" if phase == "update" else None)

        gizmo.on_update(drag)
        return gizmo

    def _remove(self) -> None:
        if self._gizmo is not None and not isinstance(self._drag, GizmoDrag):
            self._gizmo.remove()
            self._gizmo = self._gizmo_key = None

    def _turn(self, phase: str, wxyz: np.ndarray, position: np.ndarray) -> None:
        item = self._client.last_selected
        if self._drag is None:
            if item is None or phase != "start":
                return
            self._drag = GizmoDrag(item.id, self._session.scene)
        drag = self._drag
        if not isinstance(drag, GizmoDrag):
            return
        start = drag.scene.object(drag.object_id)
        pose = Pose(rotation_from_quaternion(wxyz), position, start.pose.scale)
        if self._client.preferences.snap:
            pose = snap_pose(start.pose, pose)
        if phase != "end":
            moved = edits.move(drag.scene, drag.object_id, pose)
            poses = {o.id: o.pose for o in moved.objects if o is not drag.scene.object(o.id)}
            self._show(drag.scene, poses, moved)
            return
        self._drag = None
        self._end_collisions()
        if pose == start.pose or not self._session.scene.has_object(drag.object_id):
            self._session.refresh()
            return
        turned = np.allclose(pose.position, start.pose.position, atol=1e-4)
        label = (_("turn {names}") if turned else _("move {label}")).format(names=start.label, label=start.label)
        self._session.edit(label, lambda s: edits.move(s, drag.object_id, pose), by=self._client, by_hand=True)

    def cancel(self) -> bool:
        """Cancel the current drag or pending click; False when there is nothing to cancel."""
        if not self._handles.cancel() and self._drag is None and self._client.doing is None:
            return False
        self._drag = None
        if isinstance(self._client.doing, Playing):
            self._client.doing.end()
        self._client.doing = None
        self._end_collisions()
        self._session.refresh()
        return True


def objects_in(
    scene: Scene,
    low: tuple[float, float],
    high: tuple[float, float],
    R_world_camera: Float[np.ndarray, "3 3"],
    position: Float[np.ndarray, 3],
    fov_rad: float,
    aspect: float,
) -> tuple[str, ...]:
    """Ids of visible objects whose centre projects into the rectangle (0 to 1 from the top left).

    Centres are tested so that a rectangle around a chair does not select the table, and large objects need not fit.

    Args:
        scene: as it is.
        low: upper left corner, 0 to 1.
        high: lower right corner.
        R_world_camera: of the viewer.
        position: of the viewer, world, metres.
        fov_rad: vertical.
        aspect: width over height.
    """
    half = np.tan(fov_rad / 2)
    ids = []
    for item in scene.objects:
        p = R_world_camera.T @ (item.pose.position - position)
        if item.hidden or p[2] <= 1e-3:
            continue
        x, y = 0.5 + p[0] / p[2] / (2 * half * aspect), 0.5 + p[1] / p[2] / (2 * half)
        if low[0] <= x <= high[0] and low[1] <= y <= high[1]:
            ids.append(item.id)
    return tuple(ids)
