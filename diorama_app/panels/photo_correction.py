"""Corrections of the selected object in the photo: category, box, outline."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import viser

from diorama_app.reconstruction.object_correction import redraw_box, rename_class, start_outline, use_outline
from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_app.viewport.annotation_canvas import Drawn, Event, Finished, Pointed
from diorama_app.web.html import Action, LiveHtml, button, text
from diorama_core.artefacts import LabelledBox
from diorama_core.errors import EditRefused

if TYPE_CHECKING:
    from diorama_core.editing.outline import MaskDraft


class PhotoCorrection:
    """Shown for objects that were found in the photo."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._html = LiveHtml(gui, lambda action: client.post(lambda: self._do(action)))
        self._outline: MaskDraft | None = None
        self._of: str | None = None

    def refresh(self) -> None:
        """Draw what can be corrected about the selected object."""
        item, session = self._client.last_selected, self._client.session
        if item is None or item.box_px is None or session.photo is None:
            self._html.show("")
            return
        if self._of is not None and not self._client.view.canvas.is_open:
            self._of = self._outline = None
        title, cancel = f"<h4>{text(_('From the photo'))}</h4>", button(_("Cancel"), "stop")
        if self._outline is not None:
            self._html.show(
                f'{title}<div class="card">{text(_("Click the object; Shift-click what does not belong to it."))}'
                f'<div class="bar tight" style="margin:6px 0 0 0">{button(_("Use this outline"), "use")}{cancel}</div>'
                "</div>"
            )
        elif self._of is not None:
            self._html.show(
                f'{title}<div class="card">{text(_("Draw a box around it in the photo."))}'
                f'<div class="bar tight" style="margin:6px 0 0 0">{cancel}</div></div>'
            )
        else:
            self._html.show(
                f'{title}<div style="display:flex;gap:8px;align-items:center;margin-bottom:6px">'
                f'<span class="dim" style="white-space:nowrap">{text(_("This is a"))}</span>'
                f'<input data-change="is" aria-label="{text(_("Object category"))}" value="{text(_(item.category))}" '
                f'title="{text(_("Type a category and press Enter to retrieve matching shapes"))}"></div>'
                '<div class="bar tight">'
                + button(_("Redraw box"), "box", title=_("Draw a new box around it in the photo"))
                + button(_("Fix outline"), "outline", title=_("Correct the outline by clicks in the photo"))
                + "</div>"
            )

    def _do(self, action: Action) -> None:
        client = self._client
        object_id = client.need_selected()
        if action.do == "is":
            rename_class(client, object_id, action.pair[1])
        elif action.do == "box":
            self._of = object_id
            client.view.canvas.open(
                self._photo(), lambda event: client.post(lambda: self._handle(object_id, event)), "one box"
            )
            item = client.session.scene.object(object_id)
            if item.box_px is not None:
                client.view.canvas.show_boxes([LabelledBox(item.box_px, item.category, item.label)], 0)
        elif action.do == "outline":
            self._outline, self._of = start_outline(client, object_id), object_id
            client.view.canvas.open(
                self._photo(), lambda event: client.post(lambda: self._handle(object_id, event)), "points"
            )
            client.view.canvas.show_mask(self._outline.mask)
        elif action.do == "use" and self._outline is not None:
            use_outline(client, object_id, self._outline)
            self._close()
        elif action.do == "stop":
            self._close()
        client.refresh()

    def _handle(self, object_id: str, event: Event) -> None:
        """Something was done on the photo."""
        match event:
            case Drawn(box) if self._outline is None:
                self._close()
                redraw_box(self._client, object_id, box)
            case Pointed(x, y, is_part) if self._outline is not None:
                self._outline = self._outline.click(x, y, part=is_part)
                self._client.view.canvas.show_mask(self._outline.mask)
            case Finished() if self._outline is not None:
                use_outline(self._client, object_id, self._outline)
                self._close()
            case Finished():
                self._close()

    def _close(self) -> None:
        self._outline = self._of = None
        self._client.view.canvas.close()
        self._client.refresh()

    def _photo(self) -> np.ndarray:
        photo = self._client.session.photo
        if photo is None:
            raise EditRefused("this project has no photo")
        return photo.rgb
