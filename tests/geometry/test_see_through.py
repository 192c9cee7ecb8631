"""Colours that tell an object from what is seen through it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.geometry.observed import Observed, observe
from diorama_core.geometry.see_through import SeeThrough
from tests.synthetic_rooms import look

CELLS, BOX = 36, (220.0, 140.0, 420.0, 340.0)
WALL, WOOD = (150, 160, 175), (120, 70, 30)
Y, X = np.mgrid[:480, :640]
RADIUS = np.hypot(X - 320, Y - 240)
DISC, RING = RADIUS < 100, (RADIUS < 100) & (RADIUS > 82)
SQUARE = (abs(X - 320) < 100) & (abs(Y - 240) < 100)


def photo(shown: np.ndarray, colour=WOOD, noise: float = 4.0) -> np.ndarray:
    """The pixels of an object in its colour before a shaded wall."""
    shade = 1.0 - 0.2 * (X / 640)[..., None]
    rgb = np.where(shown[..., None], colour, WALL) * shade + noise * np.random.default_rng(0).normal(size=(480, 640, 3))
    return np.clip(rgb, 0, 255).astype(np.uint8)


def outlined(mask: np.ndarray, confidence: float = 0.9, box=BOX) -> Observed:
    return observe(look(0, 0), box, mask, confidence, (), CELLS)


def cells(mask: np.ndarray) -> np.ndarray:
    return outlined(mask).covered > 0.5


def test_a_ring_whose_mask_is_filled_is_still_a_ring() -> None:
    seen = outlined(DISC)
    told = SeeThrough.of(photo(RING), seen)
    assert told is not None
    of_mask = seen.agreement(np.stack([cells(RING), cells(DISC)]))
    of_colours = told.agreement(np.stack([cells(RING), cells(DISC)]))
    assert of_mask[1] > of_mask[0] + 0.3
    assert of_colours[0] > of_colours[1] + 0.3


@pytest.mark.parametrize("colour", [WOOD, (235, 235, 230), (30, 30, 32)])
def test_a_closed_thing_stays_closed(colour) -> None:
    told = SeeThrough.of(photo(SQUARE, colour), outlined(SQUARE))
    assert told is not None
    closed, ring = told.agreement(np.stack([cells(SQUARE), cells(RING)]))
    assert closed > ring + 0.3


def test_colours_say_more_where_the_mask_contradicts_them_and_less_where_they_are_those_of_the_wall() -> None:
    filled, right = (SeeThrough.of(photo(RING), outlined(mask)) for mask in (DISC, RING))
    same = SeeThrough.of(photo(DISC, WALL), outlined(DISC))
    assert filled is not None
    assert right is not None
    assert same is not None
    assert filled.share > right.share
    assert same.share < 0.5 * filled.share


def test_parts_may_lie_off_by_a_little() -> None:
    told = SeeThrough.of(photo(RING), outlined(DISC))
    assert told is not None
    moved = cells(np.roll(RING, 8, axis=1))
    assert told.agreement(moved[None])[0] > told.agreement(cells(DISC)[None])[0] + 0.15


def test_drawn_masks_tell_themselves_and_too_little_tells_nothing() -> None:
    assert SeeThrough.of(photo(RING), outlined(DISC, 1.0)) is None
    small = (310.0, 230.0, 330.0, 250.0)
    assert SeeThrough.of(photo(RING), outlined(RADIUS < 10, box=small)) is None
    everything = (-100.0, -100.0, 740.0, 580.0)
    assert SeeThrough.of(photo(RING), outlined(np.ones((480, 640), dtype=bool), box=everything)) is None


@settings(max_examples=20)
@given(seed=st.integers(0, 10_000))
def test_whatever_the_picture_agreement_is_a_share(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rgb = rng.integers(0, 256, (480, 640, 3)).astype(np.uint8)
    mask = rng.random((480, 640)) < rng.random()
    told = SeeThrough.of(rgb, outlined(mask, float(rng.random())))
    if told is not None:
        found = told.agreement(rng.random((3, CELLS * CELLS)) < 0.5)
        assert ((found >= 0) & (found <= 1)).all()
        assert 0.0 <= told.share <= 1.0
        assert ((told.shown >= 0) & (told.shown <= 1)).all()
