"""Opacity of the photo over the model: 0 shows the model, 100 the photo."""

from __future__ import annotations

import viser

from diorama_app.commands.camera_presets import Views
from diorama_app.panels.fields import on_change, show_if, show_value
from diorama_app.session.client import Client


class Compare:
    """A slider that looks through the photo's camera and lays the photo over the model."""

    def __init__(self, gui: viser.GuiApi, client: Client, views: Views) -> None:
        self._client = client
        self._slider = gui.add_slider(
            "Photo over model", 0, 100, 5, 0, visible=False, hint="In the photo view: 0 is the model, 100 the photo"
        )
        on_change(self._slider, lambda v: client.post(lambda: views.overlay(client, v / 100), key="over"))

    def refresh(self) -> None:
        """Offer it where there is a photo to compare with; show all or nothing where something else asked."""
        show_if(self._client.session.photo is not None and self._client.session.scene.camera is not None, self._slider)
        shown = round(100 * self._client.view.photo.opacity)
        if shown in (0, 100):
            show_value(self._slider, shown)
