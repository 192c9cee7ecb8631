from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import meshoptimizer
import numpy as np
import pytest
from scipy.spatial import KDTree

from diorama_core.errors import UnavailableError
from diorama_core.export.blender import blender_python, missing_blender
from diorama_core.export.gltf import write_gathered
from diorama_core.export.gltf_document import (
    DRACO_EXTENSION,
    draco_mesh,
    encode_faces,
    encode_vertices,
    prepare,
    tangents,
)
from diorama_core.geometry.rotations import rotation_from_vector
from tests.export import gltf_reader
from tests.export.scenes import gathered
from tests.export.surfaces import ball, quad

DracoPy = pytest.importorskip("DracoPy", reason="DracoPy is not installed (optional extra 'draco')")


@pytest.mark.parametrize("turn", [(0.0, 0.0, 0.0), (0.3, -1.0, 0.6)])
def test_tangents_follow_u_and_the_sign_gives_v_as_pictures_have_it(turn) -> None:
    R = rotation_from_vector(np.array(turn))
    found = tangents(quad(turn=R))
    np.testing.assert_allclose(found[:, :3], np.tile(R[:, 0], (4, 1)), atol=1e-6)
    # The bitangent normal x tangent x sign points along falling v of the file, whose v grows downward.
    np.testing.assert_array_equal(found[:, 3], -1.0)


def test_a_mirrored_picture_turns_the_sign() -> None:
    surface = quad()
    mirrored = replace(surface, uv=surface.uv * np.array([-1, 1], np.float32))
    found = tangents(mirrored)
    np.testing.assert_allclose(found[:, :3], np.tile([-1, 0, 0], (4, 1)), atol=1e-6)
    np.testing.assert_array_equal(found[:, 3], -tangents(surface)[:, 3])


def test_they_are_unit_and_square_to_the_normals_even_without_information() -> None:
    surface = ball()
    blank = replace(surface, uv=np.zeros((len(surface.vertices), 2), np.float32))
    found = tangents(blank)
    assert np.isfinite(found).all()
    np.testing.assert_allclose(np.linalg.norm(found[:, :3], axis=1), 1.0, atol=1e-5)
    np.testing.assert_allclose((found[:, :3] * surface.normals).sum(axis=1), 0.0, atol=1e-5)
    assert set(found[:, 3]) <= {-1.0, 1.0}


def test_without_coordinates_there_is_nothing_to_follow() -> None:
    with pytest.raises(ValueError, match="texture coordinates"):
        tangents(quad(uv=False))


def triangles(arrays: dict[str, np.ndarray], faces: np.ndarray) -> np.ndarray:
    """Middle and vector area of every triangle, the latter weighted so that both count alike."""
    a, b, c = (arrays["POSITION"][faces[:, k]].astype(float) for k in range(3))
    return np.concatenate([(a + b + c) / 3, 10.0 * np.cross(b - a, c - a)], axis=1)


def farthest(these: np.ndarray, those: np.ndarray) -> float:
    """How far the worst of these triangles is from its nearest of those."""
    assert len(these) == len(those)
    distances, nearest = KDTree(those).query(these)
    assert len(set(nearest.tolist())) == len(these), "each has its own"
    return float(distances.max())


def test_triangles_stay_the_same_within_a_sixteenth_of_a_millimetre() -> None:
    surface = ball()
    extra = np.vstack([surface.vertices, [[9.0, 9.0, 9.0]]]).astype(np.float32)
    arrays = {"POSITION": extra, "NORMAL": np.vstack([surface.normals, [[0, 0, 1.0]]]).astype(np.float32)}
    made, faces = prepare(arrays, surface.faces)
    assert len(made["POSITION"]) == len(surface.vertices), "what no face uses is left out"
    assert sorted(set(faces.ravel())) == list(range(len(surface.vertices)))
    assert farthest(triangles(made, faces), triangles({"POSITION": surface.vertices}, surface.faces)) < 2e-4
    steps = made["POSITION"] * 2**14
    np.testing.assert_array_equal(steps, np.round(steps))
    assert made["NORMAL"].dtype == np.int8
    assert made["NORMAL"].shape[1] == 4
    unit = made["NORMAL"][:, :3] / 127.0
    np.testing.assert_allclose(np.linalg.norm(unit, axis=1), 1.0, atol=0.02)


