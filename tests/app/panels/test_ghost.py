from __future__ import annotations

import json

import numpy as np

from diorama_app.commands.insert import start_placing
from diorama_app.panels.ghost import PlacingGhost, ghost_data
from diorama_core.library.record import Shape
from tests.app.small_room import PlainLibrary, furnished_scene


def test_the_page_is_told_every_surface_and_how_the_thing_stands() -> None:
    scene, library = furnished_scene(), PlainLibrary()
    about = ghost_data(scene, library, library.shape("chair_a"))
    json.dumps(about)
    assert about["size"] == [0.5, 0.46, 0.86]
    assert not about["hung"]
    assert not about["door"]
    floor = next(s for s in about["surfaces"] if s["up"] and s["level"] == 0.0)
    inside = np.array(floor["outward"]) @ np.array([0.0, 1.0, 0.0])
    assert (inside <= floor["offset"]).all()
    outside = np.array(floor["outward"]) @ np.array([9.0, 1.0, 0.0])
    assert not (outside <= floor["offset"]).all()
    door = Shape(id="d", category="door", caption="", size_m=(0.1, 0.9, 2.0))
    assert ghost_data(scene, library, door)["door"]


def test_it_comes_with_placing_and_goes_with_escape(session, client, page) -> None:
    ghost = page.put(PlacingGhost)
    assert ghost._node is None
    start_placing(client, "chair_a")
    assert ghost._node is not None
    assert "__dioGhost({" in page.html
    client.doing = None
    client.refresh()
    assert ghost._node is None
    assert "__dioGhost(null)" in page.html
