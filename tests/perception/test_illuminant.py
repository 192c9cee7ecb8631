"""The colour of a room's light."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.perception.illuminant import Illuminant, estimate_illuminant

TUNGSTEN, SHADE = Illuminant((1.25, 1.0, 0.72)), Illuminant((0.85, 1.02, 1.3))


def room(seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """White walls above, patches of many colours below; and where the walls are."""
    rng = np.random.default_rng(seed)
    picture = np.full((120, 160, 3), 205.0)
    picture[60:] = np.repeat(np.repeat(rng.uniform(30, 180, (6, 16, 3)), 10, axis=0), 10, axis=1)
    picture += rng.normal(0, 3, picture.shape)
    walls = np.zeros((120, 160), dtype=bool)
    walls[:60] = True
    return picture.clip(0, 255).astype(np.uint8), walls


def under(light: Illuminant, picture: np.ndarray) -> np.ndarray:
    return np.rint(255 * light.illuminate(picture / 255.0)).astype(np.uint8)


def off_deg(a: Illuminant, b: Illuminant) -> float:
    """Angle between two lights, the usual measure of colour constancy."""
    u, v = np.array(a.rgb), np.array(b.rgb)
    return float(np.degrees(np.arccos(np.clip(u @ v / np.linalg.norm(u) / np.linalg.norm(v), -1, 1))))


@pytest.mark.parametrize("light", [TUNGSTEN, SHADE])
def test_most_of_a_coloured_light_is_found(light):
    picture, walls = room()
    found = estimate_illuminant(under(light, picture), walls)
    assert off_deg(found, light) < 0.4 * off_deg(Illuminant(), light)


def test_white_light_stays_white():
    picture, walls = room()
    assert off_deg(estimate_illuminant(picture, walls), Illuminant()) < 2.0


def test_a_painted_wall_is_not_taken_for_light():
    picture, walls = room()
    green = picture.copy()
    green[:60] = (90, 170, 100)
    assert off_deg(estimate_illuminant(green, walls), Illuminant()) < 6.0


@pytest.mark.parametrize("value", [0, 255])
def test_a_picture_without_information_has_white_light(value):
    assert estimate_illuminant(np.full((50, 60, 3), value, np.uint8), np.zeros((50, 60), dtype=bool)) == Illuminant()


@given(st.lists(st.floats(0.05, 0.7), min_size=3, max_size=3), st.floats(0.8, 1.2), st.floats(0.8, 1.2))
def test_albedo_undoes_light(colour, red, blue):
    light = Illuminant((red, 1.0, blue))
    assert np.allclose(light.albedo(light.illuminate(np.array(colour))), colour, atol=1e-6)


def test_balanced_pictures_agree_with_albedo():
    picture, _ = room()
    expected = TUNGSTEN.albedo(picture / 255.0) * 255
    assert np.abs(TUNGSTEN.white_balance(picture) - expected).max() <= 0.51


@pytest.mark.parametrize("light", [TUNGSTEN, SHADE])
def test_half_of_a_light_applied_twice_is_the_light(light):
    half = light.partly(0.5)
    assert off_deg(half, Illuminant()) < off_deg(light, Illuminant())
    colour = np.array([0.4, 0.35, 0.3])
    np.testing.assert_allclose(half.albedo(half.albedo(colour)), light.albedo(colour), atol=0.02)
    assert off_deg(light.partly(1.0), light) < 1e-5
    assert off_deg(light.partly(0.0), Illuminant()) < 1e-5
