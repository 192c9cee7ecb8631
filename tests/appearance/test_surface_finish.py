from __future__ import annotations

from dataclasses import replace
from typing import get_args

import cv2
import numpy as np
import pytest

from diorama_core.appearance.patterns import COLOURS
from diorama_core.appearance.surface_finish import (
    KINDS,
    USUAL,
    finish_name,
    finish_picture,
    usual_finish,
    with_finish_pictures,
)
from diorama_core.scene.room_edits import move_plane, set_surface_finish
from diorama_core.scene.types import SurfaceFinish, SurfacePattern
from tests.app.small_room import furnished_scene

SCENE = furnished_scene()


def test_every_pattern_of_the_scene_file_can_be_made_and_every_offer_exists() -> None:
    assert set(KINDS) == set(get_args(SurfacePattern))
    assert {p for offered in USUAL.values() for p in offered} == set(KINDS)
    assert all(c in COLOURS for kind in KINDS.values() for c in kind.colours)
    assert all(len(set(kind.colours)) == len(kind.colours) for kind in KINDS.values())


def test_a_picture_has_the_plane_s_proportions_and_a_bounded_size() -> None:
    height, width, _ = finish_picture(usual_finish("boards"), "floor", (40.0, 10.0)).shape
    assert width == 1600
    assert height == 400


def test_direction_turns_the_pattern_and_scale_makes_it_larger() -> None:
    stripes = replace(usual_finish("stripes"), colour=(0.8, 0.6, 0.4))
    upright = finish_picture(stripes, "ceiling", (2.0, 2.0))
    lying = finish_picture(replace(stripes, direction_rad=np.pi / 2), "ceiling", (2.0, 2.0))

    def across(picture: np.ndarray) -> float:
        return float(picture[..., 0].astype(float).mean(axis=0).std())

    def down(picture: np.ndarray) -> float:
        return float(picture[..., 0].astype(float).mean(axis=1).std())

    assert across(upright) > 4 * down(upright)
    assert down(lying) > 4 * across(lying)
    large = finish_picture(replace(stripes, scale=2.0), "ceiling", (2.0, 2.0))
    assert _dominant_period(large) == pytest.approx(2 * _dominant_period(upright), rel=0.1)


def test_a_positive_direction_turns_counter_clockwise_seen_from_the_room() -> None:
    """Rows of a picture run downward: boards turned by 30 degrees rise to the right."""
    boards = replace(usual_finish("boards"), direction_rad=np.pi / 6)
    grey = cv2.cvtColor(finish_picture(boards, "floor", (3.0, 3.0)), cv2.COLOR_RGB2GRAY).astype(np.float32)
    gx, gy = cv2.Sobel(grey, cv2.CV_32F, 1, 0), cv2.Sobel(-grey, cv2.CV_32F, 0, 1)
    # The structure tensor's strongest direction is across the boards.
    across = 0.5 * np.arctan2(2 * (gx * gy).sum(), (gx**2 - gy**2).sum())
    along = np.degrees(across) - 90.0
    assert (along + 90) % 180 - 90 == pytest.approx(30.0, abs=3.0)


def test_planes_name_pictures_that_are_made_once_and_anew_for_another_size() -> None:
    finished = set_surface_finish(SCENE, ("wall_2",), usual_finish("leaves"))
    named, made = with_finish_pictures(finished, {})
    name = named.plane("wall_2").texture
    assert name is not None
    assert set(made) == {name}
    assert name == finish_name(finished.plane("wall_2"))
    assert with_finish_pictures(named, made) == (named, {})
    moved, more = with_finish_pictures(move_plane(named, "wall_3", 0.5), made)
    assert moved.plane("wall_2").texture not in (None, name)
    assert set(more) == {moved.plane("wall_2").texture}
    assert finish_name(SCENE.plane("floor")) is None


def test_a_wall_has_a_skirting_board_only_below_paint_and_paper() -> None:
    dark = SurfaceFinish("paint", (0.2, 0.2, 0.2))
    assert finish_picture(dark, "wall", (2.0, 2.0))[-4:].min() > 150
    assert finish_picture(dark, "ceiling", (2.0, 2.0))[-4:].max() < 100
    assert finish_picture(replace(dark, pattern="plaster"), "wall", (2.0, 2.0))[-4:].max() < 100


def _dominant_period(picture: np.ndarray) -> float:
    row = picture[..., 0].astype(float).mean(axis=0)
    spectrum = np.abs(np.fft.rfft(row - row.mean()))
    return len(row) / float(np.argmax(spectrum))
