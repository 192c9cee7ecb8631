"""Scales within the limits of what things look like."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.geometry.openings import STANDS_OUT_M
from diorama_core.library.taxonomy import CATEGORIES
from diorama_core.pose.limits import SizeLimits, sides_log_of

metres = st.floats(1e-4, 6.0)
sizes = st.tuples(metres, metres, metres)


@given(sizes, sizes, st.sampled_from([c.name for c in CATEGORIES]))
def test_scales_are_finite_positive_and_evenly_stretched(shape, observed, name) -> None:
    limits = SizeLimits.of(shape, name, np.array(observed))
    scale = limits.scale_for(np.array(observed))
    assert np.isfinite(scale).all()
    assert (scale > 0).all()
    thick = ~limits.thin
    if thick.any():
        logs = np.log(scale[thick])
        assert np.ptp(logs) <= 2 * limits.stretch_log + 1e-9


@given(st.floats(0.3, 3.0), st.floats(0.3, 3.0), st.floats(0.3, 3.0))
def test_a_request_within_the_limits_is_met_exactly(x, y, z) -> None:
    limits = SizeLimits.of((x, y, z), "object", np.array([x, y, z]))
    wanted = np.array([x, y, z]) * np.array([1.1, 0.95, 1.05])
    assert np.allclose(limits.scale_for(wanted) * [x, y, z], wanted)


def test_many_wishes_at_once_are_the_same_as_one_by_one(rng) -> None:
    limits = SizeLimits.of((0.5, 0.5, 0.9), "chair", np.array([0.5, 0.5, 0.9]))
    wanted = rng.uniform(0.1, 2.0, (20, 3))
    assert np.allclose(limits.scale_for(wanted), [limits.scale_for(w) for w in wanted])


def test_a_measured_height_is_plausible_however_tall() -> None:
    tall = np.array([0.7, 0.7, 0.75])
    assert SizeLimits.of((0.7, 0.7, 0.42), "coffee table", tall).max_m[2] == pytest.approx(0.6)
    assert SizeLimits.of((0.7, 0.7, 0.42), "coffee table", tall, measured=True).max_m[2] == pytest.approx(0.75)


@pytest.mark.parametrize("name", ["door", "window"])
def test_a_frame_stands_out_of_its_wall_as_far_as_all_do_where_only_a_photo_shows_it(name) -> None:
    shape, seen = (0.11, 0.9, 1.9), np.array([0.12, 0.8, 1.8])
    assert (SizeLimits.of(shape, name, seen).scale_for(seen) * shape)[0] == pytest.approx(STANDS_OUT_M)
    measured = SizeLimits.of(shape, name, seen, measured=True)
    assert (measured.scale_for(seen) * shape)[0] == pytest.approx(0.12)


def test_flat_things_come_in_all_proportions_where_only_a_photo_shows_them() -> None:
    landscape, tall = (0.03, 0.8, 0.6), np.array([0.03, 0.4, 1.05])
    flat = SizeLimits.of(landscape, "picture", tall)
    assert flat.any_proportions
    assert np.allclose(flat.scale_for(tall) * landscape, tall)
    measured = SizeLimits.of(landscape, "picture", tall, measured=True)
    assert not measured.any_proportions
    assert not np.allclose(measured.scale_for(tall) * landscape, tall)
    assert not SizeLimits.of((0.5, 0.5, 0.9), "chair", np.array([0.5, 0.5, 0.9])).any_proportions


@given(st.floats(0.2, 3.0), st.floats(0.2, 3.0), st.floats(0.2, 2.0))
def test_what_is_round_stays_round_and_what_is_square_becomes_no_long_one(x, y, z) -> None:
    observed, shape = np.array([x, y, z]), (0.8, 0.8, 0.75)
    round_ = SizeLimits.of(shape, "table", observed, sides_log=sides_log_of(36, "table", round=True)).scale_for(
        observed
    )
    assert round_[0] == pytest.approx(round_[1])
    square = SizeLimits.of(shape, "table", observed, sides_log=sides_log_of(4, "table", round=False)).scale_for(
        observed
    )
    assert max(square[:2]) <= 1.3 * min(square[:2]) + 1e-9


def test_unnamed_things_and_those_with_a_front_come_in_all_proportions() -> None:
    assert sides_log_of(4, "object", round=False) == np.inf
    assert sides_log_of(2, "table", round=False) == np.inf


def test_a_flat_shape_for_a_thing_without_a_name_stays_flat() -> None:
    rug = SizeLimits.of((1.6, 2.3, 0.02), "object", np.array([0.7, 1.1, 0.4]))
    height = float(rug.scale_for(np.array([0.7, 1.1, 0.4]))[2] * 0.02)
    assert height <= 0.08
    assert SizeLimits.of((0.4, 0.5, 0.4), "object", np.array([0.7, 1.1, 0.9])).max_m[2] == 4.0
