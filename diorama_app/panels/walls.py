"""Walls between the camera and the room fade, with everything mounted on them, in every frame.

The page is told where planes are and what hangs on them; it fades by itself (`static/walls.js`), so that turning the
view needs no server.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

import viser

from diorama_app.panels.fields import PageScript
from diorama_app.session.client import Client
from diorama_app.viewport.scene_view import MESH_NAMES
from diorama_core.scene.types import Plane, Scene

FADE_MS = 200
GHOST = {"wall": 0.13, "floor": 0.13, "ceiling": 0.0}
"""What is left of a plane seen from behind. A ceiling goes: it would lie over the whole room seen from above."""
HIDDEN = ([0.0, 0.0, 0.0], 1.0, 0.0)
"""Seen from behind, wherever one stands, and nothing left of it."""
PHOTO_NEAR_M = 0.03
"""Nearer to the photo's camera the model is compared with the photo, and nothing is laid over it."""


class Walls:
    """Tells one page where the walls are."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._script = PageScript(gui)

    def refresh(self) -> None:
        """Tell the page what differs from what it knows."""
        session, client = self._client.session, self._client
        ms, view = 0 if session.low_graphics else FADE_MS, session.viewport
        scene = session.scene
        about = what_fades(scene, view.plane_name, view.node_name, client.selection, ms)
        if client.rooms:
            from diorama_core.geometry.rooms import part_of_home  # shapely; a room opens without it

            shown = part_of_home(scene, client.rooms)
            gone = {view.plane_name(p.id) for p in scene.architecture.planes if not shown.has_plane(p.id)}
            about["planes"] = [[row[0], *HIDDEN] if row[0] in gone else row for row in about["planes"]]
            gone = {view.node_name(o.id) for o in scene.objects if not shown.has_object(o.id)}
            about["hung"] = [row for row in about["hung"] if row[0] not in gone] + [[name, *HIDDEN] for name in gone]
        told = json.dumps({**about, "versions": MESH_NAMES}, separators=(",", ":"))
        self._script.run(f"window.__dioWalls.told({told})")


def what_fades(
    scene: Scene,
    plane_name: Callable[[str], str | None],
    object_name: Callable[[str], str | None],
    selection: tuple[str, ...],
    fade_ms: int,
) -> dict[str, Any]:
    """What a page needs to know to fade walls.

    Args:
        scene: as it is shown.
        plane_name: node of a plane, by id.
        object_name: node of an object, by id.
        selection: ids of objects that stay opaque because they are selected.
        fade_ms: how long a fade takes; 0: at once.

    Returns:
        Rows (node, normal into the room, offset, what is left when seen from behind) of planes, and likewise of what
        hangs on walls; the photo's camera (world, metres).
    """
    planes = {p.id: p for p in scene.architecture.planes}
    rows = [[plane_name(i), *_sides(p)] for i, p in planes.items() if plane_name(i) is not None]
    parents = {s.child: s.parent for s in scene.supports}
    hung = []
    for item in scene.objects:
        wall = planes.get(_root_plane(parents, item.id))
        if wall is not None and wall.role == "wall":
            normal, offset, ghost = _sides(wall)
            hung.append([object_name(item.id), normal, offset, 1.0 if item.id in selection else ghost])
    photo = None if scene.camera is None else _round(scene.camera.position)
    return {"planes": rows, "hung": hung, "photo": photo, "near": PHOTO_NEAR_M, "ms": fade_ms}


def _sides(plane: Plane) -> list[Any]:
    return [_round(plane.normal), round(float(plane.offset), 4), GHOST[plane.role]]


def _round(vector: Any) -> list[float]:
    return [round(float(v), 4) for v in vector]


def _root_plane(parents: Mapping[str, str], object_id: str) -> str:
    """Id of the plane at the root of an object's support chain; empty without support."""
    supported = parents.get(object_id, "")
    while supported in parents:
        supported = parents[supported]
    return supported
