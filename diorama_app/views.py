"""Where the cameras of the browsers go."""

from __future__ import annotations

import numpy as np

from diorama_app.framing import NARROW_FOV_RAD, bounds, room_view, side_view
from diorama_app.guest import Guest
from diorama_app.room import Room
from diorama_core.errors import EditRefused


class Views:
    """The views that buttons and keys ask for."""

    def __init__(self, room: Room) -> None:
        self._room = room

    def room_view(self, guest: Guest) -> None:
        """See the whole room."""
        self._plain(guest)
        guest.view.look(*room_view(self._room.scene, guest.view.aspect))

    def along(self, guest: Guest, back: tuple[float, float, float]) -> None:
        """See the room along an axis from far away, nearly without perspective."""
        self._plain(guest)
        position, target = side_view(self._room.scene, np.array(back), guest.view.aspect)
        guest.view.look(position, target, float(NARROW_FOV_RAD))

    def photo(self, guest: Guest) -> None:
        """Look through the photo's camera, the photo behind the model."""
        camera = self._room.scene.camera
        if camera is None:
            raise EditRefused("this scene has no photo; upload one in the Photo panel")
        self._plain(guest)
        low, high = bounds(self._room.scene)
        far = float(np.linalg.norm(high - low)) + 2.0
        middle = float(np.clip(np.linalg.norm((low + high) / 2 - camera.position), 1.0, far))
        guest.view.look_through(camera, middle)
        if self._room.photo is not None:
            guest.view.show_backdrop(camera, self._room.photo.rgb, 2.0 * far)
        guest.refresh()

    def overlay(self, guest: Guest, opacity: float) -> None:
        """Lay the photo over the model, as much as wanted."""
        photo, camera = self._room.photo, self._room.scene.camera
        if photo is None or camera is None:
            raise EditRefused("this scene has no photo to lay over the model; upload one in the Photo panel")
        if not guest.view.through_photo and opacity > 0.0:
            self.photo(guest)
        guest.view.show_overlay(camera, photo.rgb, opacity)
        guest.show_marks()

    def focus(self, guest: Guest) -> None:
        """Look at what is selected from nearby."""
        items = [self._room.scene.object(i) for i in guest.need_selection()]
        corners = np.concatenate([o.corners_world for o in items])
        middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
        guest.view.approach(middle, 1.5 * float(np.linalg.norm(np.ptp(corners, axis=0))) + 0.5)

    def _plain(self, guest: Guest) -> None:
        guest.view.close_board()
        guest.view.show_backdrop(None, None, 1.0)
        guest.view.show_overlay(None, None, 0.0)
        guest.refresh()
