"""The lights of a page: an even one, and the photo's main light from its side."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
import viser

from diorama_app.web.lights import MAIN_LIGHT_AWAY_M, MAIN_LIGHT_EVEN, add_even_light, add_main_light
from diorama_app.web.viser_adapter import stop_server
from diorama_core.scene.types import RoomLight


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    made = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    yield made
    stop_server(made)


def test_the_main_light_comes_from_its_side_and_grows_with_its_strength(server: viser.ViserServer) -> None:
    add_even_light(server.scene, sky=1.0, around=0.9)
    direction = np.array([0.6, 0.0, 0.8])
    weak, strong = (
        add_main_light(server.scene, RoomLight((0.6, 0.0, 0.8), strength, (1.0, 0.5, 0.0)), cast_shadow=False)
        for strength in (0.0, 1.0)
    )
    np.testing.assert_allclose(strong.position, MAIN_LIGHT_AWAY_M * direction)
    assert weak.intensity == pytest.approx(MAIN_LIGHT_EVEN)
    assert strong.intensity > 2 * weak.intensity
    assert tuple(strong.color) == (255, 128, 0)


def test_light_from_below_is_shown_from_above(server: viser.ViserServer) -> None:
    light = add_main_light(server.scene, RoomLight((0.0, 0.6, -0.8), 0.5), cast_shadow=False)
    assert light.position[2] == 1.0
