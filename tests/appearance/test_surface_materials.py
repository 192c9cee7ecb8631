from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from diorama_core.appearance.lit_colour import is_shade
from diorama_core.appearance.surface_materials import (
    MIN_LINEAR,
    MIN_OF_WHOLE,
    ROUGHNESS,
    appearance_of,
    shade_of,
    slot_pixels,
    whole_pixels,
)
from diorama_core.appearance.surface_view import surface_view
from diorama_core.io.srgb import linear_to_srgb, srgb_to_linear
from diorama_core.library.slots import slots_of
from diorama_core.render.gloss import gloss_share
from diorama_core.scene.types import Pose
from tests.appearance.test_surface_view import CAMERA, parts

NOTHING = np.zeros((150, 200), dtype=bool)
B = np.array([0.0, -0.4, 0.3])
ALBEDO = {"fabric": (0.4, 0.1, 0.05), "wood": (0.1, 0.2, 0.3)}


def seen(turn: float = 0.6):
    slots, mask = slots_of(parts()), np.ones((150, 200), dtype=bool)
    view = surface_view(parts(), slots, Pose.upright((0.0, 0.0, 0.0), turn), CAMERA, mask)
    assert view is not None
    albedo = np.array([ALBEDO[s.role] for s in slots])[view.slot]
    smooth = 1.0 - np.array([ROUGHNESS[s.role][0] for s in slots])[view.slot][..., None]
    albedo = albedo + gloss_share(albedo, np.zeros_like(smooth), smooth, view.cosine[..., None])
    light = np.repeat((1.0 + view.normals_world @ B).astype(np.float32)[..., None], 3, axis=2)
    linear = np.where((view.slot >= 0)[..., None], albedo * light, 0.5)
    rgb = np.round(255 * linear_to_srgb(np.clip(linear, 0, 1))).astype(np.uint8)
    return view, slots, rgb, view.slot >= 0, light


def test_albedo_is_freed_from_the_light() -> None:
    view, slots, rgb, mask, light = seen()
    for pixels in slot_pixels(view, slots, rgb, mask, mask, NOTHING):
        found = appearance_of(view, pixels, rgb, light)
        want = linear_to_srgb(np.array(ALBEDO[found.slot.role]))
        np.testing.assert_allclose(found.colour, want, atol=0.02)
        assert found.texture is None


def test_what_is_black_in_the_photo_is_black_paint_and_no_hole() -> None:
    view, slots, rgb, mask, light = seen()
    for pixels in slot_pixels(view, slots, np.zeros_like(rgb), mask, mask, NOTHING):
        found = appearance_of(view, pixels, np.zeros_like(rgb), light)
        np.testing.assert_allclose(srgb_to_linear(np.array(found.colour)), MIN_LINEAR, atol=1e-6)


def test_faces_of_one_material_tell_the_light() -> None:
    view, slots, rgb, mask, _ = seen()
    (body, *_) = slot_pixels(view, slots, rgb, mask, mask, NOTHING)
    shade = shade_of(view, body, rgb)
    assert len(shade.luminance) == 2
    lit = 1.0 + shade.normals_world @ B
    assert np.isclose(shade.luminance[0] / shade.luminance[1], lit[0] / lit[1], rtol=0.03)


def test_slots_that_are_hardly_seen_are_not_read() -> None:
    view, slots, rgb, mask, _ = seen()
    few = np.zeros_like(mask)
    few[70:74, 98:102] = True
    assert slot_pixels(view, slots, rgb, few, few, NOTHING) == ()


def test_a_thing_whose_slots_are_hardly_seen_is_read_as_one_colour() -> None:
    view, slots, rgb, mask, light = seen()
    rows, columns = np.nonzero(view.slot == next(k for k, s in enumerate(slots) if s.main))
    few = np.zeros_like(mask)
    few[rows[: MIN_OF_WHOLE * 2], columns[: MIN_OF_WHOLE * 2]] = True
    (whole,) = whole_pixels(view, slots, few)
    assert whole.slot.main
    found = appearance_of(view, whole, rgb, light)
    assert found.texture is None
    np.testing.assert_allclose(found.colour, linear_to_srgb(np.array(ALBEDO[whole.slot.role])), atol=0.03)
    fewer = np.zeros_like(mask)
    fewer[rows[:5], columns[:5]] = True
    assert whole_pixels(view, slots, fewer) == ()
    pictured = tuple(replace(s, role="picture") for s in slots)
    assert whole_pixels(view, pictured, few) == ()


