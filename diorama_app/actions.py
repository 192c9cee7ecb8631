"""The commands of the editor: what each does, in one table."""

from __future__ import annotations

import numpy as np

from diorama_app import editing
from diorama_app.client_view import ClientView, bounds, room_view, top_view
from diorama_app.commands import Command, CommandTable
from diorama_app.gestures import Gestures
from diorama_app.room import Room
from diorama_core.errors import EditRefused


class Views:
    """Where the cameras of the browsers go."""

    def __init__(self, room: Room) -> None:
        self._room = room

    def room_view(self, client_id: int | None) -> None:
        """See the whole room."""
        view = self._plain(client_id)
        view.look(*room_view(self._room.scene, view.aspect))

    def top(self, client_id: int | None) -> None:
        """See the room from above."""
        view = self._plain(client_id)
        view.look(*top_view(self._room.scene, view.aspect))

    def photo(self, client_id: int | None) -> None:
        """Look through the photo's camera, the photo behind the model."""
        camera = self._room.scene.camera
        if camera is None:
            raise EditRefused("this scene has no photo; upload one in the Photo panel")
        view = self._plain(client_id)
        low, high = bounds(self._room.scene)
        far = float(np.linalg.norm(high - low)) + 2.0
        middle = float(np.clip(np.linalg.norm((low + high) / 2 - camera.position), 1.0, far))
        view.look_through(camera, middle)
        if self._room.photo is not None:
            view.show_backdrop(camera, self._room.photo.rgb, 2.0 * far)

    def overlay(self, client_id: int | None, opacity: float) -> None:
        """Lay the photo over the model, as much as wanted."""
        photo, camera = self._room.photo, self._room.scene.camera
        if photo is None or camera is None:
            raise EditRefused("this scene has no photo to lay over the model; upload one in the Photo panel")
        view = self.one(client_id)
        if not view.through_photo and opacity > 0.0:
            self.photo(client_id)
        view.show_overlay(camera, photo.rgb, opacity)

    def focus(self, client_id: int | None) -> None:
        """Look at the selected object from nearby."""
        item = self._room.scene.object(self._room.need_selected())
        view = self.one(client_id)
        view.approach(item.pose.position, 2.2 * float(np.linalg.norm(item.size_m)) + 0.4)

    def one(self, client_id: int | None) -> ClientView:
        """The browser that asked."""
        view = self._room.views.get(client_id) if client_id is not None else None
        if view is None:
            raise EditRefused("this browser is no longer connected; reload the page")
        return view

    def _plain(self, client_id: int | None) -> ClientView:
        view = self.one(client_id)
        view.close_board()
        view.show_backdrop(None, None, 1.0)
        view.show_overlay(None, None, 0.0)
        self._room.refresh_panels()
        return view


def build_commands(room: Room, gestures: Gestures, views: Views) -> CommandTable:
    """Every command of the editor."""

    def escape(client_id: int | None) -> None:
        view = room.views.get(client_id) if client_id is not None else None
        if gestures.cancel():
            return
        if view is not None and view.drawing:
            views.room_view(client_id)
        else:
            room.select(())

    def save(client_id: int | None) -> None:
        if room.project is None:
            raise EditRefused("there is no project open to save")
        room.saver.save_soon(room.project, room.scene)
        room.saver.flush()
        room.notice(client_id, f"Saved in {room.project.name}.", "good")

    def lock(client_id: int | None) -> None:
        item = room.scene.object(room.need_selected())
        editing.set_locked(room, item.id, not item.locked)

    def hide(client_id: int | None) -> None:
        item = room.scene.object(room.need_selected())
        editing.set_hidden(room, item.id, not item.hidden)

    return CommandTable(
        (
            Command("undo", "Undo", lambda c: editing.undo(room), "Z", "cmd/ctrl", "Take back the last change"),
            Command("redo", "Redo", lambda c: editing.redo(room), "Z", "cmd/ctrl+shift", "Do it again"),
            Command("view_room", "Room view", views.room_view, "R", None, "See the whole room"),
            Command("view_photo", "Photo view", views.photo, "P", None, "Look through the photo's camera"),
            Command("view_top", "Top view", views.top, "T", None, "See the room from above"),
            Command("focus", "Focus", views.focus, "F", None, "Look at the selected object"),
            Command(
                "gizmo_floor", "Slide and turn", lambda c: gestures.set_mode("floor"), "1", None, "Move on the floor"
            ),
            Command(
                "gizmo_free", "Move freely", lambda c: gestures.set_mode("free"), "2", None, "Move and turn any way"
            ),
            Command(
                "duplicate", "Duplicate", lambda c: editing.duplicate_selected(room), "D", "cmd/ctrl", "Copy beside"
            ),
            Command(
                "delete", "Delete", lambda c: editing.delete_selected(room), "delete", None, "Delete the selection"
            ),
            Command("hide", "Hide or show", hide, "H", None, "Hide the selected object"),
            Command("lock", "Lock or unlock", lock, "L", None, "Keep the selected object as it is"),
            Command("save", "Save", save, "S", "cmd/ctrl", "Save now (every change is saved anyway)"),
            Command("escape", "Clear selection", escape, "escape", None, "Stop drawing, or select nothing"),
        )
    )
