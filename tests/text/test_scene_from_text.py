from __future__ import annotations

from dataclasses import replace

from diorama_core.scene.types import Scene
from diorama_core.text.scene_from_text import unmet
from tests.app.small_room import furnished_scene


def scene_of(*categories: str) -> Scene:
    one = furnished_scene().objects[0]
    return Scene(objects=tuple(replace(one, id=f"o{k}", category=c) for k, c in enumerate(categories)))


def test_every_request_that_is_not_met_is_named() -> None:
    words = "a bedroom with two lamps, a wardrobe and an armchair"
    assert unmet(words, scene_of("lamp", "bed")) == ("1 of 2 lamps", "no wardrobe", "no armchair")


def test_nothing_is_said_where_all_is_there() -> None:
    assert unmet("a desk with a chair", scene_of("desk", "chair")) == ()


def test_one_object_meets_one_request() -> None:
    lines = unmet("a chair, and an armchair", scene_of("armchair"))
    assert len(lines) == 1


def test_words_of_nothing_are_named() -> None:
    assert any("flurb" in line for line in unmet("a flurb", scene_of()))
