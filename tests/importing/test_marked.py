from __future__ import annotations

import pytest

from diorama_core.importing.marked import MarkedFile, as_ids, as_mapping


@pytest.mark.parametrize(
    ("value", "found"),
    [('{"a": 1}', {"a": 1}), ({"a": 1}, {"a": 1}), ("[1]", None), ("{", None), (3, None), (None, None), ("null", None)],
)
def test_marks_are_tables_or_text_of_one(value, found) -> None:
    assert as_mapping(value) == found


@pytest.mark.parametrize(
    ("value", "found"),
    [('["a", "b"]', {"a", "b"}), (["a", 3], {"a", "3"}), ("[]", set()), ('{"a": 1}', None), ("x", None), (None, None)],
)
def test_ids_are_lists_or_text_of_one(value, found) -> None:
    assert as_ids(value) == (None if found is None else frozenset(found))


def test_a_file_says_only_what_it_knows() -> None:
    bare = MarkedFile("{}", ())
    assert bare.written is None
    assert bare.T_world_camera is None
    assert (dict(bare.planes), dict(bare.pictures), dict(bare.provenance)) == ({}, {}, {})
