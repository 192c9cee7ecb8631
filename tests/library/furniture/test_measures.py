"""Designs made to measure: sizes, parameters and their ids."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.errors import LibraryError
from diorama_core.library import furniture
from diorama_core.library.furniture.measures import (
    can_be_made,
    made_by_id,
    made_id,
    made_to_measure,
    parameters,
    values_of,
    varied,
)
from diorama_core.library.furniture.model import built, mesh_of

DESIGNS = {d.id: d for d in furniture.designs()}
DRESSER, BOOKCASE = DESIGNS["dresser-white-four"], DESIGNS["bookshelf-oak-four"]
FAMILIES = list({d.builder: d for d in DESIGNS.values()}.values())


def test_parameters_are_the_builders_arguments_without_materials_and_styles() -> None:
    names = {p.name for p in parameters(DRESSER.id)}
    assert {"bays", "base", "base_h", "handle", "shelves"} <= names
    assert not names & {"body", "top", "pull", "legs"}
    assert "style" not in {p.name for p in parameters("dresser-tall-oak")}
    assert parameters("no such design") == ()


def test_values_are_those_of_the_design_or_its_builders_defaults() -> None:
    assert values_of(DRESSER)["bays"] == ("4",)
    assert values_of(DRESSER)["base"] == "plinth"
    assert values_of(DRESSER)["shelves"] == 1


def test_alternatives_are_others_within_what_the_family_uses() -> None:
    for name, others in varied(DRESSER.id):
        parameter = next(p for p in parameters(DRESSER.id) if p.name == name)
        assert values_of(DRESSER)[name] not in others
        assert all(parameter.allows(v) for v in others)
    levels = dict(varied(BOOKCASE.id))["levels"]
    assert set(levels) >= {3, 5}


def test_every_variant_of_every_builder_can_be_built() -> None:
    for design in FAMILIES:
        size = np.array(design.size_m) * (1.1, 0.9, 1.05)
        for name, values in varied(design.id):
            for value in values:
                made = made_to_measure(design, size, {name: value})
                assert made.build(made.size_m), made.id


@pytest.mark.parametrize("design", FAMILIES[::9], ids=lambda d: d.id)
def test_variants_are_built_in_their_size_and_found_by_their_ids(design) -> None:
    size = np.array(design.size_m) * (1.1, 0.9, 1.05)
    for name, values in [("", ()), *varied(design.id)]:
        for changes in [{name: v} for v in values[:2]] or [{}]:
            made = made_to_measure(design, size, changes)
            assert made_by_id(made.id, design) == made
            assert made_id(design.id, size, changes) == made.id
            assert np.ptp(mesh_of(built(made)).vertices, axis=0) == pytest.approx(made.size_m, abs=1e-6)


def test_designs_with_nothing_of_what_they_have_several_of_can_be_built() -> None:
    """Counts are fitted one after another, so that a stand may lose its drawers and its shelves."""
    for design in FAMILIES:
        none = {p.name: 0 for p in parameters(design.id) if p.is_count and p.limits[0] == 0}
        if len(none) > 1:
            assert design.builder(design.size_m, **{**design.options, **none}), design.id


def test_a_longer_table_has_legs_as_thick_as_before() -> None:
    table = next(d for d in DESIGNS.values() if d.builder.__name__ == "leg_table" and "outline" not in d.options)
    longer = made_to_measure(table, np.array(table.size_m) * (1, 1.5, 1), {})

    def leg_width(design) -> float:
        points = mesh_of(built(design)).vertices
        foot = points[(points[:, 2] < points[:, 2].min() + 0.01) & (points[:, 1] > 0)]
        return float(np.ptp(foot[:, 1]))

    assert leg_width(longer) == pytest.approx(leg_width(table), rel=0.05)


def test_round_designs_become_oval_and_changed_ones_symmetric_for_nobody() -> None:
    round_table = next(d for d in DESIGNS.values() if d.category == "table" and d.symmetry == 36)
    size = np.array(round_table.size_m)
    assert made_to_measure(round_table, size * 1.1, {}).symmetry == 36
    assert made_to_measure(round_table, size * (1, 1.3, 1), {}).symmetry == 2
    name, values = next((n, v) for n, v in varied(round_table.id) if v)
    assert made_to_measure(round_table, size, {name: values[0]}).symmetry == 1


@pytest.mark.parametrize(
    "words",
    ["", "1x2", "460x900x1100;bays=9,9", "460x900x1100;levels=9", "460x900x1100;base", "460x900x1100;base_h=nan",
     "460x900x1100;base_h=99", "460x900x1100;shelves=9999999", "1x1x1", "99999x99999x99999", "460x900x1100;base=plinth",
     "460x900x1100;shelves=2;base=none"],
)  # fmt: skip
def test_ids_that_nobody_gave_are_errors(words: str) -> None:
    with pytest.raises(LibraryError, match="dresser-white-four"):
        made_by_id(f"{DRESSER.id}+made-{words}", DRESSER)


def test_only_built_in_designs_are_made_and_only_within_reach() -> None:
    assert can_be_made(DRESSER.id, np.array(DRESSER.size_m) * 1.5)
    assert not can_be_made(DRESSER.id, np.array(DRESSER.size_m) * 9)
    assert not can_be_made("my own chair", np.ones(3))
    with pytest.raises(LibraryError, match="my own chair"):
        made_id("my own chair", np.ones(3), {})
