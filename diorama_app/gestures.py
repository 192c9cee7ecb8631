"""What a person does with the mouse in the 3D view: pick, drag the gizmo. Preview while it lasts, commit at its end."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import viser

from diorama_app.room import Room
from diorama_app.viewport import quaternion, rotation
from diorama_core.scene import edits
from diorama_core.scene.types import Pose, Scene

GizmoMode = Literal["floor", "free"]
NODE = "/gizmo"


@dataclass(frozen=True)
class Drag:
    """A gizmo drag under way: where everything was when it began."""

    object_id: str
    scene: Scene


class Gestures:
    """Picking and the gizmo of the open room. viser calls in from its event loop; the work is done on the desk."""

    def __init__(self, room: Room) -> None:
        self._room = room
        self._drag: Drag | None = None
        self._gizmo: viser.TransformControlsHandle | None = None
        self._gizmo_key: tuple[str, GizmoMode, float] | None = None
        self.mode: GizmoMode = "floor"
        self._last_pick: tuple[int, Any] | None = None
        room.on_pick = self._picked

        async def clicked(event: viser.SceneClickEvent) -> None:
            # A click on an object also arrives here, after the object's own event.
            if self._last_pick != (event.client_id, event.screen_pos):
                room.post(event.client_id, lambda: room.select(()))

        room.server.scene.on_click()(clicked)

    def set_mode(self, mode: GizmoMode) -> None:
        """Which handles the gizmo has: sliding and turning on the floor, or everything."""
        self.mode = mode
        self.refresh()

    def refresh(self) -> None:
        """Put the gizmo where the selected object is; take it away when there is none to move."""
        item = self._room.document.selected
        if item is None or item.locked or item.hidden:
            self._remove()
            return
        scale = float(np.clip(0.62 * max(item.size_m), 0.3, 1.1))
        key = (item.id, self.mode, round(scale, 2))
        if self._gizmo is None or self._gizmo_key != key:
            if self._drag is not None:
                return
            self._remove()
            self._gizmo = self._add(item.pose, scale)
            self._gizmo_key = key
        elif self._drag is None:
            self._gizmo.wxyz = self._orientation(item.pose)
            self._gizmo.position = item.pose.position

    def _orientation(self, pose: Pose) -> np.ndarray:
        return quaternion(pose.R_world_object)

    def _add(self, pose: Pose, scale: float) -> viser.TransformControlsHandle:
        gizmo = self._room.server.scene.add_transform_controls(
            NODE,
            scale=scale,
            line_width=3.0,
            active_axes=(True, True, self.mode == "free"),
            depth_test=False,
            opacity=0.85,
            wxyz=self._orientation(pose),
            position=pose.position,
        )

        async def dragged(event: viser.TransformControlsEvent) -> None:
            wxyz, position = np.array(event.target.wxyz), np.array(event.target.position)
            client, phase = event.client_id, event.phase
            key = "gizmo" if phase == "update" else None
            self._room.post(client, lambda: self._dragged(phase, wxyz, position), key=key)

        gizmo.on_update(dragged)
        return gizmo

    def _remove(self) -> None:
        if self._gizmo is not None and self._drag is None:
            self._gizmo.remove()
            self._gizmo = self._gizmo_key = None

    def _dragged(self, phase: str, wxyz: np.ndarray, position: np.ndarray) -> None:
        item = self._room.document.selected
        if self._drag is None:
            if item is None or phase == "end":
                return
            self._drag = Drag(item.id, self._room.scene)
        drag = self._drag
        if not drag.scene.has_object(drag.object_id):
            self._drag = None
            return
        start = drag.scene.object(drag.object_id)
        pose = Pose(rotation(wxyz), position, start.pose.scale)
        if phase != "end":
            moved = edits.move(drag.scene, drag.object_id, pose)
            self._room.preview({o.id: o.pose for o in moved.objects if o is not drag.scene.object(o.id)})
            return
        self._drag = None
        if pose == start.pose:
            return
        self._room.edit(f"move {start.label}", lambda scene: edits.move(scene, drag.object_id, pose))

    def cancel(self) -> bool:
        """Put back what is being dragged; False when nothing is."""
        if self._drag is None:
            return False
        self._drag = None
        self._room.refresh()
        self.refresh()
        return True

    def _picked(self, object_id: str, event: viser.SceneNodePointerEvent[Any]) -> None:
        self._last_pick = (event.client_id, event.screen_pos)
        if event.modifier is None:
            self._room.post(event.client_id, lambda: self._room.select((object_id,)))
        else:
            self._room.post(event.client_id, lambda: self._room.toggle(object_id))
