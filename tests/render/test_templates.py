from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.errors import Cancelled, LibraryError
from diorama_core.library.catalogue import BuiltInLibrary, built_in_library
from diorama_core.progress import CancelToken, Progress
from diorama_core.render.raycast import MeshCaster
from diorama_core.render.template_cache import TemplateCache
from diorama_core.render.templates import PAPER_GRID, TemplateGrid, Templates, render_templates

SMALL = TemplateGrid(elevations_deg=(0.0, 30.0, 60.0), azimuths=4, size_px=48)


@pytest.fixture(scope="module")
def chair(tmp_path_factory: pytest.TempPathFactory) -> tuple[BuiltInLibrary, str, Templates]:
    library = built_in_library(tmp_path_factory.mktemp("cache"))
    return library, "chair-slat-oak", render_templates(library.mesh("chair-slat-oak"), SMALL)


def test_the_papers_views() -> None:
    assert len(PAPER_GRID) == 180
    assert sorted({round(float(np.degrees(e))) for e in PAPER_GRID.elevations_rad}) == [0, 15, 30, 45, 60]
    assert np.degrees(np.diff(PAPER_GRID.azimuths_rad[:36])) == pytest.approx(10.0)
    R = PAPER_GRID.R_object_camera
    assert np.abs(R @ R.transpose(0, 2, 1) - np.eye(3)).max() < 1e-12
    assert np.linalg.det(R) == pytest.approx(1.0)
    assert (R[:, 2, 1] < 0).all(), "the picture's down is the world's down"
    front, left = PAPER_GRID.R_object_camera[0], PAPER_GRID.R_object_camera[9]
    assert front[:, 2] == pytest.approx([-1, 0, 0]), "azimuth 0 looks at the front"
    assert left[:, 2] == pytest.approx([0, -1, 0]), "a quarter on, at the left side"


def test_depth_mask_and_normals_agree_with_the_general_ray_caster(
    chair: tuple[BuiltInLibrary, str, Templates],
) -> None:
    library, name, templates = chair
    for view in range(0, len(SMALL), 5):
        truth = MeshCaster([(library.mesh(name), np.eye(4))]).buffers(templates.camera(view))
        assert np.mean(templates.mask[view] != truth.silhouette) < 1e-3
        both = templates.mask[view] & truth.silhouette
        assert both.sum() > 100
        assert np.abs(templates.depth_m(view)[both] - truth.depth_m[both]).max() < 2e-4
        world = templates.normals_object(view)[both]
        assert (world * truth.normals_world[both]).sum(axis=-1).min() > np.cos(np.radians(1.5))


def test_object_coordinates_reproject_to_their_pixels(chair: tuple[BuiltInLibrary, str, Templates]) -> None:
    _, _, templates = chair
    for view in (0, 6, 11):
        rows, columns = np.nonzero(templates.mask[view])
        points = templates.points_object(view)[rows, columns]
        pixels = templates.camera(view).project(points)
        assert np.abs(pixels - np.stack([columns + 0.5, rows + 0.5], axis=-1)).max() < 1e-2
        at = templates.points_at(view, np.stack([columns, rows], axis=-1))
        assert np.allclose(at, points, atol=1e-5)
        assert np.isnan(templates.points_object(view)[~templates.mask[view]]).all()


@settings(max_examples=15)
@given(
    st.tuples(*[st.floats(0.2, 1.6)] * 3),
    st.tuples(*[st.floats(-2.0, 2.0)] * 3),
    st.integers(0, len(SMALL) - 1),
)
def test_points_lie_on_the_box_wherever_and_however_large(
    size: tuple[float, ...], centre: tuple[float, ...], view: int
) -> None:
    box = trimesh.creation.box(size, trimesh.transformations.translation_matrix(centre))
    templates = render_templates(box, SMALL)
    seen = templates.points_object(view)[templates.mask[view]]
    assert len(seen)
    away = np.abs(np.abs(seen - centre) - np.asarray(size) / 2).min(axis=1)
    assert away.max() < 3e-4 * max(size)


def test_gray_is_bright_where_the_viewer_looks_straight_on(chair: tuple[BuiltInLibrary, str, Templates]) -> None:
    _, _, templates = chair
    assert ((templates.gray > 0) == templates.mask).all()
    ball = render_templates(trimesh.creation.icosphere(3), SMALL)
    middle, rim = ball.gray[0][24, 24], ball.gray[0][24][ball.mask[0][24]][-1]
    assert middle > rim + 40


def test_symmetric_shapes_look_the_same_from_all_around() -> None:
    box = render_templates(trimesh.creation.box((1, 1, 0.5)), SMALL)
    assert np.array_equal(box.depth_codes[0], box.depth_codes[1])


def test_shapes_without_a_surface_are_refused() -> None:
    with pytest.raises(LibraryError, match="without triangles"):
        render_templates(trimesh.Trimesh(), SMALL)
    with pytest.raises(LibraryError, match="without extent"):
        render_templates(trimesh.Trimesh(np.zeros((3, 3)), [[0, 1, 2]], process=False), SMALL)
    flat = render_templates(trimesh.Trimesh([[0, -1, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2]]), SMALL)
    assert flat.mask[0].any()


def test_rendering_can_be_cancelled() -> None:
    token = CancelToken()
    token.cancel()
    with pytest.raises(Cancelled):
        render_templates(trimesh.creation.box(), SMALL, Progress(token=token))


class _CountingLibrary:
    """Hands out a library's meshes and counts how often."""

    def __init__(self, library: BuiltInLibrary) -> None:
        self._library, self.asked = library, 0

    def __getattr__(self, name: str) -> object:
        return getattr(self._library, name)

    def mesh(self, shape_id: str) -> trimesh.Trimesh:
        self.asked += 1
        return self._library.mesh(shape_id)


def test_cache_renders_once_per_content(chair: tuple[BuiltInLibrary, str, Templates], tmp_path: Path) -> None:
    library, name, expected = chair
    counting = _CountingLibrary(library)
    shape = library.shape(name)
    first = TemplateCache(tmp_path)
    assert not first.has(shape, SMALL)
    for cache in (first, first, TemplateCache(tmp_path)):
        found = cache.get(counting, shape, SMALL)
        assert np.array_equal(found.depth_codes, expected.depth_codes)
        assert np.array_equal(found.normal_codes, expected.normal_codes)
        assert found.size_m == pytest.approx(expected.size_m)
    assert first.has(shape, SMALL)
    assert counting.asked == 1
    changed = dataclasses.replace(shape, content_hash="other")
    first.get(counting, changed, SMALL)
    assert counting.asked == 2


def test_cache_mends_damaged_files_and_stays_within_its_limit(
    chair: tuple[BuiltInLibrary, str, Templates], tmp_path: Path
) -> None:
    library, name, expected = chair
    shape = library.shape(name)
    TemplateCache(tmp_path).get(library, shape, SMALL)
    (file,) = tmp_path.iterdir()
    size = file.stat().st_size
    file.write_bytes(file.read_bytes()[: size // 2])
    again = TemplateCache(tmp_path).get(library, shape, SMALL)
    assert np.array_equal(again.depth_codes, expected.depth_codes)
    narrow = TemplateCache(tmp_path, limit_bytes=2 * size)
    for number in range(5):
        narrow.get(library, dataclasses.replace(shape, content_hash=f"copy{number}"), SMALL)
    assert sum(f.stat().st_size for f in tmp_path.iterdir()) <= 2 * size
    assert narrow.has(dataclasses.replace(shape, content_hash="copy4"), SMALL)
