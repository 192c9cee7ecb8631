"""Sizes of pictures that the page can make."""

from __future__ import annotations

import pytest

from diorama_app.reconstruction.picture_job import MAX_FILM_WIDTH, MAX_WIDTH, film_suffix, picture_size, take_picture
from diorama_app.session.client import Client
from diorama_core.errors import EditRefused, InputError
from diorama_core.scene.types import Architecture, Scene


def test_sizes_follow_the_photo_the_view_and_what_films_need(client: Client) -> None:
    camera = client.session.scene.camera
    assert camera is not None
    width, height = picture_size(client, "photo", 800)
    assert width == 800
    assert height == round(800 * camera.intrinsics.height / camera.intrinsics.width)
    film = picture_size(client, "turntable", 641)
    assert film[0] % 2 == film[1] % 2 == 0
    assert film[0] == 640
    assert film_suffix() in (".gif", ".mp4")


@pytest.mark.parametrize(("view", "width"), [("here", 15), ("photo", MAX_WIDTH + 1), ("turntable", MAX_FILM_WIDTH + 1)])
def test_widths_beyond_the_limits_are_refused_in_one_line(client: Client, view: str, width: int) -> None:
    with pytest.raises(InputError, match=f"{width} pixels wide"):
        picture_size(client, view, width)


def test_nothing_to_draw_is_said(client: Client) -> None:
    client.session.commit("empty", Scene(camera=None, architecture=Architecture(())))
    with pytest.raises(EditRefused, match="nothing to draw"):
        take_picture(client, "here", 640)
