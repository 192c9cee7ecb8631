"""Pictures of materials are painted once, kept, and painted again when their file is damaged."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from diorama_core.library import cached_pictures, furniture
from diorama_core.library.cached_pictures import cached_picture, scene_with_pictures
from diorama_core.library.furniture import materials
from diorama_core.library.furniture.materials import picture_bytes
from diorama_core.library.furniture.model import built, scene_of
from diorama_core.library.furniture.roles import with_roles

DESIGN = next(d for d in furniture.designs() if d.id == "bed-channel-green")


def test_a_shape_is_the_same_with_cached_pictures(tmp_path: Path) -> None:
    solids = built(DESIGN)
    painted = with_roles(scene_of(solids), [material for material, _ in solids])
    for _ in range(2):
        cached_picture.cache_clear()
        kept = scene_with_pictures(solids, tmp_path)
        assert list(kept.geometry) == list(painted.geometry)
        for mesh, other in zip(kept.geometry.values(), painted.geometry.values(), strict=True):
            assert np.array_equal(mesh.vertices, other.vertices)
            assert mesh.metadata == other.metadata
            ours, theirs = mesh.visual.material, other.visual.material
            assert np.array_equal(np.asarray(ours.baseColorTexture), np.asarray(theirs.baseColorTexture))
            assert (ours.name, ours.roughnessFactor) == (theirs.name, theirs.roughnessFactor)


def test_a_picture_is_painted_once_and_again_when_cut_off(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    painted: list[str] = []

    def paint(material: materials.Material) -> bytes:
        painted.append(material.name)
        return picture_bytes(material)

    monkeypatch.setattr(cached_pictures, "picture_bytes", paint)
    monkeypatch.setattr(cached_pictures, "_code", lambda: "as it is")
    for _ in range(2):
        cached_picture.cache_clear()
        assert cached_picture(materials.OAK, tmp_path) == picture_bytes(materials.OAK)
    assert painted == [materials.OAK.name]
    (path,) = tmp_path.iterdir()
    path.write_bytes(path.read_bytes()[:-20])
    cached_picture.cache_clear()
    assert cached_picture(materials.OAK, tmp_path) == picture_bytes(materials.OAK)
    assert len(painted) == 2
    # Another colour and another code are other pictures.
    cached_picture(dataclasses.replace(materials.OAK, colour="#808080"), tmp_path)
    monkeypatch.setattr(cached_pictures, "_code", lambda: "as it will be")
    cached_picture.cache_clear()
    cached_picture(materials.OAK, tmp_path)
    assert len(painted) == 4
    assert len(list(tmp_path.iterdir())) == 3
