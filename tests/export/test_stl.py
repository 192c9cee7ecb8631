"""STL, read back by trimesh."""

from __future__ import annotations

import numpy as np
import trimesh

from diorama_core.export import export_scene
from tests.primitives import PrimitiveLibrary, furnished_room

LIBRARY = PrimitiveLibrary()


def test_millimetres_and_every_triangle(tmp_path) -> None:
    gathered = export_scene(furnished_room(LIBRARY), LIBRARY, tmp_path / "room.stl", "stl")
    loaded = trimesh.load_mesh(tmp_path / "room.stl", process=False)
    np.testing.assert_allclose(loaded.bounds, [[-2050, -50, -50], [2050, 5050, 2650]], atol=1e-2)
    assert len(loaded.faces) == sum(gathered.meshes[n.mesh].triangles for n in (*gathered.planes, *gathered.objects))


def test_normals_agree_with_the_winding(tmp_path) -> None:
    export_scene(furnished_room(LIBRARY), LIBRARY, tmp_path / "room.stl", "stl")
    content = np.fromfile(tmp_path / "room.stl", dtype=np.uint8)[84:].reshape(-1, 50)[:, :48]
    rows = content.copy().view("<f4").reshape(-1, 4, 3)
    across = np.cross(rows[:, 2] - rows[:, 1], rows[:, 3] - rows[:, 1])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    np.testing.assert_allclose(across, rows[:, 0], atol=2e-3)
