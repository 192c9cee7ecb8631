"""The plan: the room from above, drawn in the page (`static/plan.js`), edited through the same document as the 3D view.

Walls and corners are dragged, lengths are typed, furniture is moved; doors and windows slide along their wall. Tools of
the plan split walls, put doors and windows into them, and draw another room.
"""

from __future__ import annotations

import json
import threading
from typing import Any

import numpy as np
import viser

from diorama_app.commands import edit as editing
from diorama_app.commands.insert import put_opening
from diorama_app.panels.fields import PageScript
from diorama_app.panels.plan_picture import PicturesBelow
from diorama_app.session.client import Client
from diorama_app.session.units import Unit, format_length, parse_length
from diorama_app.strings import _, plural
from diorama_app.web.html import Action, LiveHtml
from diorama_core.editing.homes import draw_room_of_home
from diorama_core.editing.plan_edits import corners, move_corner, set_wall_length, split_wall, wall_feet
from diorama_core.errors import EditRefused, LibraryError
from diorama_core.export.footprints import Outline, outline
from diorama_core.export.plan import OVERHEAD_M, UNNAMED, RoomLines, drawing_order, freest_places, room_lines
from diorama_core.geometry.openings import OPENING_CATEGORIES, faces_behind, wall_of
from diorama_core.geometry.rooms import part_of_home
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.room_edits import floor_height, move_plane
from diorama_core.scene.types import Scene, SceneObject

SEND = '<button type="button" id="dio-plan-send" style="display:none" tabindex="-1"></button>'
UNSURE_M = 0.1
"""A place is shown as unsure from this deviation on."""
HANDLED_M = 0.2
"""A door or window is taken hold of in at least this depth."""


class ShapeOutlines:
    """What shapes cover, seen from above: found in the background, by their boxes until then."""

    def __init__(self, library: ShapeLibrary) -> None:
        self._library = library
        self._found: dict[str, tuple[Outline, ...]] = {}
        self._lost: set[str] = set()
        self._looking = False

    def object_outlines(self, item: SceneObject) -> tuple[Outline, ...]:
        """Outlines of an object in the world's x and y; the rectangle of its box while its shape's is unknown."""
        R, scale = item.pose.R_world_object[:2, :2], np.asarray(item.pose.scale)[:2]
        known = self._found.get(item.shape_id)
        if known is None:
            half = np.asarray(item.size_m[:2]) / 2
            return (
                np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]) * half @ R.T + item.pose.position[:2],
            )
        return tuple((o * scale) @ R.T + item.pose.position[:2] for o in known)

    def look_for(self, scene: Scene, then: Any) -> None:
        """Find the outlines of a scene's shapes that are not known yet; `then()` is called when there are new ones."""
        missing = {o.shape_id for o in scene.objects} - self._found.keys() - self._lost
        if not missing or self._looking:
            return
        self._looking = True

        def look() -> None:
            try:
                for shape_id in sorted(missing):
                    try:
                        mesh = self._library.mesh(shape_id)
                    except LibraryError:  # the list of objects says so; the others are drawn
                        self._lost.add(shape_id)
                        continue
                    triangles = np.asarray(mesh.vertices, dtype=np.float64)[:, :2][np.asarray(mesh.faces)]
                    self._found[shape_id] = outline(triangles)
            finally:
                self._looking = False
            then()

        threading.Thread(target=look, daemon=True, name="plan outlines").start()


