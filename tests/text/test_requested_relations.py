"""Wishes in a scene: what they name is found there, and placed before them."""

from __future__ import annotations

from diorama_core.editing.relations import Relation
from diorama_core.scene.types import Scene
from diorama_core.text.prompt import RequestedObject, Wish
from diorama_core.text.requested_relations import placement_order, targets_of, usual_relations
from tests.editing.objects import item

SCENE = Scene(
    objects=(
        item("sofa", (0.9, 2.0, 0.8), 0.0, 0.0),
        item("coffee table", (0.6, 1.0, 0.4), 1.2, 0.0),
        item("desk", (0.6, 1.2, 0.75), 3.0, 0.0),
    )
)


def order(*wanted: RequestedObject) -> list[str]:
    return [wanted[k].category for k in placement_order(wanted)]


def test_what_others_refer_to_comes_first_and_the_floor_before_walls_and_tables() -> None:
    lamp = RequestedObject("lamp", "lamp", wishes=(Wish("on", ("night stand",)),))
    stand = RequestedObject("night stand", "night stand", 2, wishes=(Wish("beside", ("bed",)),))
    picture, bed = RequestedObject("picture", "picture"), RequestedObject("bed", "bed")
    assert order(lamp, picture, stand, bed) == ["bed", "night stand", "picture", "lamp"]


def test_circles_of_wishes_have_an_order_too() -> None:
    sofa = RequestedObject("sofa", "sofa", wishes=(Wish("opposite", ("piano",)),))
    piano = RequestedObject("piano", "piano", wishes=(Wish("opposite", ("sofa",)),))
    assert sorted(order(sofa, piano)) == ["piano", "sofa"]


def test_copies_share_what_they_name_and_what_is_absent_is_nothing() -> None:
    assert targets_of(SCENE, Wish("beside", ("sofa",)), 3) == ("sofa",)
    assert targets_of(SCENE, Wish("between", ("sofa", "desk")), 0) == ("sofa", "desk")
    assert targets_of(SCENE, Wish("beside", ("piano",)), 0) == ()


def test_what_is_usual_yields_to_what_is_said() -> None:
    plain = usual_relations(SCENE, RequestedObject("coffee table", "coffee table"), 0)
    assert plain == [Relation("in front of", ("sofa",))]
    in_corner = RequestedObject("side table", "side table", wishes=(Wish("in corner"),))
    assert usual_relations(SCENE, in_corner, 0) == []
    seat = RequestedObject("armchair", "armchair", wishes=(Wish("in front of", ("sofa",)),))
    assert Relation("facing", ("sofa",)) in usual_relations(SCENE, seat, 0)
