"""Edits that add objects: which shape of the library the words mean, and where it goes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from diorama_core.editing.positioning import Positioner, new_object
from diorama_core.editing.relations import SEATS, Relation
from diorama_core.errors import EditRefused
from diorama_core.library.labels import with_article
from diorama_core.library.record import Shape, ShapeLibrary, record_of
from diorama_core.library.taxonomy import CATEGORIES, broad, category, having, with_kin
from diorama_core.scene.types import Scene, SceneObject
from diorama_core.text.edit_looks import looking_like
from diorama_core.text.edit_places import lift_onto, relations_of, unmet_notes
from diorama_core.text.edit_plan import Done, Insert
from diorama_core.text.looks import fitting_shapes
from diorama_core.text.phrases import NUMBERS, NounPhrase, noun_phrase
from diorama_core.text.prompt import RequestedObject
from diorama_core.text.requested_relations import usual_relations

SHAPES_TRIED = 8
RUG_MARGIN_M = 0.25
"""How far a rug reaches beyond what stands on it, on each side."""
TALL_M = 0.6
"""Plants of at least this height stand on the floor."""


def insert(positioner: Positioner, scene: Scene, edit: Insert) -> Done:
    """New objects of the library at the best free places where relations hold."""
    relations = relations_of(scene, edit.places)
    phrase, unknown = noun_phrase(edit.what)
    if phrase is None or not phrase.label:
        raise EditRefused(f"the library has nothing called “{unknown or edit.what}”; try another word")
    targets = [scene.object(t) for r in relations for t in r.targets]
    new: list[str] = []
    lacking: tuple[str, ...] = ()
    after = scene
    shape: Shape | None = None
    missed: list[str] = []
    for copy in range(edit.count):
        if shape is not None and copy * _pieces(shape) >= edit.count:
            break  # "curtains" are one pair
        options, lacking = _options(positioner.library, phrase, relations, targets)
        if phrase.category in SEATS and not phrase.appearance:
            present = dict.fromkeys(o.shape_id for o in scene.objects if o.category == phrase.category)
            options = (*(record_of(positioner.library, i) for i in present), *options)  # seats are of a set
        if not options:
            raise EditRefused(f"the library has no {phrase.label}")
        tried = (shape, *(s for s in options if s != shape)) if shape is not None else options
        on = any(r.kind == "on" for r in relations)
        kin = () if on else _standing_kin(positioner.library, phrase.category)
        choice, object_id, put = after, None, None
        for shapes in (tried[:SHAPES_TRIED], kin[:SHAPES_TRIED]):
            if object_id is not None and not _is_on_floor(choice, object_id):
                break
            kind = shapes[0].category if shapes else phrase.category
            other = _with_one(positioner, after, kind, shapes, relations, targets, copy, edit.count)
            choice, object_id, put = other if other[1] is not None else (choice, object_id, put)
        after, shape = choice, put
        if shape is not None and shape.category not in (phrase.category, *(s.category for s in options)):
            missed.append(f"nothing there carries {with_article(phrase.category)}: {with_article(shape.category)}")
        if object_id is None or shape is None:
            where = f" {relations[0].words(scene)}" if relations else ""
            done = f"; {copy} of {edit.count} would fit" if copy else ""
            raise EditRefused(f"there is no free place for {with_article(phrase.category)}{where}{done}")
        new.append(object_id)
        if category(shape.category).mount == "surface" and not on and _is_on_floor(after, object_id):
            missed.append(f"{after.object(object_id).label} stands on the floor; nothing there carries it")
        missed += unmet_notes(after, object_id, relations)
    assert shape is not None
    after, note = looking_like(after, new, lacking)
    where = "".join(f" {r.words(scene)}" for r in relations)
    what = f"{len(new)} x {phrase.category}" if len(new) > 1 else with_article(phrase.category)
    return Done(after, (f"add {what} ({shape.caption or shape.id}){where}",), tuple(new), (*note, *missed))


def _pieces(shape: Shape) -> int:
    """How many of its kind a shape is: "pair of linen curtains" is two."""
    return NUMBERS.get(shape.caption.partition(" ")[0].lower(), 1)


def _is_on_floor(scene: Scene, object_id: str) -> bool:
    """True for an object on the floor or on a rug there."""
    edge = scene.support_of(object_id)
    return edge is None or scene.has_plane(edge.parent) or broad(scene.object(edge.parent).category) == "rug"


def _standing_kin(library: ShapeLibrary, kind: str) -> tuple[Shape, ...]:
    """Shapes of kindred categories that stand on the floor, for what finds no place on furniture; the usual first."""
    if category(kind).mount != "surface":
        return ()
    names = with_kin(kind) | {c.name for c in CATEGORIES if c.name.split()[-1] == kind}  # a floor lamp is a lamp
    kin = sorted(k for k in names if k != kind and category(k).mount == "floor")
    return tuple(s for k in kin for s in library.in_category(k))


def _options(
    library: ShapeLibrary,
    phrase: NounPhrase,
    relations: Sequence[Relation],
    targets: Sequence[SceneObject],
) -> tuple[tuple[Shape, ...], tuple[str, ...]]:
    """Shapes for a new object, the best first, as far as their size fits where they go."""
    kind, label, appearance = phrase.category, phrase.label, phrase.appearance
    on = any(r.kind == "on" for r in relations)

    def usable(shape: Shape) -> bool:
        if kind == "plant" and not on and label in ("plant", "plants"):
            return TALL_M < shape.size_m[2] < 2.0
        if kind == "television" and not on:
            return True
        return shape.size_m[2] < 2.4

    shapes, lacking = fitting_shapes(library, kind, label, appearance, usable)
    shapes, lacking = (shapes, lacking) if shapes else fitting_shapes(library, kind, label, appearance)
    if kind in having("rug") and targets and any(r.kind in ("under", "around") for r in relations):
        need = np.sort(np.ptp(np.concatenate([t.corners_world[:, :2] for t in targets]), axis=0)) + 2 * RUG_MARGIN_M
        wide = tuple(s for s in shapes if (np.sort(s.size_m[:2]) >= need - 0.1).all())
        shapes = wide or tuple(sorted(shapes, key=lambda s: -float(np.prod(s.size_m[:2]))))
    return shapes, lacking


def _with_one(
    positioner: Positioner,
    scene: Scene,
    kind: str,
    shapes: Sequence[Shape],
    relations: Sequence[Relation],
    targets: Sequence[SceneObject],
    copy: int,
    count: int,
) -> tuple[Scene, str | None, Shape | None]:
    """The first shape that finds a free place; of several targets "beside", each gets its share."""
    candidates = list(relations)
    if count > 1 or len(targets) > 1:
        candidates = [
            replace(r, targets=(r.targets[copy % len(r.targets)],))
            if r.kind in ("beside", "on", "near", "above", "in front of") and len(r.targets) > 1
            else r
            for r in candidates
        ]
    for shape in shapes:
        item = new_object(scene, shape, kind)
        # Where nothing is said, it stands as such things do: a chair at the table.
        usual = [] if candidates else usual_relations(scene, RequestedObject(kind, kind), copy)
        spot = positioner.best(scene, item, candidates, usual=usual)
        if spot is not None:
            return lift_onto(positioner.put(scene, item, spot), item.id), item.id, shape
    return scene, None, None
