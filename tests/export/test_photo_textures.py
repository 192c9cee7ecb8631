from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.export.gathering import ExportOptions, gather
from diorama_core.export.gltf import write_gathered
from diorama_core.export.photo_textures import bounded_pictures
from diorama_core.importing.opening import marked_file, open_marked
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import PhotoMaterial, Pose, Scene, SceneObject
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


def test_pictures_of_objects_are_bounded_together() -> None:
    bounded = bounded_pictures(hung_picture(), pictures(), 40)
    texels = sum(p.shape[0] * p.shape[1] for name, p in bounded.items() if name != "wall")
    assert 0.9 * 40**2 < texels <= 40**2
    assert bounded["wall"].shape == ART.shape
    assert bounded_pictures(hung_picture(), pictures(), 80)["picture-1-picture-0"] is ART


def test_the_look_is_in_the_file_and_comes_back(tmp_path) -> None:
    path = tmp_path / "scene.glb"
    write_gathered(gather(hung_picture(), built_in_library(), textures=pictures()), path)
    opened = open_marked(marked_file(path))
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
