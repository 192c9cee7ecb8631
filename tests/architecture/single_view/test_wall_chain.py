from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from diorama_core.architecture.single_view.level_view import level_view
from diorama_core.architecture.single_view.room_cues import PRIOR_MEDIAN_M, gather_room_cues
from diorama_core.architecture.single_view.settings import SETTINGS
from diorama_core.architecture.single_view.wall_chain import (
    FINE,
    Chain,
    ChainScorer,
    PhotoWalls,
    best_ceiling,
    best_chain,
    leaves,
    nearby_walls,
    refine_chain,
)
from tests.architecture.single_view.plain_cues import cues, drawn_edges
from tests.synthetic_rooms import box_room, cuboid, look, shoot

CAMERA = look(20.0, 8.0, fov_deg=75.0, size=(320, 240))
SHOT = shoot(CAMERA, box_room(-2.0, 2.0, 4.0, 2.6), (cuboid("table", (-0.8, 2.6, 0), (0.8, 1.0, 0.7)),))
BLANK = np.full((240, 320, 3), 128, np.uint8)


def walls(*rows: tuple[tuple[float, float], float]) -> PhotoWalls:
    """Planes in plan: (normal, offset)."""
    normals = np.array([n for n, _ in rows])
    return PhotoWalls(normals, np.array([o for _, o in rows]), np.abs(normals).argmax(axis=1))


LEFT, FAR = ((1.0, 0.0), -2.0), ((0.0, -1.0), -4.0)


@cache
def seen() -> ChainScorer:
    """The scorer of the photographed room."""
    found = gather_room_cues(SHOT.inputs.photo.rgb, CAMERA, SHOT.objects, SHOT.cuboids)
    return ChainScorer(found, level_view(SHOT.inputs.photo.rgb, found, SHOT.objects))


def blank(**given) -> ChainScorer:
    """A scorer that only knows what is given."""
    found = cues(camera=CAMERA, **given)
    return ChainScorer(found, level_view(BLANK, found, ()))


def test_reach_is_the_distance_to_the_wall_in_the_heading() -> None:
    scorer = seen()
    headings = scorer.view.middles_rad
    far, left = scorer.reach(walls(FAR, LEFT))
    np.testing.assert_allclose(far[np.isfinite(far)], 4.0 / np.cos(headings[np.isfinite(far)]))
    to_the_left = np.sin(headings) < -0.06
    assert np.isfinite(left[headings < -0.2]).all()
    np.testing.assert_allclose(left[np.isfinite(left)], 2.0 / -np.sin(headings[np.isfinite(left)]))
    assert not np.isfinite(left[~to_the_left]).any()
    (behind,) = scorer.reach(walls(((0.0, 1.0), -4.0)))
    assert not np.isfinite(behind).any()


def test_a_wall_that_is_not_met_or_too_near_cannot_be_chosen() -> None:
    costs = seen().costs(walls(LEFT, ((0.0, -1.0), -0.1)), 2.6)
    assert (costs[0][seen().view.middles_rad > 0] == 1e3).all()
    assert (costs[1] == 1e3).all()


def test_the_true_wall_costs_least_where_it_is_seen() -> None:
    scorer = seen()
    offsets = np.array([-3.0, -3.6, -4.0, -4.4, -5.2])
    costs = scorer.costs(walls(*(((0.0, -1.0), o) for o in offsets)), 2.6)
    on_far = (scorer.view.middles_rad > np.arctan2(-1.9, 4.0)) & (scorer.view.middles_rad < 0.2)
    assert on_far.sum() > 20
    assert offsets[costs[:, on_far].sum(axis=1).argmin()] == -4.0


def test_objects_push_walls_away_in_the_headings_of_their_corners() -> None:
    # Straight ahead at 3 m, thin, so that all corners share few headings.
    item = {"object_low": np.array([[-0.01, 2.99, 0.0]]), "object_high": np.array([[0.01, 3.01, 1.0]])}
    with_item = blank(**item, object_weights=np.array([1.0]))
    near, far = walls(((0.0, -1.0), -1.5)), walls(FAR)
    extra = [with_item.costs(w, 2.6) - blank().costs(w, 2.6) for w in (near, far)]
    # At most twice the scale, for each of four corners a quarter of the weight.
    assert extra[0].sum() == pytest.approx(2.0 * SETTINGS.cues.object_weight, rel=1e-6)
    assert np.flatnonzero(extra[0][0]).size <= 4
    np.testing.assert_allclose(extra[1], 0.0, atol=1e-12)


