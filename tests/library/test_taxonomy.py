"""What company kinds keep."""

from __future__ import annotations

from diorama_core.library.taxonomy import (
    CARRIED_KINDS,
    CARRIES_AS,
    CATEGORIES,
    ROOMS,
    carrier_in,
    category,
    column,
    often_carried,
    usual_carriers,
)


def test_carriers_are_loaded_as_kinds_that_things_lie_on() -> None:
    assert all(CARRIES_AS[like] == like for like in CARRIES_AS.values())
    lain_on = {like for often in column("lies_on").values() for like in often}
    assert lain_on == set(CARRIES_AS.values())


def test_rooms_have_kinds_of_their_own() -> None:
    assert all(len(kinds) > 10 for kinds in ROOMS.values())
    assert "toilet" in ROOMS["bathroom"] - ROOMS["kitchen"]


def test_what_lies_on_objects_is_small_or_hangs_nowhere() -> None:
    assert {category(kind).mount for kind in CARRIED_KINDS} <= {"surface", "floor", "wall"}
    assert sum(category(kind).mount == "surface" for kind in CARRIED_KINDS) > 0.8 * len(CARRIED_KINDS)


def test_how_often_kinds_lie_on_carriers() -> None:
    assert often_carried("keyboard", "desk") > often_carried("keyboard", "table") > often_carried("wardrobe", "table")
    assert often_carried("vase", "night stand") > 1 > often_carried("vase", "bed")
    assert often_carried("heater", "bed") > often_carried("sofa", "bed")
    assert often_carried("vase", "door") == often_carried("object", "bed") == 1.0
    assert {c.name for c in CATEGORIES} > set(CARRIES_AS)


def test_what_people_put_things_on_follows_from_what_lies_where() -> None:
    assert usual_carriers("monitor")[0] == usual_carriers("keyboard")[0] == "desk"
    assert usual_carriers("lamp")[:3] == ("night stand", "sideboard", "side table")
    assert usual_carriers("wardrobe") == usual_carriers("object") == ()


def test_what_is_added_for_a_thing_is_at_home_in_the_room() -> None:
    assert carrier_in("lamp", "bedroom") == "night stand"
    assert carrier_in("lamp", "living") == "side table"
    assert carrier_in("kettle", "living") == "kitchen counter"
    assert carrier_in("bowl", "corridor") == "table"
    assert carrier_in("sofa", "living") is None
