from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.architecture.single_view.level_view import LevelView, level_view, project_directions, response
from diorama_core.architecture.single_view.room_cues import EDGE_THRESHOLD, gather_room_cues
from tests.architecture.single_view.plain_cues import CAMERA, cues
from tests.synthetic_rooms import box_room, cuboid, look, shoot

SHOT = shoot(
    look(0.0, 12.0, fov_deg=70.0, size=(320, 240)),
    box_room(-2.0, 2.0, 4.0, 2.6),
    (cuboid("table", (-0.9, 3.0, 0), (0.8, 1.0, 0.7)), cuboid("chair", (0.9, 2.4, 0), (0.5, 0.5, 0.9))),
)


@cache
def view() -> LevelView:
    found = gather_room_cues(SHOT.inputs.photo.rgb, SHOT.camera, SHOT.objects, SHOT.cuboids)
    return level_view(SHOT.inputs.photo.rgb, found, SHOT.objects)


@given(x=st.floats(-3, 3), y=st.floats(-3, 5), z=st.floats(-1, 3))
def test_directions_project_as_points_far_along_them(x, y, z) -> None:
    direction = np.array([[x, y, z]])
    ahead = CAMERA.to_camera(CAMERA.position + direction)[0, 2]
    pixels, inside = project_directions(CAMERA, direction)
    if ahead <= 1e-3:
        assert not inside[0]
        return
    expected = CAMERA.project(CAMERA.position + 7.0 * direction)[0]
    np.testing.assert_allclose(pixels[0], expected, rtol=1e-6, atol=1e-6)
    assert inside[0] == bool((pixels[0] > 0).all() and (pixels[0] < [320, 240]).all())


def test_cells_cover_the_picture_once() -> None:
    v = view()
    assert v.share.sum() == pytest.approx(1.0)
    assert (v.share >= 0).all()
    # The strip of slopes below the horizon is the part of the picture below the horizon's row.
    horizon = SHOT.camera.project(SHOT.camera.position + np.array([[0.0, 10.0, 0.0]]))[0, 1]
    below = v.share[:, v.slopes[1:] <= 0].sum()
    assert below == pytest.approx(1.0 - horizon / 240, abs=0.03)


def test_rows_and_slopes_are_inverse() -> None:
    v = view()
    rows = np.array([0.0, 17.0, 42.5, 160.0])
    slopes = np.interp(rows, np.arange(len(v.slopes)), v.slopes)
    np.testing.assert_allclose(v.row_of(slopes), rows, atol=1e-6)


def test_the_floors_colour_is_told_from_the_walls() -> None:
    v = view()
    middle = np.abs(v.middles_rad) < 0.05
    rows = 0.5 * (v.slopes[1:] + v.slopes[:-1])
    floor = rows < -1.5 / 3.9
    wall = (rows > -1.5 / 4.1) & (rows < 0.15)
    seen = v.share[middle] > 0
    ratio = v.floor_ratio[middle]
    assert ratio[seen & floor[None]].mean() > 0.5
    assert ratio[seen & wall[None]].mean() < -0.5
    assert (v.floor_ratio[v.share == 0] == 0).all()


def test_pixels_of_objects_have_no_colour_of_floor_or_wall() -> None:
    v = view()
    table = next(o for o in SHOT.objects if o.id == "table")
    columns, rows = np.meshgrid(v.middles_rad, 0.5 * (v.slopes[1:] + v.slopes[:-1]), indexing="ij")
    pixels, inside = project_directions(SHOT.camera, np.stack([np.sin(columns), np.cos(columns), rows], axis=-1))
    x, y = np.moveaxis(np.where(inside[..., None], pixels, 0).astype(int), -1, 0)
    on_table = inside & table.mask[y, x]
    assert on_table.sum() > 100
    assert (v.floor_ratio[on_table] == 0).all()


def test_lines_fall_into_the_cells_that_their_rays_meet() -> None:
    rays = np.array([[0.0, 1.0, -0.2], [0.1, 1.0, 0.1], [0.0, -1.0, 0.0]])
    given_cues = cues(directions=rays, ray_axes=np.array([0, 2, 1]), ray_weights=np.array([0.5, 0.3, 0.2]))
    v = level_view(np.full((240, 320, 3), 128, np.uint8), given_cues, ())
    np.testing.assert_allclose(v.lines.sum(axis=(0, 1)), [0.5, 0.0, 0.3])
    m, k, axis = np.argwhere(v.lines == 0.5)[0]
    assert v.edges_rad[m] <= 0.0 <= v.edges_rad[m + 1]
    assert v.slopes[k] <= -0.2 <= v.slopes[k + 1]
    assert axis == 0


def test_upright_edges_show_at_the_heading_of_the_corner() -> None:
    edge_maps = np.full((3, 240, 320), EDGE_THRESHOLD, np.float32)
    corner = np.array([1.0, 4.0, 0.0]) + np.linspace(0.0, 2.6, 3000)[:, None] * [0.0, 0.0, 1.0]
    columns, rows = np.floor(CAMERA.project(corner)).astype(int).T
    ok = (columns > 1) & (columns < 318) & (rows >= 0) & (rows < 240)
    for shift in (-1, 0, 1):
        edge_maps[2, rows[ok], columns[ok] + shift] = 1.0
    v = level_view(np.full((240, 320, 3), 128, np.uint8), cues(edge_maps=edge_maps), ())
    best = v.edges_rad[v.upright.sum(axis=1).argmax()]
    assert best == pytest.approx(np.arctan2(1.0, 4.0), abs=np.deg2rad(1.0))


def test_a_picture_without_objects_knows_no_floor_colour() -> None:
    found = gather_room_cues(SHOT.inputs.photo.rgb, SHOT.camera, (), ())
    assert not level_view(SHOT.inputs.photo.rgb, found, ()).floor_ratio.any()


def test_response_reads_the_scaled_map_and_is_neutral_outside() -> None:
    edge_map = np.arange(12.0).reshape(3, 4)
    pixels = np.array([[3.0, 5.0], [7.9, 0.0], [100.0, 100.0]])
    found = response(edge_map, pixels, np.array([True, True, False]), 0.5)
    np.testing.assert_allclose(found, [edge_map[2, 1], edge_map[0, 3], EDGE_THRESHOLD])
