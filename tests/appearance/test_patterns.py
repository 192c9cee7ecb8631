from __future__ import annotations

import numpy as np
import pytest

from diorama_core.appearance import patterns
from diorama_core.appearance.patterns import Swatch

PAINTERS = (
    patterns.planks, patterns.parquet, patterns.tiles, patterns.checker, patterns.carpet, patterns.paint,
    patterns.paper, patterns.brick, patterns.panelling, patterns.plaster, patterns.stripes, patterns.dots,
    patterns.leaves, patterns.herringbone,
)  # fmt: skip
COLOUR = np.array([0.6, 0.5, 0.4])


@pytest.mark.parametrize("painter", PAINTERS, ids=lambda p: p.__name__)
def test_a_pattern_has_its_colour_on_the_whole_and_is_the_same_again(painter) -> None:
    first, again = (painter(Swatch(240, 320, 160.0, COLOUR, np.random.default_rng(3), "ceiling")) for _ in range(2))
    assert first.shape == (240, 320, 3)
    np.testing.assert_array_equal(first, again)
    assert np.abs(np.median(first, axis=(0, 1)) - COLOUR).max() < 0.3
    assert first.std(axis=(0, 1)).max() > 0.003, "no flat colour"


def test_stripes_are_as_wide_as_the_texels_per_metre_say() -> None:
    for texels in (100.0, 200.0):
        row = patterns.stripes(Swatch(4, 640, texels, COLOUR, np.random.default_rng(0), "wall"))[0, :, 0]
        changes = np.count_nonzero(np.diff(row > row.mean()))
        assert changes == pytest.approx(640 / (0.08 * texels), abs=2)


def test_herringbone_strips_are_six_times_as_long_as_wide() -> None:
    texels = 100.0
    picture = patterns.herringbone(
        Swatch(400, 400, texels, np.array([0.5, 0.5, 0.5]), np.random.default_rng(1), "floor")
    )
    seams = picture[..., 0] < 0.4
    lying = [run for row in seams[4:400:9] for run in _runs(~row) if run > 20]
    assert np.median(lying) == pytest.approx(6 * 0.09 * texels, abs=3)


def test_a_skirting_board_is_on_walls_only() -> None:
    plain = np.full((200, 100, 3), 0.3)
    assert (patterns.with_skirting(plain.copy(), 160.0, "floor") == plain).all()
    walled = patterns.with_skirting(plain.copy(), 160.0, "wall")
    assert (walled[-10:] > 0.7).all()
    assert (walled[:100] == 0.3).all()


def _runs(there: np.ndarray) -> list[int]:
    edges = np.flatnonzero(np.diff(np.concatenate([[0], there.astype(int), [0]])))
    return list(np.diff(edges)[::2])
