"""Overlays of detected objects on the photo and of plane edges in the room, while switched on."""

from __future__ import annotations

import numpy as np
from jaxtyping import UInt8

from diorama_app.commands.edit import supporter_name
from diorama_app.reconstruction.photo_outlines import PhotoOutlines
from diorama_app.session.client import Client
from diorama_core.scene.room_edits import floor_height
from diorama_core.scene.types import Architecture, Camera


class Overlays:
    """Draws anew what changed: the scene, the selection, the settings, the point of view."""

    def __init__(self, client: Client, outlines: PhotoOutlines) -> None:
        self._client = client
        self._outlines = outlines
        self._picture_of: object = None
        self._planes_of: Architecture | None = None

    def refresh(self) -> None:
        """Update both to the document and the preferences."""
        self._refresh_planes()
        self._refresh_picture()

    def _refresh_planes(self) -> None:
        scene = self._client.session.scene
        wanted = scene.architecture if self._client.preferences.planes else None
        if wanted != self._planes_of:
            self._planes_of = wanted
            planes = () if wanted is None else wanted.planes
            self._client.view.show_planes([(supporter_name(scene, p.id).capitalize(), p) for p in planes])

    def _refresh_picture(self) -> None:
        client, session = self._client, self._client.session
        preferences, scene, photo = client.preferences, session.scene, session.photo
        own = client.further_photo is None
        shown = client.view.camera.through_photo and own and photo is not None and scene.camera is not None
        masks, planes = preferences.masks and self._outlines.found is not None, preferences.planes
        trial = client.trial_camera
        if not shown or not (masks or planes or trial is not None):
            key: object = None
        else:
            objects = tuple((o.id, o.box_px, o.hidden) for o in scene.objects) if masks else ()
            key = (scene.camera, scene.architecture if planes else None, objects, client.selection, masks, trial)
        if key == self._picture_of:
            return
        self._picture_of = key
        if key is None or photo is None or scene.camera is None:
            client.view.photo.show_layer(None, None)
            return
        client.view.photo.show_layer(scene.camera, self._picture(scene.camera, masks=masks, planes=planes))

    def _picture(self, camera: Camera, *, masks: bool, planes: bool) -> UInt8[np.ndarray, "h w 4"]:
        from diorama_app.viewport.overlays import draw_ground, draw_planes, mask_picture, seen_objects

        session, k = self._client.session, camera.intrinsics
        items = seen_objects(session.scene, self._outlines.found or ()) if masks else ()
        picture = mask_picture((k.width, k.height), items, self._client.selection)
        if planes:
            draw_planes(picture, session.scene.architecture.planes, camera)
        if self._client.trial_camera is not None:
            draw_ground(picture, self._client.trial_camera, floor_height(session.scene))
        return picture
