"""Floors are made of floor: what nobody marked is rejected, patterns stay."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.architecture.texture.floor_material import contact_pixels, floor_colour, floor_texels, white_level
from diorama_core.artefacts import DetectedObject

SIZE, PIXEL_M = 200, 0.02
OAK, WALNUT, BLUE = (170.0, 130.0, 95.0), (45.0, 30.0, 22.0), (60.0, 90.0, 150.0)


def floor(colour: tuple[float, float, float] = OAK, seed: int = 0) -> np.ndarray:
    """Four metres of one colour with some grain."""
    noise = np.random.default_rng(seed).normal(0, 4, (SIZE, SIZE, 1))
    return (np.array(colour) + noise).clip(0, 255).astype(np.float32)


def texels(colours: np.ndarray, contact: np.ndarray | bool = False, seen: np.ndarray | bool = True) -> np.ndarray:
    seen, contact = (np.broadcast_to(mask, (SIZE, SIZE)) for mask in (seen, contact))
    return floor_texels(colours, seen, np.ones((SIZE, SIZE)), contact, PIXEL_M)


def assert_floor_is(colour, *pixels: tuple[int, tuple[int, int, int]]) -> None:
    """Check the floor's colour among so many pixels of each colour, all over the photo."""
    rgb = np.concatenate([np.full((count, 3), other) for count, other in pixels]).astype(np.uint8)
    places = np.random.default_rng(0).uniform(0, 100, (len(rgb), 2))
    assert np.allclose(np.array(floor_colour(rgb, places, 95.0)) * 255, colour, atol=2)


def test_a_plain_floor_is_all_floor():
    assert texels(floor()).mean() > 0.99


@pytest.mark.parametrize("colour", [WALNUT, BLUE, (250.0, 250.0, 250.0)])
def test_what_nobody_marked_is_rejected(colour):
    colours = floor()
    colours[60:130, 40:140] = colour
    own = texels(colours)
    assert not own[60:130, 40:140].any()
    assert own[:50].mean() > 0.99


def test_a_colour_between_two_materials_is_neither():
    """A cream rug left over on brown boards: a cell of colour between the two holds both."""
    boards, cream = np.array([160.0, 140.0, 125.0]), np.array([205.0, 200.0, 190.0])
    colours = floor((160.0, 140.0, 125.0))
    colours[60:150] = floor((205.0, 200.0, 190.0), seed=1)[60:150]
    colours[56:60] = np.linspace(boards, cream, 4)[:, None]
    own = texels(colours)
    assert own[155:].mean() > 0.95
    assert not own[65:145].any()


def test_the_floor_is_what_shows_at_the_feet_of_objects():
    colours = floor((96, 108, 84))
    colours[:, 60:] = OAK  # more of another colour, as of a bed nobody marked
    contact = np.zeros((SIZE, SIZE), dtype=bool)
    assert texels(colours, contact)[:, 80:].mean() > 0.9
    contact[90:110, 10:40] = True
    assert texels(colours, contact)[:, :50].mean() > 0.9


def test_shadows_at_the_feet_of_objects_speak_for_the_floor_that_they_lie_on():
    colours = floor((150, 135, 95))
    colours[30:170, 30:170] = floor((58, 51, 33))[30:170, 30:170]
    contact = np.zeros((SIZE, SIZE), dtype=bool)
    contact[40:160, 40:160] = True
    own = texels(colours, contact)
    assert own[:25].mean() > 0.95
    assert own[40:160, 40:160].mean() < 0.05


def test_a_sliver_far_away_does_not_outweigh_the_floor_that_is_near():
    colours, weight = floor((186, 152, 119)), np.full((SIZE, SIZE), 1.0)
    seen = np.zeros((SIZE, SIZE), dtype=bool)
    seen[80:120, 150:195], seen[:, :4] = True, True  # a wall's foot across the whole room, almost edge on
    colours[:, :4] = floor((107, 96, 72))[:, :4]
    colours[80:120, 150:170] = floor((107, 96, 72))[80:120, 150:170]  # and the floor's shade under a table
    weight[:, :4] = 0.1
    own = floor_texels(colours, seen, weight, seen & False, PIXEL_M)
    assert own[85:115, 175:190].mean() > 0.9


def test_a_pattern_belongs_to_the_floor():
    rows, columns = np.indices((SIZE, SIZE)) // 10
    colours = np.where(((rows + columns) % 2 == 0)[..., None], floor((90, 80, 70)), floor((190, 180, 165), 1))
    assert texels(colours.astype(np.float32)).mean() > 0.95


def test_black_is_hardly_a_floor():
    colours = floor()
    colours[:, 90:] = 5.0
    assert texels(colours)[:, :80].mean() > 0.95


def test_nothing_seen_is_nothing_known():
    assert not texels(floor(), seen=False).any()


def test_the_plain_colour_is_the_floors_and_not_a_shadows():
    assert_floor_is((150, 120, 90), (300, (150, 120, 90)), (350, (4, 4, 4)))


