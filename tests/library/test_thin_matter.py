"""Where matter is thin along an axis, on shapes whose parts are known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.library.thin_matter import BINS, derive_thin_matter, thin_matter
from tests.library.ingest.models import block


def thin(mesh: trimesh.Trimesh, axis: int) -> np.ndarray:
    return thin_matter(np.asarray(mesh.vertices), np.asarray(mesh.faces), axis)


def frame(axis: int) -> trimesh.Trimesh:
    """A board 1.2 long with an upright 6 cm thick at either end, turned so that it is long along an axis."""
    parts = [block((1.2, 0.4, 0.04), (0, 0, 0.4)), *(block((0.06, 0.4, 0.4), (x, 0, 0.18)) for x in (-0.57, 0.57))]
    mesh = trimesh.util.concatenate(parts)
    turned = np.roll(np.eye(3), axis, axis=0)
    return trimesh.Trimesh(mesh.vertices @ turned.T, mesh.faces, process=False)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_uprights_are_thin_along_the_board_and_what_lies_between_is_not(axis: int) -> None:
    found = thin(frame(axis), axis)
    upright = round(BINS * 0.06 / 1.2)
    assert (found[:upright] > 0).all()
    assert (found[-upright:] > 0).all()
    assert not found[upright + 1 : -upright - 1].any()


def test_a_shape_that_is_inside_out_says_the_same() -> None:
    mesh = frame(0)
    inverted = trimesh.Trimesh(mesh.vertices, mesh.faces[:, ::-1], process=False)
    np.testing.assert_allclose(thin(inverted, 0), thin(mesh, 0), atol=1e-9)


def test_parts_that_touch_or_overlap_are_one() -> None:
    apart, touching, overlapping = (
        trimesh.util.concatenate([block((wide, 1, 1), (0.2 * k, 0, 0)) for k in range(6)]) for wide in (0.1, 0.2, 0.25)
    )
    assert thin(apart, 0).mean() == pytest.approx(6 * 0.1 / 1.1, abs=0.05)
    assert not thin(touching, 0).any()
    assert not thin(overlapping, 0).any()


def test_an_open_shape_still_shows_its_legs() -> None:
    mesh = frame(0)
    top = mesh.face_normals[:, 2] < 0.9
    assert thin(trimesh.Trimesh(mesh.vertices, mesh.faces[top], process=False), 0)[5] > 0


def test_a_single_sheet_says_nothing() -> None:
    sheet = trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [1, 1, 0.2], [0, 1, 0.2]], [[0, 1, 2], [0, 2, 3]], process=False)
    assert not thin(sheet, 2).any()


@settings(max_examples=20)
@given(st.integers(0, 2), st.integers(0, 10_000))
def test_it_is_a_share_whatever_the_mesh_and_blind_to_the_order_of_faces(axis: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    vertices = rng.normal(size=(30, 3))
    faces = np.array([rng.choice(30, 3, replace=False) for _ in range(40)])
    found = thin_matter(vertices, faces, axis)
    assert found.shape == (BINS,)
    assert ((found >= 0) & (found <= 1)).all()
    np.testing.assert_allclose(thin_matter(vertices, faces[::-1], axis), found, atol=1e-9)


def test_what_was_found_is_kept_by_the_shape_and_found_again_when_damaged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    vertices, faces = np.asarray(frame(0).vertices), np.asarray(frame(0).faces)
    probed: list[int] = []

    def probe(vertices: np.ndarray, faces: np.ndarray, axis: int) -> np.ndarray:
        probed.append(axis)
        return thin_matter(vertices, faces, axis)

    monkeypatch.setattr("diorama_core.library.thin_matter.thin_matter", probe)
    for _ in range(2):
        np.testing.assert_array_equal(derive_thin_matter(vertices, faces, 0, tmp_path), thin_matter(vertices, faces, 0))
    assert probed == [0]
    derive_thin_matter(vertices, faces, 1, tmp_path)
    derive_thin_matter(vertices + 0.1, faces, 0, tmp_path)
    assert probed == [0, 1, 0]
    for path in tmp_path.iterdir():
        path.write_bytes(path.read_bytes()[:100])
    np.testing.assert_array_equal(derive_thin_matter(vertices, faces, 0, tmp_path), thin_matter(vertices, faces, 0))
    assert len(probed) == 4
