"""The photo of a scene: brought back from a file that holds it, missed in one that does not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from diorama_core.export import export_scene
from diorama_core.export.gathering import ExportOptions
from diorama_core.export.pictures import photo_text
from diorama_core.importing.marked import as_bytes
from diorama_core.importing.opening import marked_file, open_marked
from diorama_core.scene.types import Scene
from tests.export.scenes import scene_of


def photo_of(scene: Scene) -> np.ndarray:
    """A smooth picture of the camera's size."""
    assert scene.camera is not None
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
    opened = open_marked(marked_file(path))
    assert opened.changes == ()
    assert opened.inputs is not None
    assert opened.inputs.photo.name == "room.jpg"
    assert opened.inputs.intrinsics == scene.camera.intrinsics
    np.testing.assert_allclose(opened.inputs.photo.rgb.astype(int), photo_of(scene).astype(int), atol=6)


def test_a_file_without_its_photo_says_so(tmp_path: Path) -> None:
    scene, library = scene_of("fittings")
    path = tmp_path / "room.glb"
    export_scene(scene, library, path, "glb", photo=photo_of(scene), provenance={"photo": "room.jpg"})
    assert b"diorama_photo" not in path.read_bytes()
    opened = open_marked(marked_file(path))
    assert opened.inputs is None
    assert opened.changes == ("room.jpg is not in the file; export it again with its photo",)


@pytest.mark.parametrize(("photo", "said"), [(b"no picture", "cannot be read"), (b"", "not of the camera's size")])
def test_a_photo_that_cannot_be_used_is_left_out(photo: bytes, said: str, tmp_path: Path) -> None:
    scene, library = scene_of("fittings")
    export_scene(scene, library, tmp_path / "room.glb", "glb")
    marked = marked_file(tmp_path / "room.glb")
    assert marked is not None
    small = as_bytes(photo_text(np.zeros((300, 400, 3), np.uint8)))
    opened = open_marked(replace(marked, photo=photo or small))
    assert opened.photo is None
    assert len(opened.changes) == 1
    assert said in opened.changes[0]


def test_text_that_is_no_bytes_is_none() -> None:
    assert as_bytes("not base 64!") is None
    assert as_bytes(None) is None
    assert as_bytes("") is None
