from __future__ import annotations

import numpy as np
import pytest

from diorama_core.geometry.sun import daylight, sun_direction

NORTH = np.pi / 2


def test_the_sun_rises_in_the_east_stands_in_the_south_and_sets_in_the_west() -> None:
    np.testing.assert_allclose(sun_direction(6.0, NORTH), [1.0, 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(sun_direction(12.0, NORTH), [0.0, -np.sqrt(0.5), np.sqrt(0.5)], atol=1e-12)
    np.testing.assert_allclose(sun_direction(18.0, NORTH), [-1.0, 0.0, 0.0], atol=1e-12)
    assert sun_direction(0.0, NORTH)[2] < -0.5


@pytest.mark.parametrize("hour", [0.0, 7.3, 12.0, 20.0])
def test_turning_north_turns_the_sun(hour: float) -> None:
    x, y, z = sun_direction(hour, NORTH)
    turned = sun_direction(hour, NORTH + np.pi / 2)
    np.testing.assert_allclose(turned, [-y, x, z], atol=1e-12)
    assert np.linalg.norm(turned) == pytest.approx(1.0)


def test_light_grows_whiter_and_stronger_toward_noon_and_is_nearly_gone_at_night() -> None:
    morning, noon, night = (daylight(h, NORTH) for h in (6.6, 12.0, 1.0))
    assert (noon.sun > morning.sun).all()
    assert morning.sun[2] / morning.sun[0] < 0.6 * noon.sun[2] / noon.sun[0], "low sun is red"
    assert not night.sun.any()
    assert noon.sky.max() == pytest.approx(1.0, abs=0.01)
    assert 0.0 < night.sky.max() < 0.1
