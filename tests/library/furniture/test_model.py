"""Rows of tables of designs."""

from __future__ import annotations

from inspect import signature

from diorama_core.library.furniture import designs
from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.model import Parts, Size, built, design, of
from diorama_core.library.furniture.solids import box
from diorama_core.library.furniture.styles import RUSTIC, Style


def block(size: Size, style: Style | None = None, wood: m.Material = m.OAK) -> Parts:
    return of(wood if style is None else style.wood, box(size))


def test_a_row_is_called_after_its_category_and_name() -> None:
    row = design("bar cart", "brass", "brass cart", (0.4, 0.7, 0.8), "modern", block, 2, wood=m.PINE)
    assert (row.id, row.category, row.style, row.symmetry) == ("bar-cart-brass", "bar cart", "modern", 2)
    assert built(row)[0][0] == m.PINE
    assert design("box", "a", "a", (1, 1, 1), "modern", block, id="trunk").id == "trunk"


def test_a_whole_style_gives_its_name_and_goes_to_the_builder() -> None:
    row = design("chest", "pine", "pine chest", (0.4, 0.7, 0.4), RUSTIC.but(wood=m.WALNUT), block)
    assert row.style == "rustic"
    assert built(row)[0][0] == m.WALNUT


def test_every_design_is_a_row_whose_options_its_builder_takes() -> None:
    for row in designs():
        signature(row.builder).bind(row.size_m, **row.options)
