"""Convex parts are cut back from places above which nothing is."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from scipy.spatial import Delaunay

from diorama_core.geometry.convex import ConvexPart, convex_parts, hull_part, simplest_part
from diorama_core.layout.problem.clear_places import clear_of_places
from diorama_core.library.record import SupportSurface
from diorama_core.library.surfaces import support_surfaces

RADIUS, WALL, HIGH = 0.19, 0.01, 0.04


def round_tray() -> trimesh.Trimesh:
    floor = trimesh.creation.cylinder(RADIUS, WALL, sections=48)
    floor.apply_translation([0, 0, WALL / 2])
    rim = trimesh.creation.annulus(RADIUS - WALL, RADIUS, HIGH, sections=48)
    rim.apply_translation([0, 0, HIGH / 2])
    tray = trimesh.util.concatenate([floor, rim])
    tray.apply_translation([0, 0, -HIGH / 2])
    return tray


def quarters(tray: trimesh.Trimesh) -> tuple[ConvexPart, ...]:
    """The floor, and hulls of the rim's quarters, as a coarse decomposition has them."""
    v = np.asarray(tray.vertices)
    level = v[:, 2].min() + WALL
    rim = v[v[:, 2] > level + 1e-6]
    floor = v[v[:, 2] <= level + 1e-6]
    found = [simplest_part(floor)]
    for x in (-1.0, 1.0):
        for y in (-1.0, 1.0):
            own = rim[(x * rim[:, 0] >= -1e-6) & (y * rim[:, 1] >= -1e-6)]
            found.append(hull_part(np.vstack([own, own * [1, 1, 0] + [0, 0, level]])))
    return tuple(found)


def contains(parts: tuple[ConvexPart, ...], points: np.ndarray) -> np.ndarray:
    grown = [p.vertices.mean(axis=0) + 1.002 * (p.vertices - p.vertices.mean(axis=0)) for p in parts]
    return np.any([Delaunay(v).find_simplex(points) >= 0 for v in grown], axis=0)


def test_nothing_is_left_over_the_inside_of_a_round_tray() -> None:
    tray = round_tray()
    parts, places = quarters(tray), support_surfaces(tray)
    angle = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    inside = np.column_stack([0.15 * np.cos(angle), 0.15 * np.sin(angle), np.zeros(24)])
    assert contains(parts, inside).any()
    cleared = clear_of_places(parts, places, lambda: tray)
    assert not contains(cleared, inside).any()
    points = trimesh.sample.sample_surface(tray, 500, seed=1)[0]
    assert contains(cleared, points).mean() > 0.99


def test_what_stands_on_a_place_stays() -> None:
    top = trimesh.creation.box([1.0, 0.6, 0.04])
    tap = trimesh.creation.box([0.05, 0.05, 0.3])
    tap.apply_translation([0.0, 0.1, 0.17])
    worktop = trimesh.util.concatenate([top, tap])
    outline = np.array([[-0.5, -0.3, 0.02], [0.5, -0.3, 0.02], [0.5, 0.3, 0.02], [-0.5, 0.3, 0.02]])
    place = SupportSurface(outline, float("inf"), False)
    parts = convex_parts(worktop)
    assert clear_of_places(parts, (place,), lambda: worktop) == parts


@pytest.mark.parametrize(
    ("bar_m", "carries", "gives_way"), [(0.03, True, True), (0.08, True, False), (0.03, False, False)]
)
def test_grates_give_way_to_what_stands_between_them_and_high_bars_and_seats_do_not(
    bar_m: float, carries: bool, gives_way: bool
) -> None:
    top = trimesh.creation.box([0.6, 0.6, 0.04])
    guard = trimesh.creation.box([0.04, 0.6, 0.12])
    guard.apply_translation([-0.32, 0.0, 0.08])
    bars = [trimesh.creation.box([0.5, 0.01, bar_m]) for _ in range(4)]
    for k, bar in enumerate(bars):
        bar.apply_translation([0.0, -0.21 + 0.14 * k, 0.02 + bar_m / 2])
    stove = trimesh.util.concatenate([top, guard, *bars])
    outline = np.array([[-0.28, -0.3, 0.02], [0.3, -0.3, 0.02], [0.3, 0.3, 0.02], [-0.28, 0.3, 0.02]])
    place = SupportSurface(outline, float("inf"), False)
    cleared = clear_of_places((hull_part(np.asarray(stove.vertices)),), (place,), lambda: stove, carries=carries)
    between = np.array([[0.0, 0.0, 0.03], [0.1, 0.14, 0.03]])
    assert contains(cleared, between).any() != gives_way
    assert contains(cleared, trimesh.sample.sample_surface(guard, 200, seed=1)[0]).mean() > 0.99


def test_shapes_whose_parts_leave_their_places_free_are_not_looked_at() -> None:
    table = trimesh.creation.box([1.0, 0.6, 0.7])
    places = support_surfaces(table)
    assert places
    parts = convex_parts(table)
    assert clear_of_places(parts, places, lambda: pytest.fail("its mesh is not needed")) == parts


@pytest.mark.parametrize("closed", [False, True])
def test_a_closed_cupboard_is_solid_and_an_open_one_is_not(closed: bool) -> None:
    panels = [((0.0, 0.0, 0.01), (0.4, 0.6, 0.02)), ((0.0, 0.0, 0.59), (0.4, 0.6, 0.02))]
    panels += [((0.0, y, 0.3), (0.4, 0.02, 0.56)) for y in (-0.29, 0.29)]
    panels += [((x, 0.0, 0.3), (0.02, 0.56, 0.56)) for x in ((-0.19, 0.19) if closed else (-0.19,))]
    boxes = [trimesh.creation.box(size) for _, size in panels]
    for box, (centre, _) in zip(boxes, panels, strict=True):
        box.apply_translation(centre)
    cupboard = trimesh.util.concatenate(boxes)
    places = support_surfaces(cupboard)
    assert any(place.interior for place in places) != closed, "nobody puts things into a closed cupboard"
    cleared = clear_of_places((hull_part(np.asarray(cupboard.vertices)),), places, lambda: cupboard)
    assert contains(cleared, np.array([[0.0, 0.0, 0.3]])).all() == closed
