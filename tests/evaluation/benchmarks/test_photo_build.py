"""Ghosts on a floor's picture: what differs from its colour, lightness in full."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_core.errors import InputError
from diorama_core.evaluation.benchmarks.photo_build import (
    SIZE,
    case_picture,
    case_writer,
    ghost_share,
    side_by_side,
    usual_colour,
    write_picture,
)
from diorama_core.pipeline.run import Built
from diorama_core.scene.types import Scene
from tests.built import built_scene
from tests.evaluation.truth import blank_view
from tests.primitives import PrimitiveLibrary, box_room, place
from tests.synthetic_rooms import look


def test_ghosts_are_what_differs_from_the_floor():
    floor = np.full((100, 100, 3), (150, 120, 90), np.uint8)
    colour = usual_colour(floor)
    assert ghost_share(floor, colour) == 0.0
    floor[:50, :40] = (40, 90, 60)
    assert ghost_share(floor, colour) == pytest.approx(0.2)
    floor[:50, :40] = (75, 60, 45)  # a dark smear of the floor's own hue
    assert ghost_share(floor, colour) == pytest.approx(0.2)
    floor[:50, :40] = (135, 108, 80)
    assert ghost_share(floor, colour) == 0.0


LIBRARY = PrimitiveLibrary()
VIEW = blank_view(Scene(), (80, 60), 200)


def built(camera: bool = True) -> Built:
    scene = Scene(look(size=(80, 60)) if camera else None, box_room(), (place(LIBRARY, "t", "table", (0, 2.5, 0.36)),))
    return built_scene(scene)


def test_a_strip_is_the_photo_and_two_views_of_every_result() -> None:
    width, height = SIZE
    strip = case_picture(VIEW, (built(), None), LIBRARY)
    assert strip.shape == (height, 5 * width + 4 * 4, 3)
    panels = [strip[:, k * (width + 4) : k * (width + 4) + width] for k in range(5)]
    assert (panels[0] == 200).all()
    assert panels[1].std() > 5
    assert panels[2].std() > 5
    assert (panels[3] == 128).all()
    assert (panels[4] == 128).all()


def test_a_scene_without_a_camera_is_seen_from_outside_only() -> None:
    width = SIZE[0]
    strip = case_picture(VIEW, (built(camera=False),), LIBRARY)
    assert (strip[:, width + 4 : 2 * width + 4] == 128).all()
    assert strip[:, 2 * width + 8 :].std() > 5


def test_every_case_is_written_by_its_name(tmp_path: Path) -> None:
    show = case_writer(tmp_path / "cases", LIBRARY)
    show("living-3-0", VIEW, (None,))
    assert Image.open(tmp_path / "cases" / "living-3-0.jpg").size == (3 * SIZE[0] + 8, SIZE[1])


def test_pictures_are_png_or_jpeg(tmp_path: Path) -> None:
    red = np.zeros((4, 6, 3), np.uint8)
    red[..., 0] = 255
    write_picture(tmp_path / "a.PNG", red)
    np.testing.assert_array_equal(np.asarray(Image.open(tmp_path / "a.PNG")), red)
    with pytest.raises(InputError, match=r"written as \.png or \.jpg"):
        write_picture(tmp_path / "a.gif", red)


def test_side_by_side_keeps_the_photo_and_the_rendering_s_aspect() -> None:
    photo = np.full((100, 150, 3), 7, np.uint8)
    both = side_by_side(photo, np.full((50, 80, 3), 9, np.uint8), gap=4)
    assert both.shape == (100, 150 + 4 + 160, 3)
    assert (both[:, :150] == 7).all()
    assert (both[:, 154:] == 9).all()
