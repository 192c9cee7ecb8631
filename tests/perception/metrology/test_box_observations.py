from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.artefacts import DetectedObject
from diorama_core.perception.metrology.box_observations import HIDDEN_ODDS, BoxObservations, gather
from diorama_core.perception.metrology.settings import SETTINGS
from tests.perception.metrology.test_metrology import detected

LEFT, TOP, RIGHT, BOTTOM = range(4)


def of(*items: tuple[str, tuple[float, float, float, float]]) -> BoxObservations:
    return gather(tuple(detected(f"o{n}", name, box) for n, (name, box) in enumerate(items)), 640, 480)


def masked(box: tuple[int, int, int, int], share: float, confidence: float = 1.0) -> DetectedObject:
    """A mask that fills the left share of a box."""
    mask = np.zeros((480, 640), dtype=bool)
    x1, y1, x2, y2 = box
    mask[y1:y2, x1 : x1 + round(share * (x2 - x1))] = True
    item = detected("m", "chair", tuple(float(v) for v in box))
    return replace(item, mask=mask, mask_confidence=confidence)


def test_an_object_in_front_hides_the_edges_inside_its_box() -> None:
    seen = of(("sofa", (100, 100, 300, 250)), ("coffee table", (90, 200, 320, 400)))
    assert seen.is_hidden(0).tolist() == [False, False, False, True]
    assert not seen.is_hidden(1).any()
    assert seen.in_front.tolist() == [[False, True], [False, False]]


def test_an_object_that_ends_little_lower_or_covers_little_hides_nothing() -> None:
    assert not of(("sofa", (100, 100, 300, 250)), ("chair", (90, 200, 320, 260))).is_hidden(0).any()
    assert not of(("sofa", (100, 100, 300, 250)), ("chair", (90, 200, 220, 400))).is_hidden(0).any()


def test_what_rests_on_a_parent_is_not_hidden_by_it() -> None:
    seen = of(("books", (150, 150, 200, 250)), ("table", (100, 200, 300, 400)), ("lamp", (140, 240, 210, 420)))
    assert seen.is_hidden(0).tolist() == [False, False, False, True]
    # The lamp on another surface still hides it; a thing on the floor beyond the table does not.
    assert seen.is_hidden(0, parent=1)[BOTTOM]
    behind = of(("books", (150, 150, 200, 250)), ("table", (100, 200, 300, 400)), ("chair", (140, 240, 210, 300)))
    assert not behind.is_hidden(0, parent=1).any()


def test_edges_on_the_border_are_cut_and_tell_no_corner() -> None:
    seen = of(("chair", (0, 100, 200, 480)))
    assert seen.truncated[0].tolist() == [True, False, False, True]
    exact = gather((replace(masked((0, 100, 200, 480), 1.0), box=(0.0, 100.0, 200.0, 480.0)),), 640, 480)
    assert exact.corner_weight[0].tolist() == [0.0, 1.0, 0.0, 0.0]


def test_sigmas_grow_with_the_box_and_the_picture() -> None:
    seen = of(("chair", (100, 100, 200, 300)))
    assert seen.edge_sigma_px[0] == pytest.approx([6.0, 9.0, 6.0, 9.0])
    double = gather((detected("o", "chair", (200, 200, 400, 600)),), 1280, 960)
    assert double.edge_sigma_px[0] == pytest.approx([12.0, 18.0, 12.0, 18.0])


def test_own_masks_are_trusted_wholly() -> None:
    own = gather((masked((100, 100, 200, 300), 0.5),), 640, 480)
    guessed = gather((masked((100, 100, 200, 300), 0.5, 0.8),), 640, 480)
    assert (own.mask_exact[0], guessed.mask_exact[0]) == (True, False)
    assert own.corner_weight[0] == pytest.approx([1.0] * 4)
    assert guessed.corner_weight[0] == pytest.approx([0.32] * 4)
    # The mask's right edge is the box's middle: it reaches the left corners only.
    assert own.mask_reach[0] == pytest.approx([2.0, 1.0, 2.0, 1.0])


@pytest.mark.parametrize("box", [(-5.0, -5.0, -1.0, -1.0), (700.0, 500.0, 800.0, 600.0), (50.0, 60.0, 50.0, 60.0)])
def test_boxes_out_of_the_picture_or_without_extent_become_proper(box: tuple) -> None:
    x1, y1, x2, y2 = of(("chair", box)).box_px[0]
    assert 0 <= x1 <= x2 - 2 <= 638
    assert 0 <= y1 <= y2 - 2 <= 478


def test_no_objects() -> None:
    seen = of()
    assert len(seen) == 0
    assert seen.box_px.shape == seen.corner_weight.shape == (0, 4)


def test_boxes_and_masks_beyond_an_edge_raise_the_odds_that_the_object_goes_on_there() -> None:
    sofa, table = ("sofa", (100, 100, 300, 250)), ("coffee table", (90, 200, 320, 400))
    alone, before = of(sofa).hidden_odds(0), of(sofa, table).hidden_odds(0)
    assert alone.tolist() == HIDDEN_ODDS.tolist()
    np.testing.assert_allclose(before / alone, [1.0, 1.0, 1.0, SETTINGS.observed.odds_boxed])
    outlined = replace(masked((90, 200, 320, 400), 1.0), category="coffee table")
    seen = gather((detected("s", *sofa), outlined), 640, 480)
    assert seen.beside[0, 1].tolist() == pytest.approx([1 / 3, 0.0, 1 / 3, 1.0], abs=0.02)
    assert seen.hidden_odds(0)[BOTTOM] == pytest.approx(
        HIDDEN_ODDS[BOTTOM] * SETTINGS.observed.odds_boxed * SETTINGS.observed.odds_outlined
    )
    # What it rests on hides nothing of it.
    assert seen.hidden_odds(0, parent=1).tolist() == HIDDEN_ODDS.tolist()


def test_the_lower_contour_tells_whether_a_lower_edge_is_hidden() -> None:
    """Seen at an angle, a sofa has its lowest corner behind something, and most of its front's foot in sight."""
    lower = np.linspace(250, 320, 200).astype(int)
    mask = np.zeros((480, 640), dtype=bool)
    for x, y in zip(range(100, 300), lower, strict=True):
        mask[100:y, x] = True
    sofa = replace(detected("s", "sofa", (100.0, 100.0, 300.0, 320.0)), mask=mask)
    before = masked((90, 322, 330, 420), 1.0)
    seen = gather((sofa, before), 640, 480)
    assert seen.beside[0, 1, BOTTOM] == 1.0
    assert seen.ends_seen[0] > 0.9
    raised = SETTINGS.observed.odds_outlined ** (1 - seen.ends_seen[0])
    assert seen.hidden_odds(0)[BOTTOM] == pytest.approx(HIDDEN_ODDS[BOTTOM] * raised)
    level = gather((masked((100, 100, 300, 320), 1.0), before), 640, 480)
    assert level.ends_seen[0] == 0.0
    assert level.hidden_odds(0)[BOTTOM] == pytest.approx(HIDDEN_ODDS[BOTTOM] * SETTINGS.observed.odds_outlined)


def test_what_the_picture_cuts_does_not_end_in_sight() -> None:
    assert gather((masked((100, 300, 300, 480), 1.0),), 640, 480).ends_seen.tolist() == [0.0]
    assert gather((masked((100, 300, 300, 400), 1.0),), 640, 480).ends_seen.tolist() == [1.0]