@pytest.mark.parametrize("unusual", [(90, 120, 190), (200, 60, 120), (70, 150, 90)])
def test_boards_in_warm_light_are_likelier_than_what_no_floor_looks_like(unusual):
    assert_floor_is((200, 135, 75), (300, (200, 135, 75)), (500, unusual))


def test_contact_is_a_little_below_masks_and_in_no_other():
    mask, other = np.zeros((100, 100), dtype=bool), np.zeros((100, 100), dtype=bool)
    mask[20:50, 30:60], other[50:60, 30:40] = True, True
    things = [DetectedObject(f"a_{k}", "chair", "chair", (0, 0, 1, 1), m, k, 1.0) for k, m in enumerate((mask, other))]
    found = contact_pixels((100, 100), things)
    assert found[52:55, 42:60].all()
    assert not found[:50].any()
    assert not (found & other).any()


@pytest.mark.parametrize(
    ("category", "sure", "is_floor"), [("rug", 0.8, False), ("rug", 1.0, True), ("box", 0.8, True)]
)
def test_what_a_doubtful_rug_may_hide_is_no_floor_at_the_feet_of_things(category, sure, is_floor):
    foot, lying = np.zeros((100, 100), dtype=bool), np.zeros((100, 100), dtype=bool)
    foot[20:50, 30:60], lying[80:95, 20:80] = True, True
    chair = DetectedObject("chair_1", "chair", "chair", (30, 20, 60, 50), foot, 1, 0.9)
    other = DetectedObject("other_1", category, category, (10, 40, 90, 95), lying, 2, sure)
    assert contact_pixels((100, 100), [chair, other])[52:55, 32:58].all() == is_floor


def test_the_white_of_a_dark_photo_is_dark():
    assert white_level(np.full((50, 50, 3), 60, np.uint8)) < 30 < white_level(np.full((50, 50, 3), 250, np.uint8))


@pytest.mark.parametrize(("light", "dark"), [((236, 196, 140), (133, 106, 72)), ((205, 200, 190), (110, 107, 101))])
def test_a_dark_colour_that_a_lighter_one_covers_more_is_its_shade(light, dark):
    assert_floor_is(light, (900, light), (400, dark))


def test_a_dark_floor_beside_as_much_of_a_light_thing_stays_dark():
    assert_floor_is((133, 106, 72), (500, (236, 196, 140)), (450, (133, 106, 72)))


def test_a_floor_that_turns_gradually_from_daylight_to_lamplight_is_one():
    cold, warm = np.array([150.0, 140.0, 125.0]), np.array([158.0, 136.0, 96.0])
    share = np.clip((np.arange(SIZE) - 60.0) / 80.0, 0.0, 1.0)[:, None, None]
    noise = np.random.default_rng(0).normal(0, 4, (SIZE, SIZE, 1))
    colours = ((1.0 - share) * cold + share * warm + noise).astype(np.float32)
    assert texels(colours).mean() > 0.95
    # With an edge it is another thing.
    step = (np.arange(SIZE) > 100)[:, None, None]
    assert texels(np.where(step, warm + noise, cold + noise).astype(np.float32)).mean() < 0.6


def test_a_skirting_board_along_a_strip_of_floor_is_no_pattern_of_it_and_inlays_are():
    colours, seen = floor(), np.zeros((SIZE, SIZE), dtype=bool)
    seen[92:108] = True  # 32 cm of floor and board
    board = colours.copy()
    board[92:99] = (235.0, 235.0, 230.0)
    assert not texels(board, seen=seen)[92:99].any()
    inlaid = colours.copy()
    inlaid[92:108][:, np.arange(SIZE) % 8 < 3] = (235.0, 235.0, 230.0)
    assert texels(inlaid, seen=seen)[94:106, 10:190].mean() > 0.9


def test_boards_in_the_sun_are_the_floor_though_things_stand_in_the_grey_shade():
    """Where the sun does not reach, the sky's blue light leaves less of the boards' orange."""
    colours = floor((253.0, 181.0, 129.0))
    shade = np.zeros((SIZE, SIZE), dtype=bool)
    shade[:, 40:80] = True
    colours[shade] = floor((188.0, 150.0, 122.0), seed=1)[shade]
    contact = np.zeros((SIZE, SIZE), dtype=bool)
    contact[90:110, 45:75] = True
    own = texels(colours, contact)
    assert own[:, 90:].mean() > 0.95
    assert not own[:, 45:75].any()


def test_a_grey_floor_beside_as_much_of_orange_boards_is_no_shade_of_them():
    colours = floor((188.0, 150.0, 122.0))
    colours[:, :80] = floor((253.0, 181.0, 129.0), seed=1)[:, :80]
    contact = np.zeros((SIZE, SIZE), dtype=bool)
    contact[90:110, 100:180] = True
    assert texels(colours, contact)[:, 90:].mean() > 0.95
