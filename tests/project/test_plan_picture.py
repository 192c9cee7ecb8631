from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from diorama_core.errors import InputError
from diorama_core.project.plan_picture import PlanPicture, load_plan_picture, place_plan_picture, save_plan_picture
from tests.app.small_room import make_project

RGB = np.full((20, 40, 3), 230, np.uint8)
PLACE = PlanPicture((40, 20), (1.0, -2.0), 0.05)


def test_a_picture_comes_back_where_it_was_put(tmp_path: Path) -> None:
    project = make_project(tmp_path / "demo")
    assert load_plan_picture(project) is None
    save_plan_picture(project, RGB, PLACE)
    found = load_plan_picture(project)
    assert found is not None
    assert found[0].startswith(b"\xff\xd8")
    assert found[1] == PLACE
    place_plan_picture(project, replace(PLACE, metres=0.01))
    assert load_plan_picture(project)[1].metres == 0.01
    place_plan_picture(project, None)
    assert load_plan_picture(project) is None


def test_a_damaged_entry_is_no_picture(tmp_path: Path) -> None:
    project = make_project(tmp_path / "demo")
    save_plan_picture(project, RGB, PLACE)
    for entry in ({"size": [1]}, {"size": [4, 4], "at": [0, 0], "metres": -1}, "here", {"size": 5}):
        project.update_info(plan_picture=entry)
        assert load_plan_picture(project) is None


@pytest.mark.parametrize("change", [{"metres": 0.0}, {"metres": float("nan")}, {"at": (1e9, 0.0)}, {"size": (0, 5)}])
def test_a_place_that_no_plan_has_is_refused(change: dict) -> None:
    with pytest.raises(InputError, match="cannot lie there"):
        replace(PLACE, **change)
