"""Swaps of an object's shape in place; the user's preferences decide its size and colour."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_app.commands.edit import names_of
from diorama_app.session.client import Client
from diorama_app.session.preferences import SizeMode
from diorama_app.strings import _
from diorama_core.errors import EditRefused
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.scene import edits
from diorama_core.scene.types import Candidate, Scene, SceneObject

SIZE_MODES: tuple[SizeMode, ...] = ("as found", "same box", "in proportion", "catalogue")


def candidate_for(library: ShapeLibrary, item: SceneObject, shape_id: str, mode: SizeMode) -> Candidate:
    """A shape as an alternative of an object.

    Sizes: "as found" is what the photo says of this alternative (in proportion where the photo said nothing), "same
    box" stretches it to the object's box, "in proportion" scales it evenly into that box, "catalogue" leaves it.

    Args:
        library: where shapes come from.
        item: the object.
        shape_id: of the library.
        mode: which size it gets.
    """
    known = next((c for c in item.candidates if c.shape_id == shape_id), None)
    if known is not None and mode == "as found":
        return known
    shape: Shape = library.shape(shape_id)
    size_m = np.asarray(shape.size_m)
    if mode == "catalogue":
        scale = np.ones(3)
    elif mode == "same box":
        scale = item.size_m / size_m
    else:
        scale = np.full(3, _even_scale(item.size_m, size_m))
    score = known.score if known is not None else 0.0
    return Candidate(shape.id, shape.size_m, score, replace(item.pose, scale=scale))


def swap_shape(scene: Scene, item: SceneObject, candidate: Candidate, *, keep_colour: bool) -> Scene:
    """The scene with an object's shape replaced, at the same position.

    Args:
        scene: as it is.
        item: the object.
        candidate: the other shape, with its size and pose.
        keep_colour: whether the new shape is painted as the old one.
    """
    changed = edits.swap(scene, item.id, candidate, keep_pose=True)
    if keep_colour:
        return changed
    if item.photo_materials:
        changed = edits.set_material_source(changed, item.id, "library")
    return edits.refinish(edits.recolour(changed, item.id, None), item.id, None)


def swap(client: Client, object_id: str, shape_id: str) -> None:
    """Swap an object (or all with the same shape) according to the client's preferences."""
    session, preferences = client.session, client.preferences
    item = session.scene.object(object_id)
    if shape_id == item.shape_id:
        client.refresh()
        return
    targets = alike(session.scene, item) if preferences.all_alike else (item,)

    def take(scene: Scene) -> Scene:
        for one in targets:
            candidate = candidate_for(session.library, one, shape_id, preferences.size_mode)
            scene = swap_shape(scene, one, candidate, keep_colour=preferences.keep_colour)
        return scene

    session.edit(_("swap {names}").format(names=names_of(session.scene, [t.id for t in targets])), take, by=client)


def preview_swap(client: Client, object_id: str, shape_id: str) -> None:
    """Preview an object with another shape without changing the document."""
    session = client.session
    if not session.scene.has_object(object_id):
        return
    item = session.scene.object(object_id)
    if item.locked or session.jobs.status is not None:
        return
    candidate = candidate_for(session.library, item, shape_id, client.preferences.size_mode)
    shown = swap_shape(session.scene, item, candidate, keep_colour=client.preferences.keep_colour)
    session.viewport.preview_item(shown.object(object_id))


def alike(scene: Scene, item: SceneObject) -> tuple[SceneObject, ...]:
    """Every unlocked object of the same shape, the given one first."""
    others = tuple(o for o in scene.objects if o.shape_id == item.shape_id and o.id != item.id and not o.locked)
    return (item, *others)


def next_alternative(client: Client, step: int) -> None:
    """Swap to the next (or previous) of the object's ranked candidates."""
    item = client.session.scene.object(client.need_selected())
    shapes = list(dict.fromkeys(c.shape_id for c in item.candidates))
    if len(shapes) < 2:
        raise EditRefused(_("{label} has no alternatives; search the library for others").format(label=item.label))
    at = shapes.index(item.shape_id) if item.shape_id in shapes else -1
    swap(client, item.id, shapes[(at + step) % len(shapes)])


def _even_scale(box: np.ndarray, size_m: np.ndarray) -> float:
    """The scale that keeps the volume's cube root, so that a swap neither grows nor shrinks what is there."""
    return float(np.cbrt(np.prod(box / size_m)))
