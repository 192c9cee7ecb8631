"""The photos of the room, side by side: a click looks through one, and another is added."""

from __future__ import annotations

import numpy as np
import viser
from jaxtyping import UInt8

from diorama_app.commands.camera_presets import Views
from diorama_app.panels.fields import UploadField
from diorama_app.projects.pictures import encode_picture, jpeg_uri
from diorama_app.projects.uploads import Upload
from diorama_app.reconstruction.photo_joining import awaits_photo, missing_for_joining, take_out, take_photo
from diorama_app.session.client import Client
from diorama_app.strings import N_, _, plural
from diorama_app.viewport.mesh_assets import reduce
from diorama_app.web.html import Action, LiveHtml, button, text
from diorama_core.artefacts import FurtherPhoto

TILE_PX = 200
"""Size of the pictures, which are shown at half of it."""
ADVICE = N_(
    "Take another photo from one or two steps to the side, with most of the same furniture in view. The scene stays."
)
ALL_ROUND = N_(
    "Drag in the 3D view to look around. To change the room, mark its furniture in the whole photo and build again."
)
KEPT = 128
"""Encoded pictures."""


class PhotoStrip:
    """Shown once a scene was built from a photo, and for scans, which a photo may join."""

    def __init__(self, gui: viser.GuiApi, client: Client, views: Views) -> None:
        self._client, self._views = client, views
        self._pictures: dict[int, tuple[object, str]] = {}
        self._html = LiveHtml(gui, self._act)
        self._upload = UploadField(gui, client, _("Add a photo of this room"), self._receive, mime_type="image/*")
        self._upload.show_if(False)

    def refresh(self) -> None:
        """Draw the photos."""
        session, client = self._client.session, self._client
        inputs, camera = session.inputs, session.scene.camera
        shown = (inputs is not None and camera is not None) or awaits_photo(session.scene)
        missing = session.glances.get("joining", lambda: missing_for_joining(session.scene)) if shown else ""
        self._upload.show_if(shown and not missing)
        if inputs is None or camera is None or not session.further_photos:
            self._html.show(f'<p class="dim">{text(_(missing or ADVICE))}</p>' if shown else "")
            return
        first = self._tile("", _("First photo"), inputs.photo.rgb, on=client.further_photo is None, joined=True)
        rest = "".join(
            self._tile(p.name, p.name, p.inputs.photo.rgb, on=p is client.further_photo, joined=p.is_placed)
            for p in session.further_photos
        )
        further = client.further_photo
        about = "" if further is None else _photo_hint(further)
        self._html.show(f'<h4>{text(_("Photos of this room"))}</h4><div class="grid">{first}{rest}</div>{about}')

    def _tile(self, name: str, label: str, rgb: UInt8[np.ndarray, "h w 3"], *, on: bool, joined: bool) -> str:
        state = "" if joined else f"<small>{text(_('not in the scene yet'))}</small>"
        title = (_("Show the view of {label}") if joined else _("Mark the furniture in {label}")).format(label=label)
        return (
            f'<button type="button" class="tile {"on" if on else ""}" data-do="choose" data-arg="{text(name)}" '
            f'title="{text(title)}" aria-pressed="{"true" if on else "false"}">'
            f'<img alt="" style="aspect-ratio:4/3;object-fit:cover" src="{self._picture(rgb)}">'
            f'<b style="height:auto;white-space:nowrap;text-overflow:ellipsis">{text(label)}</b>{state}</button>'
        )

    def _picture(self, rgb: UInt8[np.ndarray, "h w 3"]) -> str:
        """A small picture, encoded once for every photo."""
        known = self._pictures.get(id(rgb))
        if known is None or known[0] is not rgb:
            uri = jpeg_uri(encode_picture(reduce(rgb, TILE_PX), "JPEG", quality=75))
            if len(self._pictures) >= KEPT:
                self._pictures.clear()
            known = self._pictures[id(rgb)] = (rgb, uri)
        return known[1]

    def _receive(self, name: str, content: bytes) -> None:
        client = self._client
        client.session.reader.read(Upload(content, name), client, lambda read: take_photo(client, name, read.inputs))

    def _act(self, action: Action) -> None:
        def do() -> None:
            client = self._client
            if action.do == "choose":
                self._choose(action.arg or None)
            elif action.do == "out" and client.photo_name is not None:
                take_out(client, client.photo_name)

        self._client.post(do)

    def _choose(self, name: str | None) -> None:
        client = self._client
        client.choose_photo(name)
        camera = client.viewpoint[0]
        if camera is not None:
            self._views.photo(client)
        else:
            client.open_board()
        client.refresh()


def _photo_hint(photo: FurtherPhoto) -> str:
    """Hint on what to do with the chosen photo."""
    if photo.inputs.photo.equirectangular:
        return f'<p class="dim" style="margin-top:6px">{text(_(ALL_ROUND))}</p>'
    if photo.camera is None:
        message = _(
            "Mark the furniture that the first photo does not show, or shows less well. Then add it to the scene."
        )
    else:
        message = plural(
            "{count} object of the scene is visible in it.",
            "{count} objects of the scene are visible in it.",
            len(photo.seen),
        )
    out = button(_("Remove photo"), "out", title=_("Remove the photo; its objects stay. One undo step"))
    return f'<p class="dim" style="margin-top:6px">{text(message)}</p><div class="bar tight">{out}</div>'
