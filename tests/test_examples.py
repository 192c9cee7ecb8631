"""The examples run, and use the public interface only."""

from __future__ import annotations

import ast
import json
import re
import runpy
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image

import diorama_core as diorama
from diorama_core.project.storage import Project
from diorama_core.scene.edits import remove
from tests.cli.room_photo import write_room
from tests.export.scenes import scene_of

EXAMPLES = Path(__file__).parents[1] / "examples"
OTHERS = {"numpy", "PIL", "mujoco", "gymnasium"}


def _run(name: str, *arguments: object) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", [name, *map(str, arguments)])
        runpy.run_path(str(EXAMPLES / name), run_name="__main__")


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the first example makes."""
    folder = tmp_path_factory.mktemp("examples")
    _run("01_photo_to_scene.py", *write_room(folder), folder / "room")
    return folder / "room"


@pytest.mark.slow
def test_a_photo_becomes_a_scene_seen_from_four_sides(project: Path) -> None:
    assert len(diorama.load(project).scene.objects) == 2
    pictures = [np.asarray(Image.open(project / f"{view}.png")) for view in ("photo", "top", "front", "orbit_30")]
    assert all(p.shape == (480, 640, 3) and p.std() > 5 for p in pictures)


def test_a_stage_is_replaced(project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    photo, boxes = project.parent / "room.png", project.parent / "boxes.json"
    _run("02_replace_one_stage.py", photo, boxes, tmp_path / "level")
    assert "2 objects; camera: " in capsys.readouterr().out
    camera = diorama.load(tmp_path / "level").scene.camera
    assert camera is not None
    assert camera.T_world_camera[:3, 2] == pytest.approx([0.0, 1.0, 0.0])


def test_a_project_is_optimised_and_exported(project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _run("03_optimise_and_export.py", project, tmp_path / "room.glb")
    assert "overlapping_pairs" in capsys.readouterr().out
    assert json.loads((project / "scene.json").read_text())["metrics"]["overlapping_pairs"] == 0
    assert trimesh.load_scene(tmp_path / "room.glb").geometry


@pytest.fixture(scope="module")
def fitted(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A room with a door, a desk's drawers and a laptop, for examples that drive there."""
    pytest.importorskip("mujoco", reason="MuJoCo is not installed (optional extra 'sim')")
    pytest.importorskip("pxr", reason="USD is not installed (optional extra 'usd')")
    folder = tmp_path_factory.mktemp("fitted") / "room"
    scene = scene_of("fittings")[0]
    Project.create(folder).save_scene(remove(scene, [o.id for o in scene.objects if o.category in ("dresser", "lamp")]))
    return folder


@pytest.mark.slow
def test_a_disc_drives_through_the_door(fitted: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _run("04_drive_through_doors.py", fitted)
    assert re.findall(r"^door: through in \d\.\d s, 0 touches$", capsys.readouterr().out, re.MULTILINE)


@pytest.mark.slow
def test_every_drawer_and_door_is_opened_and_closed(fitted: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _run("05_open_everything.py", fitted)
    assert capsys.readouterr().out.splitlines()[-1] == "5 of 5 open and close"


def test_a_disc_in_gymnasium_comes_to_a_surface(fitted: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("gymnasium", reason="gymnasium is not installed (optional extra 'gym')")
    _run("06_gymnasium.py", fitted)
    assert capsys.readouterr().out.startswith("at the goal after")


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.py")), ids=lambda p: p.stem)
def test_examples_use_the_public_interface_only(path: Path) -> None:
    tree = ast.parse(path.read_text())
    imported = {a.name for n in ast.walk(tree) if isinstance(n, ast.Import) for a in n.names}
    imported |= {str(n.module) for n in ast.walk(tree) if isinstance(n, ast.ImportFrom)}
    assert imported - sys.stdlib_module_names - OTHERS == {"diorama_core"}
    used = {
        node.attr
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "diorama"
    }
    assert used <= set(diorama.__all__)


def test_every_example_begins_with_prose_and_is_numbered() -> None:
    names = sorted(p.name for p in EXAMPLES.glob("*.py"))
    assert [name[:3] for name in names] == [f"{i:02d}_" for i in range(1, len(names) + 1)]
    assert all(ast.get_docstring(ast.parse((EXAMPLES / name).read_text())) for name in names)