def test_a_slot_that_the_mask_lost_is_read_where_the_shape_shows_it() -> None:
    view, slots, rgb, mask, light = seen()
    lost = mask & np.array([s.role != "wood" for s in slots])[view.slot]
    body_alone = slot_pixels(view, slots, rgb, lost, lost, NOTHING)
    both = slot_pixels(view, slots, rgb, lost, mask, NOTHING)
    assert [p.slot.role for p in body_alone] == ["fabric"]
    assert [p.slot.role for p in both] == ["fabric", "wood"]
    found = appearance_of(view, both[1], rgb, light)
    np.testing.assert_allclose(found.colour, linear_to_srgb(np.array(ALBEDO["wood"])), atol=0.02)


def test_a_mask_that_is_elsewhere_is_not_replaced_by_the_shape() -> None:
    view, slots, rgb, mask, _ = seen()
    little = np.zeros_like(mask)
    little[70:84, 90:112] = True
    (body,) = slot_pixels(view, slots, rgb, mask & little, mask, NOTHING)
    assert body.mine.sum() <= little.sum()


def test_a_duvet_that_hangs_over_the_frame_is_no_colour_of_the_frame() -> None:
    view, slots, rgb, mask, light = seen()
    body, wood = (next(k for k, s in enumerate(slots) if s.role == role) for role in ("fabric", "wood"))
    rows = np.argwhere(view.slot == wood)
    over = rows[rows[:, 0] < np.quantile(rows[:, 0], 0.6)]
    hung = rgb.copy()
    hung[over[:, 0] + view.top, over[:, 1] + view.left] = np.median(view.crop(rgb)[view.slot == body], axis=0)
    (_, frame) = slot_pixels(view, slots, hung, mask, mask, NOTHING)
    assert frame.slot.role == "wood"
    found = appearance_of(view, frame, hung, light)
    np.testing.assert_allclose(found.colour, linear_to_srgb(np.array(ALBEDO["wood"])), atol=0.02)


def test_an_object_of_one_colour_keeps_it_on_all_its_slots() -> None:
    view, slots, rgb, mask, _ = seen()
    rgb[mask] = (200, 190, 180)
    (body, frame) = slot_pixels(view, slots, rgb, mask, mask, NOTHING)
    np.testing.assert_allclose(*(np.median(view.crop(rgb)[p.near], axis=0) for p in (body, frame)))


def colours_of(rgb, view, slots, background=NOTHING):
    """Median colours by role of the slots that are read, from a picture of the view's size."""
    mask = view.slot >= 0
    found = slot_pixels(view, slots, rgb, mask, mask, background)
    return {p.slot.role: np.median(view.crop(rgb)[p.near], axis=0) for p in found}


def index_of(slots, role: str) -> int:
    return next(k for k, s in enumerate(slots) if s.role == role)


def test_a_large_slot_keeps_its_colour_where_a_small_one_crosses_it() -> None:
    view, slots, rgb, _, _ = seen()
    body, foot = (view.slot == index_of(slots, role) for role in ("fabric", "wood"))
    red, white = (160, 20, 30), (240, 240, 240)
    rgb[body | foot] = red
    rows = np.argwhere(body)
    rgb[tuple(rows[rows[:, 0] > np.quantile(rows[:, 0], 0.65)].T)] = white
    found = colours_of(rgb, view, slots)
    np.testing.assert_allclose(found["fabric"], red, atol=2)
    assert "wood" not in found


def test_the_lit_side_of_a_neighbours_wood_is_no_colour_of_a_cushion() -> None:
    view, slots, rgb, _, _ = seen()
    frame, cushion = (view.slot == index_of(slots, role) for role in ("fabric", "wood"))
    shaded, lit, cloth = (94, 62, 43), (230, 164, 119), (120, 178, 208)
    assert is_shade(*(cv2.cvtColor(np.array([[c]], np.float32) / 255, cv2.COLOR_RGB2Lab)[0, 0] for c in (shaded, lit)))
    rgb[frame] = shaded
    places = np.argwhere(cushion)
    share = np.argsort(np.argsort(places[:, 1], kind="stable")) / len(places)
    rgb[tuple(places[share < 0.41].T)] = lit
    rgb[tuple(places[(share >= 0.41) & (share < 0.79)].T)] = cloth
    rgb[tuple(places[share >= 0.79].T)] = shaded
    np.testing.assert_allclose(colours_of(rgb, view, slots)["wood"], cloth, atol=2)


