from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from diorama_core.scene.values import ArrayValue, read_only_array


@dataclass(frozen=True, eq=False)
class Measured(ArrayValue):
    name: str
    values: np.ndarray


@dataclass(frozen=True, eq=False)
class Other(ArrayValue):
    name: str
    values: np.ndarray


def test_values_are_equal_by_content_and_hash_alike() -> None:
    a, b = Measured("a", np.arange(3.0)), Measured("a", np.arange(3.0))
    assert a == b
    assert hash(a) == hash(b)
    assert len({a, b}) == 1
    assert a != Measured("b", np.arange(3.0))
    assert a != Measured("a", np.array([0.0, 1.0, 2.5]))
    assert a != Measured("a", np.arange(4.0))
    assert a != Other("a", np.arange(3.0))
    assert a != "a"


def test_frozen_arrays_are_read_only_copies() -> None:
    given = np.zeros((2, 3))
    made = read_only_array(given, (-1, 3))
    given[0, 0] = 5.0
    assert made[0, 0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        made[0, 0] = 1.0
    assert read_only_array([1, 2, 3], (3,)).dtype == np.float64


@pytest.mark.parametrize("value", [np.zeros((2, 2)), np.zeros(3), np.zeros((1, 2, 3)), 4.0])
def test_another_shape_is_refused(value) -> None:
    with pytest.raises(ValueError, match="expected an array of shape"):
        read_only_array(value, (-1, 3))


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 10**400])
def test_numbers_must_be_finite(bad) -> None:
    with pytest.raises(ValueError, match="finite"):
        read_only_array([0.0, bad, 1.0], (3,))
