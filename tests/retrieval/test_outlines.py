from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.retrieval.outlines import close_gaps, open_share, outline_agreement


def slats(gap: int) -> np.ndarray:
    """A ladder back: upright slats with gaps, in a margin."""
    mask = np.zeros((64, 64), dtype=bool)
    mask[10:54, 10:54] = (np.arange(44) % (gap + 3)) < 3
    mask[10:13, 10:54] = mask[51:54, 10:54] = True
    return mask


def test_narrow_gaps_are_closed_and_wide_ones_stay_open() -> None:
    assert close_gaps(slats(2))[10:52, 12:50].all()
    assert not close_gaps(slats(20))[30, 10:54].all()


@given(st.integers(0, 1000))
def test_filling_adds_and_never_takes_away_and_not_twice(seed: int) -> None:
    rng = np.random.default_rng(seed)
    mask = rng.random((24, 24)) < 0.4
    once = close_gaps(mask)
    assert (once >= mask).all()
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    outside = once.copy()
    outside[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1] = False
    assert not outside.any()


def test_an_empty_mask_stays_empty() -> None:
    empty = np.zeros((8, 8), dtype=bool)
    assert close_gaps(empty) is empty


@pytest.mark.parametrize(("trust", "share"), [(0.0, 0.0), (0.5, 0.0), (0.75, 0.25), (1.0, 0.5)])
def test_gaps_count_as_far_as_the_mask_is_trusted(trust: float, share: float) -> None:
    assert open_share(trust) == pytest.approx(share)


@pytest.mark.unchecked
def test_the_right_outline_agrees_best_with_and_without_its_gaps() -> None:
    true, solid, other = slats(2), close_gaps(slats(2)), np.roll(slats(2), 12, axis=1)

    def seen(trust: float):
        covered = true.ravel().astype(float)

        def agreement(silhouettes: np.ndarray) -> np.ndarray:
            both = (silhouettes & true.ravel()).sum(axis=1)
            return both / (silhouettes | true.ravel()).sum(axis=1)

        return SimpleNamespace(covered=covered, weight=np.ones(64 * 64), mask_trust=trust, agreement=agreement)

    candidates = np.stack([true.ravel(), solid.ravel(), other.ravel()])
    whole = close_gaps(true).ravel().astype(float)
    doubtful = outline_agreement(seen(0.4), whole, candidates)
    assert doubtful[0] == pytest.approx(doubtful[1]), "a doubtful mask's gaps say nothing"
    assert doubtful[0] > doubtful[2] + 0.2
    sure = outline_agreement(seen(1.0), whole, candidates)
    assert sure[0] == pytest.approx(1.0)
    assert sure[0] > sure[1] + 0.05
