"""Rows of the table of kinds: what every row must say, and what is said of a row that is wrong."""

from typing import get_args

import numpy as np
import pytest

from diorama_core.appearance.flat_faces import MAIN
from diorama_core.errors import LibraryError
from diorama_core.library.kind_rows import Trait, read_rows
from diorama_core.library.kinds import modes_of_kind
from diorama_core.library.slots import Role
from diorama_core.library.taxonomy import CATEGORIES, UNKNOWN, broad, category, having, resolve, with_kin

CHAIR = "[chair]\ndensity = 28\nsizes = [[0.9, 0.5, 0.5, 0.1, 0.1, 0.1]]\n"
CHAIR += "traits = ['supports_objects', 'quarter_turns_free']\n"
ROCKER = "[rocker]\nkin = 'chair'\nsizes = [[1.0, 0.7, 0.9, 0.1, 0.1, 0.1]]\ndensity = 30\n"


def test_every_name_and_every_synonym_means_one_category():
    for row in CATEGORIES:
        assert category(row.name) is row
        assert resolve(row.name).category is row
    words = [word for row in CATEGORIES for word in (row.name, *row.synonyms)]
    assert len(words) == len(set(words))


def test_the_last_row_is_the_kind_of_what_has_no_name():
    assert UNKNOWN.name == "object"
    assert not resolve("flibbertigibbet").exact
    assert resolve("flibbertigibbet").category is UNKNOWN


def test_sizes_are_of_rooms_and_seats_lie_below_the_top():
    for row in CATEGORIES:
        for prior in row.priors:
            assert np.exp(prior.log_median_xyz).min() > 0.005, row.name
            assert np.exp(prior.log_median_xyz).max() < 3.0, row.name
            assert (prior.log_sigma_xyz >= 0.04).all(), row.name
            assert (prior.log_sigma_xyz <= 1.0).all(), row.name
        assert row.seat_height_m is None or row.seat_height_m < max(p.height_m for p in row.priors), row.name


def test_every_kind_but_the_unknown_has_shapes():
    assert [row.name for row in CATEGORIES if not modes_of_kind(row.name)] in ([], [UNKNOWN.name])


def test_kin_is_one_broad_kind_that_stands_likewise_or_is_told_apart():
    for row in CATEGORIES:
        if row.kin:
            assert broad(row.name) == row.kin
            assert not category(row.kin).kin
            assert row.name in with_kin(row.kin)


def test_traits_come_from_kin_unless_lacking():
    plain, special = read_rows(CHAIR + ROCKER + "traits = ['soft']\nlacks = ['quarter_turns_free']\n")
    assert plain.traits == {"supports_objects", "quarter_turns_free"}
    assert special.traits == {"supports_objects", "soft"}
    assert {row.name for row in CATEGORIES if row.soft} == having("soft")
    assert {"dresser", "changing table"} <= having("back_at_wall")
    assert "kitchen island" not in having("back_at_wall")


def test_columns_come_from_kin_unless_given():
    chair = CHAIR + "tucked_under = ['table']\nfloor_before_m = 0.4\nfrequency = 5\n"
    special = read_rows(chair + ROCKER + "tucked_under = []\n")[1]
    assert special.tucked_under == ()
    assert special.floor_before_m == 0.4
    assert special.frequency is None, "how usual a kind is says nothing of its special kinds"


def test_every_kind_that_a_row_names_exists():
    for row in CATEGORIES:
        named = {
            *(row.kin, row.carries_as, *(row.also_said_of or {}), *(row.related or ()), *(row.lies_on or {})),
            *(*(row.instead or ()), *(row.tucked_under or ())),
            *(kind for _, targets in row.usual_relations or () for kind in targets),
            *(kind for company in row.seldom_without or () for kind in company.others),
        } - {"", None}
        assert named <= {c.name for c in CATEGORIES}, row.name
        assert row.name not in (row.related or ())
        assert row.face is None or set(row.face) <= {*get_args(Role), MAIN}, row.name


def test_every_trait_has_kinds_and_tells_them_apart():
    found = {trait: having(trait) for trait in get_args(Trait)}
    assert all(found.values())
    assert len(set(found.values())) == len(found)


@pytest.mark.parametrize(
    ("table", "said"),
    [
        (CHAIR + "colour = 'red'\n", "row 'chair', column 'colour'"),
        ("[chair]\ndensity = 28\nsizes = [[0.9, 0.5]]\n", "row 'chair', column 'sizes.0.2'"),
        (CHAIR.replace("soft", "x") + ROCKER + "traits = ['sofft']\n", "row 'rocker', column 'traits.0'"),
        (CHAIR + "mount = 'sky'\n", "row 'chair', column 'mount'"),
        (ROCKER, "row 'rocker': kin 'chair' must be"),
        (CHAIR + ROCKER + "traits = ['supports_objects']\n", "row 'rocker': supports_objects says what"),
        (CHAIR + ROCKER + "lacks = ['soft']\n", "row 'rocker': soft says what"),
    ],
)
def test_a_row_that_is_wrong_is_named_in_one_line(table, said):
    with pytest.raises(LibraryError, match=said.replace(".", r"\.")) as raised:
        read_rows(table)
    assert "\n" not in str(raised.value)
