"""Files as scenes for a library that is open already: in the editor the reading has a process of its own."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from diorama_core.errors import Cancelled, InputError
from diorama_core.export import export_scene
from diorama_core.importing.scene_import import import_scene, read_apart, read_scene
from diorama_core.library.catalogue import built_in_library
from diorama_core.progress import CancelToken, Progress, ProgressEvent
from tests.export.scenes import scene_of


def test_an_exported_scene_comes_back_through_another_process(tmp_path: Path) -> None:
    scene, library = scene_of("fittings")
    path, shapes, events = tmp_path / "room.glb", tmp_path / "shapes", []
    export_scene(scene, library, path, "glb")
    imported = read_apart(import_scene, path, shapes, None, None, progress=Progress(events.append))
    assert (imported.opened.scene, imported.library_name) == (scene, "built-in")
    assert events[0] == ProgressEvent(0.0, "reading room.glb")
    known = frozenset(s.id for s in built_in_library().shapes())
    assert read_apart(read_scene, path, shapes, known, progress=Progress()).scene == scene


def crash(path: Path, progress: Progress) -> None:
    """As a library in C++ does it at a damaged file."""
    os.abort()


def hoard(path: Path, progress: Progress) -> int:
    return len(bytes(8_000_000_000))


@pytest.mark.parametrize("reader", [crash, hoard])
def test_a_reader_that_crashes_or_hoards_is_one_line(reader, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"^room\.usdc: it needs more memory .* or is damaged; .*$"):
        read_apart(reader, tmp_path / "room.usdc", progress=Progress())


def test_pictures_of_planes_come_back_too(tmp_path: Path) -> None:
    scene, library = scene_of("example")
    textures = {str(p.texture): np.full((8, 8, 3), 90, np.uint8) for p in scene.architecture.planes if p.texture}
    assert textures
    export_scene(scene, library, tmp_path / "room.glb", "glb", textures=textures)
    opened = read_scene(
        tmp_path / "room.glb", tmp_path / "shapes", frozenset(s.id for s in library.shapes()), Progress()
    )
    assert opened.scene == scene
    assert textures.keys() <= opened.textures.keys()


def test_a_cancel_before_it_begins_reads_nothing(tmp_path: Path) -> None:
    token = CancelToken()
    token.cancel()
    with pytest.raises(Cancelled):
        read_scene(tmp_path / "room.glb", tmp_path / "shapes", frozenset(), Progress(token=token))


def test_a_broken_file_names_itself_and_not_its_folder(tmp_path: Path) -> None:
    path = tmp_path / "room.glb"
    path.write_bytes(b"glTF and then nothing")
    with pytest.raises(InputError, match=r"^room\.glb cannot be read") as caught:
        read_apart(read_scene, path, tmp_path / "shapes", frozenset(), progress=Progress())
    assert str(tmp_path) not in str(caught.value)
