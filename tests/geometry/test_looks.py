"""Triangles and colours of shapes, remembered."""

from __future__ import annotations

import numpy as np
import trimesh
from PIL import Image

from diorama_core.geometry.looks import LookStore, look_of, material_rgb
from tests.primitives import PrimitiveLibrary

LIBRARY = PrimitiveLibrary()


def test_a_look_has_all_triangles_and_every_colour() -> None:
    look = look_of(LIBRARY.parts("table"))
    mesh = LIBRARY.mesh("table")
    assert len(look.faces) == len(mesh.faces)
    assert np.allclose(np.ptp(look.vertices, axis=0), mesh.extents, atol=1e-6)
    assert len(np.unique(look.colours_srgb, axis=0)) == 2
    assert abs(look.areas_m2.sum() - mesh.area) < 1e-6


def test_nodes_are_placed() -> None:
    scene = trimesh.Scene()
    T = trimesh.transformations.translation_matrix((5.0, 0.0, 0.0))
    scene.add_geometry(trimesh.creation.box((1, 1, 1)), transform=T)
    assert look_of(scene).vertices[:, 0].min() == 4.5


def test_a_look_is_made_once_and_read_back_the_same(tmp_path) -> None:
    made = []

    def parts() -> trimesh.Scene:
        made.append(1)
        return LIBRARY.parts("chair")

    first = LookStore().get("key", tmp_path, parts)
    store = LookStore()
    again = store.get("key", tmp_path, parts)
    assert store.get("key", tmp_path, parts) is again
    assert len(made) == 1
    assert (first.vertices == again.vertices).all()
    assert (first.faces == again.faces).all()
    assert (first.areas_m2 == again.areas_m2).all()


def test_half_a_file_is_made_again(tmp_path) -> None:
    LookStore().get("key", tmp_path, lambda: LIBRARY.parts("chair"))
    (file,) = tmp_path.iterdir()
    file.write_bytes(file.read_bytes()[:100])
    assert len(LookStore().get("key", tmp_path, lambda: LIBRARY.parts("chair")).faces)


def test_a_folder_that_cannot_be_written_loses_nothing(tmp_path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("")
    assert len(LookStore().get("key", blocked, lambda: LIBRARY.parts("chair")).faces)


def test_colours_are_those_that_viewers_show() -> None:
    picture = Image.new("RGB", (4, 4), (63, 95, 82))
    plain = trimesh.visual.material.PBRMaterial(baseColorTexture=picture)
    halved = trimesh.visual.material.PBRMaterial(baseColorTexture=picture, baseColorFactor=[0.5, 0.5, 0.5, 1.0])
    tinted = trimesh.visual.material.PBRMaterial(baseColorFactor=[0.2140, 0.0, 1.0, 1.0])
    seen = []
    for material in (plain, halved, tinted):
        box = trimesh.creation.box((1, 1, 1))
        box.visual = trimesh.visual.TextureVisuals(uv=np.zeros((len(box.vertices), 2)), material=material)
        seen.append(material_rgb(box.visual))
    assert np.array_equal(seen[0], [63, 95, 82])
    assert np.allclose(seen[1], [45, 69, 59], atol=2)  # half the light, not half the number
    assert np.allclose(seen[2], [128, 0, 255], atol=2)
