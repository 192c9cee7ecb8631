"""Draco compression, decoded by DracoPy and by Blender."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import KDTree

from diorama_core.errors import UnavailableError
from diorama_core.export.blender import blender_python, missing_blender
from diorama_core.export.draco import EXTENSION, draco_mesh
from diorama_core.export.gltf import write_gathered
from tests.export import gltf_reader
from tests.export.scenes import gathered
from tests.export.surfaces import ball

DracoPy = pytest.importorskip("DracoPy", reason="DracoPy is not installed (optional extra 'draco')")


def centres(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    return np.asarray(points, dtype=float)[np.asarray(faces)].mean(axis=1)


def test_a_primitive_decodes_to_the_same_triangles() -> None:
    surface = ball(radius=0.5)
    uv = np.ascontiguousarray(surface.vertices[:, :2])
    tangents = np.tile(np.array([1, 0, 0, -1], np.float32), (len(uv), 1))
    arrays = {"POSITION": surface.vertices, "NORMAL": surface.normals, "TEXCOORD_0": uv, "TANGENT": tangents}
    packed = draco_mesh(arrays, surface.faces)
    assert set(packed.attributes) == set(arrays)
    assert packed.triangles == len(surface.faces)
    decoded = DracoPy.decode(packed.data)
    there = KDTree(centres(decoded.points, decoded.faces))
    distance, nearest = there.query(centres(surface.vertices, surface.faces))
    assert distance.max() < 1e-4
    assert len(set(nearest.tolist())) == len(surface.faces)
    np.testing.assert_array_equal(packed.lower, np.asarray(decoded.points).min(axis=0))
    assert len(packed.data) < 0.5 * sum(a.nbytes for a in arrays.values())


def test_a_scene_names_the_extension_and_what_it_decodes_to(tmp_path: Path) -> None:
    for compression in ("none", "draco"):
        write_gathered(gathered("example", compression=compression), tmp_path / f"{compression}.glb")
    plain, packed = ((tmp_path / f"{c}.glb").read_bytes() for c in ("none", "draco"))
    assert len(packed) < 0.7 * len(plain)
    document, binary = gltf_reader.read(packed)
    assert EXTENSION in document["extensionsRequired"]
    for mesh in document["meshes"]:
        for primitive in mesh["primitives"]:
            stored = primitive["extensions"][EXTENSION]
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
