"""Usual forms score higher than rare ones."""

from __future__ import annotations

import pytest

from diorama_core.geometry.shape_appearance import appearance_of
from diorama_core.library.catalogue import built_in_library
from diorama_core.retrieval.usual_forms import usual_form_factor

LIBRARY = built_in_library()


def factor(shape_id: str) -> float:
    return usual_form_factor(LIBRARY, LIBRARY.shape(shape_id), appearance_of(LIBRARY.parts(shape_id)))


@pytest.mark.parametrize(
    ("usual", "rare"),
    [("chair-ladder-walnut", "chair-slipcover-linen"), ("coffee-table-oak-shelf", "coffee-table-trunk")],
)
def test_legs_are_more_usual_than_plinths(usual, rare):
    assert factor(usual) == 1.0
    assert 0.7 < factor(rare) < 0.95


@pytest.mark.parametrize("folding", ["chair-folding-black", "chair-folding-pine"])
def test_folding_chairs_are_rarer_than_chairs_on_four_legs(folding):
    assert factor(folding) < factor("chair-cafe-steel") == factor("chair-ladder-walnut") == 1.0


def test_kinds_without_bases_are_all_as_usual():
    assert factor("sofa-grey-three") == 1.0


def test_tables_are_usually_rectangular():
    assert factor("table-trestle-x") > factor("table-round-tulip")


def test_pictures_are_usually_rectangular():
    assert factor("picture-hills-oak") == 1.0
    assert 0.7 < factor("mirror-pebble") < 0.95


@pytest.mark.parametrize("several", ["picture-column", "picture-triptych", "picture-gallery"])
def test_a_row_of_prints_is_rarer_than_one(several):
    assert factor(several) == factor("mirror-pebble")


def test_a_mirror_of_panes_is_rarer_than_one_of_one_pane():
    assert factor("mirror-window") < factor("mirror-gilt") == 1.0


def test_sofas_usually_have_padded_arms():
    assert factor("sofa-leather-tan") == 1.0
    assert 0.7 < factor("sofa-slat-pine") < 0.9
    assert factor("sofa-wood-arm") < 0.9


def test_frames_are_more_usual_of_armchairs():
    assert factor("sofa-slat-pine") < factor("armchair-mission-oak") < factor("armchair-track-beige")


@pytest.mark.parametrize("rare", ["plant-cactus", "plant-bonsai", "plant-christmas", "plant-grasses"])
def test_leafy_plants_are_more_usual_than_others(rare):
    assert factor("plant-shrub") == factor("plant-rubber") == 1.0
    assert 0.7 < factor(rare) < 0.9
