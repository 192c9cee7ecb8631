from __future__ import annotations

import meshoptimizer
import numpy as np
from scipy.spatial import KDTree

from diorama_core.export.meshopt import encoded_faces, encoded_vertices, prepared
from tests.export.surfaces import ball


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
    made, faces = prepared(arrays, surface.faces)
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
    made, faces = prepared({"POSITION": ball().vertices}, ball().faces)
    data = encoded_vertices(made["POSITION"])
    assert len(data) < made["POSITION"].nbytes
    decoded = meshoptimizer.decode_vertex_buffer(len(made["POSITION"]), 12, data).reshape(-1, 3)
    np.testing.assert_array_equal(decoded, made["POSITION"])
    indices = encoded_faces(faces.reshape(-1), len(decoded))
    back = meshoptimizer.decode_index_buffer(faces.size, 4, indices)
    assert len(indices) < 4 * faces.size
    assert farthest(triangles(made, back.reshape(-1, 3)), triangles(made, faces)) < 1e-9
