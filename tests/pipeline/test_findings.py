from __future__ import annotations

from dataclasses import dataclass

import pytest

from diorama_core.artefacts import Cuboid
from diorama_core.pipeline.findings import drawing, finding
from diorama_core.scene.types import Camera
from tests.app.small_room import furnished_scene


class Room:
    architecture = furnished_scene().architecture


@pytest.mark.unchecked
@pytest.mark.parametrize(
    ("name", "artefact", "words"),
    [
        ("outlined_objects", [1], "1 object"),
        ("detected_boxes", [1, 2], "2 pieces of furniture"),
        ("shapes", [1, 2, 3], "shapes for 3 objects"),
        ("architecture", Room(), "4 walls"),
        ("architecture", None, ""),
        ("posed", [1], ""),
    ],
)
def test_what_was_found_is_told_in_a_few_words(name: str, artefact: object, words: str) -> None:
    assert finding(name, artefact) == words


@dataclass(frozen=True)
class Measured:
    camera: Camera
    cuboids: tuple[Cuboid, ...]


@pytest.mark.unchecked
def test_cuboids_and_the_room_are_drawn_over_the_photo_as_soon_as_they_are_known() -> None:
    scene = furnished_scene()
    assert scene.camera is not None
    boxes = [Cuboid(o.id, o.pose.R_world_object, o.pose.position, o.size_m, 1.0) for o in scene.objects]
    known = {"measured_geometry": Measured(scene.camera, tuple(boxes)), "architecture": Room(), "posed": [1]}
    lines = drawing("measured_geometry", known)
    assert 0 < len(lines) <= 12 * len(boxes)
    corners = scene.camera.project(boxes[0].corners_world)
    assert any(abs(x - corners[0][0]) < 0.1 and abs(y - corners[0][1]) < 0.1 for x, y, _, _ in lines)
    assert 0 < len(drawing("architecture", known)) <= sum(len(p.polygon) for p in Room.architecture.planes)
    assert drawing("posed", known) == ()
    assert drawing("architecture", {**known, "architecture": None}) == ()
