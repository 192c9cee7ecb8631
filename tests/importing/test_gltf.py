"""Scenes that come back from GLB files, as written and after other programs moved their nodes."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from diorama_core.errors import InputError
from diorama_core.export import export_scene
from diorama_core.export.gathering import ExportOptions
from diorama_core.importing.gltf import read_marked_gltf
from diorama_core.importing.opening import open_marked
from diorama_core.scene.types import Architecture, Candidate, Pose, Scene
from tests.export import gltf_reader
from tests.primitives import PrimitiveLibrary, furnished_room

LIBRARY = PrimitiveLibrary()


def edited_room() -> Scene:
    """Candidates, a lock, a hidden object, a finish, a stretched supporter."""
    scene = furnished_room(LIBRARY)
    other = Candidate("print", LIBRARY.shape("print").size_m, 0.7, Pose.upright((0.1, 3.0, 0.4), 0.3))
    changes = {
        "t": {"candidates": (other,), "locked": True, "pose": Pose.upright((0.2, 3.0, 0.4), 1.2, (1.3, 0.9, 1.1))},
        "c1": {"hidden": True, "mask_id": 4, "box_px": (1.0, 2.0, 30.5, 40.0)},
        "c2": {"finish": "gloss", "confidence": 0.3},
    }
    objects = tuple(replace(o, **changes.get(o.id, {})) for o in scene.objects)
    return replace(scene, objects=objects, metrics=(("overlap", 0.25),))


def written(tmp_path, scene: Scene, **more):
    path = tmp_path / "room.glb"
    export_scene(scene, LIBRARY, path, "glb", **more)
    return path


@contextmanager
def edited(path) -> Iterator[dict]:
    """A GLB's JSON, rewritten as another program would that moves nodes."""
    document, binary = gltf_reader.read(path.read_bytes())
    yield document
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    path.write_bytes(struct.pack("<III", 0x46546C67, 2, 12 + len(body)) + body)


def test_positions_that_are_stored_as_integers_scale_nothing(tmp_path) -> None:
    """As gltf-transform quantises: the node of a mesh is stretched to what its integers stand for."""
    path = written(tmp_path, edited_room())
    with edited(path) as document:
        carrying = {n["mesh"] for n in document["nodes"] if "mesh" in n and n.get("children")}
        for number, mesh in enumerate(document["meshes"]):
            if number in carrying:
                continue
            stored = [document["accessors"][p["attributes"]["POSITION"]] for p in mesh["primitives"]]
            low = np.min([a["min"] for a in stored], axis=0)
            half = float((np.max([a["max"] for a in stored], axis=0) - low).max()) / 2
            for accessor in stored:
                for end in ("min", "max"):
                    accessor[end] = np.rint(((np.array(accessor[end]) - low) / half - 1) * 32767).astype(int).tolist()
                accessor |= {"componentType": 5122, "normalized": True}
            for row in (n for n in document["nodes"] if n.get("mesh") == number):
                M = np.eye(4)
                M[:3, :3] = Rotation.from_quat(row.pop("rotation", [0, 0, 0, 1])).as_matrix()
                M[:3, :3] *= row.pop("scale", [1, 1, 1])
                M[:3, 3] = row.pop("translation", [0, 0, 0])
                M[:3, 3] += M[:3, :3] @ (low + half)
                M[:3, :3] *= half
                row["matrix"] = M.T.reshape(-1).tolist()
    assert back(path).scene == edited_room()
    assert back(path).changes == ()


def node(document: dict, name: str) -> dict:
    return next(n for n in document["nodes"] if n["name"] == name)


def back(path):
    marked = read_marked_gltf(path)
    return open_marked(marked)


def test_an_untouched_file_gives_the_same_scene(tmp_path) -> None:
    scene = edited_room()
    found = back(written(tmp_path, scene))
    assert found.scene == scene
    assert found.changes == ()


def test_moving_a_supporter_carries_what_stands_on_it(tmp_path) -> None:
    scene = edited_room()
    path = written(tmp_path, scene)
    with edited(path) as document:
        found = node(document, "table (t)")
        found["translation"] = [v + d for v, d in zip(found["translation"], (0.5, -0.25, 0.0), strict=True)]
    found = back(path)
    for name in ("t", "b"):
        moved = found.scene.object(name).pose.position - scene.object(name).pose.position
        np.testing.assert_allclose(moved, [0.5, -0.25, 0.0], atol=1e-5)
        np.testing.assert_allclose(found.scene.object(name).pose.scale, scene.object(name).pose.scale, atol=1e-6)
    assert found.scene.object("t").locked
    assert found.scene.supports == scene.supports
    candidate, before = found.scene.object("t").candidates[0], scene.object("t").candidates[0]
    np.testing.assert_allclose(candidate.pose.position - before.pose.position, [0.5, -0.25, 0.0], atol=1e-5)
    assert found.scene.object("c2") == scene.object("c2")
    assert [c.split(" was ")[1] for c in found.changes] == ["moved", "moved"]


