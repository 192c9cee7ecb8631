from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from PIL import Image

from diorama_core.export.wavefront import MaterialFile, ObjText, hull_file, index_rows, number_rows, obj_file
from diorama_core.io.srgb import linear_to_srgb, srgb_to_linear
from diorama_core.library.ingest.models import read_model
from diorama_core.render.appearance import Material, shape_surfaces
from tests.export.surfaces import ball, quad

CHECKS = np.zeros((8, 8, 3), np.uint8)
CHECKS[:4], CHECKS[4:] = (250, 240, 230), (120, 110, 100)


def loaded(text: bytes) -> trimesh.Trimesh:
    return trimesh.load(io.BytesIO(text), file_type="obj", process=False, force="mesh")


@pytest.mark.parametrize("uv", [True, False])
def test_surfaces_are_read_back_as_they_were(uv: bool) -> None:
    surface = quad(uv=uv)
    mesh = loaded(obj_file(surface))
    corners = surface.vertices[surface.faces]
    np.testing.assert_allclose(mesh.vertices[mesh.faces], corners, atol=1e-5)
    np.testing.assert_allclose(mesh.face_normals, [[0, 0, 1]] * 2, atol=1e-6)
    text = obj_file(surface, "all.mtl", "oak").decode()
    assert text.startswith("mtllib all.mtl\n")
    assert "usemtl oak" in text
    assert ("vt " in text) is uv


def test_vertices_are_counted_through_all_surfaces() -> None:
    text = ObjText()
    whole = loaded(text.add(quad()) + text.add(quad(uv=False)) + text.add(quad()))
    assert len(whole.faces) == 6
    np.testing.assert_allclose(whole.area, 12.0, rtol=1e-6)


def test_hulls_are_closed_bodies() -> None:
    body = ball(radius=0.5)
    mesh = loaded(hull_file(body.vertices, body.faces))
    assert mesh.volume == pytest.approx(4 / 3 * np.pi * 0.125, rel=0.02)


def test_colours_are_linear_or_for_display() -> None:
    oak = Material("light oak", (1.0, 0.0, 0.2158604), alpha=0.5)
    linear, display = (MaterialFile([oak], display=d).text().decode() for d in (False, True))
    assert "newmtl light_oak" in linear
    assert "Kd 1.000000 0.000000 0.215860" in linear
    assert "Kd 1.000000 0.000000 0.5019" in display
    assert "d 0.5000" in linear
    assert "map_Kd" not in linear


@pytest.mark.parametrize("roughness", [0.05, 0.3, 0.6, 0.9, 1.0])
def test_a_highlight_never_bleaches_a_black_surface(roughness: float) -> None:
    """Mean of the highlight over all directions of the half vector: a black table stays black."""
    text = MaterialFile([Material("black", (0.0, 0.0, 0.0), roughness=roughness)]).text().decode()
    values = {
        line.split()[0]: [float(v) for v in line.split()[1:]] for line in text.splitlines() if line[:2] in ("Ks", "Ns")
    }
    cosine = (np.arange(1000) + 0.5) / 1000
    assert values["Ks"][0] * float(np.mean(cosine ** values["Ns"][0])) < 0.02


def test_names_and_pictures_are_each_used_once() -> None:
    materials = [
        Material("oak", texture=CHECKS),
        Material("oak", texture=CHECKS),
        Material("oak", (0.5, 1, 1), texture=CHECKS),
    ]
    file = MaterialFile(materials, pictures="textures/")
    assert [file.name(m) for m in materials] == ["oak", "oak_2", "oak_3"]
    pictures = dict(file.pictures())
    assert list(pictures) == ["textures/000.png", "textures/001.png"]
    assert all(name.encode() in file.text() for name in pictures)


def test_a_textured_material_comes_back_in_its_colour(tmp_path: Path) -> None:
    """Programs that show the picture alone, and those that multiply it by `Kd`, show the same colour."""
    colour = (0.5, 0.25, 0.1)
    surface = quad(Material("cloth", colour, texture=CHECKS))
    file = MaterialFile([surface.material])
    (tmp_path / "all.mtl").write_bytes(file.text())
    (tmp_path / "one.obj").write_bytes(obj_file(surface, "all.mtl", file.name(surface.material)))
    for name, content in file.pictures():
        (tmp_path / name).write_bytes(content)
        picture = np.asarray(Image.open(io.BytesIO(content)))
    expected = 255 * linear_to_srgb(srgb_to_linear(CHECKS / 255) * np.asarray(colour))
    np.testing.assert_allclose(picture, expected, atol=0.51)

    model = read_model(tmp_path / "one.obj", tmp_path).scene

    class Library:
        def parts(self, shape_id: str) -> trimesh.Scene:
            return model

    (back,) = shape_surfaces(Library(), "one")
    assert back.material.colour == (1.0, 1.0, 1.0)
    assert back.material.texture is not None
    np.testing.assert_allclose(back.material.texture[..., :3], expected, atol=0.51)


@given(arrays(np.float64, (7, 3), elements=st.floats(-1e4, 1e4)), st.integers(1, 6))
def test_numbers_are_rounded_like_pythons(values: np.ndarray, decimals: int) -> None:
    lines = number_rows("vn", values, decimals).decode().splitlines()
    assert len(lines) == 7
    for line, row in zip(lines, values, strict=True):
        prefix, *words = line.split()
        assert prefix == "vn"
        assert all(len(w.partition(".")[2]) == decimals for w in words)
        np.testing.assert_allclose([float(w) for w in words], row, atol=0.5001 * 10.0**-decimals)


def test_columns_and_signs() -> None:
    text = number_rows("v", np.array([[-0.25, 12.0, 0.0], [3.5, -1.0, 100.125]]), 2).decode()
    assert [line.split() for line in text.splitlines()] == [
        ["v", "-0.25", "12.00", "0.00"],
        ["v", "3.50", "-1.00", "100.12"],
    ]


def test_nothing_is_no_text() -> None:
    assert number_rows("v", np.zeros((0, 3)), 3) == b""


def test_indices_follow_the_pattern() -> None:
    assert index_rows("f %d//%d", np.array([[1, 2], [30, 4]])) == b"f 1//2\nf 30//4\n"
