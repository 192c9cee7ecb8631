from __future__ import annotations

import numpy as np
import pytest
import trimesh

from diorama_core.library.record import SupportSurface
from diorama_core.library.surfaces import support_surfaces
from tests.library.ingest.models import block, table


def area(surface: SupportSurface) -> float:
    x, y = surface.polygon[:, 0], surface.polygon[:, 1]
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def bookcase() -> trimesh.Trimesh:
    """0.9 wide, 0.3 deep, 1.7 tall; boards' upper faces at 0.02, 0.42, 0.82, 1.22 and the top at 1.70."""
    sides = [block((0.3, 0.02, 1.7), (0, s * 0.44, 0.85)) for s in (1, -1)]
    boards = [block((0.3, 0.88, 0.02), (0, 0, z - 0.01)) for z in (0.02, 0.42, 0.82, 1.22, 1.70)]
    return trimesh.util.concatenate([*sides, *boards, block((0.01, 0.88, 1.7), (-0.145, 0, 0.85))])


def test_a_box_has_one_top() -> None:
    (top,) = support_surfaces(block((0.6, 0.8, 0.4), (0, 0, 0)))
    assert top.height_m == pytest.approx(0.2, abs=1e-3)
    assert area(top) == pytest.approx(0.48, rel=0.05)
    assert top.clearance_m == np.inf
    assert not top.interior


def test_outline_is_counter_clockwise_and_convex() -> None:
    (top,) = support_surfaces(block((0.6, 0.8, 0.4), (0, 0, 0)))
    edges = np.roll(top.polygon, -1, axis=0) - top.polygon
    turns = np.cross(edges, np.roll(edges, -1, axis=0))[:, 2]
    assert (turns > -1e-9).all()
    assert area(top) > 0


def test_a_table_has_one_surface() -> None:
    (top,) = support_surfaces(table())
    assert top.height_m == pytest.approx(0.74, abs=1e-3)


def test_planks_with_gaps_are_one_surface() -> None:
    planks = trimesh.util.concatenate([block((0.09, 1.0, 0.03), (0.1 * k, 0, 0)) for k in range(5)])
    (top,) = support_surfaces(planks)
    assert area(top) == pytest.approx(0.49, rel=0.06)


def test_bookcase_shelves_have_heights_and_clearances() -> None:
    surfaces = support_surfaces(bookcase())
    inside = sorted((s for s in surfaces if s.interior), key=lambda s: s.height_m)
    tops = [s for s in surfaces if not s.interior]
    assert [round(s.height_m, 2) for s in tops] == [1.70]
    assert [round(s.height_m, 2) for s in inside] == [0.02, 0.42, 0.82, 1.22]
    assert [round(s.clearance_m, 2) for s in inside] == [0.38, 0.38, 0.38, 0.46]


def test_uprights_part_the_compartments_of_a_shelf() -> None:
    """0.9 wide with two uprights: three compartments on every level, the lowest on the floor among them."""
    uprights = [block((0.298, 0.016, 1.7), (0, y, 0.85)) for y in (-0.15, 0.15)]
    surfaces = support_surfaces(trimesh.util.concatenate([bookcase(), *uprights]))
    inside = [s for s in surfaces if s.interior]
    levels = sorted({round(s.height_m, 2) for s in inside})
    assert levels == [0.02, 0.42, 0.82, 1.22]
    for level in levels:
        middles = sorted(float(s.polygon[:, 1].mean()) for s in inside if round(s.height_m, 2) == level)
        assert middles == pytest.approx([-0.29, 0.0, 0.29], abs=0.03)


def test_a_low_edge_on_a_shelf_parts_nothing() -> None:
    edge = block((0.298, 0.016, 0.014), (0, 0, 0.423))
    inside = [s for s in support_surfaces(trimesh.util.concatenate([bookcase(), edge])) if s.interior]
    assert len(inside) == 4


