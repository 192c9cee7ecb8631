"""What a page is told of the walls that fade."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_app.panels.walls import what_fades
from diorama_core.scene.types import Scene, Support
from tests.app.small_room import furnished_scene


def told(scene: Scene, selection: tuple[str, ...] = ()) -> dict:
    return what_fades(scene, lambda i: f"/room/{i}", lambda i: f"/objects/{i}", selection, 200)


def seen_from_behind(row: list, eye: tuple[float, float, float]) -> bool:
    return float(np.dot(row[1], eye)) < row[2]


def test_planes_between_an_eye_outside_and_the_room_are_told_apart_from_those_beyond() -> None:
    rows = {row[0]: row for row in told(furnished_scene())["planes"]}
    assert len(rows) == len(furnished_scene().architecture.planes)
    inside = (0.0, 1.4, 1.2)
    assert not [name for name, row in rows.items() if seen_from_behind(row, inside)], "inside nothing fades"
    behind = [name for name, row in rows.items() if seen_from_behind(row, (0.0, 9.0, 1.2))]
    assert behind == ["/room/wall_3"]
    above = [name for name, row in rows.items() if seen_from_behind(row, (0.0, 1.4, 9.0))]
    assert above == ["/room/ceiling"]
    assert rows["/room/ceiling"][3] == 0.0, "seen from above there is no ceiling"


def test_what_hangs_fades_with_its_wall_and_so_does_what_stands_on_it() -> None:
    scene = furnished_scene()
    assert [row[0] for row in told(scene)["hung"]] == ["/objects/picture_1"]
    edges = tuple(Support("lamp_1", "picture_1") if s.child == "lamp_1" else s for s in scene.supports)
    names = {row[0] for row in told(replace(scene, supports=edges))["hung"]}
    assert names == {"/objects/picture_1", "/objects/lamp_1"}


def test_what_is_selected_stays_solid() -> None:
    row = told(furnished_scene(), ("picture_1",))["hung"][0]
    assert row[3] == 1.0
