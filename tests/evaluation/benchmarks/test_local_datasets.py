"""Other people's pictures end to end: a folder in the layout of SSDB made from a room of ours, and Scan2CAD by hand."""

from __future__ import annotations

import json

import numpy as np
import pytest
from PIL import Image
from scipy.spatial.transform import Rotation

from diorama_core.artefacts import Inputs, Photo
from diorama_core.errors import InputError
from diorama_core.evaluation.adapters.scan2cad import SHAPENET_CATEGORIES, AlignedModel, ScanFrame
from diorama_core.evaluation.benchmarks.local_datasets import (
    LocalResult,
    alignment_table,
    alignments,
    local_cases,
    run,
    scan2cad_class,
)
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import Camera, Intrinsics, Pose, Scene, SceneObject, yaw_rotation
from diorama_core.synthesis.artefacts import true_supports
from diorama_core.synthesis.truth import transform
from tests.evaluation.truth import view_of_room
from tests.few_shapes import few_shapes

SIZE = (320, 240)


@pytest.fixture(scope="module")
def ssdb(tmp_path_factory):
    """One picture of a small room."""
    view = view_of_room(16, "bathroom", SIZE)
    folder = tmp_path_factory.mktemp("ssdb") / "scene_01"
    folder.mkdir()
    Image.fromarray(view.inputs.photo.rgb).save(folder / "scene.png")
    np.save(folder / "seg.npy", view.inputs.instances)
    number = {o.id: o.mask_id for o in view.scene.objects}
    records = {
        str(number[e.child]): {"class": view.scene.object(e.child).category, "parent_id": number.get(e.parent, 0)}
        for e in true_supports(view)
    }
    (folder / "gt.json").write_text(json.dumps(records))
    return folder.parent, view.scene, len(records)


def _scan2cad_model(item: SceneObject) -> dict[str, object]:
    """An object as Scan2CAD annotates a ShapeNet model: +Y up, -Z front."""
    depth, width, height = np.asarray(item.shape_size_m) * item.pose.scale
    R = item.pose.R_world_object @ np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    offsets = {name: offset for offset, name in SHAPENET_CATEGORIES.items()}
    return {
        "catid_cad": offsets.get(scan2cad_class(item.category), "00000000"),
        "id_cad": item.shape_id,
        "sym": "__SYM_NONE",
        "bbox": [width / 2, height / 2, depth / 2],
        "center": [0.0, 0.0, 0.0],
        "trs": {
            "translation": item.pose.position.tolist(),
            "rotation": Rotation.from_matrix(R).as_quat(scalar_first=True).tolist(),
            "scale": [1.0, 1.0, 1.0],
        },
    }