def test_turned_and_stretched(tmp_path) -> None:
    scene = furnished_room(LIBRARY)
    path = written(tmp_path, scene)
    with edited(path) as document:
        found = node(document, "chair (c1)")
        found["rotation"] = Rotation.from_euler("z", 100, degrees=True).as_quat().tolist()
        found["scale"] = [1.0, 1.5, 0.8]
    pose = back(path).scene.object("c1").pose
    assert pose.yaw_rad == pytest.approx(np.radians(100), abs=1e-6)
    np.testing.assert_allclose(pose.scale, [1.0, 1.5, 0.8], atol=1e-6)


def test_deleted_and_copied_nodes(tmp_path) -> None:
    scene = furnished_room(LIBRARY)
    path = written(tmp_path, scene)
    with edited(path) as document:
        index = next(i for i, n in enumerate(document["nodes"]) if n["name"] == "chair (c1)")
        copied = {**node(document, "chair (c2)"), "name": "chair.001", "translation": [0.0, 1.0, 0.54]}
        document["nodes"].append(copied)
        branch = node(document, "objects")["children"]
        branch[branch.index(index)] = len(document["nodes"]) - 1
    found = back(path)
    assert not found.scene.has_object("c1")
    copies = [o for o in found.scene.objects if o.category == "chair" and o.id != "c2"]
    assert len(copies) == 1
    np.testing.assert_allclose(copies[0].pose.position, [0.0, 1.0, 0.54], atol=1e-6)
    assert copies[0].colour == scene.object("c2").colour
    edge = found.scene.support_of(copies[0].id)
    assert edge.parent == "floor"


def test_hung_below_another_node_it_stands_on_that(tmp_path) -> None:
    scene = furnished_room(LIBRARY)
    path = written(tmp_path, scene)
    with edited(path) as document:
        nodes = document["nodes"]
        index = nodes.index(node(document, "chair (c1)"))
        for n in nodes:
            n["children"] = [c for c in n.get("children", []) if c != index]
            if not n["children"]:
                del n["children"]
        node(document, "table (t)").setdefault("children", []).append(index)
    edge = back(path).scene.support_of("c1")
    assert (edge.parent, edge.relation) == ("t", "placed on")


def test_the_whole_room_moved_in_another_program(tmp_path) -> None:
    scene = furnished_room(LIBRARY)
    path = written(tmp_path, scene)
    with edited(path) as document:
        node(document, "diorama")["translation"] = [1.0, 0.0, 0.0]
    found = back(path).scene
    np.testing.assert_allclose(
        found.plane("floor").polygon, scene.plane("floor").polygon + np.array([1, 0, 0]), atol=1e-6
    )
    np.testing.assert_allclose(found.camera.position, scene.camera.position + np.array([1, 0, 0]), atol=1e-6)
    np.testing.assert_allclose(
        found.object("b").pose.position, scene.object("b").pose.position + np.array([1, 0, 0]), atol=1e-6
    )


def test_a_selection_deletes_nothing(tmp_path) -> None:
    scene = furnished_room(LIBRARY)
    path = written(tmp_path, scene, options=ExportOptions(only=frozenset({"t", "b"})))
    assert back(path).scene == scene


def test_pictures_on_planes_come_back(tmp_path) -> None:
    scene = furnished_room(LIBRARY)
    planes = tuple(replace(p, texture="w") if p.id == "back" else p for p in scene.architecture.planes)
    picture = np.zeros((40, 60, 3), np.uint8)
    picture[:20] = (250, 10, 10)
    path = written(tmp_path, replace(scene, architecture=Architecture(planes)), textures={"w": picture})
    found = back(path).textures["w"]
    high, low = found[: len(found) // 2 - 2], found[len(found) // 2 + 2 :]
    assert (high == (250, 10, 10)).all()
    assert (low == 0).all()


def test_foreign_and_broken_files(tmp_path) -> None:
    path = tmp_path / "foreign.glb"
    path.write_bytes(LIBRARY.glb("chair"))
    assert read_marked_gltf(path) is None
    path.write_bytes(b"glTF" + b"\0" * 40)
    with pytest.raises(InputError, match=r"foreign\.glb"):
        read_marked_gltf(path)
    damaged = written(tmp_path, furnished_room(LIBRARY))
    with edited(damaged) as document:
        found = node(document, "diorama")["extras"]
        found["diorama"] = found["diorama"].replace('"units": "metres"', '"units": "feet"')
    with pytest.raises(InputError, match="units"):
        back(damaged)
