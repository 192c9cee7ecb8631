from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.editing.sunlight import first_daylight, set_light, sun_azimuth, switch_lamp, with_sun_from
from diorama_core.errors import EditRefused
from diorama_core.geometry.sun import sun_direction
from diorama_core.scene.light_settings import PHOTO_LIGHT, LightSettings
from diorama_core.scene.types import RoomLight, Scene
from tests.geometry.test_sun import room


def test_daylight_begins_with_the_noon_sun_before_the_largest_window() -> None:
    settings = first_daylight(room())
    noon = sun_direction(12.0, settings.north_rad)
    assert noon[1] == pytest.approx(np.sqrt(0.5)), "the window is in the far wall"
    assert settings.hour is not None


def test_without_windows_it_shines_from_where_the_photos_light_does() -> None:
    scene = replace(Scene(), light=RoomLight((-1.0, 0.0, 0.0)))
    assert sun_direction(12.0, first_daylight(scene).north_rad)[0] == pytest.approx(-np.sqrt(0.5))


@pytest.mark.parametrize("azimuth", [-2.0, 0.0, 3.0])
def test_the_sun_is_turned_by_hand(azimuth: float) -> None:
    settings = with_sun_from(LightSettings(hour=9.0), azimuth)
    assert sun_azimuth(9.0, settings.north_rad) == pytest.approx(azimuth)
    with pytest.raises(EditRefused, match="time of day"):
        with_sun_from(PHOTO_LIGHT, azimuth)


def test_lamps_are_switched_one_by_one_and_forgotten_with_their_object() -> None:
    scene = room()
    scene = set_light(scene, switch_lamp(scene, "window_1", on=True))
    assert scene.light_settings.lamps_on == ("window_1",)
    assert switch_lamp(scene, "window_1", on=False).lamps_on == ()
    assert set_light(scene, LightSettings(lamps_on=("gone", "window_1"))).light_settings.lamps_on == ("window_1",)
