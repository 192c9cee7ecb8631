from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.taxonomy import category
from diorama_core.retrieval.box_views import DISTANCES_M, HEIGHTS_M, box_likelihood, box_view, size_density
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
