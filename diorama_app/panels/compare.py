"""How much of the photo lies over the model: 0 shows the model, 100 the photo."""

from __future__ import annotations

import viser

from diorama_app.actions import Views
from diorama_app.panels.fields import on_change, show_if, show_value
from diorama_app.room import Room


class Compare:
    """A slider that looks through the photo's camera and lays the photo over the model."""

    def __init__(self, gui: viser.GuiApi, room: Room, views: Views) -> None:
        self._room, self._views = room, views
        self._slider = gui.add_slider(
            "Photo over model", 0, 100, 5, 0, visible=False, hint="In the photo view: 0 is the model, 100 the photo"
        )
        on_change(
            self._slider,
            lambda value, client: room.post(client, lambda: views.overlay(client, value / 100), key="over"),
        )

    def refresh(self) -> None:
        """Offer it where there is a photo to compare with; put it back when nobody compares."""
        show_if(self._room.photo is not None and self._room.scene.camera is not None, self._slider)
        if not any(view.comparing for view in self._room.views.values()):
            show_value(self._slider, 0)
