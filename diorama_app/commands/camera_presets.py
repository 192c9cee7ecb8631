"""Camera presets of the browsers."""

from __future__ import annotations

from functools import partial

import numpy as np
import viser

from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_app.strings import _
from diorama_app.viewport.camera import NARROW_FOV_RAD, bounds, room_view, side_view
from diorama_core.errors import EditRefused

AWAY_M = 0.3
"""Distance from where a 360 degree photo was taken beyond which it no longer fits the view."""


class Views:
    """The views that buttons and keys select."""

    def __init__(self, session: EditorSession) -> None:
        self._session = session

    def room_view(self, client: Client) -> None:
        """Show the whole room."""
        self._plain(client)
        client.view.camera.frame(partial(room_view, self._session.scene))

    def look(self, client: Client, back: tuple[float, float, float]) -> None:
        """Show the room along an axis from far away, with hardly any perspective."""
        self._plain(client)
        client.view.camera.frame(partial(side_view, self._session.scene, np.array(back)), float(NARROW_FOV_RAD))

    def photo(self, client: Client) -> None:
        """Look through the camera of the chosen photo, the photo behind the model."""
        further = client.further_photo
        if further is not None and further.T_world_sphere is not None:
            self._plain(client)
            client.view.camera.look_around(further.T_world_sphere[:3, 3])
            self._show_sphere(client)
            client.refresh()
            return
        camera, photo = client.viewpoint
        if camera is None and client.further_photo is not None:
            message = _("the camera of {photo} is not known yet; add the photo to the scene first")
            raise EditRefused(message.format(photo=client.photo_name))
        if camera is None:
            raise EditRefused("this scene has no photo; upload one in the Photo tab")
        self._plain(client)
        low, high = bounds(self._session.scene)
        far = self._far()
        middle = float(np.clip(np.linalg.norm((low + high) / 2 - camera.position), 1.0, far))
        client.view.camera.look_through(camera, middle)
        if photo is not None:
            client.view.photo.show_backdrop(camera, photo.rgb, 2.0 * far)
        client.refresh()

    def follow(self, client: Client) -> None:
        """Call `turn` whenever a person turns this browser's view."""

        async def look(_: viser.CameraHandle) -> None:
            client.post(lambda: self.turn(client), key="turned")

        client.viser_client.camera.on_update(look)

    def turn(self, client: Client) -> None:
        """Turn the 360 degree photo with the view of who looks around in it."""
        further = client.further_photo
        if further is None or further.T_world_sphere is None or not client.view.camera.through_photo:
            return
        if np.linalg.norm(client.view.camera.position - further.T_world_sphere[:3, 3]) > AWAY_M:
            client.view.camera.through_photo = False
            client.view.photo.hide()
            return
        self._show_sphere(client)

    def _show_sphere(self, client: Client) -> None:
        """The part of the 360 degree photo that is in view, behind the model, and over it as before."""
        camera, photo = client.viewpoint
        if camera is not None and photo is not None:
            with client.viser_client.atomic():
                client.view.photo.show_backdrop(camera, photo.rgb, 2.0 * self._far())
                client.view.photo.show_overlay(camera, photo.rgb, client.view.photo.opacity)

    def _far(self) -> float:
        """A distance beyond everything in the room."""
        low, high = bounds(self._session.scene)
        return float(np.linalg.norm(high - low)) + 2.0

    def photo_of(self, client: Client, name: str | None) -> None:
        """Choose a photo (None: the scene's own) and look through its camera."""
        client.choose_photo(name)
        self.photo(client)

    def overlay(self, client: Client, opacity: float) -> None:
        """Overlay the photo on the model with the given opacity."""
        camera, photo = client.viewpoint
        if photo is None or camera is None:
            raise EditRefused("this scene has no photo to lay over the model; upload one in the Photo tab")
        if opacity > 0.0 and (client.plan or not client.view.camera.through_photo):
            self.photo(client)
        client.view.photo.show_overlay(camera, photo.rgb, opacity)
        client.show_marks()

    def focus(self, client: Client) -> None:
        """Move the camera close to the selection."""
        items = [self._session.scene.object(i) for i in client.need_selection()]
        client.plan = False
        corners = np.concatenate([o.corners_world for o in items])
        middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
        client.view.camera.approach(middle, 1.5 * float(np.linalg.norm(np.ptp(corners, axis=0))) + 0.5)

    def walk(self, client: Client) -> None:
        """Walk through the room in the first person until Esc."""
        from diorama_core.editing.walking import walk_of  # shapely; the page opens without it

        route = walk_of(self._session.scene)
        if route is None:
            raise EditRefused("this scene has no free floor to walk on; draw a room in the plan or move furniture")
        self._plain(client)
        client.start_walk(route)

    def plan(self, client: Client) -> None:
        """Show the plan, or the 3D view again."""
        shown = client.plan
        self._plain(client)
        client.plan = not shown
        client.refresh()

    def _plain(self, client: Client) -> None:
        client.plan = False
        client.view.canvas.close()
        client.view.photo.hide()
        client.refresh()
