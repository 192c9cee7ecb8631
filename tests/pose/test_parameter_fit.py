"""Parameters of retrieved designs, fitted to rendered pictures of other members of their families."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.artefacts import Cuboid
from diorama_core.library.catalogue import base_id
from diorama_core.library.furniture.measures import made_by_id, parameters, values_of
from diorama_core.pose import parameter_fit
from diorama_core.pose.made_to_measure import MadeToMeasure
from diorama_core.pose.outline_fit import FitRange, fit_pose
from diorama_core.pose.parameter_fit import can_have, level_cost
from diorama_core.scene.types import Pose
from tests.pose import test_made_to_measure
from tests.pose.test_made_to_measure import DESIGNS, STAGE, fitted
from tests.primitives import PrimitiveLibrary

TABLE = PrimitiveLibrary().shape("table")
TOP_M = TABLE.surfaces[0].height_m


@pytest.mark.parametrize("measured", [False, True])
def test_legs_are_compared_where_a_table_with_such_legs_stands(measured: bool) -> None:
    true_id, found_id = "table-walnut-splay", "table-oak-classic"
    best = fitted(true_id, found_id, scale=(0.94, 0.94, 1.0), measured=measured)
    assert base_id(best.shape_id) == found_id
    made = values_of(made_by_id(best.shape_id, DESIGNS[found_id]))
    assert made["shape"] == values_of(DESIGNS[true_id])["shape"] == "splay"


def test_a_shape_that_agrees_worse_when_it_is_built_is_built_with_what_agrees_better() -> None:
    best = fitted("wardrobe-open-white", "wardrobe-open-steel")
    made = values_of(made_by_id(best.shape_id, DESIGNS["wardrobe-open-steel"]))
    assert made["drawers"] == values_of(DESIGNS["wardrobe-open-white"])["drawers"]


@pytest.mark.parametrize(
    ("name", "value", "possible"),
    [
        ("bays", ("3", "3"), False),
        ("bays", ("3",), True),
        ("bays", ("6",), False),
        ("bays", ("door", "3"), False),
        ("bays", ("door", "door"), True),
        ("panes", (3, 3), True),
        ("drawers", 9, True),
    ],
)
def test_a_small_cabinet_has_no_drawers_that_nothing_fits_into(name: str, value: object, possible: bool) -> None:
    assert can_have(name, value, np.array([0.33, 0.34, 0.38])) is possible


def test_the_drawers_of_designs_are_told_as_these_tests_tell_them() -> None:
    bays = next(p for p in parameters("dresser-white-four") if p.name == "bays")
    assert ("3", "3") in bays.used


def stage_with(**numbers: float) -> MadeToMeasure:
    settings = STAGE.settings
    return replace(STAGE, settings=replace(settings, shapes=replace(settings.shapes, **numbers)))


@pytest.mark.parametrize("bound", ["promising_with_depth", "finely"])
def test_what_a_fit_or_its_finer_steps_bring_is_not_enough_for_what_needs_more(
    bound: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    taken: list[tuple[float, ...]] = []

    def counted(*args: Any, near: FitRange, **settings: Any) -> Pose:
        taken.append(near.steps)
        return fit_pose(*args, near=near, **settings)

    monkeypatch.setattr(parameter_fit, "fit_pose", counted)
    left_to_finely = {"promising_with_depth": np.inf} if bound == "finely" else {}
    monkeypatch.setattr(test_made_to_measure, "STAGE", stage_with(**left_to_finely))
    quickly = fitted("table-walnut-splay", "table-oak-classic", scale=(0.94, 0.94, 1.0))
    few = len(taken)
    monkeypatch.setattr(test_made_to_measure, "STAGE", stage_with(**left_to_finely, **{bound: np.inf}))
    thoroughly = fitted("table-walnut-splay", "table-oak-classic", scale=(0.94, 0.94, 1.0))
    assert thoroughly.shape_id == quickly.shape_id
    assert np.array_equal(thoroughly.pose.matrix, quickly.pose.matrix)
    assert few < len(taken) - few


def lying_at(base_m: float) -> Cuboid:
    size = np.array([0.2, 0.2, 0.1])
    return Cuboid("cup", np.eye(3), np.array([0.0, 0.0, base_m + 0.05]), size, 0.9)


def pose(scale: float = 1.0) -> Pose:
    return Pose(np.eye(3), np.array([0.0, 0.0, 0.5]), np.array([1.0, 1.0, scale]))


def test_a_thing_on_a_surface_costs_nothing() -> None:
    assert level_cost(TABLE, pose(), [lying_at(0.5 + TOP_M)]) == pytest.approx(0.0)
    assert level_cost(TABLE, pose(1.5), [lying_at(0.5 + 1.5 * TOP_M)]) == pytest.approx(0.0)


@given(off=st.floats(0.0, 5.0), farther=st.floats(0.0, 5.0))
def test_the_farther_off_the_dearer_up_to_a_limit(off: float, farther: float) -> None:
    near, far = (level_cost(TABLE, pose(), [lying_at(0.5 + TOP_M + d)]) for d in (off, off + farther))
    assert 0.0 <= near <= far <= 4.0


def test_many_things_say_as_much_as_one() -> None:
    one = level_cost(TABLE, pose(), [lying_at(0.6 + TOP_M)])
    assert level_cost(TABLE, pose(), [lying_at(0.6 + TOP_M)] * 6) == pytest.approx(one)


def test_nothing_known_of_surfaces_or_nothing_carried_costs_nothing() -> None:
    assert level_cost(replace(TABLE, surfaces=()), pose(), [lying_at(3.0)]) == 0.0
    assert level_cost(TABLE, pose(), []) == 0.0
