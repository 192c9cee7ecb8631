"""Materials of model files as physically based ones."""

from __future__ import annotations

from pathlib import Path

import pytest
import trimesh

from diorama_core.library.ingest.limits import DEFAULT_LIMITS
from diorama_core.library.ingest.models import read_model
from diorama_core.library.ingest.repair import repaired


@pytest.mark.parametrize(
    ("entries", "metallic", "roughness"),
    [
        ("", 0.0, None),
        ("Pm 0.0\nPr 0.55\n", 0.0, 0.55),
        ("Pm 1.0\nPr 0.2\n", 1.0, 0.2),
        ("Pm nan\nPr 7\n", 0.0, 1.0),
        ("Pm\n", 0.0, None),
    ],
)
def test_a_material_of_an_obj_is_metal_only_where_it_says_so(
    tmp_path: Path, entries: str, metallic: float, roughness: float | None
) -> None:
    (tmp_path / "box.mtl").write_text(f"newmtl wood\nKd 0.6 0.4 0.2\nKs 0.5 0.5 0.5\nNs 200\n{entries}")
    text = trimesh.creation.box().export(file_type="obj", header=None)
    (tmp_path / "box.obj").write_text(f"mtllib box.mtl\nusemtl wood\n{text}")
    made = repaired(read_model(tmp_path / "box.obj", tmp_path).scene, DEFAULT_LIMITS)
    (mesh,) = made.meshes
    assert mesh.visual.material.metallicFactor == metallic
    if roughness is not None:
        assert mesh.visual.material.roughnessFactor == roughness
