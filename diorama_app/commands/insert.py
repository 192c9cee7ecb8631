"""Insertion of library shapes: at the centre of the view, or where the user clicks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_app.session.client import Client, Placing
from diorama_app.strings import _
from diorama_core.arrangement.surfaces import RestingSurface
from diorama_core.editing.clearances import clear_of_walls
from diorama_core.editing.opening_insertion import with_opening
from diorama_core.editing.placing import (
    Hit,
    SupportTarget,
    facing,
    fits,
    free_spot,
    hits_along,
    insertion,
    places_of,
    seat,
    spot_in_view,
)
from diorama_core.editing.relations import SEATS
from diorama_core.editing.support_changes import why_not_on
from diorama_core.errors import EditRefused
from diorama_core.library.record import Shape
from diorama_core.library.taxonomy import broad, resolve
from diorama_core.scene import edits
from diorama_core.scene.room_edits import floor_height
from diorama_core.scene.types import Pose, Scene, SceneObject, Support

MAX_RECENT = 24
MAX_FAVOURITES = 200
SMALL_SHARE, SMALL_HEIGHT_M = 0.25, 0.7
"""What usually stands on the floor and is no larger may stand on furniture: share of its footprint, and height."""


def toggle_favourite(client: Client, shape_id: str) -> None:
    """Mark a shape of the library, or take the mark off."""
    client.session.library.shape(shape_id)
    before = client.preferences.favourites
    rest = tuple(i for i in before if i != shape_id)
    client.change_preferences(favourites=rest if shape_id in before else (shape_id, *rest)[:MAX_FAVOURITES])


def _insert(client: Client, shape: Shape, new_id: str, change: Callable[[Scene], Scene]) -> None:
    """Insert a shape as one undo step, select it and remember it."""
    client.session.edit(_inserting(shape.category), change, by=client, selection=(new_id,))
    rest = (i for i in client.preferences.recent if i != shape.id)
    client.change_preferences(recent=(shape.id, *rest)[:MAX_RECENT])


def insert_shape(client: Client, shape_id: str) -> None:
    """Insert a shape on the selected object where such things stand on it, or else on the floor in view."""
    session = client.session
    shape, scene, parent = session.library.shape(shape_id), session.scene, client.last_selected
    mount = resolve(shape.category).category.mount
    if mount in ("wall", "ceiling") and _hang_in_view(client, shape_id):
        return
    new_id = edits.fresh_id(scene, shape.category)
    if parent is not None:
        on_it = _insert_on(client, shape, new_id, parent)
        if on_it is not None:
            _insert(client, shape, new_id, lambda scene: on_it)
            return
    room = client.room()
    floor, height = room.architecture.floor, floor_height(room)
    x, y = free_spot(room, shape, client.view.camera.target_point)
    pose = Pose.upright((x, y, height + shape.size_m[2] / 2), facing(scene, x, y))
    item = SceneObject(new_id, shape.category, shape.category, shape.id, shape.size_m, pose)
    edge = None if floor is None else Support(new_id, floor.id)
    _insert(client, shape, new_id, lambda s: edits.insert(s, item, edge))


def _insert_on(client: Client, shape: Shape, new_id: str, parent: SceneObject) -> Scene | None:
    """The scene with the shape on an object; None where such things do not stand on such an object."""
    session, category = client.session, resolve(shape.category).category
    if not session.library.shape(parent.shape_id).surfaces:
        return None
    size = shape.size_m
    small = size[0] * size[1] <= SMALL_SHARE * parent.size_m[0] * parent.size_m[1] and size[2] <= SMALL_HEIGHT_M
    if category.mount != "surface" and not (category.mount == "floor" and small):
        return None
    if (parent.category in SEATS or broad(parent.category) == "bed") and not category.soft:
        return None
    top = parent.pose.position + parent.pose.R_world_object[:, 2] * parent.size_m[2] / 2
    pose = Pose.upright(top + np.array([0.0, 0.0, size[2] / 2]), parent.pose.yaw_rad)
    item = SceneObject(new_id, shape.category, shape.category, shape.id, size, pose)
    put = edits.insert(session.scene, item, Support(new_id, parent.id))
    return None if why_not_on(put, new_id, parent.id) else seat(put, session.library, new_id)


def _hang_in_view(client: Client, shape_id: str) -> bool:
    """Hang a shape where the view meets a wall or the ceiling; False in a room without."""
    session, camera = client.session, client.view.camera
    shape, scene = session.library.shape(shape_id), client.room()
    on_ceiling = resolve(shape.category).category.mount == "ceiling"
    hit = spot_in_view(scene, shape, camera.position, camera.target_point - camera.position, on_ceiling=on_ceiling)
    if hit is None:
        return False
    new_id = edits.fresh_id(session.scene, shape.category)
    item, edge = insertion(scene, shape, new_id, hit, 0.0)
    _insert(client, shape, new_id, lambda s: edits.insert(s, item, edge))
    return True


def put_opening(client: Client, category: str, wall_id: str, at: Float[np.ndarray, 2]) -> None:
    """Put the most usual door or window into a wall, where it is nearest to a point of the floor (world x and y).

    Args:
        client: the browser that asked.
        category: door or window.
        wall_id: of the wall.
        at: point of the floor, world x and y, metres.

    Raises:
        EditRefused: see `with_opening`.
    """
    session = client.session
    after, new_id = with_opening(session.scene, session.offer, category, wall_id, at)
    session.edit(_inserting(category), lambda scene: after, by=client, selection=(new_id,))


def start_placing(client: Client, shape_id: str) -> None:
    """The next click in the view puts this shape there."""
    client.session.library.shape(shape_id)
    client.doing = Placing(shape_id)
    client.refresh()


def stop_placing(client: Client) -> None:
    """Place nothing after all."""
    if isinstance(client.doing, Placing):
        client.doing = None
        client.refresh()


def place_at(client: Client, shape_id: str, origin: Float[np.ndarray, 3], direction: Float[np.ndarray, 3]) -> None:
    """Put a shape where a ray from the eye meets a surface it can stand on or hang at.

    Args:
        client: the browser that asked.
        shape_id: of the library.
        origin: of the ray, world, metres.
        direction: of the ray.
    """
    session = client.session
    shape, scene = session.library.shape(shape_id), session.scene
    hung = resolve(shape.category).category.mount in ("wall", "ceiling")
    places = places_of(scene, session.library)
    size = np.asarray(shape.size_m)
    usable = [h for h in hits_along(origin, direction, places) if fits(h.place, size, h.point, np.eye(3))]
    # A plant clicked onto a wall is not meant to hang there, a picture clicked onto the floor may well stand.
    hit = next((h for h in usable if h.place.upward or hung), None) or _ground_hit(origin, direction)
    if hit is None:
        raise EditRefused("nothing there can support it; click the floor, a table or a wall")
    client.doing = None
    new_id = edits.fresh_id(scene, shape.category)
    yaw = facing(scene, float(hit.point[0]), float(hit.point[1]))
    item, edge = insertion(scene, shape, new_id, hit, yaw)
    item = replace(item, pose=clear_of_walls(scene, item), by_hand=True)
    known = scene.has_object(edge.parent) or scene.has_plane(edge.parent)
    _insert(client, shape, new_id, lambda s: edits.insert(s, item, edge if known else None))


def _ground_hit(origin: np.ndarray, direction: np.ndarray) -> Hit | None:
    """Hit on level ground at height 0, where there is no floor yet."""
    big = 50.0
    outline = np.array([[-big, -big, 0.0], [big, -big, 0.0], [big, big, 0.0], [-big, big, 0.0]])
    ground = SupportTarget(
        RestingSurface.of(outline, np.array([0.0, 0.0, 1.0]), float("inf"), of_plane=True), "", of_object=False
    )
    return next(iter(hits_along(origin, direction, [ground])), None)


def _inserting(category: str) -> str:
    return _("insert {kind}").format(kind=_(category))
