"""Every adapter on a tiny folder of the published layout, written by hand."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_core.errors import InputError
from diorama_core.evaluation.adapters import read_front3d, read_scan2cad, read_ssdb, read_sunrgbd
from diorama_core.evaluation.adapters.front3d import rooms_of

SIZE = (64, 48)


def picture(path: Path, value: int = 128) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    pixels = np.full((SIZE[1], SIZE[0], 3), value, np.uint8)
    pixels[:, ::2] += 20
    Image.fromarray(pixels).save(path)


def depth_png(path: Path, values: np.ndarray) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(values.astype(np.uint16)).save(path)


@pytest.fixture
def ssdb(tmp_path):
    folder = tmp_path / "scene_07"
    picture(folder / "scene.png")
    gt = {
        "1": {"class": "desk", "name": "desk", "parent_id": 0},
        "4": {"class": "laptop", "parent_id": 1},
        "9": {"class": "floor", "parent_id": 0},
    }
    (folder / "gt.json").write_text(json.dumps(gt))
    masks = np.zeros((2, SIZE[1], SIZE[0]), bool)
    masks[0, 10:40, 10:50] = True
    masks[1, 15:25, 20:30] = True
    np.save(folder / "seg.npy", masks)
    (folder / "seg.json").write_text(json.dumps([{"id": 1, "class": "desk"}, {"id": 4, "class": "laptop"}]))
    return folder


def test_ssdb_scenes_have_masks_classes_and_parents(ssdb):
    scene = read_ssdb(ssdb)
    assert [(o.id, o.category, o.parent) for o in scene.objects] == [(1, "desk", None), (4, "laptop", 1)]
    assert (scene.inputs.instances == 2).sum() == 100
    assert (scene.inputs.instances == 1).sum() == 30 * 40 - 100
    assert dict(scene.inputs.instance_boxes)[2].box == (20, 15, 30, 25)
    np.save(ssdb / "seg.npy", np.where(scene.inputs.instances == 2, 4, scene.inputs.instances))
    assert np.array_equal(read_ssdb(ssdb).inputs.instances, scene.inputs.instances)


def test_ssdb_says_what_is_missing(ssdb):
    (ssdb / "seg.npy").unlink()
    with pytest.raises(InputError, match=r"seg\.npy"):
        read_ssdb(ssdb)
    (ssdb / "gt.json").write_text("{")
    with pytest.raises(InputError, match="not valid JSON"):
        read_ssdb(ssdb)


def test_scan2cad_models_land_in_the_scan(tmp_path):
    root = tmp_path / "scans" / "scene0000_00"
    picture(root / "color" / "10.jpg")
    depth_png(root / "depth" / "10.png", np.full((SIZE[1], SIZE[0]), 2500))
    instances = np.zeros((SIZE[1], SIZE[0]), np.uint8)
    instances[10:30, 10:40] = 1
    (root / "instance").mkdir()
    Image.fromarray(instances).save(root / "instance" / "10.png")
    for name, matrix in (
        ("intrinsic/intrinsic_depth", np.array([[50.0, 0, 32, 0], [0, 51, 24, 0], [0, 0, 1, 0], [0, 0, 0, 1]])),
        ("pose/10", np.eye(4)),
    ):
        (root / name).parent.mkdir(exist_ok=True)
        np.savetxt(root / f"{name}.txt", matrix)
    turn = [np.cos(np.pi / 4), np.sin(np.pi / 4), 0.0, 0.0]  # +Y up to +Z up
    model = {
        "catid_cad": "03001627", "id_cad": "m1", "sym": "__SYM_ROTATE_UP_4", "bbox": [0.5, 1.0, 0.25],
        "center": [0.0, 0.1, 0.0],
        "trs": {"translation": [3.0, 2.0, 1.0], "rotation": turn, "scale": [2.0, 1.0, 1.0]},
    }  # fmt: skip
    still = {"translation": [1.0, 0.0, 0.0], "rotation": [1.0, 0.0, 0.0, 0.0], "scale": [1.0, 1.0, 1.0]}
    record = [{"id_scan": "scene0000_00", "trs": still, "aligned_models": [model]}]
    (tmp_path / "full_annotations.json").write_text(json.dumps(record))
    frame = read_scan2cad(tmp_path / "scans", tmp_path / "full_annotations.json", "scene0000_00", "10")
    (found,) = frame.models
    assert (found.category, found.symmetry) == ("chair", 4)
    assert np.allclose(found.size_m, [0.5, 2.0, 2.0])
    assert np.allclose(found.centre, [2.0, 2.0, 1.1])
    assert np.allclose(found.R_world_object[:, 2], [0, 0, 1], atol=1e-9)
    assert np.isclose(np.linalg.det(found.R_world_object), 1.0)
    assert np.allclose(frame.inputs.depth_m, 2.5)
    with pytest.raises(InputError, match="not annotated"):
        read_scan2cad(tmp_path / "scans", tmp_path / "full_annotations.json", "scene0001_00", "10")


def test_front3d_rooms_stand_upright(tmp_path):
    wall = {"uid": "w", "type": "WallInner", "normal": [0, 0, 1], "xyz": [0, 0, 0, 4, 0, 0, 4, 2.6, 0, 0, 2.6, 0]}
    floor = {"uid": "f", "type": "Floor", "normal": [0, 1, 0], "xyz": [0, 0, 0, 4, 0, 0, 4, 0, 3, 0, 0, 3]}
    half = np.sqrt(0.5)
    children = [
        {"ref": "w"},
        {"ref": "f"},
        {"ref": "s", "pos": [1.0, 0.0, 2.0], "rot": [0, half, 0, half], "scale": [1.0, 1.0, 2.0]},
    ]
    house = {
        "furniture": [{"uid": "s", "jid": "j1", "category": "Sofa/Loveseat Sofa", "size": [1.8, 0.8, 0.9]}],
        "mesh": [wall, floor],
        "scene": {"room": [{"instanceid": "LivingRoom-1", "children": children}]},
    }
    path = tmp_path / "house.json"
    path.write_text(json.dumps(house))
    assert rooms_of(path) == ("LivingRoom-1",)
    scene = read_front3d(path, "LivingRoom-1")
    (sofa,) = scene.objects
    assert sofa.category == "sofa"
    assert np.allclose(sofa.size_m, [1.8, 1.8, 0.8])
    assert np.allclose(sofa.pose.position, [1.0, -2.0, 0.4])
    assert np.allclose(sofa.pose.R_world_object[:, 2], [0, 0, 1], atol=1e-9)
    assert np.allclose(sofa.pose.R_world_object[:, 0], [1, 0, 0], atol=1e-9)  # +Z turned by 90 degrees about +Y is +X
    assert {p.role for p in scene.architecture.planes} == {"wall", "floor"}
    assert np.allclose(scene.architecture.floor.normal, [0, 0, 1])
    assert np.allclose(scene.architecture.by_role("wall")[0].normal, [0, -1, 0])
    assert scene.support_of(sofa.id).parent == scene.architecture.floor.id
    with pytest.raises(InputError, match="there is no room"):
        read_front3d(path, "Attic-1")


def test_sunrgbd_polygons_and_depth(tmp_path):
    folder = tmp_path / "NYU0001"
    picture(folder / "image" / "a.jpg")
    millimetres = np.full((SIZE[1], SIZE[0]), 3000, np.uint16)
    depth_png(folder / "depth_bfx" / "a.png", ((millimetres << 3) | (millimetres >> 13)).astype(np.uint16))
    np.savetxt(folder / "intrinsics.txt", [[60.0, 0, 32], [0, 60, 24], [0, 0, 1]])
    polygons = [
        {"object": 0, "x": [5, 45, 45, 5], "y": [5, 5, 40, 40]},
        {"object": 1, "x": [0, 60, 60, 0], "y": [0, 0, 4, 4]},
        {"object": 2, "x": [10, 20, 20, 10], "y": [10, 10, 20, 20]},
    ]
    index = {"frames": [{"polygon": polygons}], "objects": [{"name": "bed"}, {"name": "wall"}, {"name": "pillow:1"}]}
    (folder / "annotation2Dfinal").mkdir()
    (folder / "annotation2Dfinal" / "index.json").write_text(json.dumps(index))
    inputs = read_sunrgbd(folder)
    assert [b.category for _, b in inputs.instance_boxes] == ["bed", "pillow"]
    assert np.allclose(inputs.depth_m, 3.0, atol=0.002)
    assert (inputs.instances[12:18, 12:18] == 2).all()
    (folder / "intrinsics.txt").write_text("1 2 3")
    with pytest.raises(InputError, match="3 x 3"):
        read_sunrgbd(folder)
