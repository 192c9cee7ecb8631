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
    [
        ("chair-ladder-walnut", "chair-slipcover-linen"),  # legs and a plinth
        ("coffee-table-oak-shelf", "coffee-table-trunk"),
        ("picture-hills-oak", "mirror-pebble"),  # a rectangle and a free outline
        ("mirror-gilt", "mirror-window"),  # one pane and several
        ("sofa-leather-tan", "sofa-slat-pine"),  # padded arms and frames
        ("sofa-grey-three", "sofa-wood-arm"),
        *(("plant-shrub", rare) for rare in ("plant-cactus", "plant-bonsai", "plant-christmas", "plant-grasses")),
        ("plant-rubber", "plant-cactus"),
        *(("chair-cafe-steel", f"chair-folding-{colour}") for colour in ("black", "pine")),
    ],
)
def test_the_usual_form_of_a_kind_costs_nothing_and_a_rare_one_little(usual: str, rare: str) -> None:
    assert factor(usual) == 1.0
    assert 0.7 < factor(rare) < 0.95


@pytest.mark.parametrize("several", ["picture-column", "picture-triptych", "picture-gallery"])
def test_a_row_of_prints_is_rarer_than_one(several: str) -> None:
    assert factor(several) == factor("mirror-pebble")


def test_tables_are_usually_rectangular_and_armchairs_have_frames_more_often_than_sofas() -> None:
    assert factor("table-trestle-x") > factor("table-round-tulip")
    assert factor("sofa-slat-pine") < factor("armchair-mission-oak") < factor("armchair-track-beige")
