"""Files as scenes for a library that is open already: in the editor the reading has a process of its own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diorama_core.errors import Cancelled, InputError
from diorama_core.export import export_scene
from diorama_core.importing.scene_import import read_scene
from diorama_core.io.limited import LimitedProcess
from diorama_core.progress import CancelToken, Progress, ProgressEvent
from tests.export.scenes import scene_of
from tests.primitives import PrimitiveLibrary, furnished_room


@pytest.fixture
def room(tmp_path: Path) -> Path:
    export_scene(furnished_room(PrimitiveLibrary()), PrimitiveLibrary(), tmp_path / "room.glb", "glb")
    return tmp_path / "room.glb"


def known() -> frozenset[str]:
    return frozenset(s.id for s in PrimitiveLibrary().shapes())


def test_a_scene_of_known_shapes_comes_back_through_another_process(room: Path) -> None:
    process, events = LimitedProcess(), []
    try:
        opened = process.work(
            "room.glb", read_scene, room, room.parent / "shapes", known(), progress=Progress(events.append)
        )
    finally:
        process.close()
    assert opened.scene == furnished_room(PrimitiveLibrary())
    assert events[0] == ProgressEvent(0.0, "reading room.glb")


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


def test_a_cancel_before_it_begins_reads_nothing(room: Path) -> None:
    token = CancelToken()
    token.cancel()
    with pytest.raises(Cancelled):
        read_scene(room, room.parent / "shapes", known(), Progress(token=token))


def test_a_broken_file_names_itself_and_not_its_folder(tmp_path: Path) -> None:
    path = tmp_path / "room.glb"
    path.write_bytes(b"glTF and then nothing")
    with pytest.raises(InputError, match=r"^room\.glb cannot be read") as caught:
        read_scene(path, tmp_path / "shapes", known(), Progress())
    assert str(tmp_path) not in str(caught.value)
