"""Plain tables: legs stand under the top, shelves where they are told, plinths on a recessed foot."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.measures import made_to_measure, varied
from diorama_core.library.furniture.model import Parts
from diorama_core.library.furniture.tables.plain_tables import (
    DESIGNS,
    four_legged_table,
    framed_table,
    plinth_stand,
)

SIZE = (0.6, 1.0, 0.45)


def reach(parts: Parts, low: float, high: float) -> np.ndarray:
    """Extents along x and y of the vertices between two heights."""
    points = np.concatenate([p.solid.vertices for p in parts])
    return np.ptp(points[(points[:, 2] >= low) & (points[:, 2] <= high)][:, :2], axis=0)


@pytest.mark.parametrize("profile", ["square", "taper", "turned", "splay", "slim"])
def test_feet_stand_under_the_top(profile) -> None:
    parts = four_legged_table(SIZE, m.OAK, m.OAK, profile=profile, overhang=0.03)
    feet = reach(parts, 0.0, 0.01)
    assert (feet <= np.array(SIZE[:2]) + 1e-6).all()
    assert (feet > 0.6 * np.array(SIZE[:2])).all()


def test_legs_without_overhang_end_flush_with_the_top() -> None:
    parts = four_legged_table(SIZE, m.OAK, m.OAK, overhang=0.0)
    assert reach(parts, 0.0, 0.02) == pytest.approx(SIZE[:2], abs=0.002)


@pytest.mark.parametrize("outline", ["square", "round"])
def test_a_shelf_lies_at_its_share_of_the_height(outline) -> None:
    without, with_shelf = (
        four_legged_table((0.5, 0.5, 0.5), m.OAK, m.OAK, outline=outline, shelf=share) for share in (0.0, 0.4)
    )
    shelf = with_shelf[-1].solid.vertices
    assert len(with_shelf) == len(without) + 1
    assert shelf[:, 2].min() == pytest.approx(0.2)
    assert np.ptp(shelf[:, 0]) < 0.5


def test_an_apron_never_reaches_the_floor() -> None:
    low = four_legged_table((0.3, 0.3, 0.1), m.OAK, m.OAK, apron=0.2)
    boards = [p.solid.vertices[:, 2].min() for p in low if np.ptp(p.solid.vertices[:, 2]) < 0.05]
    assert min(boards) > 0.02


@pytest.mark.parametrize("foot", ["open", "bar", "bent"])
def test_frames_spread_toward_the_floor(foot) -> None:
    parts = framed_table(SIZE, m.OAK, m.BLACK_STEEL, foot=foot)
    assert reach(parts, 0.0, 0.02)[0] > reach(parts, 0.39, 0.41)[0]


def test_a_plinth_has_a_recessed_foot_and_a_slab_that_stands_out() -> None:
    parts = plinth_stand((0.4, 0.4, 0.6), m.WHITE, cap=0.05, waist=0.04, recess=0.01)
    body, foot, slab = (np.ptp(p.solid.vertices[:, 0]) for p in parts)
    assert foot < body < slab == pytest.approx(0.4, abs=1e-6)


@pytest.mark.parametrize("design", DESIGNS, ids=lambda d: d.id)
def test_every_parameter_can_be_varied(design) -> None:
    size = np.array(design.size_m) * (0.9, 1.2, 0.8)
    choices = dict(varied(design.id))
    assert len(choices) >= 4
    for name, values in choices.items():
        for value in values:
            made = made_to_measure(design, size, {name: value})
            points = np.concatenate([p.solid.vertices for p in made.build(made.size_m)])
            stretch = np.asarray(made.size_m) / np.ptp(points, axis=0)
            assert ((stretch > 0.8) & (stretch < 1.25)).all(), (name, value)
