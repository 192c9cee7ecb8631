"""Coordinates for baked light: in the square, without overlaps, the mesh itself unchanged."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import shapely

from diorama_core.errors import ExportError
from diorama_core.export.game import write_game
from diorama_core.export.unwrapping import unwrap
from diorama_core.io.glb import read_glb
from tests.export.scenes import gathered
from tests.export.validators import gltf_findings, needs_gltf_validator

pytest.importorskip("xatlas", reason="xatlas is not installed (optional extra 'game')")


def test_no_two_triangles_share_a_texel() -> None:
    scene = gathered("fittings")
    surfaces = scene.meshes[scene.object("desk_1").mesh].surfaces
    after = list(unwrap(surfaces))
    uv = [s.light_uv[s.faces] for s in after if s.light_uv is not None]
    triangles = shapely.polygons(np.concatenate(uv))
    assert shapely.bounds(triangles).min() >= 0.0
    assert shapely.bounds(triangles).max() <= 1.0
    covered = shapely.union_all(shapely.make_valid(triangles)).area
    assert covered == pytest.approx(shapely.area(triangles).sum(), rel=1e-3)
    for before, now in zip(surfaces, after, strict=True):
        np.testing.assert_array_equal(before.vertices[before.faces], now.vertices[now.faces])
        np.testing.assert_array_equal(before.normals[before.faces], now.normals[now.faces])


def test_a_game_pack_has_both_sets_where_it_is_asked_for(tmp_path: Path) -> None:
    for asked, compression in ((False, "none"), (True, "none"), (True, "meshopt")):
        scene = gathered("primitives", light_uv=asked, engine="three", compression=compression)
        write_game(scene, tmp_path / "room.glb")
        document = read_glb((tmp_path / "room.glb").read_bytes())[0]
        parts = [set(p["attributes"]) for m in document["meshes"] for p in m["primitives"]]
        assert all(("TEXCOORD_1" in names) == asked for names in parts)
        assert all("TEXCOORD_0" in names for names in parts if asked)
    with pytest.raises(ExportError, match="leave out its compression or --light-uv"):
        write_game(gathered("primitives", light_uv=True, compression="draco"), tmp_path / "room.glb")


@needs_gltf_validator
def test_the_khronos_validator_finds_nothing(tmp_path: Path) -> None:
    write_game(gathered("primitives", light_uv=True), tmp_path / "room.glb")
    unused = "UNUSED_OBJECT"  # coordinates of a set that waits for its picture
    assert [f for f in gltf_findings(tmp_path / "room.glb") if unused not in f] == []
