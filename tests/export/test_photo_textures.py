from __future__ import annotations

import contextlib
import io
import zipfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_core.export import FORMATS, export_scene
from diorama_core.export.gathering import ExportOptions, gather
from diorama_core.export.gltf import write_gathered
from diorama_core.export.pictures import fit_pictures
from diorama_core.importing.forms import read_mark
from diorama_core.importing.opening import open_marked
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import Architecture, PhotoMaterial, Plane, Pose, Scene, SceneObject
from tests.export.validators import gltf_findings, needs_gltf_validator

ART = np.random.default_rng(0).integers(0, 255, (64, 64, 3)).astype(np.uint8)


def hung_picture() -> Scene:
    shape = built_in_library().shape("picture-hills-oak")
    art = PhotoMaterial("picture", (0.5,) * 3, "picture-1-picture-0", "front")
    wood = PhotoMaterial("wood", (0.3, 0.2, 0.1), "picture-1-wood-1", "tiled", tile_m=0.2)
    item = SceneObject("picture_1", "print", shape.category, shape.id, shape.size_m, Pose.upright((0, 0, 1.5)))
    return Scene(objects=(replace(item, photo_materials=(art, wood)),))


def pictures() -> dict[str, np.ndarray]:
    return {"picture-1-picture-0": ART, "picture-1-wood-1": ART[::2, ::2].copy(), "wall": ART}


def test_pictures_that_the_scene_shows_are_bounded_together() -> None:
    bounded = fit_pictures(hung_picture(), pictures(), 40)
    texels = sum(p.shape[0] * p.shape[1] for name, p in bounded.items() if name != "wall")
    assert 0.9 * 40**2 < texels <= 40**2
    assert bounded["wall"].shape == ART.shape
    assert fit_pictures(hung_picture(), pictures(), 80)["picture-1-picture-0"] is ART


def test_pictures_of_planes_count_too_and_no_side_is_longer_than_the_squares() -> None:
    corners = np.array([[0.0, 1, 0], [1, 1, 0], [1, 1, 2], [0, 1, 2]])
    wall = Plane("wall_1", "wall", corners, texture="wall")
    walled = replace(hung_picture(), architecture=Architecture(planes=(wall,)))
    bounded = fit_pictures(walled, pictures(), 64)
    assert 0.9 * 64**2 < sum(p.shape[0] * p.shape[1] for p in bounded.values()) <= 64**2
    assert bounded["wall"].shape == bounded["picture-1-picture-0"].shape
    long = {**pictures(), "picture-1-picture-0": np.zeros((8, 200, 3), np.uint8)}
    assert fit_pictures(hung_picture(), long, 80)["picture-1-picture-0"].shape == (3, 80, 3)


def test_the_look_is_in_the_file_and_comes_back(tmp_path) -> None:
    path = tmp_path / "scene.glb"
    write_gathered(gather(hung_picture(), built_in_library(), textures=pictures()), path)
    opened = open_marked(read_mark(path))
    assert opened.scene.objects == hung_picture().objects
    np.testing.assert_array_equal(opened.textures["picture-1-picture-0"], ART)
    assert opened.textures["picture-1-wood-1"].shape == (32, 32, 3)


def test_the_librarys_own_is_written_when_it_is_chosen() -> None:
    scene = hung_picture()
    own = replace(scene, objects=(replace(scene.objects[0], material_source="library"),))
    gathered = gather(own, built_in_library(), textures=pictures(), options=ExportOptions())
    assert not any("from the photo" in m.name for m in gathered.materials)


@needs_gltf_validator
def test_the_khronos_validator_finds_nothing(tmp_path) -> None:
    path = tmp_path / "scene.glb"
    write_gathered(gather(hung_picture(), built_in_library(), textures=pictures()), path)
    assert gltf_findings(path) == []


TEXTURED = ("glb", "obj", "usda", "usdz", "mjcf", "urdf", "sdf", "sh3d")
"""Formats that carry pictures (docs/export.md)."""


def pictures_in(folder: Path) -> Iterator[np.ndarray]:
    """Every PNG and JPEG in the files of a folder, also within archives and binary files."""
    for path in folder.rglob("*"):
        if path.is_file():
            data = path.read_bytes()
            parts = [data]
            if zipfile.is_zipfile(path):
                with zipfile.ZipFile(path) as archive:
                    parts += [archive.read(name) for name in archive.namelist()]
            for part in parts:
                for mark in (b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff"):
                    start = part.find(mark)
                    while start >= 0:
                        with contextlib.suppress(OSError):
                            yield np.asarray(Image.open(io.BytesIO(part[start:])).convert("RGB"))
                        start = part.find(mark, start + 1)


@pytest.mark.parametrize("name", TEXTURED)
def test_every_format_with_pictures_has_the_photos(name: str, tmp_path: Path) -> None:
    if FORMATS[name].missing:
        pytest.skip(FORMATS[name].missing)
    red = {"picture-1-picture-0": np.full((48, 64, 3), (200, 30, 40), np.uint8)}
    export_scene(hung_picture(), built_in_library(), tmp_path / f"room{FORMATS[name].suffixes[0]}", name, textures=red)
    found = [p.reshape(-1, 3).mean(axis=0) for p in pictures_in(tmp_path)]
    assert min(np.abs(mean - (200, 30, 40)).max() for mean in found) < 8
