"""Things of usual size set on a bed, a table and shelves: their boxes must say that they lie there."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.taxonomy import category
from diorama_core.retrieval.box_views import (
    DISTANCES_M,
    HEIGHTS_M,
    SETTINGS,
    box_likelihood,
    box_view,
    lying_likelihoods,
    size_density,
)
from tests.retrieval.test_word_senses import LEVEL, K, seen


def view_of(kind: str, bottom_m: float = 0.0, place=(0.0, 4.0), height_m: float = 1.45, carried: float = 0.0):
    return box_view(seen(kind, kind, bottom_m, place, height_m).box, carried, K, LEVEL)


@pytest.mark.parametrize("height_m", [1.0, 1.4, 1.9])
def test_a_chairs_box_tells_how_high_the_camera_is(height_m) -> None:
    likely = box_likelihood(view_of("chair", height_m=height_m), "chair")
    assert HEIGHTS_M[likely.argmax()] == pytest.approx(height_m, abs=0.35)


def test_a_box_is_likeliest_for_its_own_kind() -> None:
    of_wardrobe = view_of("wardrobe")
    likely = {kind: float(box_likelihood(of_wardrobe, kind)[7]) for kind in ("wardrobe", "night stand", "picture")}
    assert likely["wardrobe"] > 1.5 * max(likely["night stand"], likely["picture"])


def test_sizes_are_usual_at_the_true_distance() -> None:
    usual = size_density(view_of("sofa", place=(0.0, 5.0)), category("sofa").priors[0], "floor")
    assert DISTANCES_M[usual.argmax()] == pytest.approx(5.0, rel=0.2)


def test_what_lies_on_things_needs_something_below_it() -> None:
    alone, on_it = (view_of("vase", 0.75, carried=carried) for carried in (0.0, 1.0))
    assert (box_likelihood(on_it, "vase") > box_likelihood(alone, "vase")).all()
    assert np.ptp(box_likelihood(alone, "vase")) == 0


HEIGHT = np.exp(-0.5 * ((HEIGHTS_M - 1.45) / 0.1) ** 2)
HEIGHT /= HEIGHT.sum()


def ratio(view, kind: str, carrier, carrier_kind: str) -> float:
    """How many times likelier the box is for a kind that lies there than for one that lies anywhere."""
    there = lying_likelihoods(view, [kind], carrier, [carrier_kind], HEIGHT)[0, 0]
    return float(there / (HEIGHT @ box_likelihood(view, kind)))


@pytest.mark.parametrize(("kind", "carrier"), [("pillow", "bed"), ("lamp", "night stand"), ("vase", "table")])
def test_what_lies_on_a_thing_is_as_far_away_and_as_large_as_it_should_be(kind, carrier) -> None:
    level = category(carrier).seat_height_m or category(carrier).priors[0].height_m
    assert ratio(view_of(kind, level, carried=1.0), kind, view_of(carrier), carrier) > 1.5


def test_a_dresser_beside_a_bed_is_too_large_for_a_pillow_on_it() -> None:
    dresser, bed = view_of("dresser", place=(-1.5, 4.0), carried=1.0), view_of("bed")
    assert ratio(dresser, "pillow", bed, "bed") < 0.5


def test_a_thing_far_below_a_top_does_not_lie_on_it() -> None:
    table = view_of("table")
    on_floor, on_top = (view_of("vase", bottom, carried=1.0) for bottom in (0.0, 0.72))
    assert ratio(on_floor, "vase", table, "table") < 0.4 * ratio(on_top, "vase", table, "table")


def test_shelves_carry_at_any_height() -> None:
    shelf = view_of("bookshelf")
    found = [
        lying_likelihoods(view_of("vase", z, carried=1.0), ["vase"], shelf, ["bookshelf"], HEIGHT)
        for z in (0.3, 0.9, 1.3)
    ]
    assert min(of_one[0, 0] for of_one in found) > 10 * SETTINGS.certain
