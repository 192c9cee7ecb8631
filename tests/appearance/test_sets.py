from __future__ import annotations

from diorama_core.appearance.sets import leaders, share_materials
from diorama_core.scene.types import PhotoMaterial

BLUE, PALE_BLUE, RED = (0.1, 0.2, 0.6), (0.15, 0.26, 0.66), (0.7, 0.1, 0.1)


def _slot(name: str, colour: tuple[float, float, float], *, main: bool = False) -> PhotoMaterial:
    return PhotoMaterial(slot=name, colour=colour, main=main)


def test_who_is_seen_best_speaks_for_its_like() -> None:
    sure = {"a": (10.0, "a"), "b": (20.0, "b"), "c": (15.0, "c"), "d": (1.0, "d")}
    colours = {"a": PALE_BLUE, "b": BLUE, "c": RED, "d": RED}
    follows = leaders("abcde", colours, {**sure, "e": (0.0, "e")})
    assert follows == {"a": "b", "b": "b", "c": "c", "d": "c", "e": "b"}


def test_without_a_colour_nobody_speaks() -> None:
    assert leaders("ab", {}, {"a": (1.0, "a"), "b": (2.0, "b")}) == {}


def test_each_slot_is_as_the_member_shows_it_that_sees_it_best() -> None:
    near = (_slot("fabric", BLUE, main=True),)
    far = (_slot("fabric", PALE_BLUE, main=True), _slot("metal", (0.9, 0.9, 0.9)))
    seen = {("near", "fabric"): 900.0, ("far", "fabric"): 300.0, ("far", "metal"): 80.0}
    shared = share_materials({"near": near, "far": far, "hidden": ()}, [["near", "far", "hidden"]], seen)
    assert shared["near"] == shared["far"] == shared["hidden"] == (near[0], far[1])


def test_members_of_other_colours_and_things_of_no_set_keep_what_they_show() -> None:
    materials = {
        "a": (_slot("fabric", BLUE, main=True), _slot("metal", (0.9, 0.9, 0.9))),
        "b": (_slot("fabric", RED, main=True), _slot("metal", (0.1, 0.1, 0.1))),
        "c": (_slot("wood", (0.5, 0.3, 0.2), main=True),),
    }
    seen = {(i, m.slot): 500.0 for i, of_one in materials.items() for m in of_one}
    assert share_materials(materials, [["a", "b"]], seen) == materials


def test_faces_that_show_their_own_picture_stay_with_their_object() -> None:
    label = PhotoMaterial(slot="paper", colour=RED, texture="label-1", layout="front")
    materials = {"a": (label, _slot("glass", BLUE, main=True)), "b": (_slot("glass", PALE_BLUE, main=True),)}
    shared = share_materials(materials, [["a", "b"]], {("a", "glass"): 50.0, ("b", "glass"): 90.0})
    assert shared == {"a": (label, materials["b"][0]), "b": materials["b"]}
