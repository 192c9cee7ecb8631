from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.artefacts import FurtherPhoto
from diorama_core.errors import InputError
from diorama_core.library.catalogue import built_in_library
from diorama_core.multiview.found_poses import UnposedPhoto
from diorama_core.multiview.registration import (
    GUESSED_LOG_SIGMA,
    OWN,
    CommonPoints,
    PlacedPhoto,
    camera_of,
    photos_of_scene,
    register_camera,
    sampson_px,
    solve_camera,
)
from tests.multiview.rooms import CAMERAS, K, turn_off_deg
from tests.multiview.two_photos import two_photos


def common(surface_off: float, wrong: int = 0) -> CommonPoints:
    """Two walls and a floor seen by two cameras; surfaces are a share too far away, some pairs are wrong."""
    rng = np.random.default_rng(5)
    walls = [
        np.column_stack([rng.uniform(-2, 2, 80), np.full(80, 2.2), rng.uniform(0.2, 2.2, 80)]),
        np.column_stack([np.full(60, -2.2), rng.uniform(0, 2, 60), rng.uniform(0.2, 2.2, 60)]),
        np.column_stack([rng.uniform(-1.5, 1.5, 60), rng.uniform(-0.5, 2, 60), np.zeros(60)]),
    ]
    points = np.vstack(walls)
    a, b = CAMERAS[0], CAMERAS[1]
    seen_b = b.project(points)
    seen_b[:wrong] = rng.uniform(0, 400, (wrong, 2))
    far = a.position + (1 + surface_off) * (points - a.position)
    return CommonPoints(a, a.project(points), seen_b, far)


def test_a_camera_is_found_by_points_on_surfaces() -> None:
    found = solve_camera([common(0.0, wrong=30)], K, 0.03)
    assert found is not None
    assert turn_off_deg(found, CAMERAS[1]) < 0.3
    assert np.linalg.norm(found.position - CAMERAS[1].position) < 0.03


def test_surfaces_that_are_too_far_only_stretch_the_way_between_the_photos() -> None:
    found = solve_camera([common(0.1)], K, 0.03)
    assert found is not None
    assert turn_off_deg(found, CAMERAS[1]) < 0.3
    base, true = (c.position - CAMERAS[0].position for c in (found, CAMERAS[1]))
    assert np.linalg.norm(base) == pytest.approx(1.1 * np.linalg.norm(true), rel=0.03)
    assert base @ true > 0.999 * np.linalg.norm(base) * np.linalg.norm(true)


def test_an_unknown_focal_length_is_found_too() -> None:
    found = solve_camera([common(0.0)], replace(K, fx=1.2 * K.fx, fy=1.2 * K.fy), GUESSED_LOG_SIGMA)
    assert found is not None
    assert found.intrinsics.fx == pytest.approx(K.fx, rel=0.05)


def test_too_little_in_common_is_no_camera() -> None:
    few = common(0.0).rows(np.arange(200) < 10)
    assert solve_camera([few], K, 0.03) is None
    assert solve_camera([], K, 0.03) is None
    strange = common(0.0, wrong=190)
    assert solve_camera([strange], K, 0.03) is None


def test_pixels_of_one_place_have_no_epipolar_distance() -> None:
    both = common(0.0)
    assert np.abs(sampson_px(CAMERAS[0], CAMERAS[1], both.known_px, both.new_px)).max() < 1e-6
    off = sampson_px(CAMERAS[0], CAMERAS[1], both.known_px, both.new_px + np.array([0.0, 3.0]))
    assert np.median(np.abs(off)) > 1.0


def test_a_photo_of_something_else_is_one_line() -> None:
    pytest.importorskip("pycolmap", reason="needs pycolmap (pip install 'diorama[photos]')")
    grey = [np.full((120, 160, 3), 90 + n, np.uint8) for n in range(2)]
    known = PlacedPhoto(UnposedPhoto("first", grey[0], 150.0), CAMERAS[0].resize(160, 120))
    with pytest.raises(InputError, match=r"new does not join: .* take it from a step or two beside"):
        register_camera(UnposedPhoto("new", grey[1], None), [known], lambda camera, px: np.ones(len(px)))


@pytest.mark.slow
def test_the_camera_of_a_second_photo_is_found_with_one_known_photo() -> None:
    pytest.importorskip("pycolmap", reason="needs pycolmap (pip install 'diorama[photos]')")
    photos = two_photos()
    known = photos_of_scene(photos.scene, photos.first, ())
    found = camera_of(FurtherPhoto("beside", photos.second), known, photos.scene, built_in_library())
    assert turn_off_deg(found, photos.camera) < 0.5
    assert np.linalg.norm(found.position - photos.camera.position) < 0.05
    assert found.intrinsics.fx == pytest.approx(photos.camera.intrinsics.fx, rel=0.02)


def test_photos_with_cameras_are_known_the_own_one_first() -> None:
    photos = two_photos()
    further = (FurtherPhoto("a", photos.second), FurtherPhoto("b", photos.second, photos.camera))
    known = photos_of_scene(photos.scene, photos.first, further)
    assert [p.name for p in known] == [OWN, "b"]
    assert {name for name, _ in known[0].seen} == {o.id for o in photos.scene.objects if o.box_px is not None}
