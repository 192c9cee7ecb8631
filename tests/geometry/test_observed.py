"""What a mask says of a shape's outline."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
import trimesh

from diorama_core.geometry.observed import loads_of, observe, observe_among, open_below, without_loads
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from tests.synthetic_rooms import look

CELLS, BOX = 24, (40.0, 30.0, 100.0, 110.0)


def table(cells: int = CELLS) -> np.ndarray:
    """A top on two legs, seen from the front, in the cells of a window."""
    grid = np.zeros((cells, cells), dtype=bool)
    grid[4:7, 4:20] = True
    grid[7:20, [5, 18]] = True
    return grid


def test_open_is_what_is_below_something_and_above_the_foot():
    found = open_below(table().reshape(1, -1), CELLS).reshape(CELLS, CELLS)
    assert found[7:20, 6:18].all()
    assert not found[:7].any()
    assert not found[20:].any()


def seen(confidence: float):
    mask = np.zeros((150, 160), dtype=bool)
    mask[30:110, 40:100] = True  # the space between the legs is filled
    return observe(look(0, 0), BOX, mask, confidence, (), CELLS)


@pytest.mark.parametrize(("confidence", "told"), [(1.0, True), (0.9, False)])
def test_only_a_drawn_mask_tells_that_there_is_no_space_between_legs(confidence, told):
    of = seen(confidence)
    whole = of.covered > 0.5
    rows = np.arange(CELLS * CELLS) // CELLS
    columns = np.arange(CELLS * CELLS) % CELLS
    inner = whole & (rows > 10) & (columns > 7) & (columns < 16)
    closed, open_ = of.agreement(np.stack([whole, whole & ~inner]))
    assert closed > open_
    assert (closed - open_ > 0.15) == told


def filled(rows: slice, columns: slice) -> np.ndarray:
    """A mask of one rectangle."""
    mask = np.zeros((150, 160), dtype=bool)
    mask[rows, columns] = True
    return mask


@dataclass(frozen=True)
class Marked:
    """A thing with a box and a mask."""

    box: tuple[float, float, float, float]
    mask: np.ndarray
    mask_confidence: float = 0.9


def test_what_lies_on_a_thing_is_no_part_of_its_outline() -> None:
    books = filled(slice(20, 50), slice(50, 80))
    items = (Marked(BOX, filled(slice(20, 110), slice(40, 100))), Marked((50.0, 20.0, 80.0, 50.0), books))
    of = observe_among(
        look(0, 0), items, np.array([[0.0, 3.0, 0.5], [0.0, 3.1, 0.9]]), (None, 0), 0, CELLS, loads_apart=True
    )
    on_them = of.window.coverage(books) > 0.99
    assert on_them.any()
    assert of.covered[on_them].max() == 0.0
    assert of.weight[on_them].max() < 1e-9
    beside = observe_among(
        look(0, 0), items, np.array([[0.0, 3.0, 0.5], [0.0, 3.1, 0.9]]), (None, None), 0, CELLS, loads_apart=True
    )
    assert beside.covered[on_them].min() > 0.99


def test_a_load_that_would_leave_nothing_leaves_the_mask_as_it_is() -> None:
    rug = filled(slice(60, 110), slice(40, 100))
    assert without_loads(rug, [filled(slice(50, 120), slice(30, 110))]).sum() == rug.sum()
    assert without_loads(rug, [filled(slice(60, 70), slice(40, 100))]).sum() == rug.sum() - 600


def test_loads_lie_on_a_thing_or_on_what_lies_on_it() -> None:
    assert loads_of((None, 0, 1, None, 3), 0) == (1, 2)
    assert loads_of((1, 0), 0) == (1,)


PLACES = [(0.0, 3.0, 1.0), (-0.7, 2.0, 0.4), (1.2, 1.6, 1.5), (0.0, 0.2, 1.2), (0.0, -3.0, 1.0)]
"""In the middle, on either side of the window, around the camera, and behind it."""


@pytest.mark.parametrize("places", [*([place] for place in PLACES), PLACES[:3], PLACES])
def test_rays_that_are_left_out_would_meet_nothing(places):
    of, count = seen(1.0), len(places)
    caster = ShapeCaster(trimesh.creation.icosphere(3, 0.4))
    turns = np.tile(np.eye(3), (count, 1, 1))
    poses = PoseBatch(turns, np.array(places), np.tile([1.3, 0.6, 1.0], (count, 1)))
    every = caster.cast(of.origin_world, of.directions_world, poses)
    hits = of.hits(caster, poses)
    assert np.array_equal(of.silhouettes(caster, poses), every.is_hit)
    assert np.array_equal(hits.depth_m, every.depth_m)
    assert np.array_equal(hits.normals_world, every.normals_world)
    assert np.array_equal(hits.triangles[hits.is_hit], every.triangles[every.is_hit])


def test_a_shape_in_the_middle_of_the_window_is_met():
    of = seen(1.0)
    pose = PoseBatch(np.eye(3)[None], of.origin_world[None] + 3.0 * of.directions_world[[300]], np.ones((1, 3)))
    covered = of.silhouettes(ShapeCaster(trimesh.creation.icosphere(3, 0.1)), pose)[0]
    assert covered[300]
    assert 0 < covered.sum() < CELLS**2 / 4
