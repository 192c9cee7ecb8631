"""The choices for a picture, over the page: from where, how large."""

from __future__ import annotations

from collections.abc import Callable

import viser

from diorama_app.panels.messages import dialog
from diorama_app.reconstruction.written_files import PictureView, film_suffix, picture_size, take_picture
from diorama_app.session.client import Client
from diorama_app.strings import N_, _
from diorama_app.web.html import Action, LiveHtml, button, text

WIDTHS = (640, 1280, 1920, 2560, 3840)
FILM_WIDTHS = (480, 640, 960, 1280)
VIEWS: dict[PictureView, tuple[str, str]] = {
    "here": (N_("This view"), N_("What you see now")),
    "photo": (N_("Photo's camera"), N_("From where the photo was taken")),
    "turntable": (N_("Turntable"), N_("A film that goes once around the scene")),
}
"""Name and explanation."""


def show_picture(client: Client) -> None:
    """Open the choices over the page; the picture itself is a job."""
    gui: viser.GuiApi = client.viser_client.gui
    with dialog(client, _("Picture")) as close:
        _Choices(gui, client, close).show()


class _Choices:
    """What is chosen in one dialog."""

    def __init__(self, gui: viser.GuiApi, client: Client, close: Callable[[], None]) -> None:
        self._client, self._close = client, close
        self._view: PictureView = "here"
        self._width = 1280
        self._html = LiveHtml(gui, lambda action: client.post(lambda: self._do(action)))

    def show(self) -> None:
        """Draw the choices."""
        has_photo = self._client.session.scene.camera is not None
        views = "".join(
            button(
                _(name), "view", view, title=_(hint), on=view == self._view, disabled=view == "photo" and not has_photo
            )
            for view, (name, hint) in VIEWS.items()
        )
        widths = "".join(
            button(str(w), "width", w, title=_("pixels wide"), on=w == self._width) for w in self._widths()
        )
        buttons = button(_("Make picture"), "make", on=True) + button(_("Close"), "close")
        self._html.show(
            f'<h4>{text(_("View"))}</h4><div class="bar">{views}</div>'
            f'<h4>{text(_("Width in pixels"))}</h4><div class="bar">{widths}</div>'
            f'<p class="dim">{text(self._description())}</p><div class="bar" style="margin:10px 0 0">{buttons}</div>'
        )

    def _widths(self) -> tuple[int, ...]:
        return FILM_WIDTHS if self._view == "turntable" else WIDTHS

    def _description(self) -> str:
        across, down = picture_size(self._client, self._view, self._width)
        if self._view == "turntable":
            return _("Four seconds of {across} × {down} pixels, as {format}; takes some minutes.").format(
                across=across, down=down, format=film_suffix()[1:].upper()
            )
        return _("{across} × {down} pixels, as PNG, with soft shadows; takes some seconds.").format(
            across=across, down=down
        )

    def _do(self, action: Action) -> None:
        if action.do == "close":
            self._close()
            return
        if action.do == "make":
            take_picture(self._client, self._view, self._width)
            self._close()
            return
        for view in VIEWS:
            if (action.do, action.arg) == ("view", view):
                self._view = view
        if action.do == "width" and action.arg in map(str, self._widths()):
            self._width = int(action.arg)
        if self._width not in self._widths():
            self._width = self._widths()[1]
        self.show()
