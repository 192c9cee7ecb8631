"""Desks with shelves: one can sit at them, and every board is where it is told."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.model import Parts
from diorama_core.library.furniture.tables.shelved_desks import hutch_desk, ladder_desk

SIZE = (0.6, 1.2, 1.5)


def board_heights(parts: Parts, above: float) -> list[float]:
    """Undersides of wide level boards above a height, lowest first, millimetres."""
    wide = [p.solid.vertices for p in parts if np.ptp(p.solid.vertices[:, 2]) < 0.03]
    wide = [v for v in wide if np.ptp(v[:, 1]) > 0.5]
    return sorted({round(float(v[:, 2].min()), 3) for v in wide if v[:, 2].min() > above})


@pytest.mark.parametrize("shelves", [1, 2, 3])
def test_a_hutch_has_as_many_shelves_as_told(shelves) -> None:
    parts = hutch_desk(SIZE, m.OAK, m.STEEL, shelves=shelves)
    heights = board_heights(parts, 0.8)
    assert len(heights) == shelves
    assert heights[0] > 1.0


@pytest.mark.parametrize("drawers", [0, 1, 3])
def test_drawers_of_a_hutch_open(drawers) -> None:
    parts = hutch_desk(SIZE, m.OAK, m.STEEL, drawers=drawers)
    assert len({p.joint for p in parts if p.joint is not None}) == drawers


@pytest.mark.parametrize("shelves", [2, 3])
def test_boards_of_a_ladder_grow_shallower_upward(shelves) -> None:
    parts = ladder_desk((0.55, 0.75, 1.8), m.OAK, m.BLACK_STEEL, shelves=shelves, rise=0.75)
    boards = [p.solid.vertices for p in parts if np.ptp(p.solid.vertices[:, 2]) < 0.03]
    boards = sorted((v for v in boards if np.ptp(v[:, 1]) > 0.5), key=lambda v: float(v[:, 2].min()))
    depths = [float(np.ptp(v[:, 0])) for v in boards]
    assert len(boards) == shelves + 1
    assert depths == sorted(depths, reverse=True)
    assert boards[0][:, 2].max() == pytest.approx(0.75, abs=1e-6)
