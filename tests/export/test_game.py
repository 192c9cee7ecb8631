"""A GLB for games: pivots, colliders, few materials and triangles; and the materials of it by themselves."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import trimesh

from diorama_core.export.game import MAX_TRIANGLES, write_game
from diorama_core.export.palette import GameMaterials
from diorama_core.io.glb import read_glb
from diorama_core.render.appearance import Material, Surface
from tests.export.scenes import gathered


def written(tmp_path: Path, **options: object) -> tuple[dict, trimesh.Scene, object]:
    scene = gathered("fittings", joints=True, **options)
    write_game(scene, tmp_path / "room.glb")
    return read_glb((tmp_path / "room.glb").read_bytes())[0], trimesh.load(tmp_path / "room.glb"), scene


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


def test_what_is_drawn_is_where_the_scene_has_it(tmp_path: Path) -> None:
    document, _, scene = written(tmp_path, engine="three")
    nodes = {n["name"]: n for n in document["nodes"]}
    for item in (o for o in scene.objects if scene.meshes[o.mesh].triangles < MAX_TRIANGLES):
        points = np.concatenate([s.vertices for s in scene.meshes[item.mesh].surfaces]) * item.scale
        expected = (points + np.array([0, 0, item.item.size_m[2] / 2]))[:, [0, 2, 1]] * [1, 1, -1]
        parts = document["meshes"][nodes[item.name]["mesh"]]["primitives"]
        bounds = [document["accessors"][p["attributes"]["POSITION"]] for p in parts]
        np.testing.assert_allclose(np.min([b["min"] for b in bounds], axis=0), expected.min(axis=0), atol=1e-5)
        np.testing.assert_allclose(np.max([b["max"] for b in bounds], axis=0), expected.max(axis=0), atol=1e-5)


def test_colliders_have_the_names_of_the_engine(tmp_path: Path) -> None:
    for engine, mark in (("godot", "-convcolonly"), ("unreal", "UCX_"), ("unity", None), ("three", None)):
        names = [n["name"] for n in written(tmp_path, engine=engine)[0]["nodes"]]
        assert any("-convcolonly" in n or "UCX_" in n for n in names) == (mark is not None)
        assert mark is None or sum(mark in n for n in names) > 10
        assert len(names) == len(set(names))


def test_there_are_few_materials_and_triangles(tmp_path: Path) -> None:
    document, _, scene = written(tmp_path, engine="three")
    assert len(document["materials"]) < len(scene.materials)
    for mesh in document["meshes"]:
        count = sum(document["accessors"][p["indices"]]["count"] // 3 for p in mesh["primitives"])
        assert count <= 1.25 * MAX_TRIANGLES, mesh["name"]
        materials = [p["material"] for p in mesh["primitives"]]
        assert len(materials) == len(set(materials))


def test_plain_colours_share_one_picture() -> None:
    def triangle(material: Material) -> Surface:
        corners = np.eye(3, dtype=np.float32)
        return Surface(corners, corners, np.array([[0, 1, 2]], dtype=np.int32), material)

    one_colour = np.tile(np.uint8([0, 0, 255]), (8, 8, 1))
    red, blue = Material("red", (1.0, 0.0, 0.0)), Material("blue", (1.0, 1.0, 1.0), texture=one_colour, roughness=0.2)
    glass = Material("glass", alpha=0.3)
    joined = GameMaterials([red, blue, glass]).merged(map(triangle, (red, blue, glass, glass)))
    assert [len(s.faces) for s in joined] == [2, 2]
    palette = joined[0]
    assert palette.uv is not None
    assert palette.material.texture is not None
    height, width = palette.material.texture.shape[:2]
    for corner, colour in ((0, (255, 0, 0)), (3, (0, 0, 255))):
        u, v = palette.uv[corner]
        assert tuple(palette.material.texture[int((1 - v) * height), int(u * width)]) == colour
