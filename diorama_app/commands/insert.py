"""Insertion of library shapes: at the centre of the view, or where the user clicks."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_app.session.client import Client, Placing
from diorama_core.editing.placing import Hit, Place, facing, fits, free_spot, hits_along, insertion, places_of
from diorama_core.errors import EditRefused
from diorama_core.layout.problem.supports import Surface
from diorama_core.library.taxonomy import resolve
from diorama_core.scene import edits
from diorama_core.scene.types import Pose, SceneObject, Support


def insert_shape(client: Client, shape_id: str) -> None:
    """Insert a shape on the selected object, or else on the floor at the centre of the view."""
    session = client.session
    shape, scene, parent = session.library.shape(shape_id), session.scene, client.selected
    mount = resolve(shape.category).category.mount
    if parent is not None and session.library.shape(parent.shape_id).surfaces and mount in ("surface", "floor"):
        base = parent.pose.position + parent.pose.R_world_object[:, 2] * parent.size_m[2] / 2
        edge_parent: str | None = parent.id
        yaw = parent.pose.yaw_rad
    else:
        floor = scene.architecture.floor
        height = 0.0 if floor is None else float(floor.offset / max(floor.normal[2], 1e-6))
        x, y = free_spot(scene, shape, client.view.camera.target_point)
        base, edge_parent, yaw = np.array([x, y, height]), None if floor is None else floor.id, facing(scene, x, y)
    new_id = edits.fresh_id(scene, shape.category)
    position = base + np.array([0.0, 0.0, shape.size_m[2] / 2])
    item = SceneObject(new_id, shape.category, shape.category, shape.id, shape.size_m, Pose.upright(position, yaw))
    edge = None if edge_parent is None else Support(new_id, edge_parent)
    session.edit(f"insert {shape.category}", lambda s: edits.insert(s, item, edge), by=client, selection=(new_id,))


def start_placing(client: Client, shape_id: str) -> None:
    """The next click in the view puts this shape there."""
    client.session.library.shape(shape_id)
    client.doing = Placing(shape_id)
    client.refresh()


def place_at(client: Client, shape_id: str, origin: Float[np.ndarray, "3"], direction: Float[np.ndarray, "3"]) -> None:
    """Put a shape where a ray from the eye meets a surface it can stand on or hang at."""
    session = client.session
    shape, scene = session.library.shape(shape_id), session.scene
    hung = resolve(shape.category).category.mount in ("wall", "ceiling")
    places = places_of(scene, session.library)
    size = np.asarray(shape.size_m)
    usable = [h for h in hits_along(origin, direction, places) if fits(h.place, size, h.point, np.eye(3))]
    # A plant clicked onto a wall is not meant to hang there, a picture clicked onto the floor may well stand.
    found = next((h for h in usable if h.place.upward or hung), None) or _on_ground(origin, direction)
    if found is None:
        raise EditRefused("nothing there can support it; click the floor, a table or a wall")
    client.doing = None
    new_id = edits.fresh_id(scene, shape.category)
    yaw = facing(scene, float(found.point[0]), float(found.point[1]))
    item, edge = insertion(scene, shape, new_id, found, yaw)
    known = scene.has_object(edge.parent) or scene.has_plane(edge.parent)
    session.edit(
        f"insert {shape.category}",
        lambda s: edits.insert(s, item, edge if known else None),
        by=client,
        selection=(new_id,),
    )


def _on_ground(origin: np.ndarray, direction: np.ndarray) -> Hit | None:
    """Where there is no floor yet: level ground at height 0."""
    big = 50.0
    outline = np.array([[-big, -big, 0.0], [big, -big, 0.0], [big, big, 0.0], [-big, big, 0.0]])
    ground = Place(Surface.of(outline, np.array([0.0, 0.0, 1.0]), float("inf"), of_plane=True), "", of_object=False)
    return next(iter(hits_along(origin, direction, [ground])), None)
