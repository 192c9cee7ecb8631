"""What all browsers of a session see: the scene, the photo's camera, and panels that follow the document.

Used from the UI thread only, except where a method says otherwise.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from functools import partial
from typing import Any

import viser

from diorama_app.session.connected_client import ConnectedClient
from diorama_app.session.preparation import Preparer
from diorama_app.session.redraws import Redraws
from diorama_app.session.shared_document import SharedDocument
from diorama_app.session.ui_thread import UiThread
from diorama_app.strings import N_, _
from diorama_app.viewport.camera import DEFAULT_FOV_RAD, room_view
from diorama_app.viewport.mesh_assets import ShapeBytes
from diorama_app.viewport.photo_overlay import PhotoCamera
from diorama_app.viewport.scene_view import Viewport
from diorama_core.artefacts import Photo
from diorama_core.errors import DioramaError
from diorama_core.scene.types import Camera

log = logging.getLogger(__name__)

MESH_OVERLAP_S = 0.45
"""How long an old mesh stays while the browser parses its successor."""


class SharedView:
    """Draws a session's scene on its server, and has its clients' panels drawn."""

    def __init__(
        self,
        shown: SharedDocument,
        server: viser.ViserServer,
        ui_thread: UiThread,
        shapes: ShapeBytes,
        preparer: Preparer,
    ) -> None:
        """Draw nothing yet of what is shown."""
        self._shown, self._server, self._ui_thread, self._preparer = shown, server, ui_thread, preparer
        self.viewport = Viewport(server, shapes, pick=self._pick, drag=self._drag, later=self._replace_later)
        self.redraws = Redraws(ui_thread, lambda client_id: client_id in shown.clients)
        self.on_photo_camera: Callable[[Any, str | None], None] = lambda client, name: None
        """Given who clicked, and the name of the further photo, or None."""
        self.on_pick: Callable[[str, viser.SceneNodePointerEvent], None] = lambda object_id, event: None
        self.on_drag: Callable[[str, viser.SceneNodeDragEvent], None] = lambda object_id, event: None

    def refresh(self, by: ConnectedClient | None = None) -> None:
        """Bring every browser in line with the document: the scene at once, panels as often as can be followed.

        Who caused it sees the panels follow before the others do.
        """
        scene, clients = self._shown.scene, list(self._shown.clients.values())
        self._draw(N_("the view"), lambda: self.viewport.show(scene, self._shown.textures))
        self._preparer.want(o.shape_id for o in scene.objects)
        for client in clients:
            client.drop_missing()
            self._draw(N_("the photo's camera"), partial(self.show_photo_camera, client))
        self.refresh_panels(by)

    def refresh_panels(self, by: ConnectedClient | None = None) -> None:
        """Redraw the panels, and what everyone sees of the others' selections."""
        self.redraws.ask(self._shown.clients.values(), first=by)

    def show_whole_room(self) -> None:
        """New visitors and all who are here look at the whole room."""
        scene, first_view = self._shown.scene, self._server.initial_camera
        first_view.position, first_view.look_at = room_view(scene)
        first_view.fov = float(DEFAULT_FOV_RAD)
        for client in self._shown.clients.values():
            client.selection = ()
            client.doing = None
            client.view.photo.hide()
            if not client.view.canvas.is_open:
                client.view.camera.frame(partial(room_view, scene))

    def show_photo_camera(self, client: ConnectedClient) -> None:
        """Draw the cameras of all photos for one client; a click on one is told to `on_photo_camera`."""

        def look_through(name: str | None) -> None:
            client.post(lambda: self.on_photo_camera(client, name))

        photos: list[tuple[str, str | None, Camera | None, Photo | None]]
        photos = [("", None, self._shown.scene.camera, self._shown.photo)]
        photos += [(f"_{k}", p.name, p.camera, p.inputs.photo) for k, p in enumerate(self._shown.further_photos)]
        client.view.photo.show_cameras(
            [
                PhotoCamera(suffix, camera, None if photo is None else photo.rgb, partial(look_through, name))
                for suffix, name, camera, photo in photos
                if camera is not None
            ]
        )

    def _draw(self, what: str, draw: Callable[[], None]) -> None:
        """Draw a part of the page; an unexpected error costs that part only."""
        try:
            draw()
        except DioramaError as error:
            self._shown.notice_all(str(error), "bad")
        except Exception:  # whatever a part of the page does wrong, the work is saved and the other parts are drawn
            log.exception("%s cannot be drawn", what)
            message = _("{what} could not be drawn; your work is saved. See the server's log.")
            self._shown.notice_all(message.format(what=_(what)[:1].upper() + _(what)[1:]), "bad")

    def _pick(self, object_id: str, event: viser.SceneNodePointerEvent) -> None:
        """Called from viser's event loop, as `_drag` is."""
        self.on_pick(object_id, event)

    def _drag(self, object_id: str, event: viser.SceneNodeDragEvent) -> None:
        self.on_drag(object_id, event)

    def _replace_later(self, task: Callable[[], None]) -> None:
        self._ui_thread.post(task, after_s=MESH_OVERLAP_S, awaited=False)
