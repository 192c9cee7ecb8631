"""Edits of how things look: other shapes, materials and colours, of objects and of the room."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from diorama_core.editing.positioning import Positioner
from diorama_core.errors import EditRefused
from diorama_core.library.labels import with_article
from diorama_core.library.language import size_request
from diorama_core.library.record import Shape, ShapeLibrary, record_of
from diorama_core.scene import edits
from diorama_core.scene.types import Candidate, Pose, Scene, SceneObject
from diorama_core.text.edit_places import free
from diorama_core.text.edit_plan import Done, Restyle, Swap, names_of
from diorama_core.text.looks import fitting_shapes, has_look, is_made_of, look_of, nearest_in_size, scale_into
from diorama_core.text.phrases import noun_phrase

SHAPES_COMPARED = 32
"""Shapes, of those that fit the words equally well, of which the nearest in size is taken."""


def restyle(positioner: Positioner, scene: Scene, edit: Restyle) -> Done:
    """Objects in a colour, or of a material: shapes that are made of it, or paint."""
    ids, words = edit.objects, edit.look
    look = look_of(words)
    if look is None:
        raise EditRefused(f"“{words}” is no colour or material known here; try light blue, sage, oak, leather")
    after, lines, notes, ids_left = scene, [], [], ids
    if look.material:
        after, by_shape, already = _change_material(positioner.library, scene, ids, look.material)
        lines += [f"{names_of(scene, members)}: {caption}" for caption, members in by_shape.items()]
        if already:
            notes.append(f"{names_of(scene, already)} {'is' if len(already) == 1 else 'are'} {words} already")
        changed = {i for members in by_shape.values() for i in members} | set(already)
        ids_left = [i for i in ids if i not in changed]
    for object_id in ids_left:
        after = edits.recolour(after, object_id, look.colour)
        if look.finish is not None:
            after = edits.refinish(after, object_id, look.finish)
    if ids_left:
        lines.append(f"paint {names_of(scene, ids_left)} {look.words}")
    if not lines:
        raise EditRefused(notes[0] if notes else "nothing would change")
    return Done(after, tuple(lines), tuple(ids), tuple(notes))


def _change_material(
    library: ShapeLibrary, scene: Scene, ids: Sequence[str], material: str
) -> tuple[Scene, Mapping[str, list[str]], list[str]]:
    """Swap objects for shapes of a material; gives which shape each became, and which were of it already."""
    after = scene
    by_shape: dict[str, list[str]] = {}
    already: list[str] = []
    for object_id in ids:
        item = scene.object(object_id)
        if is_made_of(record_of(library, item.shape_id), material) and item.colour is None:
            already.append(object_id)
            continue
        options = [s for s in library.in_category(item.category) if is_made_of(s, material) and s.id != item.shape_id]
        if not options:
            continue
        shape = nearest_in_size(options, item.size_m)
        after = _with_shape(after, item, shape)
        by_shape.setdefault(f"swap for {with_article(shape.caption or shape.id)}", []).append(object_id)
    return after, by_shape, already


def swap(positioner: Positioner, scene: Scene, edit: Swap) -> Done:
    """Other shapes in the place of objects: of the same kind where the words name none."""
    ids, first = edit.objects, scene.object(edit.objects[0])
    phrase, _ = noun_phrase(edit.what)
    appearance = tuple(edit.what.split()) if phrase is None else phrase.appearance
    named = phrase is not None and phrase.label
    kind, label = (phrase.category, phrase.label) if phrase is not None and named else (first.category,) * 2
    present = {scene.object(i).shape_id for i in ids}
    shapes, lacking = fitting_shapes(positioner.library, kind, label, appearance, lambda s: s.id not in present)
    if not shapes:
        raise EditRefused(f"the library has no other {label}")
    equal = [s for s in shapes if _count_missing(s, appearance) <= len(lacking)][:SHAPES_COMPARED]
    after, notes = scene, []
    like = nearest_in_size(equal, first.size_m) if appearance or kind == first.category else equal[0]
    for object_id in ids:
        item = scene.object(object_id)
        change = _with_shape if kind == item.category else _replace
        after = change(after, item, like)
        after, note = free(positioner, after, object_id)
        notes += note
    after, paint = looking_like(after, ids, lacking)
    line = f"swap {names_of(scene, ids)} for {with_article(like.caption or like.id)}"
    return Done(after, (line,), tuple(ids), (*notes, *paint))


def _with_shape(scene: Scene, item: SceneObject, shape: Shape) -> Scene:
    """Another shape in an object's place and about its size, in the shape's own colours."""
    pose = replace(item.pose, scale=np.array(scale_into(shape, item.size_m)))
    after = edits.swap(scene, item.id, Candidate(shape.id, shape.size_m, 0.0, pose), keep_pose=True)
    if item.photo_materials:
        after = edits.set_material_source(after, item.id, "library")
    return _as_library_has_it(after, item, shape)


def _replace(scene: Scene, item: SceneObject, shape: Shape) -> Scene:
    """An object of another kind in its own size, at the same place and heading."""
    up = item.pose.R_world_object[:, 2]
    base = item.pose.position - up * item.size_m[2] / 2
    pose = Pose(item.pose.R_world_object, base + up * shape.size_m[2] / 2, np.ones(3))
    after = edits.swap(scene, item.id, Candidate(shape.id, shape.size_m, 0.0, pose), keep_pose=False)
    return _as_library_has_it(after, item, shape)


def _as_library_has_it(scene: Scene, item: SceneObject, shape: Shape) -> Scene:
    """An object in its new shape's own colours, called what that is."""
    kind = shape.category
    scene = edits.refinish(edits.recolour(scene, item.id, None), item.id, None)
    if kind == item.category:
        return scene
    label = item.label.replace(item.category, kind) if item.category in item.label else kind
    new = replace(scene.object(item.id), category=kind, label=label)
    return replace(scene, objects=tuple(new if o.id == item.id else o for o in scene.objects))


def looking_like(scene: Scene, ids: Sequence[str], lacking: Sequence[str]) -> tuple[Scene, tuple[str, ...]]:
    """Colours and materials that no shape has are painted; what cannot be is named."""
    notes = []
    for word in lacking:
        look = look_of(word)
        if look is None:
            notes.append(f"the library has none that is {word}")
            continue
        for object_id in ids:
            scene = edits.refinish(edits.recolour(scene, object_id, look.colour), object_id, look.finish)
        notes.append(f"the library has none that is {word}: painted")
    return scene, tuple(notes)


def _count_missing(shape: Shape, appearance: Sequence[str]) -> int:
    return sum(size_request(w) is None and not has_look(shape, w) for w in appearance)
