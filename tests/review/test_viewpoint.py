"""Where objects may be, and from where another photo would tell."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.review.viewpoint import next_photo, place_outline
from diorama_core.scene.belief import Belief
from diorama_core.scene.types import Scene
from tests.app.small_room import furnished_scene


def unsure(sigma_m: float) -> Scene:
    """The small room, in which nothing is sure of its place."""
    scene = furnished_scene()
    return replace(scene, objects=tuple(replace(o, belief=Belief(place_sigma_m=sigma_m)) for o in scene.objects))


def test_the_ellipse_is_long_along_the_line_of_sight() -> None:
    scene = unsure(0.4)
    assert scene.camera is not None
    item = scene.object("chair_1")
    outline = place_outline(scene, item)
    assert outline is not None
    sight = item.pose.position[:2] - scene.camera.position[:2]
    sight /= np.linalg.norm(sight)
    away = outline - item.pose.position[:2]
    assert np.abs(away @ sight).max() == pytest.approx(0.4)
    assert np.abs(away @ [-sight[1], sight[0]]).max() == pytest.approx(0.05)
    assert place_outline(scene, furnished_scene().object("chair_1")) is None, "nothing is known of it"


def test_another_photo_is_taken_inside_the_room_and_from_the_side() -> None:
    scene = unsure(0.5)
    photo = next_photo(scene)
    assert photo is not None
    assert scene.camera is not None
    assert photo.objects >= 2
    floor = scene.architecture.floor
    assert floor is not None
    low, high = floor.polygon[:, :2].min(axis=0), floor.polygon[:, :2].max(axis=0)
    assert (np.array(photo.position) > low).all()
    assert (np.array(photo.position) < high).all()
    target = scene.object("table_1").pose.position[:2]
    first, second = target - scene.camera.position[:2], target - np.array(photo.position)
    angle = np.degrees(np.arccos(first @ second / np.linalg.norm(first) / np.linalg.norm(second)))
    assert angle > 25


def test_where_places_are_sure_nobody_is_sent() -> None:
    assert next_photo(unsure(0.02)) is None
    assert next_photo(furnished_scene()) is None
    assert next_photo(replace(unsure(0.5), camera=None)) is None
