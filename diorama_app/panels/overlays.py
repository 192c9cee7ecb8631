"""What is laid over the view: detected objects on the photo and plane edges in the room, the photo faded over the model
by a slider, and outlines of what is selected with the name of what is pointed at.
"""

from __future__ import annotations

import json

import numpy as np
import viser
from jaxtyping import UInt8

from diorama_app.commands.camera_presets import Views
from diorama_app.commands.edit import supporter_name
from diorama_app.panels.fields import PageScript
from diorama_app.reconstruction.photo_outlines import PhotoOutlines
from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_app.viewport.decorations import Outline
from diorama_app.web.html import Action, LiveHtml, text
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
        is_first = client.further_photo is None
        shown = client.view.camera.through_photo and is_first and photo is not None and scene.camera is not None
        masks, planes = preferences.masks and self._outlines.objects is not None, preferences.planes
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
        from diorama_app.viewport.overlays import draw_ground, draw_planes, mask_picture, visible_objects

        session, k = self._client.session, camera.intrinsics
        items = visible_objects(session.scene, self._outlines.objects or ()) if masks else ()
        picture = mask_picture((k.width, k.height), items, self._client.selection)
        if planes:
            draw_planes(picture, session.scene.architecture.planes, camera)
        if self._client.trial_camera is not None:
            draw_ground(picture, self._client.trial_camera, floor_height(session.scene))
        return picture


STEP = 5
_LIVE = "this.dispatchEvent(new Event('change',{bubbles:true}))"
"""Tells every step while the slider is being pulled, not only where it is let go."""


class Compare:
    """Looks through the photo's camera and lays the photo over the model: 0 shows the model, 100 the photo."""

    def __init__(self, gui: viser.GuiApi, client: Client, views: Views) -> None:
        self._client, self._views = client, views
        self._html = LiveHtml(gui, self._act, floating="dio-compare")
        self._drawn: int | None = None
        """What the slider was last drawn with; None: it is not there."""

    def refresh(self) -> None:
        """Offer it where there is a photo to compare with; show all or nothing where something else asked."""
        canvas = self._client.view.canvas
        if None in self._client.viewpoint or canvas.is_open or self._client.plan:
            self._drawn = None
            self._html.show("")
            return
        shown = round(100 * self._client.view.photo.opacity)
        if self._drawn is None or (shown in (0, 100) and shown != self._drawn):
            self._drawn = shown
            self._html.show(_slider(shown), again=True)

    def _act(self, action: Action) -> None:
        words = action.pair[1]
        if action.do != "over" or not words.isdecimal():
            return
        share = min(int(words), 100)

        def fade() -> None:
            self._drawn = share  # a value in the hand is left alone
            self._views.overlay(self._client, share / 100)

        self._client.post(fade, key="over")


def _slider(value: int) -> str:
    return (
        f'<label title="{text(_("Fade between the model and the photo in the photo view"))}">'
        f"<span>{text(_('Model'))}</span>"
        f'<input type="range" min="0" max="100" step="{STEP}" value="{value}" data-change="over" oninput="{_LIVE}" '
        f'aria-label="{text(_("Opacity of the photo over the model"))}"><span>{text(_("Photo"))}</span></label>'
    )


class Silhouettes:
    """Tells one page what is outlined in which colour."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._script = PageScript(gui)
        client.marks.on_outlines = lambda outlines: self.refresh()

    def refresh(self) -> None:
        """Tell the page what differs from what it knows."""
        told = {"lines": [_line(o) for o in self._client.marks.outlines], "names": self._names()}
        self._script.run(f"window.__dioSilhouettes.told({json.dumps(told, separators=(',', ':'))})")

    def _names(self) -> dict[str, str]:
        session = self._client.session
        names = {}
        for item in session.scene.objects:
            node = session.viewport.node_name(item.id)
            if node is not None and not item.hidden:
                problems = "".join(f" ⚠ {_(badge)}" for badge in session.badges.get(item.id, ()))
                names[node] = item.label[:60] + (_(" (locked)") if item.locked else "") + problems
        return names


def _line(outline: Outline) -> tuple[str, str, float]:
    return outline.node, "#" + "".join(f"{c:02x}" for c in outline.colour), outline.thickness_px
