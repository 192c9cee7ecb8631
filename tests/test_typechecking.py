"""Shapes and types are checked while tests run (`tests/typechecking.py`)."""

from __future__ import annotations

import random
from collections.abc import Callable
from importlib.util import cache_from_source
from typing import Any

import numpy as np
import pytest
from jaxtyping import Float, TypeCheckError

from diorama_app.web import html
from diorama_core.geometry import planes
from diorama_core.geometry.planes import fit_plane
from diorama_core.geometry.projection import cuboid_corners
from diorama_core.io.limited import LimitedProcess
from diorama_core.scene.types import Architecture, Plane, Pose
from tests import typechecking

pytestmark = pytest.mark.skipif(not typechecking.wanted(), reason="DIORAMA_CHECK_SHAPES=0 turned the checks off")
SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])


@pytest.mark.parametrize(
    "arguments",
    [
        (np.zeros((2, 2)), np.zeros(2), np.ones((2, 3))),  # a wrong size
        (np.zeros((2, 3)), np.zeros(3), np.ones((2, 3))),  # two numbers of cuboids
        (np.zeros((2, 3), dtype=int), np.zeros(2), np.ones((2, 3))),  # whole numbers
        ([[0.0, 0.0, 0.0]], np.zeros(1), np.ones((1, 3))),  # no array
    ],
)
def test_wrong_arrays_raise(arguments: tuple[Any, ...]) -> None:
    with pytest.raises(TypeCheckError, match="cuboid_corners"):
        cuboid_corners(*arguments)


def test_compiled_files_with_checks_lie_beside_those_without_and_other_packages_have_one() -> None:
    ours = planes.__file__
    assert typechecking.compiled_at("x", ours) != cache_from_source(ours)
    assert typechecking.compiled_at("x", np.__file__) == cache_from_source(np.__file__)


def test_wrong_fields_of_values_raise() -> None:
    with pytest.raises(TypeCheckError, match="position"):
        Pose(np.eye(3), np.zeros(2), np.ones(3))


def test_wrong_types_raise_in_both_packages() -> None:
    with pytest.raises(TypeCheckError, match="role"):
        Architecture((Plane("floor", "floor", SQUARE),)).by_role("roof")
    with pytest.raises(TypeCheckError, match="script"):
        html.run_once(3)


def test_wrong_results_raise() -> None:
    plane = Plane("floor", "floor", SQUARE)
    object.__setattr__(plane, "polygon", np.zeros((4, 2)))
    with pytest.raises(TypeCheckError, match="return value"):
        _ = plane.centre


def test_a_whole_number_is_a_float() -> None:
    assert Plane("floor", "floor", SQUARE, thickness=1).thickness == 1


@pytest.mark.parametrize(
    ("function", "expected"),
    [
        (Architecture.by_role, False),
        (html.run_once, False),
        (LimitedProcess.call, False),
        (cuboid_corners, True),
        (fit_plane, True),
        (Pose.__init__, True),
    ],
)
def test_what_names_no_shapes_is_left_to_beartype(function: Any, expected: bool) -> None:
    assert (typechecking._plain_annotations(function.__wrapped__) is None) is expected


def test_shapes_are_found_within_other_annotations() -> None:
    array = Float[np.ndarray, "n 3"]
    for holder in (array, array | None, tuple[int, array], list[array], Callable[[array], int], Callable[[int], array]):
        assert typechecking._holds_shapes(holder), holder
    assert not any(map(typechecking._holds_shapes, (int, list[int], Callable[[int], str], np.ndarray, Any, None)))


@pytest.mark.unchecked
def test_a_marked_test_is_not_checked() -> None:
    with pytest.raises(ValueError, match="shape"):
        Pose(np.eye(3), np.zeros(2), np.ones(3))


def test_checks_leave_the_chance_of_tests_alone() -> None:
    before = random.getstate()
    Architecture(tuple(Plane(f"p{i}", "wall", SQUARE) for i in range(9))).by_role("wall")
    assert random.getstate() == before
