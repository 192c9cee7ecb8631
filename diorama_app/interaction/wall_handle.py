"""The arrow at the chosen wall or ceiling: pulled, it moves the plane, and says how far it is across the room."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import viser

from diorama_app.commands.edit import supporter_name
from diorama_app.session.client import Client
from diorama_app.session.units import format_length
from diorama_app.strings import _
from diorama_core.editing.clearances import room_before
from diorama_core.editing.dragging import GRID_M
from diorama_core.errors import EditRefused
from diorama_core.geometry.planes import plane_axes
from diorama_core.geometry.rotations import quaternion_wxyz
from diorama_core.scene.room_edits import move_plane
from diorama_core.scene.types import Plane, Scene

NODE = "/wall-handle"
SIZE_M = 0.7


@dataclass(frozen=True)
class _Pull:
    """A pull in progress, with the scene at its start."""

    plane: Plane
    scene: Scene


class WallHandle:
    """Used from the UI thread, except where it says so."""

    def __init__(self, client: Client) -> None:
        self._client = client
        self._shown: Plane | None = None
        self._node: viser.TransformControlsHandle | None = None
        self._pull: _Pull | None = None

    def refresh(self) -> None:
        """Put the arrow at the chosen plane; there is none for floors, and none without."""
        client, scene = self._client, self._client.session.scene
        chosen = client.surface
        plane = scene.plane(chosen) if chosen is not None and scene.has_plane(chosen) else None
        plane = None if plane is None or plane.role == "floor" or client.doing is not None else plane
        if plane is self._shown or self._pull is not None:
            return
        if self._node is not None:
            self._node.remove()
            self._node = None
        self._shown = plane
        if plane is not None:
            self._node = self._add(plane)

    def _add(self, plane: Plane) -> viser.TransformControlsHandle:
        u, v = plane_axes(plane.normal)
        axes = np.stack([plane.normal, u, v], axis=1)
        node = self._client.viser_client.scene.add_transform_controls(
            NODE,
            scale=SIZE_M,
            line_width=4.0,
            active_axes=(True, False, False),
            disable_sliders=True,
            disable_rotations=True,
            depth_test=False,
            wxyz=quaternion_wxyz(axes),
            position=_middle(plane),
        )

        async def drag(event: viser.TransformControlsEvent) -> None:
            position, phase = np.array(event.target.position), event.phase
            self._client.post(lambda: self._move(phase, position), key="wall" if phase == "update" else None)

        node.on_update(drag)
        return node

    def _move(self, phase: str, position: Any) -> None:
        client, session = self._client, self._client.session
        if phase == "start" and self._shown is not None:
            self._pull = _Pull(self._shown, session.scene)
        pull = self._pull
        if pull is None:
            return
        outward = -float(pull.plane.normal @ (position - _middle(pull.plane)))
        if client.preferences.snap:
            outward = round(outward / GRID_M) * GRID_M
        if phase != "end":
            self._preview(pull, outward)
            return
        self._pull = self._shown = None
        client.view.show_distances(())
        client.view.show_surface(session.scene.plane(pull.plane.id) if session.scene.has_plane(pull.plane.id) else None)
        if not session.scene.has_plane(pull.plane.id) or abs(outward) < 1e-6:
            session.refresh_panels(client)
            return
        shown = format_length(outward, client.preferences.unit)
        name = supporter_name(session.scene, pull.plane.id)
        label = _("move {name} by {length}").format(name=name, length=shown)
        session.edit(label, lambda s: move_plane(s, pull.plane.id, outward), by=client)

    def _preview(self, pull: _Pull, outward_m: float) -> None:
        """The outline where the plane would be, and the length across the room."""
        client = self._client
        try:
            moved = move_plane(pull.scene, pull.plane.id, outward_m)
        except EditRefused:
            return  # too far: the last outline stays, and letting go says why
        client.view.show_surface(moved.plane(pull.plane.id))
        across = room_before(moved, pull.plane.id)
        words = "" if across is None else format_length(across.distance_m, client.preferences.unit)
        client.view.show_distances(() if across is None else ((across.start, across.end, words),))


def _middle(plane: Plane) -> np.ndarray:
    return np.asarray(0.5 * (plane.polygon.min(axis=0) + plane.polygon.max(axis=0)))
