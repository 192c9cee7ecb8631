"""What is being placed, as a ghost under the pointer.

The page moves it by itself (`static/ghost.js`): it is told the model's node and the surfaces of the room, and tells
where a tile of the catalogue is dropped.
"""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import viser

from diorama_app.commands.insert import place_at
from diorama_app.panels.fields import PageScript
from diorama_app.session.client import Client, Placing
from diorama_app.web.html import Action, LiveHtml
from diorama_core.editing.placing import places_of
from diorama_core.errors import EditRefused
from diorama_core.geometry.openings import DOOR
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.taxonomy import resolve
from diorama_core.scene.types import Scene

NODE = "/ghost"
FAR_M = (0.0, 0.0, -1000.0)
"""Where it is until the pointer moves."""


DROP = '<button type="button" id="dio-ghost-drop" data-do="drop" style="display:none" tabindex="-1"></button>'


class PlacingGhost:
    """Shown while a click is awaited that places a shape, or a tile of the catalogue is dragged."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._script = PageScript(gui)
        LiveHtml(gui, lambda action: client.post(lambda: self._drop(action))).show(DROP)
        self._node: viser.GlbHandle | None = None
        self._shape_id: str | None = None

    def refresh(self) -> None:
        """Show what is being placed, and tell the page where it may be put."""
        doing, session = self._client.doing, self._client.session
        wanted = doing.shape_id if isinstance(doing, Placing) else None
        if wanted != self._shape_id:
            self._shape_id = wanted
            if self._node is not None:
                self._node.remove()
                self._node = None
            if wanted is not None:
                scene = self._client.viser_client.scene
                self._node = scene.add_glb(NODE, session.shapes.glb(wanted), position=FAR_M, cast_shadow=False)
        about = None if wanted is None else ghost_data(session.scene, session.library, session.library.shape(wanted))
        self._script.run(f"window.__dioGhost({json.dumps(about, separators=(',', ':'))});")

    def _drop(self, action: Action) -> None:
        """Put what is dragged onto the view where the ray of the pointer ends."""
        doing = self._client.doing
        if isinstance(doing, Placing):
            try:
                origin, direction = np.array(action.value, dtype=np.float64).reshape(2, 3)
            except (ValueError, TypeError) as error:
                raise EditRefused("nothing can be put there; drop it onto the floor, a table or a wall") from error
            place_at(self._client, doing.shape_id, origin, direction)


def ghost_data(scene: Scene, library: ShapeLibrary, shape: Shape) -> dict[str, Any]:
    """Data with which a page shows a shape where a click would put it.

    Returns:
        The node, the shape's size, whether it may hang, whether it is a door, where the photo's camera is seen from
        above, and the surfaces: normal, level (`normal . p = level`), half-planes of the outline (`outward . p <=
        offset`), whether things stand on it, and the height of its foot.
    """
    hung = resolve(shape.category).category.mount in ("wall", "ceiling")
    surfaces = [
        {
            "normal": _round(place.surface.normal),
            "level": round(float(place.surface.level), 4),
            "outward": [_round(side) for side in place.surface.outward],
            "offset": _round(place.surface.offset),
            "up": place.upward,
            "foot": round(float(place.surface.polygon[:, 2].min()), 4),
        }
        for place in places_of(scene, library)
    ]
    camera = None if scene.camera is None else _round(scene.camera.position[:2])
    door = shape.category == DOOR
    size = _round(shape.size_m)
    return {"node": NODE, "size": size, "hung": hung, "door": door, "camera": camera, "surfaces": surfaces}


def _round(values: Any) -> list[float]:
    return [round(float(v), 4) for v in values]
