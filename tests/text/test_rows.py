from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.scene.types import Pose
from diorama_core.text.prompt import Wish, read_prompt
from diorama_core.text.rows import MAX_IN_ROWS, Rows, with_marks

SIZE = np.array([0.6, 1.2, 0.75])


@pytest.mark.parametrize(
    ("prompt", "count", "rows"),
    [
        ("two rows of three desks", 6, 2),
        ("a row of desks by the window", 3, 1),
        ("a long row of five white desks", 5, 1),
        ("four desks in a row along the wall", 4, 1),
        ("six desks in two rows of three", 6, 2),
        ("desks arranged in three rows", 9, 3),
        ("3 rows of 8 desks", 24, 3),
        ("two desks side by side", 2, 0),
    ],
)
def test_rows_are_read(prompt: str, count: int, rows: int) -> None:
    request = read_prompt(prompt)
    desks = request.objects[0]
    assert (desks.category, desks.count, desks.rows) == ("desk", count, rows)
    assert not request.ignored


def test_what_hangs_or_is_a_row_itself_stands_in_none() -> None:
    pictures = read_prompt("a row of pictures above the sofa").objects[0]
    assert (pictures.count, pictures.rows) == (3, 0)
    assert Wish("aligned with", each_other=True) in pictures.wishes
    books = read_prompt("a row of books on a shelf").objects[0]
    assert (books.count, books.rows) == (1, 0)


def test_rows_that_hold_too_many_are_named() -> None:
    request = read_prompt("six rows of ten chairs")
    assert request.ignored == ("six rows of ten",)
    assert request.objects[0].rows == 0


def test_descriptions_without_rows_stay_as_they_are() -> None:
    text = "a sofa in front of a window and a roving chair with arrows"
    assert with_marks(text) == (text, ())


@given(
    count=st.integers(2, MAX_IN_ROWS),
    rows=st.integers(1, 6),
    category=st.sampled_from(["desk", "chair", "bookshelf", "bed"]),
    watching=st.booleans(),
    face_to_face=st.booleans(),
)
def test_members_fill_their_block_and_keep_clear(
    count: int, rows: int, category: str, watching: bool, face_to_face: bool
) -> None:
    of = Rows(count, min(rows, count), category, SIZE, face_to_face and rows == 2, watching)
    places = of.places
    assert (np.abs(places[:, :2]) + SIZE[:2] / 2 <= of.block_m[:2] / 2 + 1e-9).all()
    apart = np.abs(places[:, None, :2] - places[None, :, :2])
    clear = (apart >= SIZE[:2] - 1e-9).any(axis=2)
    assert clear[~np.eye(count, dtype=bool)].all()


def test_two_rows_face_each_other_and_at_desks_people_do() -> None:
    chairs, desks = (Rows(4, 2, name, SIZE, face_to_face=True) for name in ("chair", "desk"))
    toward = {name: np.cos(of.places[:, 2]) * -np.sign(of.places[:, 0]) for name, of in (("c", chairs), ("d", desks))}
    assert (toward["c"] > 0.9).all()
    assert (toward["d"] < -0.9).all()  # whoever sits at a desk looks over it, away from its front


def test_members_turn_with_their_block() -> None:
    of = Rows(3, 1, "chair", SIZE)
    poses = of.poses(Pose.upright(np.array([1.0, 2.0, 0.4]), np.pi / 2), np.ones(3))
    at = np.array([p.position for p in poses])
    np.testing.assert_allclose(at[:, 1:], [[2.0, 0.4]] * 3, atol=1e-9)
    np.testing.assert_allclose(np.diff(at[:, 0]), -(SIZE[1] + 0.1), atol=1e-9)
