from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.errors import LibraryError
from diorama_core.library.record import (
    Assumption,
    Guess,
    Shape,
    SupportSurface,
    shape_from_json,
    shape_to_json,
    usual_contact_faces,
)

metres = st.floats(1e-4, 50.0)
coordinate = st.floats(-50.0, 50.0)
words = st.text(max_size=20)
corners = st.lists(st.tuples(coordinate, coordinate, coordinate), min_size=3, max_size=8).map(np.array)
surfaces = st.builds(SupportSurface, corners, metres | st.just(float("inf")), st.booleans())
assumptions = st.builds(Assumption, words, st.floats(0, 1), words)
shapes = st.builds(
    Shape,
    id=words,
    category=words,
    caption=words,
    size_m=st.tuples(metres, metres, metres),
    symmetry=st.sampled_from([1, 2, 3, 4, 5, 6, 8, 36]),
    surfaces=st.lists(surfaces, max_size=3).map(tuple),
    mass_kg=metres,
    synonyms=st.lists(words, max_size=3).map(tuple),
    contact_faces=st.sampled_from([("bottom",), ("back", "bottom"), ("top",)]),
    triangles=st.integers(0, 10**6),
    guess=st.none() | st.builds(Guess, assumptions, assumptions, assumptions, assumptions),
)


@given(shape=shapes)
def test_a_record_survives_json(shape: Shape) -> None:
    text = shape_to_json(shape)
    assert shape_from_json(text) == shape
    assert shape_to_json(shape_from_json(text)) == text


@pytest.mark.parametrize(
    "text", ["", "[]", "{}", '{"id": "a"}', '{"id": "a", "size_m": 3}', "[" * 5000, '{"id": 1e999}']
)
def test_a_broken_record_is_a_library_error(text: str) -> None:
    with pytest.raises(LibraryError, match=r"a shape record (cannot be read|is not valid JSON|is nested)"):
        shape_from_json(text)


def test_contact_faces_follow_where_objects_are_found() -> None:
    faces = {mount: usual_contact_faces(mount)[0] for mount in ("floor", "surface", "wall", "ceiling")}
    assert faces == {"floor": "bottom", "surface": "bottom", "wall": "back", "ceiling": "top"}
