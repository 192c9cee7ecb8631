from __future__ import annotations

import json
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image

from diorama_app.cli import main, scenes
from diorama_app.projects.options import POSES, pose_solver
from diorama_core.io import assets
from diorama_core.library.catalogue import built_in_library
from diorama_core.pose.correspondence.solvers import CorrespondencePose
from diorama_core.project.storage import Project
from tests.app.small_room import furnished_scene
from tests.cli.room_photo import write_room
from tests.cli.running import refused, told
from tests.few_shapes import stored_seats


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A project built by the command itself, from a library of few shapes."""
    folder = tmp_path_factory.mktemp("cli")
    photo, boxes = write_room(folder)
    command = ["build", str(photo), "--boxes", str(boxes), "--library", stored_seats()]
    assert main([*command, "-o", str(folder / "room")]) == 0
    return folder / "room"


def test_build_writes_a_whole_project(project: Path) -> None:
    document = json.loads((project / "scene.json").read_text())
    kinds = {o["category"] for o in document["objects"]}
    assert "sofa" in kinds
    assert kinds <= {"chair", "armchair", "office chair", "sofa"}, "plain blocks: a chair may be an armchair"
    roles = [p["role"] for p in document["architecture"]["planes"]]
    assert "floor" in roles
    assert "wall" in roles
    assert (project / "photo.jpg").exists()
    stages = {s["stage"] for s in json.loads((project / "project.json").read_text())["stages"]}
    assert stages >= {"camera", "objects", "geometry", "architecture", "retrieval", "pose", "layout"}


def test_building_again_reads_finished_stages(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    photo, boxes = project.parent / "room.png", project.parent / "boxes.json"
    before = (project / "scene.json").read_text()
    command = ["build", str(photo), "--boxes", str(boxes), "--library", stored_seats(), "-o", str(project), "--json"]
    report = json.loads(told(capsys, command))
    assert all(s["cached"] for s in report["stages"] if s["stage"] not in ("layout", "refinement"))
    assert (project / "scene.json").read_text() == before


def test_a_photo_alone_gives_a_room_and_an_invitation(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A photo of 16 bits a pixel, one of the two oddest modes; `perception/inputs/photos` tests all."""
    without = tmp_path / "without recogniser"
    without.mkdir()
    shutil.copyfile(assets.FOLDER / assets.OUTLINER, without / assets.OUTLINER)
    monkeypatch.setattr(assets, "FOLDER", without)
    photo, _ = write_room(tmp_path)
    Image.fromarray(np.asarray(Image.open(photo).convert("L")).astype(np.uint16) * 257).save(tmp_path / "deep.png")
    assert "draw boxes" in told(capsys, ["build", str(tmp_path / "deep.png"), "-o", str(tmp_path / "empty")])
    document = json.loads((tmp_path / "empty" / "scene.json").read_text())
    assert document["objects"] == []
    assert any(p["role"] == "wall" for p in document["architecture"]["planes"])


