from __future__ import annotations

import numpy as np

from diorama_core.appearance.surface_materials import appearance_of, shade_of, slot_pixels
from diorama_core.appearance.surface_view import surface_view
from diorama_core.io.srgb import linear_to_srgb
from diorama_core.library.slots import slots_of
from diorama_core.scene.types import Pose
from tests.appearance.test_surface_view import CAMERA, parts

B = np.array([0.0, -0.4, 0.3])
ALBEDO = {"fabric": (0.4, 0.1, 0.05), "wood": (0.1, 0.2, 0.3)}


def seen(turn: float = 0.6):
    slots, mask = slots_of(parts()), np.ones((150, 200), dtype=bool)
    view = surface_view(parts(), slots, Pose.upright((0.0, 0.0, 0.0), turn), CAMERA, mask)
    assert view is not None
    albedo = np.array([ALBEDO[s.role] for s in slots])[view.slot]
    light = (1.0 + view.normals_world @ B).astype(np.float32)
    linear = np.where((view.slot >= 0)[..., None], albedo * light[..., None], 0.5)
    rgb = np.round(255 * linear_to_srgb(np.clip(linear, 0, 1))).astype(np.uint8)
    return view, slots, rgb, view.slot >= 0, light


def test_albedo_is_freed_from_the_light() -> None:
    view, slots, rgb, mask, light = seen()
    for pixels in slot_pixels(view, slots, rgb, mask, mask):
        found = appearance_of(view, pixels, rgb, light)
        want = linear_to_srgb(np.array(ALBEDO[found.slot.role]))
        np.testing.assert_allclose(found.colour, want, atol=0.02)
        assert found.texture is None


def test_faces_of_one_material_tell_the_light() -> None:
    view, slots, rgb, mask, _ = seen()
    (body, *_) = slot_pixels(view, slots, rgb, mask, mask)
    shade = shade_of(view, body, rgb)
    assert len(shade.luminance) == 2
    lit = 1.0 + shade.normals_world @ B
    assert np.isclose(shade.luminance[0] / shade.luminance[1], lit[0] / lit[1], rtol=0.03)


def test_slots_that_are_hardly_seen_are_not_read() -> None:
    view, slots, rgb, mask, _ = seen()
    few = np.zeros_like(mask)
    few[70:74, 98:102] = True
    assert slot_pixels(view, slots, rgb, few, few) == ()


def test_a_slot_that_the_mask_lost_is_read_where_the_shape_shows_it() -> None:
    view, slots, rgb, mask, light = seen()
    lost = mask & np.array([s.role != "wood" for s in slots])[view.slot]
    body_alone = slot_pixels(view, slots, rgb, lost, lost)
    both = slot_pixels(view, slots, rgb, lost, mask)
    assert [p.slot.role for p in body_alone] == ["fabric"]
    assert [p.slot.role for p in both] == ["fabric", "wood"]
    found = appearance_of(view, both[1], rgb, light)
    np.testing.assert_allclose(found.colour, linear_to_srgb(np.array(ALBEDO["wood"])), atol=0.02)


def test_a_mask_that_is_elsewhere_is_not_replaced_by_the_shape() -> None:
    view, slots, rgb, mask, _ = seen()
    little = np.zeros_like(mask)
    little[70:84, 90:112] = True
    (body,) = slot_pixels(view, slots, rgb, mask & little, mask)
    assert body.mine.sum() <= little.sum()


def test_a_duvet_that_hangs_over_the_frame_is_no_colour_of_the_frame() -> None:
    view, slots, rgb, mask, light = seen()
    body, wood = (next(k for k, s in enumerate(slots) if s.role == role) for role in ("fabric", "wood"))
    rows = np.argwhere(view.slot == wood)
    over = rows[rows[:, 0] < np.quantile(rows[:, 0], 0.6)]
    hung = rgb.copy()
    hung[over[:, 0] + view.top, over[:, 1] + view.left] = np.median(view.of(rgb)[view.slot == body], axis=0)
    (_, frame) = slot_pixels(view, slots, hung, mask, mask)
    assert frame.slot.role == "wood"
    found = appearance_of(view, frame, hung, light)
    np.testing.assert_allclose(found.colour, linear_to_srgb(np.array(ALBEDO["wood"])), atol=0.02)


def test_an_object_of_one_colour_keeps_it_on_all_its_slots() -> None:
    view, slots, rgb, mask, _ = seen()
    rgb[mask] = (200, 190, 180)
    (body, frame) = slot_pixels(view, slots, rgb, mask, mask)
    np.testing.assert_allclose(*(np.median(view.of(rgb)[p.near], axis=0) for p in (body, frame)))
