"""The furniture proper: seats, tables, beds, cases, shelves and kitchens."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.catalogue import BuiltInLibrary, built_in_library
from diorama_core.library.furniture import (
    beds,
    designs,
    kitchen,
    seating,
    shelving,
    storage,
    styles,
    tables,
    upholstery,
)
from diorama_core.library.furniture.model import Design, built
from diorama_core.library.furniture.styles import STYLES
from diorama_core.library.taxonomy import broad, category, resolve, with_kin

FAMILIES = (seating, upholstery, tables, beds, storage, shelving, kitchen)
OWN = tuple(design for family in FAMILIES for design in family.DESIGNS)
STYLE_NAMES = frozenset(style.name for style in STYLES)
ONCE_IN_A_WHILE = OWN[::6]


@pytest.fixture(scope="module")
def library() -> BuiltInLibrary:
    return built_in_library()


def levels(library: BuiltInLibrary, shape_id: str, *, interior: bool = False) -> list[float]:
    """Heights above the floor of a shape's open or inner surfaces, lowest first."""
    shape = library.shape(shape_id)
    return sorted(s.height_m + shape.size_m[2] / 2 for s in shape.surfaces if s.interior == interior)


def test_there_is_a_house_full() -> None:
    assert len(OWN) >= 330
    assert len({d.category for d in OWN}) >= 50
    assert len(designs()) >= 600
    assert len({d.category for d in designs()} - {"object"}) >= 60


def test_every_shape_has_a_style() -> None:
    assert {d.style for d in designs()} == STYLE_NAMES


@pytest.mark.parametrize("name", sorted({d.category for d in OWN}))
def test_swapping_offers_every_style(name: str) -> None:
    assert {d.style for d in OWN if d.category == name} == STYLE_NAMES


@pytest.mark.parametrize("design", ONCE_IN_A_WHILE, ids=lambda d: d.id)
def test_builders_keep_to_their_size_and_solids_are_not_inside_out(design: Design) -> None:
    """A solid's faces look outward, so that it encloses no negative volume; rays need that."""
    parts = design.build(design.size_m)
    stretch = np.asarray(design.size_m) / np.ptp(np.concatenate([p.solid.vertices for p in parts]), axis=0)
    assert (stretch > 0.8).all()
    assert (stretch < 1.25).all()
    for part in parts:
        a, b, c = part.solid.vertices[part.solid.faces].transpose(1, 0, 2)
        assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6 > -1e-9, part.material.name


def test_building_twice_gives_the_same() -> None:
    for design in designs()[::60]:
        first, second = built(design), built(design)
        for (material, one), (other_material, other) in zip(first, second, strict=True):
            assert material == other_material
            assert np.array_equal(one.vertices, other.vertices)
            assert np.array_equal(one.faces, other.faces)
            assert np.array_equal(one.uv, other.uv)


def test_styles_differ_where_the_kind_is_the_same() -> None:
    materials = {style.name: {style.wood.name, style.frame.name, style.cloth.name} for style in STYLES}
    assert len({style.leg for style in STYLES}) == len(STYLES)
    assert len({frozenset(names) for names in materials.values()}) == len(STYLES)
    assert styles.MODERN.but(wood=styles.GREY_OAK).wood == styles.GREY_OAK


@pytest.mark.parametrize(
    ("name", "low", "high"),
    [
        ("chair", 0.40, 0.53),
        ("bar stool", 0.60, 0.82),
        ("armchair", 0.33, 0.52),
        ("sectional sofa", 0.34, 0.48),
        ("chaise longue", 0.30, 0.52),
        ("recliner", 0.38, 0.56),
        ("office chair", 0.42, 0.68),
        ("day bed", 0.38, 0.52),
        ("crib", 0.42, 0.55),
        ("bench", 0.35, 0.52),
    ],
)
def test_what_one_sits_or_lies_on_is_a_surface(library: BuiltInLibrary, name: str, low: float, high: float) -> None:
    for shape in library.in_category(name)[::3]:
        both = levels(library, shape.id) + levels(library, shape.id, interior=True)
        assert any(low <= z <= high for z in both), (shape.id, both)


def test_mattresses_lie_low_and_high(library: BuiltInLibrary) -> None:
    tops = [levels(library, i) for i in ("bed-floor-oak", "bed-canopy-birch", "bed-storage-oak", "bed-pine-high")]
    lying = [next(z for z in heights if z > 0.3) for heights in tops]
    assert lying == sorted(lying)
    assert lying[0] < 0.45
    assert lying[-1] > 0.7


def test_a_bunk_bed_has_two_places_to_sleep(library: BuiltInLibrary) -> None:
    inside, above = levels(library, "bunk-bed-walnut", interior=True), levels(library, "bunk-bed-walnut")
    assert any(0.35 < z < 0.6 for z in inside)
    assert any(1.1 < z < 1.5 for z in above)


@pytest.mark.parametrize(
    ("shape_id", "count"),
    [
        ("display-cabinet-steel-glass", 4),
        ("bookshelf-cubes-oak", 6),
        ("shelves-birch-box", 2),
        ("shoe-cabinet-birch-rack", 3),
    ],
)
def test_open_pieces_offer_their_shelves(library: BuiltInLibrary, shape_id: str, count: int) -> None:
    assert len(levels(library, shape_id, interior=True)) == count


@pytest.mark.parametrize("shape_id", ["dresser-pine-four", "locker-navy-four", "shoe-cabinet-white-slim", "fridge"])
def test_closed_pieces_offer_only_their_tops(library: BuiltInLibrary, shape_id: str) -> None:
    shape_id = "refrigerator-retro-cream" if shape_id == "fridge" else shape_id
    assert levels(library, shape_id, interior=True) == []
    assert levels(library, shape_id)[-1] == pytest.approx(library.shape(shape_id).size_m[2], abs=0.01)


@pytest.mark.parametrize(
    "name", ["table", "desk", "coffee table", "bed", "sofa", "night stand", "bookshelf", "bar stool"]
)
def test_sizes_spread(name: str) -> None:
    heights = [d.size_m[2] for d in OWN if d.category == name]
    footprints = [d.size_m[0] * d.size_m[1] for d in OWN if d.category == name]
    assert max(heights) > 1.08 * min(heights)
    assert max(footprints) > 1.4 * min(footprints)


@pytest.mark.parametrize(
    ("word", "name"),
    [
        ("bar stool", "bar stool"),
        ("barstools", "bar stool"),
        ("rocker", "rocking chair"),
        ("corner couch", "sectional sofa"),
        ("dressing table", "vanity table"),
        ("filing cabinets", "filing cabinet"),
        ("china cabinet", "display cabinet"),
        ("tumble dryer", "dryer"),
        ("cooker hood", "range hood"),
        ("cot", "crib"),
        ("tea trolley", "bar cart"),
        ("hat stand", "coat rack"),
        ("larder", "pantry cabinet"),
        ("steamer trunk", "chest"),
        ("beanbag", "bean bag"),
        ("oven", "stove"),
        ("built-in oven", "wall oven"),
    ],
)
def test_words_british_and_american(word: str, name: str) -> None:
    found = resolve(word)
    assert found.exact
    assert found.category.name == name


def test_special_kinds_share_the_rules_of_broad_ones() -> None:
    assert broad("bar stool") == "stool"
    assert broad("stool") == "stool"
    assert broad("nothing of the kind") == "nothing of the kind"
    assert with_kin("stool", "sofa") >= {"stool", "bar stool", "sofa", "sectional sofa", "chaise longue"}
    assert all(category(broad(d.category)).kin == "" for d in OWN)
