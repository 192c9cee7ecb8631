"""Lights of files show a room as bright as pictures do where a camera has no exposure: direct light on its planes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from diorama_core.export.gathering import ExportOptions, ExportScene, LightUnits, gather
from diorama_core.export.gltf import glb_bytes
from diorama_core.io.glb import read_glb
from diorama_core.scene.light_settings import LightSettings
from diorama_core.scene.types import RoomLight
from tests.export.scenes import scene_of

Shining = tuple[str, np.ndarray, float]
"""Kind, transform below the scene's root, and candela or lux."""
MAX_SHARE = 1.1
"""Pictures have .89 on average; where these are measured, it is brighter than in corners."""
PHOTO = RoomLight((0.6, 0.0, 0.8), 0.3)
SETTINGS = {
    "photo": LightSettings(),
    "noon": LightSettings(12.0),
    "night with a lamp": LightSettings(23.0, lamps_on=("lamp_1",)),
}


def lit(setting: str, lights: LightUnits = "unit") -> ExportScene:
    scene, library = scene_of("fittings")
    scene = replace(scene, light=PHOTO, light_settings=SETTINGS[setting])
    return gather(scene, library, options=ExportOptions(lights=lights))


def glb_lights(gathered: ExportScene) -> Iterator[Shining]:
    document, _ = read_glb(glb_bytes(gathered.scene, gathered.library, options=gathered.options))
    nodes = document["nodes"]
    kinds = document.get("extensions", {}).get("KHR_lights_punctual", {}).get("lights", [])

    def below(index: int, above: np.ndarray) -> Iterator[Shining]:
        node, T = nodes[index], np.eye(4)
        T[:3, :3] = Rotation.from_quat(node.get("rotation", [0, 0, 0, 1])).as_matrix()
        T[:3, 3] = node.get("translation", [0, 0, 0])
        if "extensions" in node:
            light = kinds[node["extensions"]["KHR_lights_punctual"]["light"]]
            yield light["type"], above @ T, light["intensity"]
        for child in node.get("children", ()):
            yield from below(child, above @ T)

    (root,) = document["scenes"][0]["nodes"]
    for child in nodes[root]["children"]:
        yield from below(child, np.eye(4))


def usd_lights(gathered: ExportScene) -> Iterator[Shining]:
    pytest.importorskip("pxr", reason="usd-core is not installed (optional extra 'usd')")
    from pxr import UsdGeom, UsdLux

    from diorama_core.export.usd import build_stage
    from diorama_core.progress import Progress

    stage, _ = build_stage(gathered, "textures", Progress(), up_axis="Z")
    for prim in stage.Traverse():
        T = np.array(UsdGeom.XformCache().GetLocalToWorldTransform(prim)).T
        if prim.IsA(UsdLux.SphereLight):
            light = UsdLux.SphereLight(prim)
            yield "point", T, light.GetIntensityAttr().Get() * np.pi * light.GetRadiusAttr().Get() ** 2
        elif prim.IsA(UsdLux.RectLight):
            window = UsdLux.RectLight(prim)
            area = window.GetWidthAttr().Get() * window.GetHeightAttr().Get()
            yield "spot", T, window.GetIntensityAttr().Get() * area
        elif prim.IsA(UsdLux.DistantLight):
            yield "directional", T, UsdLux.DistantLight(prim).GetIntensityAttr().Get()
        assert not prim.IsA(UsdLux.DomeLight), "beside lamps it counts light twice"


def white_share(gathered: ExportScene, lights: Iterator[Shining]) -> np.ndarray:
    """Luminance of a white surface halfway from the middle of every plane to each corner, where 1 is white."""
    found = list(lights)
    seen = []
    planes = gathered.scene.architecture.planes
    for plane, point in ((p, (p.centre + corner) / 2) for p in planes for corner in p.polygon):
        irradiance = 0.0
        for kind, T, strength in found:
            if kind == "directional":
                irradiance += strength * max(float(T[:3, 2] @ plane.normal), 0.0)
                continue
            ray = T[:3, 3] - point
            distance = float(np.linalg.norm(ray))
            facing = 1.0 if kind == "point" else max(float(T[:3, 2] @ ray) / distance, 0.0)
            irradiance += strength * facing * max(float(ray @ plane.normal) / distance, 0.0) / max(distance, 0.5) ** 2
        seen.append(irradiance / np.pi)
    return np.array(seen)


@pytest.mark.parametrize("read", [glb_lights, usd_lights])
@pytest.mark.parametrize("setting", list(SETTINGS))
def test_a_white_room_is_neither_blank_nor_black(read, setting: str) -> None:
    gathered = lit(setting)
    share = white_share(gathered, read(gathered))
    assert 0.1 < share.mean() < MAX_SHARE
    assert share.max() < 2.0


@pytest.mark.parametrize("read", [glb_lights, usd_lights])
def test_photometric_lights_are_in_lux_on_request_and_may_be_left_out(read) -> None:
    gathered = lit("photo", "photometric")
    assert white_share(gathered, read(gathered)).mean() > 20
    assert not list(read(lit("noon", "none")))


def test_a_room_without_lamps_is_lit() -> None:
    scene, library = scene_of("empty shell")
    gathered = gather(scene, library)
    for read in (glb_lights, usd_lights):
        assert 0.1 < white_share(gathered, read(gathered)).mean() < MAX_SHARE
