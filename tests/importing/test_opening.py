"""What comes back from a file: every object in its place, and the photo where the file holds it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from diorama_core.errors import InputError
from diorama_core.export import export_scene
from diorama_core.export.gathering import ExportOptions
from diorama_core.export.pictures import photo_text
from diorama_core.importing.forms import read_mark
from diorama_core.importing.marked import as_bytes
from diorama_core.importing.opening import open_marked, pose_of
from diorama_core.scene.types import Scene
from tests.export.scenes import scene_of
from tests.importing.test_gltf import edited


def photo_of(scene: Scene) -> np.ndarray:
    """A smooth picture of the camera's size."""
    k = scene.camera.intrinsics
    across = np.linspace(20, 220, k.width)[None, :, None] + np.array([0.0, 15.0, 30.0])
    return np.broadcast_to(across, (k.height, k.width, 3)).astype(np.uint8)


@pytest.mark.parametrize("suffix", ["glb", "usdc", "usdz"])
def test_the_photo_comes_back_where_it_was_put_in(suffix: str, tmp_path: Path) -> None:
    if suffix != "glb":
        pytest.importorskip("pxr", reason="OpenUSD is not installed (optional extra 'usd')")
    scene, library = scene_of("fittings")
    path, options = tmp_path / f"room.{suffix}", ExportOptions(photo=True)
    export_scene(scene, library, path, suffix, photo=photo_of(scene), options=options, provenance={"photo": "room.jpg"})
    opened = open_marked(read_mark(path))
    assert opened.changes == ()
    assert opened.inputs.photo.name == "room.jpg"
    assert opened.inputs.intrinsics == scene.camera.intrinsics
    np.testing.assert_allclose(opened.inputs.photo.rgb.astype(int), photo_of(scene).astype(int), atol=6)


def test_a_file_without_its_photo_says_so(tmp_path: Path) -> None:
    scene, library = scene_of("fittings")
    path = tmp_path / "room.glb"
    export_scene(scene, library, path, "glb", photo=photo_of(scene), provenance={"photo": "room.jpg"})
    assert b"diorama_photo" not in path.read_bytes()
    opened = open_marked(read_mark(path))
    assert opened.inputs is None
    assert opened.changes == ("room.jpg is not in the file; export it again with its photo",)


@pytest.mark.parametrize(("photo", "said"), [(b"no picture", "cannot be read"), (b"", "not of the camera's size")])
def test_a_photo_that_cannot_be_used_is_left_out(photo: bytes, said: str, tmp_path: Path) -> None:
    scene, library = scene_of("fittings")
    export_scene(scene, library, tmp_path / "room.glb", "glb")
    marked = read_mark(tmp_path / "room.glb")
    small = as_bytes(photo_text(np.zeros((300, 400, 3), np.uint8)))
    opened = open_marked(replace(marked, photo=photo or small))
    assert opened.photo is None
    assert len(opened.changes) == 1
    assert said in opened.changes[0]


def test_text_that_is_no_bytes_is_none() -> None:
    assert as_bytes("not base 64!") is None
    assert as_bytes(None) is None
    assert as_bytes("") is None


def boxes(scene: Scene) -> dict[str, np.ndarray]:
    """World box of every object: lower and upper corner."""
    return {o.id: np.stack([o.corners_world.min(axis=0), o.corners_world.max(axis=0)]) for o in scene.objects}


def move_node(path: Path, object_id: str, by_m: np.ndarray) -> None:
    """Move an object's node in a GLB, as a program would that knows nothing of Diorama."""
    with edited(path) as document:
        node = next(n for n in document["nodes"] if n.get("extras", {}).get("id") == object_id)
        node["translation"] = [float(v + d) for v, d in zip(node["translation"], by_m, strict=True)]


def move_prim(path: Path, object_id: str, by_m: np.ndarray) -> None:
    """Move an object's prim in a USD file."""
    from pxr import Gf, Usd, UsdGeom

    stage = Usd.Stage.Open(str(path))
    ops = UsdGeom.Xformable(stage.GetPrimAtPath(f"/Scene/Objects/{object_id}")).GetOrderedXformOps()
    place = next(o for o in ops if o.GetOpName() == "xformOp:translate")
    place.Set(place.Get() + Gf.Vec3d(*(float(d) for d in by_m)))
    stage.Save()


@pytest.mark.parametrize(
    ("suffix", "compression", "move"),
    [
        ("glb", "none", move_node),
        ("glb", "meshopt", move_node),
        ("glb", "draco", move_node),
        ("usda", "none", move_prim),
        ("usdc", "none", move_prim),
        ("usdz", "none", None),  # a package is changed by writing it anew
    ],
)
def test_boxes_come_back_within_a_millimetre_and_one_that_was_moved_at_its_new_place(
    suffix: str, compression: Any, move: Callable[[Path, str, np.ndarray], None] | None, tmp_path: Path
) -> None:
    if suffix != "glb":
        pytest.importorskip("pxr", reason="OpenUSD is not installed (optional extra 'usd')")
    if compression == "draco":
        pytest.importorskip("DracoPy", reason="DracoPy is not installed (optional extra 'draco')")
    scene, library = scene_of("fittings")
    path, expected = tmp_path / f"room.{suffix}", boxes(scene)
    export_scene(scene, library, path, suffix, options=ExportOptions(compression=compression))
    moved: set[str] = set()
    if move is not None:
        by_m = np.array([0.25, -0.4, 0.0])
        move(path, "chair_1", by_m)
        expected["chair_1"] = expected["chair_1"] + by_m
        moved = {"chair_1"}
    opened = open_marked(read_mark(path))
    found = boxes(opened.scene)
    assert found.keys() == expected.keys()
    for name, box in expected.items():
        np.testing.assert_allclose(found[name], box, atol=1e-3, err_msg=name)
    assert opened.scene.supports == scene.supports
    unmoved = [o for o in scene.objects if o.id not in moved]
    assert [opened.scene.object(o.id) for o in unmoved] == unmoved
    assert len(opened.changes) == len(moved)


@pytest.mark.parametrize("number", [np.nan, np.inf, 1e200])
@pytest.mark.parametrize("place", [(0, 0), (1, 2), (0, 3)])
def test_numbers_that_cannot_be_a_pose_are_refused(number: float, place: tuple[int, int]) -> None:
    matrix = np.eye(4)
    matrix[place] = number
    if number == 1e200 and place[1] == 3:
        assert np.isfinite(pose_of(matrix)[0].position).all()
        return
    with pytest.raises(InputError, match="too large or none"):
        pose_of(matrix)


def test_an_object_without_thickness_is_refused() -> None:
    with pytest.raises(InputError, match="no size along one axis"):
        pose_of(np.diag([1.0, 0.0, 1.0, 1.0]))


def test_turn_and_scale_are_told_apart() -> None:
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn @ np.diag([2.0, 0.5, 1.0]), (1.0, 2.0, 3.0)
    pose, given_up = pose_of(matrix)
    assert not given_up
    np.testing.assert_allclose(pose.R_world_object, turn, atol=1e-12)
    np.testing.assert_allclose(pose.scale, (2.0, 0.5, 1.0))
    np.testing.assert_allclose(pose.position, (1.0, 2.0, 3.0))
