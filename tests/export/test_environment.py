"""A room's light as a file, and in USD."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from diorama_core.export import export_scene
from diorama_core.export.environment import NITS, as_picture, environment_of
from diorama_core.export.gathering import ExportOptions, gather
from diorama_core.io.srgb import srgb_to_linear
from diorama_core.render.panorama import directions
from tests.primitives import PrimitiveLibrary, furnished_room

LIBRARY = PrimitiveLibrary()
SCENE = furnished_room(LIBRARY)


def test_a_file_holds_the_radiance(tmp_path: Path) -> None:
    gathered = export_scene(SCENE, LIBRARY, tmp_path / "room.hdr", "hdr")
    read = cv2.imread(str(tmp_path / "room.hdr"), cv2.IMREAD_ANYDEPTH | cv2.IMREAD_COLOR)
    assert read.dtype == np.float32
    truth = environment_of(gathered)
    assert read.shape == truth.shape
    assert read[..., ::-1] == pytest.approx(truth, abs=0.01)


def test_a_picture_of_8_bits_says_what_its_white_is() -> None:
    radiance = np.linspace(0.0, 3.0, 64 * 32 * 3, dtype=np.float32).reshape(32, 64, 3)
    picture, brightest = as_picture(radiance)
    assert brightest == pytest.approx(3.0, rel=0.01)
    again = srgb_to_linear(picture / 255.0) * brightest
    assert again == pytest.approx(np.minimum(radiance, brightest), abs=0.02)


def test_domes_of_both_up_axes_show_the_room_where_it_is(tmp_path: Path) -> None:
    pxr = pytest.importorskip("pxr", reason="usd-core is an optional extra")
    for suffix in ("usda", "usdz"):
        path = tmp_path / f"room.{suffix}"
        export_scene(SCENE, LIBRARY, path, suffix)
        stage = pxr.Usd.Stage.Open(str(path))
        dome = pxr.UsdLux.DomeLight.Get(stage, "/Scene/Environment")
        assert dome
        assert dome.GetTextureFormatAttr().Get() == "latlong"
        assert 0.1 * NITS < dome.GetIntensityAttr().Get() < 10.0 * NITS
        picture = dome.GetTextureFileAttr().Get()
        assert picture.resolvedPath or (tmp_path / picture.path).is_file()
        # OpenEXR: longitude 0 is +Z of the dome and 90 degrees +X, its pole +Y; the scene lies below the root.
        to_world = np.array(pxr.UsdGeom.XformCache().GetLocalToWorldTransform(dome.GetPrim())).T[:3, :3]
        of_scene = np.array(pxr.UsdGeom.XformCache().GetLocalToWorldTransform(stage.GetPrimAtPath("/Scene"))).T[:3, :3]
        longitude = np.pi * (1 - 2 * (np.arange(64) + 0.5) / 64)
        in_dome = np.stack([np.sin(longitude), np.zeros(64), np.cos(longitude)], axis=1)
        in_scene = directions(64)[15:17].mean(axis=0)
        np.testing.assert_allclose(in_dome @ to_world.T, in_scene @ of_scene.T, atol=0.01)


def test_parts_of_a_scene_bring_no_environment() -> None:
    pytest.importorskip("pxr", reason="usd-core is an optional extra")
    from diorama_core.export.usd import build_stage
    from diorama_core.progress import Progress

    only = frozenset({SCENE.objects[0].id})
    stage, _ = build_stage(gather(SCENE, LIBRARY, options=ExportOptions(only=only)), "t", Progress(), up_axis="Z")
    assert not stage.GetPrimAtPath("/Scene/Environment")
