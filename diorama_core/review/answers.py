"""Answers to questions about a scene, as edits of it: only what depends on an answer changes."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from diorama_core.editing.placing import seat
from diorama_core.editing.reconstructed import move_onto
from diorama_core.editing.support_changes import without_objects
from diorama_core.errors import EditRefused
from diorama_core.library.record import ShapeLibrary, record_of
from diorama_core.library.taxonomy import CATEGORIES
from diorama_core.review.questions import NO, SUBJECTS, TURNS, YES
from diorama_core.scene import edits
from diorama_core.scene.belief import Belief
from diorama_core.scene.room_edits import rescale_to_length
from diorama_core.scene.types import Candidate, Scene, SceneObject, Support, yaw_rotation


def apply_answer(scene: Scene, library: ShapeLibrary, question_id: str, value: str) -> Scene:
    """The scene after an answer, in which what was asked is certain.

    Args:
        scene: as it is.
        library: where shapes come from.
        question_id: of the question: `SUBJECT:OBJECT`.
        value: one of the question's choices; any category, any object or plane.

    Raises:
        EditRefused: the object is gone or locked, or the answer is none; says what can be answered.
    """
    subject, _, object_id = question_id.partition(":")
    if subject not in SUBJECTS or not scene.has_object(object_id):
        raise EditRefused(f"nothing is asked under {question_id!r} now; ask for the questions again")
    if subject == "presence":
        return _answer_presence(scene, library, object_id, value)
    if subject == "kind":
        return _answer_kind(scene, library, object_id, value)
    if subject == "front":
        return _answer_front(scene, object_id, value)
    if subject == "scale":
        return rescale_to_length(scene, *lengths(scene, object_id, value))
    return _answer_supporter(scene, library, object_id, value)


def lengths(scene: Scene, object_id: str, value: str) -> tuple[float, float]:
    """An object's height in the scene and the true one, in metres.

    Raises:
        EditRefused: the answer is no length.
    """
    words = value.strip().lower().removesuffix("m")
    try:
        return float(scene.object(object_id).size_m[2]), float(words)
    except ValueError:
        raise EditRefused(f"{value!r} is no length; answer with a height in metres, such as 2.03") from None


def _answer_presence(scene: Scene, library: ShapeLibrary, object_id: str, value: str) -> Scene:
    if value == NO:
        return without_objects(scene, library, (object_id,))[0]
    _need(value, (YES,), f"{YES} or {NO}")
    return _believe(scene, object_id, replace(_belief(scene, object_id), present=1.0))


def _answer_kind(scene: Scene, library: ShapeLibrary, object_id: str, kind: str) -> Scene:
    _need(kind, {c.name for c in CATEGORIES}, "a kind of object, such as armchair")
    item = scene.object(object_id)
    if record_of(library, item.shape_id).category != kind:
        scene = edits.swap(scene, object_id, candidate_of(library, item, kind), keep_pose=True)
        scene = seat(scene, library, object_id)
    named = replace(scene.object(object_id), category=kind, label=kind if item.category != kind else item.label)
    scene = replace(scene, objects=tuple(named if o.id == object_id else o for o in scene.objects))
    return _believe(scene, object_id, _belief(scene, object_id).with_kind(kind))


def candidate_of(library: ShapeLibrary, item: SceneObject, kind: str) -> Candidate:
    """The object's best candidate of a kind; else the kind's shape that is nearest to it in size, made as large.

    Raises:
        EditRefused: the library has no shape of that kind.
    """
    known = [c for c in item.candidates if record_of(library, c.shape_id).category == kind]
    if known:
        return max(known, key=lambda c: c.score)
    shapes = library.in_category(kind)
    if not shapes:
        raise EditRefused(f"the library has no {kind}; choose another kind")
    sizes = np.log(np.array([s.size_m for s in shapes]))
    shape = shapes[int(np.abs(sizes - np.log(item.size_m)).sum(axis=1).argmin())]
    scale = float(np.cbrt(np.prod(item.size_m / np.asarray(shape.size_m))))
    return Candidate(shape.id, shape.size_m, 0.0, replace(item.pose, scale=np.full(3, scale)))


def _answer_front(scene: Scene, object_id: str, turn: str) -> Scene:
    _need(turn, TURNS, ", ".join(TURNS[:-1]) + f" or {TURNS[-1]}")
    pose, quarters = scene.object(object_id).pose, TURNS.index(turn)
    if quarters:
        R = yaw_rotation(quarters * np.pi / 2) @ pose.R_world_object
        scene = edits.move(scene, object_id, replace(pose, R_world_object=R))
    return _believe(scene, object_id, _belief(scene, object_id).with_front())


def _answer_supporter(scene: Scene, library: ShapeLibrary, object_id: str, parent_id: str) -> Scene:
    if not scene.has_object(parent_id) and not scene.has_plane(parent_id):
        raise EditRefused(f"the scene has no {parent_id!r}; answer with the id of an object, a wall, floor or ceiling")
    edge = scene.support_of(object_id)
    if edge is None or edge.parent != parent_id:
        hung = scene.has_plane(parent_id) and scene.plane(parent_id).role != "floor"
        new = Support(object_id, parent_id, "mounted on" if hung else "placed on")
        onto = move_onto(scene, object_id, parent_id, library) if scene.has_object(parent_id) else None
        scene = seat(edits.attach(scene, new), library, object_id) if onto is None else onto
    return _believe(scene, object_id, _belief(scene, object_id).with_supporter(parent_id))


def _belief(scene: Scene, object_id: str) -> Belief:
    return scene.object(object_id).belief or Belief()


def _believe(scene: Scene, object_id: str, belief: Belief) -> Scene:
    objects = tuple(replace(o, belief=belief) if o.id == object_id else o for o in scene.objects)
    return replace(scene, objects=objects)


def _need(value: str, known: Collection[str], words: str) -> None:
    if value not in known:
        raise EditRefused(f"{value!r} is no answer; answer {words}")
