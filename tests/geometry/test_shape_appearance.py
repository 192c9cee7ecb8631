"""Triangles and colours of shapes, remembered."""

from __future__ import annotations

import numpy as np
import trimesh
from PIL import Image

from diorama_core.geometry.shape_appearance import AppearanceStore, appearance_of, face_colours, material_rgb
from tests.primitives import PrimitiveLibrary

LIBRARY = PrimitiveLibrary()


def test_an_appearance_has_all_triangles_and_every_colour() -> None:
    appearance = appearance_of(LIBRARY.parts("table"))
    mesh = LIBRARY.mesh("table")
    assert len(appearance.faces) == len(mesh.faces)
    assert np.allclose(np.ptp(appearance.vertices, axis=0), mesh.extents, atol=1e-6)
    assert len(np.unique(appearance.colours_srgb, axis=0)) == 2
    assert abs(appearance.areas_m2.sum() - mesh.area) < 1e-6


def test_nodes_are_placed() -> None:
    scene = trimesh.Scene()
    T = trimesh.transformations.translation_matrix((5.0, 0.0, 0.0))
    scene.add_geometry(trimesh.creation.box((1, 1, 1)), transform=T)
    assert appearance_of(scene).vertices[:, 0].min() == 4.5


def test_an_appearance_is_made_once_and_read_back_the_same(tmp_path) -> None:
    made = []

    def parts() -> trimesh.Scene:
        made.append(1)
        return LIBRARY.parts("chair")

    first = AppearanceStore().get("key", tmp_path, parts)
    store = AppearanceStore()
    again = store.get("key", tmp_path, parts)
    assert store.get("key", tmp_path, parts) is again
    assert len(made) == 1
    assert (first.vertices == again.vertices).all()
    assert (first.faces == again.faces).all()
    assert (first.areas_m2 == again.areas_m2).all()
    assert (first.face_rgba == again.face_rgba).all()


def test_half_a_file_is_made_again(tmp_path) -> None:
    AppearanceStore().get("key", tmp_path, lambda: LIBRARY.parts("chair"))
    (file,) = tmp_path.iterdir()
    file.write_bytes(file.read_bytes()[:100])
    assert len(AppearanceStore().get("key", tmp_path, lambda: LIBRARY.parts("chair")).faces)


def test_a_folder_that_cannot_be_written_loses_nothing(tmp_path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("")
    assert len(AppearanceStore().get("key", blocked, lambda: LIBRARY.parts("chair")).faces)


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


def striped(uv) -> trimesh.Trimesh:
    """One triangle of a picture whose upper half is red and whose lower half is blue."""
    pixels = np.zeros((8, 8, 3), np.uint8)
    pixels[:4], pixels[4:] = (200, 0, 0), (0, 0, 200)
    material = trimesh.visual.material.PBRMaterial(baseColorTexture=Image.fromarray(pixels))
    visual = trimesh.visual.TextureVisuals(uv=np.array(uv), material=material)
    return trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], visual=visual, process=False)


def test_a_face_has_the_colour_of_its_part_of_the_picture() -> None:
    upper, lower, beyond = (
        face_colours(striped([(0.1, v), (0.9, v), (0.5, v + 0.1)]))[0].tolist() for v in (0.7, 0.2, -0.8)
    )
    assert upper == [200, 0, 0, 255]
    assert lower == beyond == [0, 0, 200, 255]


def test_faces_keep_their_own_colours_and_their_opacity() -> None:
    box = trimesh.creation.box((1, 1, 1))
    box.visual.face_colors = [(10 * k, 5, 7, 255) for k in range(12)]
    assert face_colours(box)[:, 0].tolist() == [10 * k for k in range(12)]
    box = trimesh.creation.box((1, 1, 1))
    glass = trimesh.visual.material.PBRMaterial(baseColorFactor=[255, 255, 255, 60], alphaMode="BLEND")
    box.visual = trimesh.visual.TextureVisuals(uv=np.zeros((len(box.vertices), 2)), material=glass)
    assert (face_colours(box) == [255, 255, 255, 60]).all()


def test_without_colours_nothing_is_known_of_a_face() -> None:
    scene = trimesh.Scene({"plain": trimesh.creation.box((1, 1, 1))})
    assert not appearance_of(scene).face_rgba.any()
    assert appearance_of(trimesh.Scene()).face_rgba.shape == (0, 4)
