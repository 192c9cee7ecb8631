"""CIEDE2000 against the published pairs (Sharma, Wu and Dalal 2005, table 1)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.evaluation.metrics.colour import (
    HALF_LIGHTNESS,
    delta_e_2000,
    lab_of,
    light_error_deg,
    main_light,
    perceptual_difference,
    visible_colours,
)
from diorama_core.library.catalogue import built_in_library
from diorama_core.render.lighting import room_lighting
from diorama_core.scene.types import Pose, RoomLight, Scene, SceneObject
from tests.pose.rooms import camera_at
from tests.synthetic_rooms import look

PUBLISHED = (
    ((50.0, 2.6772, -79.7751), (50.0, 0.0, -82.7485), 2.0425),
    ((50.0, -1.3802, -84.2814), (50.0, 0.0, -82.7485), 1.0),
    ((50.0, 0.0, 0.0), (50.0, -1.0, 2.0), 2.3669),
    ((50.0, 2.49, -0.001), (50.0, -2.49, 0.0009), 7.1792),
    ((50.0, 2.5, 0.0), (73.0, 25.0, -18.0), 27.1492),
    ((50.0, 2.5, 0.0), (58.0, 24.0, 15.0), 19.4535),
    ((60.2574, -34.0099, 36.2677), (60.4626, -34.1751, 39.4387), 1.2644),
    ((22.7233, 20.0904, -46.6940), (23.0331, 14.9730, -42.5619), 2.0373),
    ((90.8027, -2.0831, 1.4410), (91.1528, -1.6435, 0.0447), 1.4441),
    ((2.0776, 0.0795, -1.1350), (0.9033, -0.0636, -0.5514), 0.9082),
)
unit = st.floats(0.0, 1.0, width=32)
colours = st.tuples(unit, unit, unit).map(np.array)


@pytest.mark.parametrize(("first", "second", "expected"), PUBLISHED)
def test_the_published_pairs(first, second, expected) -> None:
    assert delta_e_2000(np.array(first), np.array(second)) == pytest.approx(expected, abs=1e-4)


@given(colours, colours)
def test_it_is_symmetric_and_nothing_for_equal_colours(a, b) -> None:
    assert perceptual_difference(a, b) == pytest.approx(perceptual_difference(b, a), abs=1e-6)
    assert perceptual_difference(a, a) == pytest.approx(0.0, abs=1e-6)


@given(unit, unit)
def test_grays_differ_half_as_much_with_lightness_at_half_weight(a, b) -> None:
    first, second = lab_of(np.full(3, a)) * (1, 0, 0), lab_of(np.full(3, b)) * (1, 0, 0)
    half = delta_e_2000(first, second, HALF_LIGHTNESS)
    assert half == pytest.approx(delta_e_2000(first, second) / 2, abs=1e-9)


BOUNDS = np.array([[-2.0, -2.0, 0.0], [2.0, 2.0, 2.5]])


@pytest.mark.parametrize("direction", [(0.0, 0.0, 1.0), (0.8, 0.0, 0.6), (0.0, -0.6, 0.8)])
def test_the_main_light_of_pictures_is_the_one_they_were_made_with(direction: tuple[float, float, float]) -> None:
    found = main_light(room_lighting(BOUNDS, RoomLight(direction, 0.5)), BOUNDS.mean(axis=0)[None])
    assert np.degrees(np.arccos(found @ np.array(direction) / np.linalg.norm(found))) < 8.0


def test_directions_are_compared_as_the_photo_sees_them() -> None:
    camera = camera_at()
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    T = camera.T_world_camera.copy()
    T[:3, :3] = turn @ T[:3, :3]
    turned = replace(camera, T_world_camera=T)
    true, found = np.array([0.6, 0.0, 0.8]), RoomLight((0.0, 0.6, 0.8), 0.4)
    assert light_error_deg(true, camera, found, turned) == pytest.approx(0.0, abs=1e-4)
    assert light_error_deg(true, camera, found, camera) == pytest.approx(50.2, abs=0.1)
    assert light_error_deg(true, camera, None, camera) is None


@pytest.fixture(scope="module")
def library():
    return built_in_library()


def seen(library, shape_id, **changes):
    shape = library.shape(shape_id)
    item = SceneObject(
        id="a", label="a", category=shape.category, shape_id=shape.id, shape_size_m=shape.size_m,
        pose=Pose.upright((0.0, 3.0, shape.size_m[2] / 2), -np.pi / 2),
    )  # fmt: skip
    return visible_colours(Scene(camera=look(0, 12), objects=(replace(item, **changes),)), library)


def test_paint_shows(library):
    red = seen(library, "sofa-grey-three", colour=(0.7, 0.1, 0.1))["a"]
    assert red[0] > 2.5 * red[1]


def test_the_shapes_own_colour_shows_without_paint(library):
    grey = seen(library, "sofa-grey-three")["a"]
    assert np.ptp(grey) < 0.1


def test_what_is_out_of_view_is_left_out(library):
    assert seen(library, "sofa-grey-three", pose=Pose.upright((0.0, -3.0, 0.4))) == {}