class Plan:
    """Drawn while the client looks at the plan."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._outlines = ShapeOutlines(client.session.library)
        self._sender = LiveHtml(gui, lambda action: client.post(lambda: self._do(action)))
        self._sender.show(SEND)
        self._picture = PicturesBelow(gui, client, self._everything)
        self._script = PageScript(gui)
        self._tell("null")

    def refresh(self) -> None:
        """Tell the page what differs from what it knows; nothing is computed while the plan is not seen."""
        client = self._client
        if not client.plan:
            self._tell("null")
            return
        scene = self._scene()
        self._outlines.look_for(scene, lambda: client.post(self.refresh, key="plan"))
        self._picture.refresh()
        self._tell(json.dumps(self._plan_data(scene), separators=(",", ":")))

    def _scene(self) -> Scene:
        """The scene; of a home the storey of what is shown, the lowest where everything is."""
        scene = self._client.session.scene
        if not scene.rooms:
            return scene
        return part_of_home(scene, {r.id for r in scene.rooms if r.storey in self._storeys()})

    def _storeys(self) -> set[int]:
        """The storeys of the rooms that are shown, the lowest where everything is."""
        rooms, shown = self._client.session.scene.rooms, self._client.rooms
        return {r.storey for r in rooms if r.id in shown} or {min((r.storey for r in rooms), default=0)}

    def _everything(self) -> list[list[float]]:
        scene = self._scene()
        visible = [o for o in scene.objects if not o.hidden]
        return _bounds(room_lines(scene.architecture.planes, visible, scene), [o.corners_world[:, :2] for o in visible])

    def _tell(self, told: str) -> None:
        self._script.run(f"window.__dioPlan.told({told})")

    def _plan_data(self, scene: Scene) -> dict[str, Any]:
        client = self._client
        visible = [o for o in scene.objects if not o.hidden]
        room = room_lines(scene.architecture.planes, visible, scene)
        unit = client.preferences.unit
        pieces = [self._piece(scene, o) for o in sorted(visible, key=drawing_order)]
        return {
            "bounds": _bounds(room, [o for p in pieces for o in p["outlines"]]),
            "snap": client.preferences.snap,
            "feet": unit == "ft-in",
            "floors": [_flat(o) for o in room.floors],
            "solid": [_flat(o) for o in room.walls],
            "swings": [_flat(o) for o in room.door_leaves],
            "panes": [_flat(o) for o in room.window_panes],
            "walls": _walls(scene, client.surface, unit),
            "corners": [{"walls": [c.first, c.second], "at": _flat(c.at)} for c in corners(scene)],
            "pieces": pieces,
            "rooms": _names(scene, pieces),
            **_doubts(scene),
        }

    def _piece(self, scene: Scene, item: SceneObject) -> dict[str, Any]:
        outlines, along = self._outlines.object_outlines(item), None
        if item.category in OPENING_CATEGORIES:
            wall = wall_of(item, scene.architecture.by_role("wall"), scene)
            along = None if wall is None else [-float(wall.normal[1]), float(wall.normal[0])]
            half = np.maximum(np.asarray(item.size_m[:2]) / 2, (HANDLED_M / 2, 0.0))
            outlines = (_rectangle(item, half),)
        size = np.ptp(np.concatenate(outlines), axis=0) if outlines else np.zeros(2)
        bottom = float(item.corners_world[:, 2].min()) - floor_height(scene)
        named = item.category not in (*UNNAMED, *OPENING_CATEGORIES)
        return {
            "id": item.id,
            "label": item.label,
            "outlines": [_flat(o) for o in outlines],
            "at": _flat(item.pose.position[:2]),
            "room": _flat(size) if named else [0.0, 0.0],
            "on": item.id in self._client.selection,
            "overhead": bottom > OVERHEAD_M,
            "flat": item.category in UNNAMED,
            "along": along,
        }

    def _do(self, action: Action) -> None:
        client, session = self._client, self._client.session
        try:
            arg = action.value
            match action.do:
                case "select":
                    self._select(arg[0], add=bool(arg[1]))
                case "surface":
                    client.select_surface(str(arg))
                    client.open_tab("Object")
                case "move":
                    item = session.scene.object(str(arg[0]))
                    shift = np.array([float(arg[1]), float(arg[2]), 0.0])
                    editing.set_base_position(client, item.id, editing.base_position(item) + shift)
                case "wall":
                    wall, outward = str(arg[0]), float(arg[1])
                    name = editing.supporter_name(session.scene, wall)
                    session.edit(_("move {name}").format(name=name), lambda s: move_plane(s, wall, outward), by=client)
                case "corner":
                    first, second, shift = str(arg[0]), str(arg[1]), np.array([float(arg[2]), float(arg[3])])
                    session.edit(_("move a corner"), lambda s: move_corner(s, first, second, shift), by=client)
                case "length":
                    wall, metres = str(arg[0]), parse_length(str(arg[1]), client.preferences.unit)
                    name = editing.supporter_name(session.scene, wall)
                    label = _("set the length of {name}").format(name=name)
                    session.edit(label, lambda s: set_wall_length(s, wall, metres), by=client)
                case "split":
                    wall, at = str(arg[0]), np.array([float(arg[1]), float(arg[2])])
                    name = editing.supporter_name(session.scene, wall)
                    session.edit(_("split {name}").format(name=name), lambda s: split_wall(s, wall, at), by=client)
                case "door" | "window":
                    put_opening(client, action.do, str(arg[0]), np.array([float(arg[1]), float(arg[2])]))
                case "picture":
                    self._picture.place(arg)
                case "room":
                    outline, storey = np.array(arg, dtype=np.float64).reshape(-1, 2), min(self._storeys())
                    session.edit(_("draw the room"), lambda s: draw_room_of_home(s, outline, storey), by=client)
        except (KeyError, TypeError, IndexError, json.JSONDecodeError) as error:
            raise EditRefused("that is no longer in the plan") from error
        finally:
            self._script.forget()  # what was dragged goes where the document says
            self.refresh()

    def _select(self, object_id: str | None, *, add: bool) -> None:
        client = self._client
        if object_id is None or not client.session.scene.has_object(object_id):
            client.select(())
        elif add:
            client.toggle(object_id)
        else:
            client.select((object_id,))


PHOTO_HERE = (
    "A photo from here would show where {count} object is",
    "A photo from here would show where {count} objects are",
)


def _doubts(scene: Scene) -> dict[str, Any]:
    """Where objects may be whose places are not sure, and from where another photo would tell."""
    from diorama_core.review.viewpoint import next_photo, place_outline  # SciPy and shapely: only once a plan is shown

    unsure = (o for o in scene.objects if o.belief is not None and o.belief.place_sigma_m > UNSURE_M and not o.hidden)
    outlines = [outline for o in unsure if (outline := place_outline(scene, o)) is not None]
    photo = next_photo(scene)
    told = None
    if photo is not None:
        words = plural(*PHOTO_HERE, photo.objects)
        told = {"at": _flat(photo.position), "to": _flat(photo.look_at), "words": words}
    return {"spreads": [_flat(o) for o in outlines], "photo": told}


def _rectangle(item: SceneObject, half: np.ndarray) -> Outline:
    """A rectangle around an object, turned as it is."""
    signs = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    return np.asarray((signs * half) @ item.pose.R_world_object[:2, :2].T + item.pose.position[:2])


def _names(scene: Scene, pieces: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Names of rooms, each where the most of its floor is free."""
    taken = [np.reshape(o, (-1, 2)) for p in pieces if not p["overhead"] for o in p["outlines"]] if scene.rooms else []
    floors = [scene.plane(r.floor).polygon[:, :2] for r in scene.rooms]
    places = freest_places(floors, taken, [r.name for r in scene.rooms])
    return [{"at": _flat(at), "name": room.name} for room, at in zip(scene.rooms, places, strict=True)]


def _walls(scene: Scene, chosen: str | None, unit: Unit) -> list[dict[str, Any]]:
    faces = scene.architecture.by_role("wall")
    return [
        {
            "id": f.id,
            "name": editing.supporter_name(scene, f.id),
            "start": _flat(f.start),
            "end": _flat(f.end),
            "outward": [round(float(v), 6) for v in f.outward],
            "thickness": scene.plane(f.id).thickness,
            "inner": bool(faces_behind(scene.plane(f.id), scene.plane(f.id).centre, faces)),
            "length": format_length(f.length_m, unit),
            "on": f.id == chosen,
        }
        for f in wall_feet(scene)
    ]


def _bounds(room: RoomLines, outlines: list[Any]) -> list[list[float]]:
    """Least and largest x and y of everything; two metres where there is nothing."""
    known = [*room.floors, *room.walls, *(np.asarray(o) for o in outlines)]
    every = np.concatenate(known) if known else np.array([[-1.0, -1.0], [1.0, 1.0]])
    return [_flat(every.min(axis=0)), _flat(every.max(axis=0))]


def _flat(points: Any) -> Any:
    """Rounded to millimetres, as lists."""
    return (np.round(np.asarray(points, dtype=np.float64), 3) + 0.0).tolist()
