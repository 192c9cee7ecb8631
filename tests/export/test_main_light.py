from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.export.gathering import ExportOptions, gather
from diorama_core.export.gltf import write_gathered
from diorama_core.export.lights import SUN_LUX, main_light_of
from diorama_core.io.glb import read_glb
from diorama_core.scene.light_settings import LightSettings
from diorama_core.scene.types import RoomLight, Scene
from tests.export.validators import gltf_findings, needs_gltf_validator
from tests.primitives import PrimitiveLibrary, furnished_room

LIBRARY = PrimitiveLibrary()
LIGHT = RoomLight((0.6, 0.0, 0.8), 0.5)


def lit() -> Scene:
    return replace(furnished_room(LIBRARY), light=LIGHT)


def test_it_shines_from_where_the_light_is() -> None:
    light = main_light_of(lit())
    assert light is not None
    np.testing.assert_allclose(-light.T_world[:3, 2], [-0.6, 0.0, -0.8])
    np.testing.assert_allclose(light.T_world[:3, :3].T @ light.T_world[:3, :3], np.eye(3), atol=1e-12)
    assert np.linalg.det(light.T_world[:3, :3]) > 0
    assert main_light_of(replace(lit(), light=None)) is None


def test_glb_has_it_and_a_selection_has_not(tmp_path) -> None:
    path = tmp_path / "scene.glb"
    write_gathered(gather(lit(), LIBRARY), path)
    document, _ = read_glb(path.read_bytes())
    lights = document["extensions"]["KHR_lights_punctual"]["lights"]
    assert [light["type"] for light in lights if light["name"] == "main light"] == ["directional"]
    alone = ExportOptions(only=frozenset({furnished_room(LIBRARY).objects[0].id}))
    assert gather(lit(), LIBRARY, options=alone).main_light is None


@needs_gltf_validator
def test_the_khronos_validator_finds_nothing(tmp_path) -> None:
    path = tmp_path / "scene.glb"
    write_gathered(gather(lit(), LIBRARY), path)
    assert gltf_findings(path) == []


def test_the_sun_takes_its_place_by_day_and_there_is_none_at_night() -> None:
    noon = main_light_of(replace(lit(), light_settings=LightSettings(12.0, np.pi / 2)))
    assert noon is not None
    np.testing.assert_allclose(noon.T_world[:3, 2], [0.0, -np.sqrt(0.5), np.sqrt(0.5)], atol=1e-9)
    assert 50_000 < noon.lux < SUN_LUX
    assert main_light_of(replace(lit(), light_settings=LightSettings(23.0))) is None
