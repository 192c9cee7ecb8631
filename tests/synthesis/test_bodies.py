from __future__ import annotations

import numpy as np
import pytest

from diorama_core.scene.types import Pose
from diorama_core.synthesis.bodies import Item, PlacedBodies, heights_below
from tests.synthesis.box_rooms import LIBRARY

BOX = Item(next(s for s in LIBRARY.shapes() if s.category == "box"))
"""0.35 x 0.45 x 0.3 m."""
TABLE = Item(LIBRARY.in_category("table")[0])


def test_items_have_their_scaled_size() -> None:
    assert BOX.size_m == pytest.approx([0.35, 0.45, 0.3])
    assert Item(BOX.shape, (2.0, 1.0, 0.5)).size_m == pytest.approx([0.7, 0.45, 0.15])
    assert BOX.category == "box"


@pytest.mark.parametrize(("x", "hit"), [(0.0, "a"), (0.34, "a"), (0.36, None)])
def test_bodies_that_cut_each_other_are_named(x: float, hit: str | None) -> None:
    bodies = PlacedBodies(LIBRARY)
    bodies.add("a", BOX, Pose.upright((0, 0, 0.15)))
    assert bodies.hit_by(BOX, Pose.upright((x, 0, 0.15))) == hit
    assert bodies.hit_by(BOX, Pose.upright((x, 0, 0.15)), ignore={"a"}) is None
    bodies.remove("a")
    assert bodies.hit_by(BOX, Pose.upright((x, 0, 0.15))) is None


def test_it_is_the_surfaces_that_count_not_the_boxes() -> None:
    bodies = PlacedBodies(LIBRARY)
    bodies.add("table", TABLE, Pose.upright((0, 0, 0.37)))
    assert bodies.hit_by(BOX, Pose.upright((0, 0, 0.15))) is None, "it stands under the table"
    assert bodies.hit_by(BOX, Pose.upright((0, 0, 0.65))) == "table"
    turned = Pose.upright((0.4, 0, 0.15), np.pi / 4)
    bodies.add("box", BOX, Pose.upright((0, 0, 0.15)))
    assert bodies.hit_by(BOX, turned) == "box"


def test_contact_is_no_collision() -> None:
    bodies = PlacedBodies(LIBRARY)
    bodies.add("a", BOX, Pose.upright((0, 0, 0.15)))
    assert bodies.hit_by(BOX, Pose.upright((0, 0, 0.45))) is None
    assert bodies.hit_by(BOX, Pose.upright((0, 0, 0.44))) == "a"


def test_heights_below_points_are_those_of_the_first_surface() -> None:
    top = TABLE.size_m[2] / 2
    points = np.array([[0.0, 0.0, top + 0.1], [2.0, 0.0, top], [0.0, 0.0, top + 0.5]])
    found = heights_below(LIBRARY, TABLE.shape.id, points, 0.3)
    assert found[0] == pytest.approx(top, abs=1e-6)
    assert np.isneginf(found[1:]).all()
