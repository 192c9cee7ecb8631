"""Scene files through a process of their own: the same scenes, and one line where that process had to end."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from diorama_core.errors import InputError
from diorama_core.export import export_scene
from diorama_core.importing import apart
from diorama_core.library.catalogue import built_in_library
from diorama_core.progress import Progress
from tests.export.scenes import scene_of


def crash(path: Path, progress: Progress) -> None:
    """As a library in C++ does it at a damaged file."""
    os.abort()


def hoard(path: Path, progress: Progress) -> int:
    return len(bytes(8_000_000_000))


def test_an_exported_scene_comes_back(tmp_path: Path) -> None:
    scene, library = scene_of("fittings")
    export_scene(scene, library, tmp_path / "room.glb", "glb")
    imported = apart.import_apart(tmp_path / "room.glb", tmp_path / "shapes", None, Progress())
    assert (imported.opened.scene, imported.library_name) == (scene, "built-in")
    known = frozenset(s.id for s in built_in_library().shapes())
    assert apart.read_apart(tmp_path / "room.glb", tmp_path / "shapes", known, Progress()).scene == scene


def test_what_the_reader_says_is_said_here(tmp_path: Path) -> None:
    (tmp_path / "room.glb").write_bytes(b"glTF and then nothing")
    with pytest.raises(InputError, match=r"^room\.glb cannot be read"):
        apart.import_apart(tmp_path / "room.glb", tmp_path / "shapes", None, Progress())


@pytest.mark.parametrize("reader", [crash, hoard])
def test_a_reader_that_crashes_or_hoards_is_one_line(reader, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"^room\.usdc: it needs more memory .* or is damaged; .*$"):
        apart._apart(tmp_path / "room.usdc", reader, tmp_path / "room.usdc", progress=Progress())
