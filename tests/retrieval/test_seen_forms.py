"""Shapes whose form is the one that was seen score higher; what was not seen changes nothing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.geometry.shape_appearance import appearance_of
from diorama_core.io.cache import LruCache
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.form import MEASURED, VALUES
from diorama_core.retrieval import feature_cache, seen_forms
from diorama_core.retrieval.seen_forms import form_likelihood_factor, has_form, shape_form

LIBRARY = built_in_library()


def seen(**sure: str | int) -> list[float]:
    """Nine in ten for the given values, and nothing known of the other attributes."""
    found: list[float] = []
    for name in MEASURED:
        values = VALUES[name]
        if name in sure:
            found += [0.9 if v == sure[name] else 0.1 / (len(values) - 1) for v in values]
        else:
            found += [1.0 / len(values)] * len(values)
    return found


def form(shape_id: str) -> dict[str, str | int]:
    return dict(shape_form(LIBRARY, LIBRARY.shape(shape_id), appearance_of(LIBRARY.parts(shape_id))))


def test_the_form_that_was_seen_scores_higher() -> None:
    round_top = seen(top="round", base="pedestal")
    assert form_likelihood_factor(form("table-round-tulip"), round_top) > 1.0
    assert form_likelihood_factor(form("table-trestle-x"), round_top) < 1.0


def test_drawers_are_counted_by_joints() -> None:
    assert form("night-stand-white-open")["drawers"] == 0
    assert form_likelihood_factor(form("night-stand-white-open"), seen(drawers=2)) < 1.0


@pytest.mark.parametrize("shape_id", ["table-round-tulip", "sofa-grey-three", "picture-hills-oak"])
def test_what_was_not_seen_changes_nothing(shape_id: str) -> None:
    assert form_likelihood_factor(form(shape_id), ()) == 1.0
    assert form_likelihood_factor(form(shape_id), seen()) == pytest.approx(1.0)


@given(st.integers(0, 2**32 - 1))
def test_on_average_no_form_is_preferred(seed: int) -> None:
    """Weighted by what was seen, the logarithms of the factors of all values of an attribute add up to 0."""
    rng = np.random.default_rng(seed)
    parts = [rng.dirichlet(np.ones(len(VALUES[name]))) for name in MEASURED]
    flat = [float(p) for part in parts for p in part]
    for name, part in zip(MEASURED, parts, strict=True):
        smooth = (part + 0.03) / (part + 0.03).sum()
        logs = [np.log(form_likelihood_factor({name: value}, flat)) for value in VALUES[name]]
        assert float(smooth @ np.array(logs)) == pytest.approx(0.0, abs=1e-9)


def test_a_form_is_measured_once_for_all_processes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shape = LIBRARY.shape("night-stand-white-open")
    appearance = appearance_of(LIBRARY.parts(shape.id))
    assert not has_form(shape, tmp_path)
    first = shape_form(LIBRARY, shape, appearance, tmp_path)
    assert has_form(shape, tmp_path)
    monkeypatch.setattr(feature_cache, "_CACHE", LruCache(4))  # as another process

    def never(*_: object) -> dict[str, str | int]:
        raise AssertionError("the form is on disk")

    monkeypatch.setattr(seen_forms, "form_of", never)
    assert shape_form(LIBRARY, shape, appearance, tmp_path) == first
