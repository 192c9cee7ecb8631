"""`diorama export --variants` and `--shake`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from PIL import Image

from diorama_app.cli import main
from diorama_app.cli.variants import PICTURE_PX
from diorama_core.project.storage import Project
from tests.cli.running import told
from tests.export.scenes import scene_of

pytest.importorskip("mujoco", reason="MuJoCo is not installed (optional extra 'sim')")


@pytest.fixture
def project(tmp_path: Path) -> Path:
    Project.create(tmp_path / "room").save_scene(scene_of("fittings")[0])
    return tmp_path / "room"


def test_variants_come_with_a_manifest_and_a_contact_sheet(
    project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "cousins"
    command = ["export", str(project), "--format", "mjcf", "--variants", "2", "--vary", "light", "--seed", "7"]
    assert "2 variants" in told(capsys, [*command, "-o", str(folder)])
    manifest = json.loads((folder / "variants.json").read_text())
    assert [v["seed"] for v in manifest["variants"]] == [7, 8]
    assert all(set(v["changes"]) == {"light"} and v["max_moved_m"] < 0.01 for v in manifest["variants"])
    assert all((folder / v["file"]).stat().st_size > 1000 for v in manifest["variants"])
    assert Image.open(folder / "variants.jpg").size == (2 * PICTURE_PX[0], PICTURE_PX[1])


def test_what_cannot_vary_is_one_line(project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["export", str(project), "--format", "mjcf", "-o", str(tmp_path / "v"), "--variants"]
    assert main([*command, "1", "--vary", "weather"]) != 0
    assert "--vary weather: choose of shapes, textures" in capsys.readouterr().err
    assert main([*command, "0"]) != 0
    assert "--variants 0" in capsys.readouterr().err


def test_a_shaken_floor_is_reported(project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["export", str(project), "--format", "mjcf", "-o", str(tmp_path / "room.xml"), "--shake"]
    assert "floor shaken by 0.3 g at 2 Hz for 3 s: 0 of 8 objects fall" in told(capsys, command)