def test_what_is_encoded_decodes_to_the_same_bytes() -> None:
    made, faces = prepare({"POSITION": ball().vertices}, ball().faces)
    data = encode_vertices(made["POSITION"])
    assert len(data) < made["POSITION"].nbytes
    decoded = meshoptimizer.decode_vertex_buffer(len(made["POSITION"]), 12, data).reshape(-1, 3)
    np.testing.assert_array_equal(decoded, made["POSITION"])
    indices = encode_faces(faces.reshape(-1), len(decoded))
    back = meshoptimizer.decode_index_buffer(faces.size, 4, indices)
    assert len(indices) < 4 * faces.size
    assert farthest(triangles(made, back.reshape(-1, 3)), triangles(made, faces)) < 1e-9


def test_a_primitive_decodes_to_the_same_triangles() -> None:
    surface = ball(radius=0.5)
    uv = np.ascontiguousarray(surface.vertices[:, :2])
    tangents = np.tile(np.array([1, 0, 0, -1], np.float32), (len(uv), 1))
    arrays = {"POSITION": surface.vertices, "NORMAL": surface.normals, "TEXCOORD_0": uv, "TANGENT": tangents}
    packed = draco_mesh(arrays, surface.faces)
    assert set(packed.attributes) == set(arrays)
    assert packed.triangles == len(surface.faces)
    decoded = DracoPy.decode(packed.data)
    there = triangles({"POSITION": np.asarray(decoded.points)}, np.asarray(decoded.faces))
    assert farthest(triangles(arrays, surface.faces), there) < 3e-4
    np.testing.assert_array_equal(packed.lower, np.asarray(decoded.points).min(axis=0))
    assert len(packed.data) < 0.5 * sum(a.nbytes for a in arrays.values())


def test_a_scene_names_the_extension_and_what_it_decodes_to(tmp_path: Path) -> None:
    for compression in ("none", "draco"):
        write_gathered(gathered("example", compression=compression), tmp_path / f"{compression}.glb")
    plain, packed = ((tmp_path / f"{c}.glb").read_bytes() for c in ("none", "draco"))
    assert len(packed) < 0.7 * len(plain)
    document, binary = gltf_reader.read(packed)
    assert DRACO_EXTENSION in document["extensionsRequired"]
    for mesh in document["meshes"]:
        for primitive in mesh["primitives"]:
            stored = primitive["extensions"][DRACO_EXTENSION]
            view = document["bufferViews"][stored["bufferView"]]
            decoded = DracoPy.decode(binary[view["byteOffset"] :][: view["byteLength"]])
            assert set(stored["attributes"]) == set(primitive["attributes"])
            assert {a["unique_id"] for a in decoded.attributes} == set(stored["attributes"].values())
            accessor = document["accessors"][primitive["attributes"]["POSITION"]]
            assert accessor["count"] == len(decoded.points)
            assert document["accessors"][primitive["indices"]]["count"] == 3 * len(decoded.faces)


def test_without_the_library_it_is_one_clear_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "DracoPy", None)
    with pytest.raises(UnavailableError, match=r"pip install 'diorama\[draco\]'"):
        draco_mesh({"POSITION": ball().vertices}, ball().faces)


@pytest.mark.slow
@pytest.mark.skipif(bool(missing_blender()), reason=missing_blender())
def test_blender_reads_it(tmp_path: Path) -> None:
    scene = gathered("fittings", compression="draco")
    write_gathered(scene, tmp_path / "room.glb")
    code = (
        "import bpy, json, sys; bpy.ops.wm.read_factory_settings(use_empty=True); "
        "bpy.ops.import_scene.gltf(filepath=sys.argv[1]); "
        "print('FOUND', json.dumps(sum(len(o.data.polygons) for o in bpy.data.objects if o.type == 'MESH')))"
    )
    command = [blender_python(), "-c", code, str(tmp_path / "room.glb")]
    output = subprocess.run(command, capture_output=True, text=True, check=True, timeout=300).stdout
    count = json.loads(next(line for line in output.splitlines() if line.startswith("FOUND "))[6:])
    assert count == sum(scene.meshes[x.mesh].triangles for x in (*scene.planes, *scene.objects))
