"""Handles on the faces of the selected object that make it longer, wider, higher or larger as a whole."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import viser
from jaxtyping import Float

from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_core.editing.stretching import HANDLES, Handle, handle_place, new_poses, pull_m, stretch
from diorama_core.geometry.rotations import quaternion_wxyz
from diorama_core.scene import edits
from diorama_core.scene.types import Scene, SceneObject

NODE = "/size"
AXIS_COLOURS = ((226, 60, 84), (78, 160, 90), (52, 120, 220))
WHOLE_COLOUR = (255, 170, 40)
MARGIN_M = 0.04
NOTHING_M = 1e-6
"""A pull by less comes from rounding the ray to the hand."""


@dataclass
class Pull:
    """A handle drag in progress: the scene at its start and the current preview."""

    object_id: str
    handle: Handle
    grabbed: Float[np.ndarray, 3]
    """The grabbed point, world."""
    start: Scene
    now: Scene


class SizeHandles:
    """One browser's handles. Used from the UI thread only."""

    def __init__(self, client: Client, show: Callable[[Scene, Scene], None], done: Callable[[], None]) -> None:
        """Without handles at first.

        Args:
            client: the owner.
            show: shows the second scene as a preview of the first.
            done: told when a handle is let go of.
        """
        self._client = client
        self._session = client.session
        self._show_scene = show
        self._done = done
        self._nodes: dict[str, viser.BoxHandle] = {}
        self._of: tuple[str, float] | None = None
        self._pull: Pull | None = None

    @property
    def pulling(self) -> bool:
        """Whether a handle is being dragged."""
        return self._pull is not None

    def show(self, item: SceneObject | None) -> None:
        """Put the handles on an object, or take them away."""
        if item is None:
            if self._pull is None:
                self._remove()
            return
        side = round(float(np.clip(0.075 * max(item.size_m), 0.035, 0.09)), 3)
        if self._of != (item.id, side) and self._pull is None:
            self._remove()
            self._of = (item.id, side)
            self._nodes = {h.name: self._add(h, side) for h in HANDLES}
        self._put(item)

    def cancel(self) -> bool:
        """Cancel the current handle drag and restore the scene; returns whether there was one."""
        modifier_key, self._pull = self._pull is not None, None
        return modifier_key

    def _put(self, item: SceneObject) -> None:
        wxyz = quaternion_wxyz(item.pose.R_world_object)
        with self._client.viser_client.atomic():
            for handle in HANDLES:
                node = self._nodes[handle.name]
                place = item.pose.position + item.pose.R_world_object @ handle_place(item, handle, MARGIN_M)
                node.wxyz, node.position = wxyz, place

    def _add(self, handle: Handle, side: float) -> viser.BoxHandle:
        axis = handle.axis
        node = self._client.viser_client.scene.add_box(
            f"{NODE}/{handle.name}",
            color=WHOLE_COLOUR if axis is None else AXIS_COLOURS[axis],
            dimensions=(side, side, side),
            cast_shadow=False,
            receive_shadow=False,
        )

        async def drag(event: viser.SceneNodeDragEvent[Any]) -> None:
            phase, inverted = event.phase, event.modifier == "alt"
            grabbed, hand = np.array(event.start_position), np.array(event.end_position)
            self._client.post(
                lambda: self._stretch(handle, phase, grabbed, hand, inverted),
                key="stretch" if phase == "update" else None,
            )

        for modifier_key in (None, "alt"):
            node.on_drag("left", modifier=modifier_key)(drag)
        return node

    def _remove(self) -> None:
        for node in self._nodes.values():
            node.remove()
        self._nodes, self._of = {}, None

    def _stretch(self, handle: Handle, phase: str, grabbed: np.ndarray, hand: np.ndarray, inverted: bool) -> None:
        client, session = self._client, self._session
        item = client.last_selected
        if phase == "start":
            if item is not None and client.doing is None:
                self._pull = Pull(item.id, handle, grabbed, session.scene, session.scene)
            return
        pull = self._pull
        if pull is None:
            return
        if phase in ("update", "end"):
            eye = np.asarray(client.viser_client.camera.position, dtype=np.float64)
            start = pull.start.object(pull.object_id)
            by_m = pull_m(start, handle, pull.grabbed, eye, hand - eye)
            by_m = 0.0 if abs(by_m) < NOTHING_M else by_m
            snap = client.preferences.snap != inverted
            pull.now = stretch(pull.start, pull.object_id, handle, by_m, snap=snap)
            self._show_scene(pull.start, pull.now)
            self._put(pull.now.object(pull.object_id))
        if phase != "end":
            return
        self._pull = None
        self._done()
        self._commit(pull)

    def _commit(self, pull: Pull) -> None:
        session = self._session
        if pull.now is pull.start or not session.scene.has_object(pull.object_id):
            session.refresh()
            return
        poses = new_poses(pull.start, pull.now)
        label = pull.start.object(pull.object_id).label

        def apply(scene: Scene) -> Scene:
            # Onto the scene as it is now: somebody else may have edited it meanwhile.
            return edits.place(scene, {i: p for i, p in poses.items() if scene.has_object(i)})

        session.edit(_("resize {label}").format(label=label), apply, by=self._client, by_hand=True)
