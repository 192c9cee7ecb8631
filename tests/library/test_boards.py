from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.errors import LibraryError
from diorama_core.library.boards import AxisMap, Boards, base_id, levels_m, with_boards
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.store import CombinedLibrary
from diorama_core.library.surfaces import support_surfaces
from diorama_core.synthesis.splits import Subset

LIBRARY = built_in_library()
BASE = LIBRARY.shape("bookshelf-oak-four")
LEVELS = np.array(levels_m(BASE))


def raised(k: int, by_m: float) -> str | None:
    wanted = LEVELS.copy()
    wanted[k] += by_m
    return with_boards(BASE, wanted)


def test_levels_are_the_heights_of_boards_from_the_lowest_up() -> None:
    np.testing.assert_allclose(LEVELS + 0.8, [0.092, 0.469, 0.846, 1.223, 1.6], atol=2e-3)


def test_a_board_is_where_the_id_puts_it_and_the_others_stay() -> None:
    moved = raised(2, 0.1)
    assert moved is not None
    shape = LIBRARY.shape(moved)
    np.testing.assert_allclose(np.subtract(levels_m(shape), LEVELS), [0, 0, 0.1, 0, 0], atol=2e-3)
    assert base_id(shape.id) == BASE.id
    assert shape.size_m == BASE.size_m
    assert shape.content_hash != BASE.content_hash
    mesh = LIBRARY.mesh(moved)
    np.testing.assert_allclose(mesh.bounds, LIBRARY.mesh(BASE.id).bounds, atol=1e-9)


def test_surfaces_of_the_record_are_those_of_the_moved_mesh() -> None:
    moved = raised(1, -0.08)
    assert moved is not None
    shape = LIBRARY.shape(moved)
    measured = sorted((s.height_m, s.clearance_m) for s in support_surfaces(LIBRARY.mesh(moved)))
    recorded = sorted((s.height_m, s.clearance_m) for s in shape.surfaces)
    np.testing.assert_allclose(recorded, measured, atol=8e-3)


def test_parts_and_files_show_the_moved_boards() -> None:
    moved = raised(2, 0.1)
    assert moved is not None
    shown, merged = LIBRARY.parts(moved).to_geometry().vertices[:, 2], LIBRARY.mesh(moved).vertices[:, 2]
    assert np.abs(shown[:, None] - merged).min(axis=1).max() < 1e-6
    assert LIBRARY.glb(moved) != LIBRARY.glb(BASE.id)
    normals = np.concatenate([g.vertex_normals for g in LIBRARY.parts(moved).geometry.values()])
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-6)


@pytest.mark.parametrize(("k", "by_m"), [(4, -0.2), (1, 0.36), (1, 0.5)])
def test_no_shape_where_the_top_would_move_or_a_gap_close(k: int, by_m: float) -> None:
    assert raised(k, by_m) is None


def test_a_moved_shape_is_not_moved_again() -> None:
    moved = raised(2, 0.1)
    assert moved is not None
    assert with_boards(LIBRARY.shape(moved), LEVELS) is None


@pytest.mark.parametrize("word", ["", "1-2", "a-b-c-d-e", "58-293-999-764-1000", "58-293-529-764-99999"])
def test_ids_that_say_nothing_sensible_are_refused(word: str) -> None:
    with pytest.raises(LibraryError):
        Boards.of(f"{BASE.id}+boards-{word}", BASE)


def test_libraries_of_libraries_find_what_their_shapes_are_derived_from() -> None:
    moved = raised(2, 0.1)
    assert moved is not None
    part = Subset(LIBRARY, frozenset({BASE.id}))
    assert part.shape(moved).id == moved
    assert isinstance(CombinedLibrary([part]).mesh(moved), trimesh.Trimesh)
    with pytest.raises(LibraryError):
        Subset(LIBRARY, frozenset()).shape(moved)


STEPS = st.lists(st.floats(0.1, 5.0), min_size=3, max_size=3)


@given(STEPS, STEPS)
def test_ends_stay_and_lengths_grow_by_the_slope(widths: list[float], grown: list[float]) -> None:
    knots = np.concatenate([[0.0], np.cumsum(widths)]) / sum(widths)
    values = np.concatenate([[0.0], np.cumsum(grown)]) / sum(grown)
    axis = AxisMap(knots, values)
    np.testing.assert_allclose(axis(np.array([0.0, 1.0])), [0.0, 1.0], atol=1e-12)
    middle = (knots[:-1] + knots[1:]) / 2
    short = np.diff(knots) / 10
    np.testing.assert_allclose(axis(middle + short) - axis(middle), axis.slope(middle) * short, atol=1e-12)
    assert (np.diff(axis(np.linspace(0, 1, 50))) > 0).all()
