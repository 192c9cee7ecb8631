"""Looks: materials swap shapes, colours paint, swaps keep the place."""

from __future__ import annotations

from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import record_of
from diorama_core.scene.types import Scene
from diorama_core.text.edit_looks import looking_like
from diorama_core.text.edit_plan import Paint, Restyle, Swap
from diorama_core.text.looks import is_made_of
from tests.text.edited import assert_sound, done


def test_materials_swap_shapes_and_colours_paint(dining: Scene) -> None:
    library = built_in_library()
    chairs = [o.id for o in dining.objects if o.category == "chair"]
    wooden = done(dining, Restyle(objects=chairs, look="wooden"))
    assert all(is_made_of(record_of(library, wooden.object(i).shape_id), "wood") for i in chairs)
    assert_sound(dining, wooden)
    red = done(dining, Restyle(objects=chairs, look="red"))
    assert all(red.object(i).colour is not None for i in chairs)
    painted = done(dining, Paint(part="walls", colour="light blue"))
    assert {p.texture for p in painted.architecture.by_role("wall")} == {None}


def test_swapped_objects_fit_the_words_and_their_place(living: Scene) -> None:
    swapped = done(living, Swap(objects=["sofa_1"], what="leather sofa"))
    assert "leather" in record_of(built_in_library(), swapped.object("sofa_1").shape_id).caption
    assert_sound(living, swapped)
    other = done(living, Swap(objects=["plant_1"], what="floor lamp"))
    assert other.object("plant_1").category == "floor lamp"
    assert other.object("plant_1").label.startswith("floor lamp")
    assert_sound(living, other)


def test_a_colour_that_no_shape_has_is_painted_and_said(living: Scene) -> None:
    after, notes = looking_like(living, ["sofa_1"], ["purple"])
    assert after.object("sofa_1").colour is not None
    assert notes == ("the library has none that is purple: painted",)
    same, notes = looking_like(living, ["sofa_1"], ["zorkmid"])
    assert same is living
    assert notes == ("the library has none that is zorkmid",)
