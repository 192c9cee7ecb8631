"""A GLB for games: pivots, colliders, few materials and triangles; and the materials of it by themselves."""

from __future__ import annotations

from importlib.util import find_spec
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import shapely
import trimesh

from diorama_core.errors import ExportError
from diorama_core.export.game import MAX_SHARE_OF_FINER, unwrap, write_game
from diorama_core.export.palette import GameMaterials
from diorama_core.io.glb import read_glb
from diorama_core.render.appearance import Material, Surface
from tests.export.scenes import gathered
from tests.export.validators import gltf_findings, needs_gltf_validator

ENGINES = ("godot", "unreal", "unity", "three")


def written(tmp_path: Path, **options: object) -> tuple[dict, trimesh.Scene, object]:
    scene = gathered("fittings", joints=True, **options)
    write_game(scene, tmp_path / "room.glb")
    return read_glb((tmp_path / "room.glb").read_bytes())[0], trimesh.load(tmp_path / "room.glb"), scene


def triangles(document: dict, mesh: int) -> int:
    parts = document["meshes"][mesh]["primitives"]
    return sum(document["accessors"][p["indices"]]["count"] // 3 for p in parts)


def corners(document: dict, mesh: int) -> np.ndarray:
    parts = document["meshes"][mesh]["primitives"]
    bounds = [document["accessors"][p["attributes"]["POSITION"]] for p in parts]
    return np.array([np.min([b["min"] for b in bounds], axis=0), np.max([b["max"] for b in bounds], axis=0)])


def test_objects_stand_on_their_origin_and_parts_turn_about_theirs(tmp_path: Path) -> None:
    document, loaded, scene = written(tmp_path)
    nodes = {n["name"]: n for n in document["nodes"]}
    assert not any("scale" in n for n in document["nodes"])
    for item in scene.objects:
        foot = item.T_world @ [0.0, 0.0, -item.item.size_m[2] / 2, 1.0]
        np.testing.assert_allclose(nodes[item.name]["translation"], foot[[0, 2, 1]] * [1, 1, -1], atol=1e-6)
        for limb in item.limbs:
            about = nodes[f"{item.name} {limb.name}"]["extras"]
            assert about["joint"] == limb.kind
            hinge = item.T_world @ limb.T_object_limb @ [*limb.origin, 1.0]
            T = loaded.graph[f"{item.name} {limb.name}"][0]
            np.testing.assert_allclose(T[:3, 3], hinge[[0, 2, 1]] * [1, 1, -1], atol=1e-5)


@pytest.mark.parametrize("engine", ENGINES)
def test_metres_y_up_and_objects_that_look_along_z(engine: str, tmp_path: Path) -> None:
    """What glTF asks for, and what each engine's import turns to its own units and axes."""
    document, loaded, scene = written(tmp_path, engine=engine)
    nodes = {n["name"]: n for n in document["nodes"]}
    to_gltf = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
    for item in (o for o in scene.objects if scene.meshes[o.mesh].triangles < 1000):
        T = loaded.graph[item.name][0]
        np.testing.assert_allclose(T[:3, 2], to_gltf @ item.T_world[:3, 0], atol=1e-6)  # front
        np.testing.assert_allclose(T[:3, 1], to_gltf @ item.T_world[:3, 2], atol=1e-6)  # up
        points = np.concatenate([s.vertices for s in scene.meshes[item.mesh].surfaces]) * item.scale
        expected = (points + np.array([0, 0, item.item.size_m[2] / 2]))[:, [1, 2, 0]]
        shown = nodes[item.name] if "mesh" in nodes[item.name] else nodes[f"{item.name} shape"]
        bounds = corners(document, shown["mesh"])
        np.testing.assert_allclose(bounds, [expected.min(axis=0), expected.max(axis=0)], atol=1e-5)


@pytest.mark.parametrize("engine", ENGINES)
def test_coarser_levels_are_nodes_beside_the_scene(engine: str, tmp_path: Path) -> None:
    document, loaded, _ = written(tmp_path, engine=engine)
    nodes = document["nodes"]
    finest = [n for n in nodes if "MSFT_lod" in n.get("extensions", {})]
    assert ("MSFT_lod" in document.get("extensionsUsed", [])) == bool(finest) == (engine != "godot")
    shown = {child for n in nodes for child in n.get("children", [])}
    for node in finest:
        ids = node["extensions"]["MSFT_lod"]["ids"]
        assert not shown & set(ids)
        assert not node.get("children"), "a level takes its children along when it is hidden"
        levels = [node, *(nodes[k] for k in ids)]
        assert [n["name"] for n in levels[1:]] == [f"{node['name']}_LOD{k}" for k in range(1, len(levels))]
        assert len({str((n.get("rotation"), n.get("translation"))) for n in levels}) == 1
        counts = [triangles(document, n["mesh"]) for n in levels]
        assert all(b <= MAX_SHARE_OF_FINER * a for a, b in pairwise(counts)), node["name"]
        covered = node["extras"]["MSFT_screencoverage"]
        assert len(covered) == len(levels)
        assert covered == sorted(covered, reverse=True)
        assert covered[-1] == 0.0
        sizes = [np.ptp(corners(document, n["mesh"]), axis=0) for n in levels]
        assert max(np.abs(s - sizes[0]).max() for s in sizes) < 0.1 * sizes[0].max()
    assert not any("_LOD" in name for name in loaded.graph.nodes_geometry)


def test_triangles_keep_to_their_budgets(tmp_path: Path) -> None:
    counts = {}
    for name, asked in (("each", {"max_triangles": 2400}), ("all", {"max_total_triangles": 12000}), ("free", {})):
        document, _, scene = written(tmp_path, engine="unity", **asked)
        levels = {k for n in document["nodes"] for k in n.get("extensions", {}).get("MSFT_lod", {}).get("ids", [])}
        finest = {
            n["name"]: triangles(document, n["mesh"])
            for k, n in enumerate(document["nodes"])
            if "mesh" in n and k not in levels
        }
        counts[name] = [sum(v for k, v in finest.items() if k.startswith(o.name)) for o in scene.objects]
        assert sum(finest.values()) <= asked.get("max_total_triangles", np.inf)
    assert max(counts["each"]) <= 1.25 * 2400
    assert max(counts["all"]) < max(counts["free"])
    with pytest.raises(ExportError, match=r"its shapes keep \d+ triangles, 500 were"):
        written(tmp_path, max_total_triangles=500)


def test_colliders_have_the_names_of_the_engine(tmp_path: Path) -> None:
    for engine, mark in zip(ENGINES, ("-convcolonly", "UCX_", None, None), strict=True):
        names = [n["name"] for n in written(tmp_path, engine=engine)[0]["nodes"]]
        assert any("-convcolonly" in n or "UCX_" in n for n in names) == (mark is not None)
        assert mark is None or sum(mark in n for n in names) > 10
        assert len(names) == len(set(names))


def test_there_are_few_materials_and_triangles(tmp_path: Path) -> None:
    document, _, scene = written(tmp_path, engine="three")
    assert len(document["materials"]) < len(scene.materials)
    for mesh in document["meshes"]:
        count = sum(document["accessors"][p["indices"]]["count"] // 3 for p in mesh["primitives"])
        assert count <= 1.25 * scene.options.max_triangles, mesh["name"]
        materials = [p["material"] for p in mesh["primitives"]]
        assert len(materials) == len(set(materials))


def test_plain_colours_share_one_picture() -> None:
    def triangle(material: Material) -> Surface:
        corners = np.eye(3, dtype=np.float32)
        return Surface(corners, corners, np.array([[0, 1, 2]], dtype=np.int32), material)

    one_colour = np.tile(np.uint8([0, 0, 255]), (8, 8, 1))
    red, blue = Material("red", (1.0, 0.0, 0.0)), Material("blue", (1.0, 1.0, 1.0), texture=one_colour, roughness=0.2)
    glass = Material("glass", alpha=0.3)
    joined = GameMaterials([red, blue, glass]).merge(map(triangle, (red, blue, glass, glass)))
    assert [len(s.faces) for s in joined] == [2, 2]
    palette = joined[0]
    assert palette.uv is not None
    assert palette.material.texture is not None
    height, width = palette.material.texture.shape[:2]
    for corner, colour in ((0, (255, 0, 0)), (3, (0, 0, 255))):
        u, v = palette.uv[corner]
        assert tuple(palette.material.texture[int((1 - v) * height), int(u * width)]) == colour


needs_xatlas = pytest.mark.skipif(find_spec("xatlas") is None, reason="xatlas is not installed (optional extra 'game')")


@needs_xatlas
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


@needs_xatlas
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


@needs_xatlas
@needs_gltf_validator
def test_the_khronos_validator_finds_nothing(tmp_path: Path) -> None:
    write_game(gathered("primitives", light_uv=True), tmp_path / "room.glb")
    unused = "UNUSED_OBJECT"  # coordinates of a set that waits for its picture
    assert [f for f in gltf_findings(tmp_path / "room.glb") if unused not in f] == []
