from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.library.record import ShapeLibrary
from diorama_core.render.raycast import MeshCaster
from diorama_core.scene.types import Camera, Scene
from diorama_core.text import scene_from_text
from diorama_core.text.scene_from_text import EYE_M, OBJECT_CLEARANCE_M, best_viewpoint, unmet
from tests.app.small_room import furnished_scene
from tests.primitives import PrimitiveLibrary, box_room, place

LIBRARY = PrimitiveLibrary()
SIZE = (160, 120)


def scene_of(*categories: str) -> Scene:
    one = furnished_scene().objects[0]
    return Scene(objects=tuple(replace(one, id=f"o{k}", category=c) for k, c in enumerate(categories)))


def test_every_request_that_is_not_met_is_named() -> None:
    words = "a bedroom with two lamps, a wardrobe and an armchair"
    assert unmet(words, scene_of("lamp", "bed")) == ("1 of 2 lamps", "no wardrobe", "no armchair")


def test_nothing_is_said_where_all_is_there() -> None:
    assert unmet("a desk with a chair", scene_of("desk", "chair")) == ()


def test_one_object_meets_one_request() -> None:
    lines = unmet("a chair, and an armchair", scene_of("armchair"))
    assert len(lines) == 1


def test_words_of_nothing_are_named() -> None:
    assert any("flurb" in line for line in unmet("a flurb", scene_of()))


@pytest.fixture(autouse=True)
def _few_places(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scene_from_text, "PLACES", 4)


def room(*objects) -> Scene:
    return Scene(architecture=box_room(), objects=objects)


def unseen(scene: Scene, library: ShapeLibrary, camera: Camera) -> frozenset[str]:
    """Ids of the objects that a picture hardly shows."""
    meshes = [(library.mesh(o.shape_id), o.pose.matrix) for o in scene.objects]
    seen = MeshCaster(meshes).buffers(camera.resize(*scene_from_text.PROBE_PX)).instance
    pixels = np.bincount(seen[seen >= 0].ravel(), minlength=len(scene.objects))
    return frozenset(o.id for o, n in zip(scene.objects, pixels, strict=True) if n < scene_from_text.SEEN_PX)


TABLE = place(LIBRARY, "table", "table", (0.5, 3.8, 0.36))


CHAIR = place(LIBRARY, "chair", "chair", (-1.2, 0.8, 0.45))


def test_what_was_asked_for_is_seen_from_where_a_person_can_stand() -> None:
    scene = room(TABLE)
    camera = best_viewpoint(scene, LIBRARY, SIZE, {"table": 1.0})
    assert (camera.intrinsics.width, camera.intrinsics.height) == SIZE
    x, y, z = camera.position
    assert z == pytest.approx(EYE_M)
    assert abs(x) < 2.0 - 0.1
    assert 0.1 < y < 4.9
    corners = camera.project(TABLE.corners_world)
    assert (corners > 0).all()
    assert (corners < SIZE).all()
    assert camera.to_camera(TABLE.corners_world)[:, 2].min() > 0.5
    local = np.abs((camera.position - TABLE.pose.position)[:2])
    assert (local > TABLE.size_m[:2] / 2 + OBJECT_CLEARANCE_M - 1e-6).any()
    assert unseen(scene, LIBRARY, camera) == frozenset()


def test_weights_decide_where_one_looks() -> None:
    scene = room(TABLE, CHAIR)
    for wanted in ("table", "chair"):
        camera = best_viewpoint(scene, LIBRARY, SIZE, {wanted: 1.0})
        assert wanted not in unseen(scene, LIBRARY, camera)


def test_what_is_behind_the_camera_or_another_object_is_unseen() -> None:
    camera = best_viewpoint(room(TABLE), LIBRARY, SIZE, {"table": 1.0})
    behind = place(LIBRARY, "behind", "ball", tuple(camera.position - camera.T_world_camera[:3, 2] * 0.8))
    assert unseen(room(TABLE, behind), LIBRARY, camera) == {"behind"}
    ahead = camera.position + camera.T_world_camera[:3, 2]
    wall_of_ball = place(LIBRARY, "large", "ball", tuple(ahead), scale=(8.0, 8.0, 8.0))
    assert "table" in unseen(room(TABLE, wall_of_ball), LIBRARY, camera)


def test_a_room_without_a_place_to_stand_says_so() -> None:
    tiny = replace(box_room(0.2, 0.2))
    with pytest.raises(ValueError, match="nobody could stand"):
        best_viewpoint(Scene(architecture=tiny), LIBRARY, SIZE, {})