def test_optimise_reports_its_costs(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    report = json.loads(told(capsys, ["optimise", str(project), "--json"]))
    assert report["recipe"] == "feasible"
    assert set(report["before"]) == set(report["after"])


def test_export_opens_elsewhere_in_metres_with_y_up(project: Path, tmp_path: Path) -> None:
    assert main(["export", str(project), "--format", "glb", "-o", str(tmp_path / "room.glb")]) == 0
    loaded = trimesh.load_scene(tmp_path / "room.glb")
    document = json.loads((project / "scene.json").read_text())
    assert len(loaded.geometry) >= len(document["objects"])
    room = np.ptp(np.vstack([p["polygon"] for p in document["architecture"]["planes"]]), axis=0)
    assert loaded.extents[1] == pytest.approx(room[2], abs=0.5)


@pytest.mark.parametrize("view", ["photo", "top", "front", "orbit:30"])
def test_picture_draws_every_view(project: Path, tmp_path: Path, view: str) -> None:
    out = tmp_path / "view.png"
    assert main(["picture", str(project), "-o", str(out), "--view", view, "--size", "160x120"]) == 0
    image = np.asarray(Image.open(out).convert("RGB"))
    assert image.shape == (120, 160, 3)
    assert image.std() > 5


def test_arrangements_write_scenes_with_other_shapes(
    project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    photo, boxes = write_room(tmp_path)
    shutil.copytree(project, tmp_path / "room")  # its stages are finished
    arguments = ["build", str(photo), "--boxes", str(boxes), "-o", str(tmp_path / "room"), "--arrangements", "3"]
    arguments += ["--library", stored_seats()]
    names = json.loads(told(capsys, [*arguments, "--json"]))["scenes"]
    shapes = [
        tuple(o["shape"] for o in json.loads((tmp_path / "room" / name).read_text())["objects"]) for name in names
    ]
    assert len(set(shapes)) == 3


def test_doctor_finds_what_is_needed(capsys: pytest.CaptureFixture[str]) -> None:
    findings = {f["name"]: f for f in json.loads(told(capsys, ["doctor", "--json"]))}
    assert findings["torch"]["ok"]
    assert "shapes" in findings["shape library"]["detail"]


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["build"],
        ["build", "x.jpg", "-o", "p", "--intrinsics", "1,2,3"],
        ["build", "x.jpg", "-o", "p", "--fov", "900"],
        ["build", "x.jpg", "-o", "p", "--fov", "60", "--intrinsics", "1,1,1,1"],
        ["picture", "p", "-o", "x.png", "--view", "sideways"],
        ["picture", "p", "-o", "x.png", "--size", "huge"],
        ["export", "p", "--format", "doc", "-o", "x"],
        ["paint"],
    ],
)
def test_bad_usage_exits_2(arguments: list[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(arguments)
    assert stop.value.code == 2


def test_a_room_that_nobody_photographed_is_drawn_from_outside(tmp_path: Path) -> None:
    project = Project.create(tmp_path / "room")
    project.save_scene(replace(furnished_scene(), camera=None, objects=(), supports=()))
    drawn = [tmp_path / "as_it_is.png", tmp_path / "from_outside.png"]
    views = ([], ["--view", scenes.WITHOUT_PHOTO])
    for path, view in zip(drawn, views, strict=True):
        assert main(["picture", str(project.folder), "-o", str(path), "--size", "80x60", *view]) == 0
    assert drawn[0].read_bytes() == drawn[1].read_bytes()


@pytest.mark.parametrize("command", ["serve", "build", "optimise", "export", "picture", "doctor"])
def test_every_command_has_help_with_an_example(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main([command, "--help"])
    assert stop.value.code == 0
    assert f"diorama {command}" in capsys.readouterr().out.split("example:")[1]


def _bad_photos(folder: Path) -> dict[str, Path]:
    good, _ = write_room(folder)
    bad = {
        "missing": folder / "nowhere.jpg",
        "text": folder / "text.jpg",
        "empty": folder / "empty.jpg",
        "truncated": folder / "truncated.png",
        "tiny": folder / "tiny.png",
        "folder": folder / "directory.png",
    }
    bad["text"].write_text("this is no picture")
    bad["empty"].write_bytes(b"")
    bad["truncated"].write_bytes(good.read_bytes()[:500])
    Image.new("RGB", (1, 1)).save(bad["tiny"])
    bad["folder"].mkdir()
    return bad


@pytest.mark.parametrize("case", ["missing", "text", "empty", "truncated", "tiny", "folder"])
def test_a_bad_photo_is_one_clear_line_and_loses_nothing(
    case: str, project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = (project / "scene.json").read_bytes()
    photo = _bad_photos(tmp_path)[case]
    assert photo.name in refused(capsys, ["build", str(photo), "-o", str(project)])
    assert (project / "scene.json").read_bytes() == before


def test_boxes_outside_and_unknown_classes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The picture is a CMYK TIFF, the other of the two oddest modes."""
    given, boxes = write_room(tmp_path)
    photo = tmp_path / "room.tif"
    Image.open(given).convert("CMYK").save(photo)
    boxes.write_text(json.dumps([{"bbox": [900, 900, 950, 950], "class": "chair"}]))
    assert "outside" in refused(capsys, ["build", str(photo), "--boxes", str(boxes), "-o", str(tmp_path / "a")])
    boxes.write_text(json.dumps([{"bbox": [120, 110, 180, 200], "class": "flurbistan"}]))
    command = ["build", str(photo), "--boxes", str(boxes), "--library", stored_seats(), "-o", str(tmp_path / "b")]
    assert main(command) == 0
    document = json.loads((tmp_path / "b" / "scene.json").read_text())
    assert [o["label"] for o in document["objects"]] == ["flurbistan"]


def test_depth_of_another_size_is_one_clear_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    photo, _ = write_room(tmp_path)
    np.save(tmp_path / "depth.npy", np.full((50, 300), 2.0, np.float32))
    arguments = ["build", str(photo), "--depth", str(tmp_path / "depth.npy"), "-o", str(tmp_path / "a")]
    assert "depth.npy" in refused(capsys, arguments)


def test_other_failures_are_one_clear_line(project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    photo = str(project.parent / "room.png")
    cases = [
        ["build", photo, "-o", str(tmp_path / "file" / "room")],
        ["build", photo, "-o", str(tmp_path / "file")],
        ["build", photo, "-o", str(tmp_path / "room"), "--profile", "foundation"],
        ["build", photo, "-o", str(tmp_path / "room"), "--library", "mine"],
        ["optimise", str(tmp_path)],
        ["picture", str(project), "-o", str(tmp_path / "picture.gif")],
        ["export", str(project), "--format", "glb", "-o", str(tmp_path / "file" / "room.glb")],
    ]
    for arguments in cases:
        assert refused(capsys, arguments)


def test_the_installed_command_runs() -> None:
    command = Path(sys.executable).with_name("diorama")
    done = subprocess.run([command, "--version"], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0
    assert done.stdout.startswith("diorama ")


@pytest.mark.parametrize("name", POSES)
def test_every_way_to_pose_can_be_chosen(name: str) -> None:
    solver = pose_solver(name, built_in_library())
    assert (solver.kind if isinstance(solver, CorrespondencePose) else "render-and-compare") == name