def test_sights_leave_a_footprint_where_it_ends_behind() -> None:
    across = np.array([[0.0, 1.0], [1.0, 0.0], [np.sqrt(0.5), np.sqrt(0.5)]])
    found = leaves(np.zeros(2), across, np.array([-0.5, 2.0]), np.array([3.0, 3.5]))
    np.testing.assert_allclose(found, [3.5, np.inf, 3.0 * np.sqrt(2.0)])
    within = leaves(np.array([0.0, 2.5]), across[:1], np.array([-0.5, 2.0]), np.array([3.0, 3.5]))
    np.testing.assert_allclose(within, [1.0])


def test_what_stands_at_walls_draws_the_wall_to_its_back() -> None:
    at = {"backed_low": np.array([[-0.5, 2.6, 0.0]]), "backed_high": np.array([[0.5, 3.0, 2.0]])}
    scorer = blank(backed_weights=np.array([0.8]), **at)
    near, behind, far = (
        scorer.costs(walls(((0.0, -1.0), -y)), 2.6).sum() - blank().costs(walls(((0.0, -1.0), -y)), 2.6).sum()
        for y in (2.4, 3.0, 4.5)
    )
    assert behind < 0.1 * near
    assert behind < 0.1 * far
    assert far <= SETTINGS.search.back_weight * 0.8 * SETTINGS.search.back_cap + 1e-9, "it may stand elsewhere"


def test_walls_that_lead_far_away_cost_more() -> None:
    far, farther = blank().costs(walls(((0.0, -1.0), -6.0), ((0.0, -1.0), -11.0)), 2.6).sum(axis=1)
    assert farther > far + 0.3


def test_usual_heights_and_objects_below_them_cost_nothing() -> None:
    usual = float(PRIOR_MEDIAN_M[2])
    assert blank().ceiling_prior(usual) == pytest.approx(0.0)
    assert blank().ceiling_prior(usual * 1.2) == pytest.approx(blank().ceiling_prior(usual / 1.2))
    assert blank().ceiling_prior(usual * 1.2) > 0.01
    hung = blank(hung_top_m=usual + 0.125)
    assert hung.ceiling_prior(usual) == pytest.approx(0.25)


def test_going_over_costs_a_corner_a_protrusion_or_a_jump() -> None:
    scorer = blank()
    pair = walls(LEFT, FAR)
    over = scorer.going_over(pair, 2.6)
    corner = int(np.abs(scorer.view.edges_rad[1:-1] - np.arctan2(-2.0, 4.0)).argmin())
    assert over[corner, 0, 1] == pytest.approx(SETTINGS.search.corner_cost)
    assert over[corner, 1, 0] == pytest.approx(SETTINGS.search.protruding_cost)
    assert over[corner + 30, 0, 1] == pytest.approx(SETTINGS.search.jump_cost)
    assert (over[:, [0, 1], [0, 1]] == 0).all()


def test_an_upright_edge_makes_going_over_cheaper() -> None:
    scorer = blank()
    upright = np.zeros_like(scorer.view.upright)
    at = 1 + int(np.abs(scorer.view.edges_rad[1:-1] - np.arctan2(-2.0, 4.0)).argmin())
    upright[at] = 0.001
    drawn = ChainScorer(scorer.cues, replace(scorer.view, upright=upright))
    assert drawn.going_over(walls(LEFT, FAR), 2.6)[at - 1, 0, 1] < SETTINGS.search.corner_cost - 0.01
    assert drawn.going_over(walls(LEFT, FAR), 2.6)[at, 0, 1] == pytest.approx(SETTINGS.search.corner_cost)


def test_the_chain_is_the_cheapest_of_all_paths() -> None:
    """Against every path over few headings."""
    rng = np.random.default_rng(3)

    class Fixed(ChainScorer):
        def costs(self, walls, ceiling_m):
            return table

        def going_over(self, walls, ceiling_m):
            return over

        def ceiling_prior(self, ceiling_m):
            return 0.25

    options = walls(LEFT, FAR, ((-1.0, 0.0), -2.0))
    scorer = Fixed(seen().cues, seen().view)
    for _ in range(20):
        table, over = rng.random((3, 6)), rng.random((5, 3, 3))
        for k in range(5):
            np.fill_diagonal(over[k], 0.0)
        paths = np.stack(np.meshgrid(*[range(3)] * 6, indexing="ij"), axis=-1).reshape(-1, 6)
        total = table[paths, np.arange(6)].sum(axis=1)
        total += over[np.arange(5), paths[:, :-1], paths[:, 1:]].sum(axis=1)
        best = paths[total.argmin()]
        chain = best_chain(scorer, options, 2.5)
        assert chain.cost == pytest.approx(total.min() + 0.25)
        lengths = np.diff(chain.borders)
        labels = [int(np.flatnonzero((options.normals == n).all(axis=1))[0]) for n in chain.walls.normals]
        assert np.repeat(labels, lengths).tolist() == best.tolist()


