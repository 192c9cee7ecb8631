from __future__ import annotations

import numpy as np
import pytest

from diorama_core.editing.clipboard import BESIDE_M, clip_of, free_offset, paste_clip
from tests.app.small_room import furnished_scene

SCENE = furnished_scene()


@pytest.mark.parametrize("object_id", [o.id for o in SCENE.objects])
def test_a_copy_stands_beside_its_original_clear_of_everything_and_inside(object_id: str) -> None:
    clip = clip_of(SCENE, [object_id])
    scene, heads = paste_clip(SCENE, clip, free_offset(SCENE, clip))
    others = SCENE.objects
    for head in heads:
        copy = scene.object(head)
        for plane in scene.architecture.planes:
            assert float((copy.corners_world @ plane.normal).min()) > plane.offset - 0.03, plane.id
        low, high = copy.corners_world.min(axis=0), copy.corners_world.max(axis=0)
        for other in others:
            shared = np.minimum(high, other.corners_world.max(axis=0)) - np.maximum(
                low, other.corners_world.min(axis=0)
            )
            assert shared.min() <= 0.03 + 1e-9, other.id


def test_where_all_places_are_taken_a_copy_is_shown_across(monkeypatch: pytest.MonkeyPatch) -> None:
    clip = clip_of(SCENE, ["chair_1"])
    monkeypatch.setattr("diorama_core.editing.clipboard.TOUCHING_M", -100.0)
    np.testing.assert_array_equal(free_offset(SCENE, clip), BESIDE_M)
