"""Places of colours: alike under any brightness, unlike when they change places; views in a shape's own colours."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from jaxtyping import Bool, UInt8

from diorama_core.geometry.shape_appearance import appearance_of
from diorama_core.render.templates import TemplateGrid, render_templates, templates_with_faces
from diorama_core.render.view_features import (
    LAYOUT_WIDTH,
    colour_layout,
    layout_agreement,
    paint_views,
    square_around,
    window_around,
)
from tests.primitives import material

WHITE, BLACK, RED = (235, 235, 235), (30, 30, 30), (200, 40, 40)
GRID = TemplateGrid(elevations_deg=(10.0,), azimuths=5, size_px=48)


def framed(frame: tuple[int, int, int], inside: tuple[int, int, int]) -> UInt8[np.ndarray, "h w 3"]:
    rgb = np.full((80, 100, 3), 120, np.uint8)
    rgb[20:60, 20:80] = frame
    rgb[27:53, 27:73] = inside
    return rgb


def whole(rgb: np.ndarray) -> Bool[np.ndarray, "h w"]:
    mask = np.zeros(rgb.shape[:2], bool)
    mask[20:60, 20:80] = True
    return mask


def layout(frame: tuple[int, int, int], inside: tuple[int, int, int]) -> np.ndarray:
    rgb = framed(frame, inside)
    return colour_layout(rgb, whole(rgb))


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1))
def test_a_picture_agrees_with_itself_and_no_other_more(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rgb = rng.integers(0, 256, (40, 50, 3), dtype=np.uint8)
    mask = np.zeros((40, 50), bool)
    mask[rng.integers(0, 15) : rng.integers(25, 40), rng.integers(0, 15) : rng.integers(25, 50)] = True
    own = colour_layout(rgb, mask)
    others = np.stack([own, colour_layout(rng.integers(0, 256, rgb.shape, dtype=np.uint8), mask), own * 0])
    agreement = layout_agreement(own, others)
    assert own.shape == (LAYOUT_WIDTH,)
    assert agreement[0] == pytest.approx(1.0)
    assert (agreement[1:] < 1).all()
    assert (agreement > 0).all()


def test_where_a_colour_is_counts_and_what_surrounds_the_object_does_not() -> None:
    seen = layout(WHITE, BLACK)
    same, swapped = layout_agreement(seen, np.stack([layout((220, 220, 220), (40, 40, 40)), layout(BLACK, WHITE)]))
    assert same > 0.8 > 0.5 > swapped
    rgb = framed(WHITE, BLACK)
    elsewhere = np.where(whole(rgb)[..., None], rgb, 7).astype(np.uint8)
    assert layout_agreement(seen, colour_layout(elsewhere, whole(rgb))) > 0.97  # less only by what smoothing mixes in


def test_brightness_of_the_whole_says_nothing_hue_much() -> None:
    seen = layout((180, 180, 180), (120, 120, 120))
    darker, red = layout_agreement(seen, np.stack([layout((120, 120, 120), (70, 70, 70)), layout(RED, RED)]))
    assert darker > 0.85
    assert red < 0.3


def test_an_empty_mask_knows_nothing() -> None:
    rgb = framed(WHITE, BLACK)
    nothing = colour_layout(rgb, whole(rgb) & False)
    assert (nothing == 0).all()
    assert layout_agreement(nothing, layout(WHITE, BLACK)) == 0.5


def test_views_show_faces_in_their_colours_and_shade() -> None:
    box, top = trimesh.creation.box((0.5, 0.5, 0.4)), trimesh.creation.box((0.5, 0.5, 0.4))
    box.visual = trimesh.visual.TextureVisuals(material=material("red", (0.6, 0.02, 0.02)))
    top.apply_translation([0, 0, 0.4])
    appearance = appearance_of(trimesh.Scene({"box": box, "top": top}))
    mesh = trimesh.Trimesh(appearance.vertices, appearance.faces, process=False)
    templates, face_ids = templates_with_faces(mesh, GRID)
    plain = render_templates(mesh, GRID)
    assert (templates.depth_codes == plain.depth_codes).all()
    assert ((face_ids >= 0) == templates.mask).all()
    views = paint_views(templates, face_ids, appearance)
    assert (views[~templates.mask] == 0).all()
    lower = np.isin(face_ids, np.arange(len(box.faces)))
    assert (views[lower][:, 0] > 2 * views[lower][:, 1].astype(int)).all()
    upper = templates.mask & ~lower
    assert (np.ptp(views[upper].astype(int), axis=1) == 0).all()  # no colour known: gray
    assert len(np.unique(views[upper][:, 0])) > 1  # lit from one side


@pytest.mark.parametrize("corner", [(130, 200), (0, 370)])
def test_all_that_the_square_shows_is_in_its_window(rng: np.random.Generator, corner: tuple[int, int]) -> None:
    picture, mask = rng.uniform(0, 255, (400, 500, 3)).astype(np.float32), np.zeros((400, 500), bool)
    mask[corner[0] : corner[0] + 130, corner[1] : corner[1] + 130] = True
    window = window_around(mask)
    assert window is not None
    assert mask[window].size < 0.2 * mask.size
    alone = np.zeros_like(picture)
    alone[window] = picture[window]
    whole, part = square_around(mask, picture), square_around(mask, alone)
    assert whole is not None
    assert part is not None
    np.testing.assert_array_equal(part, whole)
    assert window_around(np.zeros((4, 4), bool)) is None
