from __future__ import annotations

import pytest

from diorama_app.commands.light import clock, set_hour, switch_all, use_daylight
from diorama_core.scene.light_settings import LightSettings


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
