"""The choices for a picture, over the page: from where, how large."""

from __future__ import annotations

from collections.abc import Callable

import viser

from diorama_app.panels.dialog import dialog
from diorama_app.reconstruction.picture_job import PictureView, film_suffix, picture_size, take_picture
from diorama_app.session.client import Client
from diorama_app.web.html import Action, LiveHtml, button, text

WIDTHS = (640, 1280, 1920, 2560, 3840)
FILM_WIDTHS = (480, 640, 960, 1280)
VIEWS: dict[PictureView, tuple[str, str]] = {
    "here": ("This view", "What you see now"),
    "photo": ("Photo's camera", "From where the photo was taken"),
    "turntable": ("Turntable", "A film that goes once around the scene"),
}
"""Name and explanation."""


def show_picture(client: Client) -> None:
    """Open the choices over the page; the picture itself is a job."""
    gui: viser.GuiApi = client.viser_client.gui
    with dialog(client, "Picture") as close:
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
            button(name, "view", view, title=hint, on=view == self._view, disabled=view == "photo" and not has_photo)
            for view, (name, hint) in VIEWS.items()
        )
        widths = "".join(button(str(w), "width", w, title="pixels wide", on=w == self._width) for w in self._widths())
        buttons = button("Make picture", "make", on=True) + button("Close", "close")
        self._html.show(
            f'<h4>From</h4><div class="bar">{views}</div><h4>Pixels across</h4><div class="bar">{widths}</div>'
            f'<p class="dim">{text(self._in_words())}</p><div class="bar" style="margin:10px 0 0">{buttons}</div>'
        )

    def _widths(self) -> tuple[int, ...]:
        return FILM_WIDTHS if self._view == "turntable" else WIDTHS

    def _in_words(self) -> str:
        across, down = picture_size(self._client, self._view, self._width)
        if self._view == "turntable":
            return f"Four seconds of {across} × {down} pixels, as {film_suffix()[1:].upper()}; takes some minutes."
        return f"{across} × {down} pixels, as PNG, with soft shadows; takes some seconds."

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
