from __future__ import annotations

import numpy as np
import pytest

from diorama_app.commands.room_looks import (
    clock,
    finish_surfaces,
    set_hour,
    surface_ids,
    surface_under,
    switch_all,
    use_daylight,
)
from diorama_core.appearance.surface_finish import usual_finish
from diorama_core.errors import EditRefused
from diorama_core.scene.light_settings import LightSettings
from diorama_core.scene.types import Scene
from tests.app.small_room import furnished_scene


@pytest.mark.parametrize(("hour", "shown"), [(0.0, "00:00"), (7.25, "07:15"), (23.999, "24:00")])
def test_the_clock(hour: float, shown: str) -> None:
    assert clock(hour) == shown


def test_setting_the_hour_begins_daylight_and_daylight_keeps_the_hour(session, client) -> None:
    set_hour(client, 15.0)
    assert session.scene.light_settings.hour == 15.0
    use_daylight(client)
    assert session.scene.light_settings.hour == 15.0


def test_all_lamps_at_once(session, client) -> None:
    switch_all(client, on=True)
    assert session.scene.light_settings == LightSettings(lamps_on=("lamp_1",))
    switch_all(client, on=False)
    assert session.scene.light_settings.lamps_on == ()


def test_the_surface_under_a_ray_is_the_nearest_that_faces_the_eye() -> None:
    scene, outside = furnished_scene(), np.array([0.0, -5.0, 1.2])
    assert surface_under(scene, outside, np.array([0.0, 1.0, 0.0])) == "wall_3", "the near wall is seen through"
    assert surface_under(scene, np.array([0.0, 1.0, 6.0]), np.array([0.0, 0.0, -1.0])) == "floor"
    assert surface_under(scene, outside, np.array([0.0, -1.0, 0.0])) is None
    assert surface_under(Scene(), outside, np.array([0.0, 1.0, 0.0])) is None


def test_one_step_for_one_or_for_all_walls(session, client) -> None:
    with pytest.raises(EditRefused, match="no surface"):
        surface_ids(client, all_walls=False)
    client.select_surface("wall_2")
    assert surface_ids(client, all_walls=False) == ("wall_2",)
    finish_surfaces(client, usual_finish("brick"), all_walls=True)
    assert all(p.finish is not None for p in session.scene.architecture.by_role("wall"))
    assert session.document.history.current.label == "brick on 4 walls"
    session.undo(client)
    assert all(p.finish is None for p in session.scene.architecture.planes)
    client.select_surface("floor")
    assert surface_ids(client, all_walls=True) == ("floor",)
