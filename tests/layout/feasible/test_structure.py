"""Structure leaves the picture as it is where a photo alone gave distances."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.layout.feasible.photo_observations import MAX_STRETCH
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.feasible.structure import MAX_GROWTH
from diorama_core.progress import Progress
from diorama_core.synthesis.layout_rooms import box_library
from tests.layout.feasible.test_photo_observations import looking_north, outline
from tests.layout.small_rooms import Room

LIBRARY = box_library()


@pytest.mark.parametrize(("above_m", "farther"), [(0.12, True), (-0.15, False)])
def test_what_is_seen_off_its_table_changes_distance_and_size_and_looks_the_same(room: Room, above_m, farther):
    table = room.put("table_0", (0.0, 0.6, 0.37))
    vase = room.put("vase_20", (0.0, 0.5, 0.74 + above_m + 0.14), on=table)
    scene = room.scene(camera=looking_north())
    settled = FeasibleRecipe(LIBRARY, sizes_reasoned=True).optimise(scene, Progress())[0]
    before, after = scene.object(vase), settled.object(vase)
    assert after.corners_world[:, 2].min() == pytest.approx(0.74, abs=1e-3)
    np.testing.assert_allclose(outline(settled, vase), outline(scene, vase), atol=2.0)
    grown = after.pose.scale / before.pose.scale
    assert ((grown > 1.05) if farther else (grown < 0.95)).all()
    assert (grown < MAX_GROWTH).all()


def test_sizes_stay_within_limits_where_they_were_not_reasoned(room: Room):
    table = room.put("table_0", (0.0, 0.6, 0.37))
    vase = room.put("vase_20", (0.0, 0.5, 0.74 + 0.3 + 0.14), on=table)
    scene = room.scene(camera=looking_north())
    settled = FeasibleRecipe(LIBRARY).optimise(scene, Progress())[0]
    assert (settled.object(vase).pose.scale <= MAX_STRETCH + 1e-9).all()
