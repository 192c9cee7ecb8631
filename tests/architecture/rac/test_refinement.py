"""A partition behind whose edge the room goes on; the wall at the edge is turned away from the camera."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.architecture.rac.proposals import proposals
from diorama_core.architecture.rac.refinement import depth_error_m, find_hidden_ends, refine_layout
from diorama_core.architecture.rac.search import best_layout
from diorama_core.architecture.rac.stage import RenderAndCompareRoom
from diorama_core.architecture.walls.surface import measure_surface
from diorama_core.evaluation.metrics.architecture import architecture_scores
from diorama_core.progress import Progress
from diorama_core.scene.types import Plane
from tests.synthetic_rooms import box_room, cuboid, floor, look, shoot, wall

EDGE_M = (0.6, 3.0)
CAMERA = look(0, 8, fov_deg=80)


def room(edge: tuple[float, float] = EDGE_M) -> tuple[Plane, ...]:
    """A room with a nook behind a partition that ends at the edge."""
    x, y = edge
    corners = ((-2.2, -3), (2.4, -3), (2.4, 5), (x, 5), (x, y), (-2.2, y))
    return (
        floor(*corners),
        wall("near", (-2.2, y), (x, y), 2.5),
        wall("hidden", (x, y), (x, 5), 2.5),
        wall("far", (x, 5), (2.4, 5), 2.5),
        wall("right", (2.4, 5), (2.4, -3), 2.5),
        wall("left", (-2.2, -3), (-2.2, y), 2.5),
        Plane("ceiling", "ceiling", np.array([[a, b, 2.5] for a, b in reversed(corners)])),
    )


def scores(shot, *, refine: bool):
    stage = RenderAndCompareRoom(refine=refine)
    found = stage.reconstruct(shot.inputs, shot.objects, shot.geometry, Progress()).architecture
    return architecture_scores(found.planes, shot.planes, shot.camera)


def looked_at(planes, cuboids=()):
    shot = shoot(CAMERA, planes, cuboids)
    surface = measure_surface(shot.inputs.depth_m, CAMERA, shot.inputs.instances > 0)
    found = proposals(surface)
    layout = best_layout(surface, found, CAMERA)
    assert layout is not None
    return surface, found, layout


@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_a_wall_ends_where_the_room_is_seen_past_it(noise: float) -> None:
    shot = shoot(CAMERA, room(), (cuboid("cabinet", (-1.2, 2.6, 0), (0.6, 1.0, 0.8)),), noise=noise)
    before, after = scores(shot, refine=False), scores(shot, refine=True)
    assert before.pixel_error > 0.15
    assert after.pixel_error < 0.05
    assert after.iou > 0.9


def test_the_wall_s_end_is_found_in_the_picture() -> None:
    surface, found, layout = looked_at(room())
    (end,) = find_hidden_ends(layout, surface, found, CAMERA)
    edge = CAMERA.project(np.array([[*EDGE_M, 0.3], [*EDGE_M, 2.2]]))
    assert np.abs(edge @ end.form[:2] + end.form[2]).max() / np.linalg.norm(end.form[:2]) < 3.0
    (ended,) = end.ending
    assert found.offsets[ended] == pytest.approx(found.normals[ended] @ [0.0, EDGE_M[1], 0.0], abs=0.02)


def test_the_layout_gets_nearer_to_the_depth_and_no_further_round_is_needed() -> None:
    surface, found, layout = looked_at(room())
    pixels = CAMERA.project(surface.points)
    refined = refine_layout(layout, surface, found, CAMERA)
    assert depth_error_m(refined, surface, pixels) < 0.2 * depth_error_m(layout, surface, pixels)
    assert find_hidden_ends(refined, surface, found, CAMERA) == ()


def test_a_room_all_of_whose_walls_are_seen_stays_as_it_is() -> None:
    surface, found, layout = looked_at(box_room(-2.0, 2.0, 4.0, 2.5))
    assert find_hidden_ends(layout, surface, found, CAMERA) == ()
    assert refine_layout(layout, surface, found, CAMERA) is layout


def test_what_no_line_explains_changes_nothing() -> None:
    surface, found, layout = looked_at(box_room(-2.0, 2.0, 4.0, 2.5))
    rng = np.random.default_rng(0)
    torn = replace(surface, depth_m=surface.depth_m + 0.5 * (rng.random(len(surface.depth_m)) > 0.9))
    assert refine_layout(layout, torn, found, CAMERA).chosen == layout.chosen
