"""A project folder that came from somebody else."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_core.errors import ProjectError
from diorama_core.project.storage import Project
from tests.app.small_room import furnished_scene, make_project
from tests.io.test_bombs import png

EPS = b"""%!PS-Adobe-3.0 EPSF-3.0
%%BoundingBox: 0 0 40 40
%%EndComments
0 0 40 40 rectfill
showpage
%%EOF
"""


@pytest.fixture
def ghostscript(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A program called `gs` that tells when it was started; returns the file that it makes then."""
    started, programs = tmp_path / "started", tmp_path / "programs"
    programs.mkdir()
    program = programs / "gs"
    program.write_text(f"#!/bin/sh\ntouch {started}\nexit 1\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{programs}{os.pathsep}{os.environ['PATH']}")
    return started


def test_pillow_alone_would_start_it(ghostscript: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The test can fail: with Pillow's own switch as it comes, the program is started."""
    from PIL import EpsImagePlugin

    monkeypatch.setattr(EpsImagePlugin, "gs_binary", None)
    (tmp_path / "floor.jpg").write_bytes(EPS)
    with pytest.raises(Exception), Image.open(tmp_path / "floor.jpg") as picture:  # noqa: B017
        picture.load()
    assert ghostscript.exists()


def test_no_picture_of_a_project_starts_a_program(ghostscript: Path, tmp_path: Path) -> None:
    project = make_project(tmp_path / "projects" / "demo")
    textures = project.folder / "textures"
    textures.mkdir()
    (textures / "floor.jpg").write_bytes(EPS)
    (project.folder / "photo.jpg").write_bytes(EPS)
    with pytest.raises(ProjectError, match="not a whole picture"):
        project.texture("floor")
    from diorama_app.panels.projects import _small_picture

    assert _small_picture(project.folder / "photo.jpg", 0) == ""
    with pytest.raises(Exception), Image.open(textures / "floor.jpg") as picture:  # noqa: B017  # as trimesh would
        picture.load()
    assert not ghostscript.exists()


@pytest.mark.parametrize(
    "content", [b"", b"\xff\xd8\xff", b"GIF89a" + bytes(20), b"BM" + bytes(100), png(9000, 7000, 8, 2, 3), EPS]
)
def test_a_texture_that_cannot_be_read_costs_that_texture(tmp_path: Path, content: bytes) -> None:
    from dataclasses import replace

    from diorama_core.scene.types import Architecture

    project = make_project(tmp_path / "demo")
    project.save_textures({"fine": np.full((8, 8, 3), 120, np.uint8)})
    (project.folder / "textures" / "bad.jpg").write_bytes(content)
    scene = furnished_scene()
    first, second, *rest = scene.architecture.planes
    planes = (replace(first, texture="bad"), replace(second, texture="fine"), *rest)
    found = project.textures(replace(scene, architecture=Architecture(planes)))
    assert list(found) == ["fine"]


def test_a_pipe_in_the_folder_does_not_hold_the_reader(tmp_path: Path) -> None:
    project = make_project(tmp_path / "demo")
    (project.folder / "project.json").unlink()
    os.mkfifo(project.folder / "project.json")
    with pytest.raises(ProjectError, match="is not a file"):
        Project.open(project.folder)


def test_files_get_the_mode_of_any_new_file(tmp_path: Path) -> None:
    old = os.umask(0o027)
    try:
        project = make_project(tmp_path / "demo")
        inputs = project.load_inputs()
        assert inputs is not None
        project.save_inputs(inputs)
        project.save_textures({"fine": np.full((8, 8, 3), 120, np.uint8)})
    finally:
        os.umask(old)
    modes = {p.name: p.stat().st_mode & 0o777 for p in project.folder.rglob("*") if p.is_file()}
    assert set(modes.values()) == {0o640}, modes
