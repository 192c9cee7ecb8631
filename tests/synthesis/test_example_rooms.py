from __future__ import annotations

import pytest

from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.schema import scene_from_json, scene_to_json
from diorama_core.synthesis.example_rooms import EXAMPLE_ROOMS, PATTERNS, example_room
from diorama_core.synthesis.finishes import FLOORS, WALLS


@pytest.mark.parametrize("room", EXAMPLE_ROOMS, ids=lambda r: r.kind)
def test_an_example_is_furnished_and_finished_and_the_same_again(room) -> None:
    library = built_in_library()
    scene = example_room(room, library)
    assert len(scene.objects) >= 10
    assert all(p.finish is not None for p in scene.architecture.by_role("wall"))
    assert all(p.texture is None for p in scene.architecture.planes), "pictures are made when it is opened"
    assert example_room(room, library) == scene
    assert scene_from_json(scene_to_json(scene)) == scene
    labels = [o.label for o in scene.objects]
    assert len(set(labels)) == len(labels)


def test_every_composed_finish_has_a_pattern() -> None:
    assert {*FLOORS, *WALLS} == set(PATTERNS)
