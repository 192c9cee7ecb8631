from __future__ import annotations

import io

import numpy as np
import pytest
import trimesh
from PIL import Image

from diorama_core.export.wavefront import hull_text, material_text, obj_text, png_bytes
from diorama_core.render.appearance import Material
from tests.export.surfaces import ball, quad


def loaded(text: str) -> trimesh.Trimesh:
    return trimesh.load(io.StringIO(text), file_type="obj", process=False, force="mesh")


@pytest.mark.parametrize("uv", [True, False])
def test_surfaces_are_read_back_as_they_were(uv: bool) -> None:
    surface = quad(uv=uv)
    mesh = loaded(obj_text(surface))
    corners = surface.vertices[surface.faces]
    np.testing.assert_allclose(mesh.vertices[mesh.faces], corners, atol=1e-6)
    np.testing.assert_allclose(mesh.face_normals, [[0, 0, 1]] * 2, atol=1e-6)
    text = obj_text(surface, "oak")
    assert text.startswith("mtllib oak.mtl\n")
    assert "usemtl oak" in text
    assert ("vt " in text) is uv


def test_hulls_are_closed_bodies() -> None:
    body = ball(radius=0.5)
    mesh = loaded(hull_text(body.vertices, body.faces))
    assert mesh.volume == pytest.approx(4 / 3 * np.pi * 0.125, rel=0.02)


def test_materials_are_srgb_and_name_their_picture() -> None:
    text = material_text("oak", Material("oak", (1.0, 0.0, 0.2158605), alpha=0.5), "oak.png")
    assert "newmtl oak" in text
    assert "Kd 1.00000 0.00000 0.50196" in text or "Kd 1.00000 0.00000 0.5019" in text
    assert "d 0.5000" in text
    assert "map_Kd oak.png" in text
    assert "map_Kd" not in material_text("oak", Material("oak", (1, 1, 1)), None)


def test_pictures_are_png() -> None:
    picture = np.arange(48, dtype=np.uint8).reshape(4, 4, 3)
    np.testing.assert_array_equal(np.asarray(Image.open(io.BytesIO(png_bytes(picture[:, ::-1])))), picture[:, ::-1])