def test_a_lamp_stands_on_its_foot_but_nothing_stands_there() -> None:
    foot = trimesh.creation.cylinder(0.15, 0.02)
    pole = trimesh.creation.cylinder(0.012, 1.4, transform=trimesh.transformations.translation_matrix((0, 0, 0.7)))
    shade = trimesh.creation.cylinder(0.22, 0.3, transform=trimesh.transformations.translation_matrix((0, 0, 1.5)))
    assert all(s.height_m > 1.0 for s in support_surfaces(trimesh.util.concatenate([foot, pole, shade])))


def test_overlapping_solids_do_not_make_buried_surfaces() -> None:
    pair = trimesh.util.concatenate([block((0.6, 0.6, 0.4), (0, 0, 0)), block((0.6, 0.6, 0.4), (0, 0, 0.1))])
    (top,) = support_surfaces(pair)
    assert top.height_m == pytest.approx(0.3, abs=1e-3)


def test_a_slope_and_a_ball_carry_nothing() -> None:
    wedge = trimesh.convex.convex_hull([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 0, 1), (0, 1, 1)])
    assert support_surfaces(wedge) == ()
    assert support_surfaces(trimesh.creation.icosphere(subdivisions=4, radius=0.3)) == ()


def test_a_rim_is_no_surface() -> None:
    frame = [block((0.04, 0.6, 0.04), (s * 0.28, 0, 0)) for s in (1, -1)]
    frame += [block((0.6, 0.04, 0.04), (0, s * 0.28, 0)) for s in (1, -1)]
    assert support_surfaces(trimesh.util.concatenate(frame)) == ()


def test_a_worktop_with_a_lower_piece_between_is_as_high_as_its_higher_ends() -> None:
    ends = [block((0.6, 0.4, 0.04), (0, s * 0.45, 0.88)) for s in (1, -1)]
    (top,) = support_surfaces(trimesh.util.concatenate([*ends, block((0.6, 0.5, 0.03), (0, 0, 0.875))]))
    assert top.height_m == pytest.approx(0.9, abs=1e-3)


def test_what_is_put_on_a_basin_stands_on_its_rim() -> None:
    """A counter of 1.0 x 0.5 m with a basin: strips of 0.3 m beside it; the basin is no place, nor its rim."""
    counter = block((0.5, 1.0, 0.2), (0, 0, 0.8))
    basin = counter.difference(block((0.42, 0.4, 0.2), (0, 0, 0.85)))
    strips = support_surfaces(basin, carries=True)
    assert sorted(round(float(s.polygon[:, 1].mean()), 2) for s in strips) == [-0.35, 0.35]
    assert all(s.height_m == pytest.approx(0.9, abs=1e-3) for s in strips)
    assert all(area(s) == pytest.approx(0.15, rel=0.08) for s in strips)


def test_a_corner_desk_has_nothing_over_its_notch() -> None:
    desk = trimesh.util.concatenate([block((0.6, 1.6, 0.03), (-0.3, 0, 0.7)), block((0.6, 0.6, 0.03), (0.3, 0.5, 0.7))])
    tops = support_surfaces(desk, carries=True)
    assert len(tops) == 2
    assert sum(map(area, tops)) == pytest.approx(0.96 + 0.36, rel=0.04)


def test_the_inside_of_a_tray_stays_a_place() -> None:
    tray = block((0.4, 0.6, 0.05), (0, 0, 0)).difference(block((0.36, 0.56, 0.05), (0, 0, 0.02)))
    (inside,) = support_surfaces(tray, carries=True)
    assert inside.height_m == pytest.approx(-0.005, abs=1e-3)


def test_a_shelf_with_a_low_rim_under_a_roof_stays_a_place() -> None:
    tray = block((0.4, 0.6, 0.1), (0, 0, 0.05)).difference(block((0.36, 0.56, 0.1), (0, 0, 0.07)))
    posts = [block((0.02, 0.02, 0.4), (sx * 0.19, sy * 0.29, 0.3)) for sx in (1, -1) for sy in (1, -1)]
    roofed = trimesh.util.concatenate([tray, *posts, block((0.4, 0.6, 0.02), (0, 0, 0.51))])
    assert [round(s.height_m, 2) for s in support_surfaces(roofed, carries=True) if s.interior] == [0.02]