@pytest.mark.slow
def test_a_folder_of_scan2cad_is_built_and_fills_the_table_by_category(tmp_path):
    view = view_of_room(3, "office", SIZE, clutter=2)
    shown = [o for o in view.scene.objects if o.mask_id is not None]
    seen = [o for name, most in (("chair", 2), ("desk", 1)) for o in [s for s in shown if s.category == name][:most]]
    instances = np.where(np.isin(view.inputs.instances, [o.mask_id for o in seen]), view.inputs.instances, 0)
    root, k = tmp_path / "scans" / "scene0000_00", view.camera.intrinsics
    for folder in ("color", "depth", "instance", "pose", "intrinsic"):
        (root / folder).mkdir(parents=True)
    Image.fromarray(view.inputs.photo.rgb).save(root / "color" / "10.png")
    Image.fromarray((view.inputs.depth_m * 1000).astype(np.uint16)).save(root / "depth" / "10.png")
    Image.fromarray(instances.astype(np.uint8)).save(root / "instance" / "10.png")
    np.savetxt(root / "pose" / "10.txt", view.camera.T_world_camera)
    K = np.array([[k.fx, 0, k.cx, 0], [0, k.fy, k.cy, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    np.savetxt(root / "intrinsic" / "intrinsic_depth.txt", K)
    still = {"translation": [0.0, 0.0, 0.0], "rotation": [1.0, 0.0, 0.0, 0.0], "scale": [1.0, 1.0, 1.0]}
    record = {"id_scan": "scene0000_00", "trs": still, "aligned_models": [_scan2cad_model(o) for o in seen]}
    (tmp_path / "full_annotations.json").write_text(json.dumps([record]))
    bench = run("scan2cad", tmp_path, few_shapes(view.scene), 3)
    (result,) = bench.results
    assert result.failure == ""
    assert result.asked == len(seen)
    assert {name for name, _ in result.aligned} >= {"chair", "table"}
    row = bench.tables()[1].row("embedded")
    assert isinstance(row["instance mean"], float)
    assert row["instance mean"] >= 25.0
    assert row["bathtub"] is None


@pytest.mark.parametrize(
    ("ours", "theirs"),
    [("armchair", "chair"), ("desk", "table"), ("dresser", "cabinet"), ("television", "display"), ("lamp", "lamp")],
)
def test_kinds_of_things_have_scan2cads_classes(ours, theirs):
    assert scan2cad_class(ours) == theirs


def test_a_folder_of_ssdb_is_built_and_measured(ssdb):
    folder, room, count = ssdb
    bench = run("ssdb", folder, few_shapes(room), 3)
    (result,) = bench.results
    assert result.failure == ""
    assert (result.asked, result.found) == (count, count)
    assert result.image_iou > 0.3
    assert result.relation > 0.4
    assert "ssdb" in bench.tables()[0].to_markdown()
    assert json.loads(json.dumps(bench.to_json()))["cases"][0]["case"] == "scene_01"


def test_parents_are_named_by_mask(ssdb):
    (case,) = local_cases("ssdb", ssdb[0])
    masks = {number for number, _ in case.inputs.instance_boxes}
    assert {child for child, _ in case.parents} == masks
    assert any(parent is None for _, parent in case.parents)


def test_an_empty_folder_is_named(tmp_path):
    with pytest.raises(InputError, match="no picture of sunrgbd"):
        run("sunrgbd", tmp_path, built_in_library())


def _frame(models) -> ScanFrame:
    T = np.eye(4)
    T[:3, :3] = yaw_rotation(0.8) @ np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0.0]])
    T[:3, 3] = [1.0, -2.0, 1.5]
    photo = Photo(np.zeros((48, 64, 3), np.uint8), "x.png", (64, 48))
    return ScanFrame("s/0", Inputs(photo), Camera(Intrinsics.from_fov(64, 48, 1.2), T), tuple(models))


def test_models_are_aligned_in_the_world_of_the_scan():
    model = AlignedModel("chair", yaw_rotation(0.3), np.array([1.0, 1.0, 0.45]), np.array([0.5, 0.5, 0.9]), symmetry=1)
    frame = _frame([model])
    pose = Pose(model.R_world_object, model.centre, np.ones(3))
    item = SceneObject("a", "chair", "chair", "s", (0.5, 0.5, 0.9), pose)
    elsewhere = np.eye(4)
    elsewhere[:3, :3], elsewhere[:3, 3] = yaw_rotation(-1.0), [4, 5, 0]
    scene = transform(Scene(camera=frame.camera, objects=(item,)), elsewhere)
    assert alignments([model], scene, frame) == (("chair", True),)
    assert alignments([model, model], scene, frame) == (("chair", True), ("chair", False))
    there = scene.objects[0].pose
    for kind, pose, right in (
        ("chair", there.move([0.3, 0, 0]), False),
        ("table", there, False),
        ("stool", there, True),
    ):
        other = SceneObject("a", kind, kind, "s", (0.5, 0.5, 0.9), pose)
        assert alignments([model], Scene(camera=scene.camera, objects=(other,)), frame) == (("chair", right),)


def test_the_table_by_category_stands_beside_the_papers():
    models = (("chair", True), ("chair", False), ("monitor", True), ("lamp", False))
    table = alignment_table([LocalResult("a", 4, 2, 0.5, None, models, 1.0, 1.0, 0.0, 0.0, 1.0)])
    row = table.row("embedded")
    assert (row["chair"], row["display"], row["others"], row["sofa"]) == (50.0, 100.0, 0.0, None)
    assert (row["class mean"], row["instance mean"]) == (50.0, 50.0)
    assert "other dataset" in table.to_markdown()
