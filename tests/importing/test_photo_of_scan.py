"""A photo of a room that RoomPlan scanned: looks and kinds come from it, walls and boxes stay as measured."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_app.cli import main
from diorama_core.artefacts import Inputs
from diorama_core.evaluation.benchmarks.cases import recipe as recipe_of_rooms
from diorama_core.evaluation.benchmarks.views import photograph
from diorama_core.importing.opening import Opened
from diorama_core.importing.photo_of_scan import with_photo_of_scan
from diorama_core.importing.roomplan_parts import KINDS
from diorama_core.importing.scene_import import import_scene
from diorama_core.layout.recipes import recipe
from diorama_core.library.catalogue import built_in_library
from diorama_core.multiview.one_scene import move_to_room
from diorama_core.pipeline.stages import embedded_stages
from diorama_core.scene.types import Scene
from diorama_core.synthesis.artefacts import photo_only
from diorama_core.synthesis.splits import split_library
from diorama_core.synthesis.truth import TruthView
from tests.few_shapes import few_shapes
from tests.importing.roomplan_files import TO_SCAN, write_scan_of
from tests.made_once import made_once

KNOWN = frozenset(kind for kinds in KINDS.values() for kind in kinds)


@cache
def room(number: int = 0) -> tuple[Scene, TruthView, np.ndarray]:
    """A furnished room, a photo of it, and where that was taken, in the room's own frame."""
    case = recipe_of_rooms(number + 1, 1, 0)[number]
    tested = split_library(built_in_library(), "test")
    view = made_once(f"photo of {case.name}", lambda: photograph(case, tested, 1)[0])
    there = view.camera.T_world_camera @ np.linalg.inv(view.truth.camera.T_world_camera)
    scene = view.truth.scene
    return move_to_room(scene, there), view.truth, view.camera.position


def joined(opened: Opened, inputs: Inputs) -> Opened:
    library = few_shapes(opened.scene)
    return with_photo_of_scan(
        opened, inputs, library, lambda given: embedded_stages(given, library),
        lambda free: recipe("feasible", library, free, depth_measured=True),
    )  # fmt: skip


def in_scan(scene: Scene, points: np.ndarray) -> np.ndarray:
    return points @ TO_SCAN[:3, :3].T + TO_SCAN[:3, 3]


@pytest.mark.slow
def test_looks_and_kinds_come_from_the_photo_and_boxes_stay(tmp_path: Path) -> None:
    scene, truth, place = room()
    opened = import_scene(write_scan_of(tmp_path / "room.json", scene)).opened
    whole = photo_only(truth)
    marked = tuple(b for b in whole.boxes if b.category in KNOWN or b.category in ("door", "window", "plant"))
    found = joined(opened, replace(whole, boxes=marked))
    after, before = found.scene, opened.scene
    assert [o.id for o in after.objects[: len(before.objects)]] == [o.id for o in before.objects]
    # One rigid motion, upright, takes the scan to the new scene: nothing was moved by itself.
    a = np.vstack([o.corners_world.mean(axis=0) for o in before.objects])
    b = np.vstack([after.object(o.id).corners_world.mean(axis=0) for o in before.objects])
    R, t = _rigid(a, b)
    np.testing.assert_allclose(a @ R.T + t, b, atol=1e-6)
    for item in before.objects:
        np.testing.assert_allclose(after.object(item.id).size_m, item.size_m, atol=1e-6)
    for wall in before.architecture.planes:
        np.testing.assert_allclose(after.plane(wall.id).polygon, wall.polygon @ R.T + t, atol=1e-6)
    floor = after.architecture.floor
    np.testing.assert_allclose(floor.polygon[:, 2], 0.0, atol=1e-6)
    # Where the photo was taken, through both frames.
    true_place = in_scan(scene, place[None])[0] @ R.T + t
    assert np.linalg.norm(after.camera.position - true_place) < 0.35
    seen = [o for o in after.objects if o.box_px is not None]
    scanned = [o for o in seen if o.id in {b.id for b in before.objects}]
    assert len(scanned) >= 4
    for item in scanned:
        own = min(truth.scene.objects, key=lambda o: np.abs(np.subtract(o.box_px or (9e9,) * 4, item.box_px)).max())
        assert item.category == own.category, "as it is marked in the photo"
    coloured = [o for o in scanned if o.colour is not None or o.photo_materials]
    assert 2 * len(coloured) >= len(scanned)
    assert not any(o.colour is not None or o.photo_materials for o in before.objects)
    assert len(after.objects) > len(before.objects), "what RoomPlan has no word for comes from the photo"
    assert floor.texture in found.textures
    assert len(found.inputs.boxes) == len(marked)


@pytest.mark.slow
def test_a_photo_of_another_room_is_one_line_and_no_project(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write_scan_of(tmp_path / "room.json", room()[0])
    inputs = photo_only(room(3)[1])
    Image.fromarray(inputs.photo.rgb).save(tmp_path / "kitchen.png")
    rows = [{"bbox": list(b.box), "class": b.category} for b in inputs.boxes]
    (tmp_path / "boxes.json").write_text(json.dumps(rows))
    asked = ["import", str(path), "-o", str(tmp_path / "out"), "--photo", str(tmp_path / "kitchen.png")]
    assert main([*asked, "--boxes", str(tmp_path / "boxes.json")]) != 0
    said = capsys.readouterr().err.strip().splitlines()[-1]
    assert "kitchen.png does not join the scan" in said
    assert not (tmp_path / "out" / "scene.json").exists()


def test_boxes_without_a_photo_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write_scan_of(tmp_path / "room.json", room()[0])
    assert main(["import", str(path), "-o", str(tmp_path / "out"), "--boxes", "boxes.json"]) != 0
    assert "--photo" in capsys.readouterr().err


def _rigid(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The rotation and shift that take points to points (Kabsch)."""
    u, _, vt = np.linalg.svd((a - a.mean(0)).T @ (b - b.mean(0)))
    d = np.diag([1.0, 1.0, np.sign(np.linalg.det(vt.T @ u.T))])
    R = vt.T @ d @ u.T
    return R, b.mean(0) - R @ a.mean(0)
