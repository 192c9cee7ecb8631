"""Main colours and their agreement."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from diorama_core.geometry.palettes import NOTHING_KNOWN, palette_agreement, palette_of_appearance, palette_of_crop
from diorama_core.geometry.shape_appearance import appearance_of
from tests.primitives import material

RED, GREEN = (200, 30, 30), (30, 160, 40)


def crop(left, right):
    rgb = np.zeros((20, 40, 3), np.uint8)
    rgb[:, :20], rgb[:, 20:] = left, right
    return rgb


def linear_light(srgb) -> np.ndarray:
    return ((np.array(srgb) / 255 + 0.055) / 1.055) ** 2.4  # above 0.04, as all of these are


def painted(colour) -> trimesh.Scene:
    mesh = trimesh.creation.box((1, 1, 1))
    mesh.visual = trimesh.visual.TextureVisuals(material=material("paint", tuple(linear_light(colour))))
    return trimesh.Scene({"box": mesh})


def test_only_what_the_mask_covers_counts() -> None:
    mask = np.zeros((20, 40), bool)
    mask[:, :20] = True
    seen = palette_of_crop(crop(RED, GREEN), mask)
    assert len(seen.share) == 1
    assert palette_agreement(seen, palette_of_appearance(appearance_of(painted(RED)))) > 0.9


def test_the_same_colour_agrees_more_than_another() -> None:
    seen = palette_of_crop(crop(RED, RED), np.ones((20, 40), bool))
    same, other = (palette_agreement(seen, palette_of_appearance(appearance_of(painted(c)))) for c in (RED, GREEN))
    assert same > 2 * other


def test_shares_add_up_to_one() -> None:
    seen = palette_of_crop(crop(RED, GREEN), np.ones((20, 40), bool))
    assert seen.share.sum() == pytest.approx(1.0)


def test_nothing_known_is_neutral() -> None:
    empty = palette_of_crop(crop(RED, GREEN), np.zeros((20, 40), bool))
    assert empty == NOTHING_KNOWN
    assert palette_agreement(empty, palette_of_appearance(appearance_of(painted(RED)))) == 0.5