def test_best_ceiling_is_the_rooms_and_above_the_eye() -> None:
    camera = look(0.0, -10.0, fov_deg=75.0, size=(320, 240))
    shot = shoot(camera, box_room(-2.0, 2.0, 4.0, 2.4))
    found = gather_room_cues(shot.inputs.photo.rgb, camera, (), ())
    scorer = ChainScorer(found, level_view(shot.inputs.photo.rgb, found, ()))
    chain = best_chain(scorer, walls(LEFT, FAR, ((-1.0, 0.0), -2.0)), 2.4)
    heights = np.array([1.0, 1.6, 2.0, 2.4, 2.8, 3.4, 9.0])
    assert best_ceiling(scorer, chain, heights) == 2.4
    assert best_ceiling(scorer, chain, np.array([1.0, 9.0])) == chain.ceiling_m


def test_walls_around_others_are_nearer_and_farther_by_a_share() -> None:
    scorer = seen()
    near = nearby_walls(scorer, walls(LEFT, FAR), 1.0)
    assert len(near) == 2 * len(FINE)
    np.testing.assert_allclose(np.sort(near.offsets[near.directions == 1]), np.sort(-4.0 * (1.0 + FINE)))
    same = nearby_walls(scorer, walls(FAR), 0.0)
    assert same.offsets.tolist() == [-4.0]


def test_refinement_moves_rough_walls_to_the_true_ones() -> None:
    scorer = seen()
    rough = best_chain(scorer, walls(((1.0, 0.0), -2.1), ((0.0, -1.0), -4.2)), 2.6)
    fine = refine_chain(scorer, rough, np.array([2.4, 2.6, 2.8]))
    assert fine.cost <= best_chain(scorer, rough.walls, best_ceiling(scorer, rough, np.array([2.4, 2.6, 2.8]))).cost
    found = {int(d): o for d, o in zip(fine.walls.directions, fine.walls.offsets, strict=True)}
    assert found[1] == pytest.approx(-4.0, abs=0.08)
    assert found[0] == pytest.approx(-2.0, abs=0.08)


def test_support_tells_a_seen_wall_from_an_assumed_one() -> None:
    scorer = seen()
    true = best_chain(scorer, walls(LEFT, FAR), 2.6)
    wrong = Chain(PhotoWalls(true.walls.normals, true.walls.offsets * 1.6, true.walls.directions), true.borders, 3.4, 0)
    assert (scorer.support(true) > scorer.support(wrong) + 0.2).all()
    nothing = blank().support(Chain(walls(FAR), np.array([0, 144]), 2.6, 0.0))
    assert ((nothing >= 0) & (nothing < 0.35)).all()


LINES = [(0, (-6.0, 4.0, height), (6.0, 4.0, height)) for height in (0.0, 0.09)]
"""The two edges of a skirting board along the far wall."""
AT_UPPER_EDGE = ((0.0, -1.0), -4.0 * 1.5 / (1.5 - 0.09))
"""The wall whose foot would be where the board's upper edge is seen."""


def test_the_lower_edge_of_a_skirting_board_is_the_walls_foot() -> None:
    scorer = blank(edge_maps=drawn_edges(CAMERA, LINES))
    foot, upper = scorer.costs(walls(FAR, AT_UPPER_EDGE), 2.6).sum(axis=1)
    assert foot < upper - 0.2
    bare = blank(edge_maps=drawn_edges(CAMERA, LINES[1:]))
    foot, upper = bare.costs(walls(FAR, AT_UPPER_EDGE), 2.6).sum(axis=1)
    assert upper < foot, "one line alone is the foot itself"


def test_a_wall_with_a_skirting_board_is_surer() -> None:
    chain = Chain(walls(FAR), np.array([0, 144]), 2.6, 0.0)
    with_board, without = (
        blank(edge_maps=drawn_edges(CAMERA, lines)).support(chain)[0] for lines in (LINES, LINES[:1])
    )
    assert with_board > without + 0.05