def test_what_lies_before_two_slots_is_no_colour_of_either() -> None:
    """A white board before a red chair's seat and legs; the red lies in several bins of colour, the white in one."""
    view, slots, rgb, _, _ = seen()
    body, foot = (view.slot == index_of(slots, role) for role in ("fabric", "wood"))
    columns = np.arange(rgb.shape[1])[None, :, None]
    red = np.array([200, 25, 35]) * (0.35 + 0.6 * ((columns // 3) % 4) / 3)
    rgb[:] = np.where((body | foot)[..., None], red, 90).astype(np.uint8)
    for part in (body, foot):
        rows = np.argwhere(part)
        rgb[tuple(rows[rows[:, 1] > np.quantile(rows[:, 1], 0.7)].T)] = 250
    found = colours_of(rgb, view, slots)
    assert found["fabric"][0] > 3 * found["fabric"][1]
    assert found.get("wood", np.zeros(3)).min() < 200


def test_a_wall_seen_past_a_frame_is_not_before_its_white_cushion() -> None:
    view, slots, rgb, _, _ = seen()
    frame, cushion = (view.slot == index_of(slots, role) for role in ("fabric", "wood"))
    shaded, lit, white = (94, 62, 43), (230, 164, 119), (228, 229, 229)
    rgb[:], rgb[-50:] = white, (120, 140, 160)  # the wall, and a third of the floor
    for part, colours in (
        (frame, ((0.74, shaded), (1.0, white))),
        (cushion, ((0.38, lit), (0.74, white), (1.0, shaded))),
    ):
        places = np.argwhere(part)
        share, begin = np.argsort(np.argsort(places[:, 1], kind="stable")) / len(places), 0.0
        for end, colour in colours:
            rgb[tuple(places[(share >= begin) & (share < end)].T)] = colour
            begin = end
    found = colours_of(rgb, view, slots, view.slot < 0)
    np.testing.assert_allclose(found["fabric"], shaded, atol=2)
    np.testing.assert_allclose(found["wood"], white, atol=2)


def test_two_materials_of_one_pale_colour_are_both_read() -> None:
    view, slots, rgb, _, _ = seen()
    rgb[view.slot >= 0] = (225, 222, 218)
    assert set(colours_of(rgb, view, slots)) == {"fabric", "wood"}


def test_a_colour_that_the_background_has_more_of_is_the_backgrounds() -> None:
    view, slots, rgb, _, _ = seen()
    body = np.argwhere(view.slot == index_of(slots, "fabric"))
    brown, rug = (90, 50, 30), (190, 120, 150)
    rgb[:] = rug
    rgb[view.slot >= 0] = brown
    rgb[tuple(body[body[:, 0] > np.quantile(body[:, 0], 0.45)].T)] = rug
    alone, beside = (colours_of(rgb, view, slots, b)["fabric"] for b in (NOTHING, view.slot < 0))
    np.testing.assert_allclose(alone, rug, atol=2)
    np.testing.assert_allclose(beside, brown, atol=2)


def test_the_librarys_weave_gives_way_where_the_photo_shows_none() -> None:
    view, slots, rgb, mask, light = seen()
    body = next(p for p in slot_pixels(view, slots, rgb, mask, mask, NOTHING) if p.slot.role == "fabric")
    body = replace(body, slot=replace(body.slot, tile_m=0.3))
    weave = np.random.default_rng(0).integers(90, 160, (16, 16, 3)).astype(np.uint8)
    found = appearance_of(view, body, rgb, light, weave)
    assert found.texture is not None
    assert found.texture.reshape(-1, 3).std(axis=0).max() == 0
    assert appearance_of(view, body, rgb, light, np.full_like(weave, 120)).texture is None


def test_legs_that_the_mask_lost_are_not_blue_because_the_carpet_is() -> None:
    view, slots, rgb, mask, _ = seen()
    wood = view.slot == next(k for k, s in enumerate(slots) if s.role == "wood")
    rows, columns = np.nonzero(wood)
    lost, painted = mask.copy(), rgb.copy()
    lost[rows + view.top, columns + view.left] = False
    painted[rows + view.top, columns + view.left] = (30, 60, 150)
    background = ~mask
    grey, blue = painted.copy(), painted.copy()
    grey[background], blue[background] = 128, (30, 60, 150)
    roles = [[p.slot.role for p in slot_pixels(view, slots, x, lost, mask, background)] for x in (grey, blue)]
    assert roles == [["fabric", "wood"], ["fabric"]]
