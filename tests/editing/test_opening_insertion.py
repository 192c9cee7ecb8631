from __future__ import annotations

import numpy as np
import pytest

from diorama_core.editing.opening_insertion import with_opening
from diorama_core.errors import EditRefused
from diorama_core.library.catalogue import built_in_library
from tests.text.test_edit_room import living_room


def test_openings_of_one_wall_stand_beside_one_another_until_it_is_full() -> None:
    library, scene, made = built_in_library(), living_room(), []
    middle = scene.plane("wall_3").polygon[:, :2].mean(axis=0)
    wall_3 = scene.plane("wall_3").polygon[:, :2]
    for category in ("door", "window"):
        scene, new_id = with_opening(scene, library, category, "wall_3", middle)
        made.append(new_id)
    for _ in range(int(np.ptp(wall_3, axis=0).max() / 0.8)):
        try:
            scene, new_id = with_opening(scene, library, "window", "wall_3", middle)
            made.append(new_id)
        except EditRefused:
            break
    with pytest.raises(EditRefused, match="no part of this wall is free"):
        with_opening(scene, library, "door", "wall_3", middle)
    for k, one in enumerate(made):
        low, high = _span(scene.object(one))
        for other in made[:k]:
            other_low, other_high = _span(scene.object(other))
            assert ((high <= other_low + 1e-6) | (other_high <= low + 1e-6)).any()


def _span(item):
    return item.corners_world[:, :2].min(axis=0), item.corners_world[:, :2].max(axis=0)
