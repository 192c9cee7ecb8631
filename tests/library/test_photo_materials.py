from __future__ import annotations

import numpy as np
import trimesh
from PIL import Image
from trimesh.visual.material import PBRMaterial

from diorama_core.library.catalogue import built_in_library
from diorama_core.library.photo_materials import PhotographedMaterial, shows_wood, with_photo_materials
from diorama_core.library.slots import slots_of
from diorama_core.scene.types import PhotoMaterial

LIBRARY = built_in_library()
ART = np.random.default_rng(0).integers(0, 255, (20, 30, 3)).astype(np.uint8)


def scene() -> trimesh.Scene:
    art, frame = trimesh.creation.box((0.02, 0.8, 0.6)), trimesh.creation.box((0.04, 1.0, 0.8))
    art.visual = trimesh.visual.TextureVisuals(material=PBRMaterial(name="painting"))
    frame.visual = trimesh.visual.TextureVisuals(material=PBRMaterial(name="oak"))
    return trimesh.Scene({"art": art, "frame": frame})


def test_a_face_shows_the_whole_picture_and_the_frame_stays() -> None:
    shown = with_photo_materials(scene(), [PhotoMaterial("picture", (0.5,) * 3, "art", "front")], {"art": ART})
    material = shown.geometry["art"].visual.material
    assert isinstance(material, PhotographedMaterial)
    np.testing.assert_array_equal(np.asarray(material.baseColorTexture), ART)
    uv = shown.geometry["art"].visual.uv
    np.testing.assert_allclose([uv.min(axis=0), uv.max(axis=0)], [[0, 0], [1, 1]], atol=1e-9)
    assert shown.geometry["frame"].visual.material.name == "oak"


def test_a_face_without_its_picture_keeps_its_own() -> None:
    shown = with_photo_materials(scene(), [PhotoMaterial("picture", (0.5,) * 3, "art", "front")], {})
    assert shown.geometry["art"].visual.material.name == "painting"


def test_a_plain_material_is_its_colour() -> None:
    shown = with_photo_materials(scene(), [PhotoMaterial("wood", (1.0, 0.5, 0.0), roughness=0.3, main=True)], {})
    material = shown.geometry["frame"].visual.material
    np.testing.assert_allclose(
        np.asarray(material.baseColorFactor)[:3], [255, 54, 0], atol=1
    )  # glTF factors are linear
    assert material.roughnessFactor == 0.3


def test_painted_wood_shows_no_grain_and_bare_wood_keeps_it() -> None:
    def worn(colour: tuple[float, float, float]) -> PBRMaterial:
        parts = scene()
        grain = PBRMaterial(name="oak", baseColorTexture=Image.fromarray(ART))
        uv = np.zeros((len(parts.geometry["frame"].vertices), 2))
        parts.geometry["frame"].visual = trimesh.visual.TextureVisuals(uv=uv, material=grain)
        shown = with_photo_materials(parts, [PhotoMaterial("wood", colour, main=True)], {})
        return shown.geometry["frame"].visual.material

    assert worn((0.55, 0.4, 0.25)).baseColorTexture is not None
    white = worn((0.9, 0.9, 0.87))
    assert white.baseColorTexture is None
    assert 240 > white.baseColorFactor[0] > 190
    assert all(map(shows_wood, ((0.35, 0.25, 0.18), (0.8, 0.7, 0.57))))
    assert not any(map(shows_wood, ((0.5, 0.5, 0.5), (0.4, 0.5, 0.4))))


def test_the_librarys_patterns_give_way_to_plain_cloth_and_its_weaves_stay() -> None:
    def worn(shape_id: str) -> PBRMaterial:
        parts = LIBRARY.parts(shape_id)
        slot = next(s for s in slots_of(parts) if s.main)
        shown = with_photo_materials(parts, [PhotoMaterial(slot.name, (0.4, 0.3, 0.3), main=True)], {})
        return shown.geometry[slot.geometry[0]].visual.material

    assert worn("pillow-kilim").baseColorTexture is None
    assert worn("curtain-linen-pair").baseColorTexture is not None


def test_a_tiled_material_is_measured_in_metres() -> None:
    tiled = PhotoMaterial("wood", (0.5,) * 3, "grain", "tiled", tile_m=0.25, main=True)
    uv = with_photo_materials(scene(), [tiled], {"grain": ART}).geometry["frame"].visual.uv
    assert np.isclose(np.ptp(uv, axis=0).max(), 1.0 / 0.25)


def test_the_given_shape_is_unchanged() -> None:
    parts = scene()
    with_photo_materials(parts, [PhotoMaterial("wood", (1.0, 0.5, 0.0), main=True)], {})
    assert parts.geometry["frame"].visual.material.name == "oak"
