from __future__ import annotations

import numpy as np
import pytest

from diorama_core.editing.opening_insertion import with_opening
from diorama_core.errors import EditRefused
from diorama_core.library.catalogue import built_in_library
from diorama_core.text.edit_plan import Light, Paint, RoomLength
from diorama_core.text.edit_room import cover, covering_in_words, lengthen, light, off_wall
from diorama_core.text.edit_words_room import room_edits
from diorama_core.text.selecting import Selector
from tests.text.edited import living_room


def test_the_wall_behind_something_alone_is_covered() -> None:
    after = cover(living_room(), Paint(part="walls", colour="sage", behind="piano_1")).scene
    assert [p.id for p in after.architecture.planes if p.finish is not None] == ["wall_3"]
    with pytest.raises(EditRefused, match="no colour or covering"):
        cover(living_room(), Paint(part="walls", colour="zorkmid"))


def test_the_room_is_lengthened_and_the_light_set() -> None:
    scene = living_room()
    longer = lengthen(scene, RoomLength(side="width", by_m=0.5)).scene
    before, after = (np.sort(np.ptp(s.architecture.floor.polygon[:, :2], axis=0)) for s in (scene, longer))
    np.testing.assert_allclose(after - before, [0.5, 0.0], atol=0.06)  # the room is a little askew
    assert light(scene, Light(hour=8.0)).scene.light_settings.hour == 8.0
    with pytest.raises(EditRefused, match="which light"):
        light(scene, Light())


def test_away_from_the_wall_is_into_the_room() -> None:
    assert float(off_wall(living_room(), "piano_1") @ living_room().plane("wall_3").normal[:2]) == pytest.approx(1.0)


def test_openings_stand_where_they_fit() -> None:
    after, new_id = with_opening(living_room(), built_in_library(), "window", "wall_3", np.zeros(2))
    assert after.support_of(new_id).parent == "wall_3"
    with pytest.raises(EditRefused, match="choose a wall"):
        with_opening(living_room(), built_in_library(), "window", "nowhere", np.zeros(2))


def test_what_is_not_about_the_room_is_left_to_others() -> None:
    selector = Selector(living_room(), built_in_library())
    for clause in ("move the lamp to the wall", "a wooden chair by the wall", "remove the rug on the floor"):
        assert room_edits(selector, clause) is None


@pytest.mark.parametrize(
    ("words", "pattern"),
    [("brick", "brick"), ("oak boards", "boards"), ("white metro tiles", "metro"), ("light blue", "paint"),
     ("striped wallpaper", "stripes"), ("wooden", "boards"), ("grey carpet", "carpet"),
     ("walnut herringbone", "herringbone")],
)  # fmt: skip
def test_coverings_have_their_words(words: str, pattern: str) -> None:
    found = covering_in_words(words, living_room().plane("floor"))
    assert found is not None
    assert found.pattern == pattern


@pytest.mark.parametrize("words", ["zorkmid", "the lamp", "", "darker lamp"])
def test_other_words_name_no_covering(words: str) -> None:
    assert covering_in_words(words, living_room().plane("floor")) is None


def test_darker_is_of_what_there_is() -> None:
    plane = living_room().plane("wall_0")
    darker = covering_in_words("a bit darker", plane)
    assert darker is not None
    assert sum(darker.colour) < sum(plane.colour)
