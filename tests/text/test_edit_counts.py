"""How many there are, in words; whole commands are in `test_edit_grammar.py`."""

from __future__ import annotations

import pytest

from diorama_core.errors import EditRefused
from diorama_core.library.catalogue import built_in_library
from diorama_core.text.edit_counts import all_but, counted_edits
from diorama_core.text.edit_plan import Insert
from diorama_core.text.selecting import Selector
from tests.text.edited import dining_room


@pytest.mark.parametrize(
    ("text", "spared"),
    [
        ("all but one of the pillows", (1, "pillows")),
        ("all except 2 chairs", (2, "chairs")),
        ("all but the chairs", None),
        ("all chairs", None),
    ],
)
def test_some_are_spared(text: str, spared: tuple[int, str] | None) -> None:
    assert all_but(text) == spared


def test_more_of_a_kind_are_as_many_as_asked_and_not_too_many() -> None:
    selector = Selector(dining_room(), built_in_library())
    assert counted_edits(selector, "double the chairs") == (Insert(what="chair", count=5),)
    assert counted_edits(selector, "i want twice as many chairs") == (Insert(what="chair", count=5),)
    assert counted_edits(selector, "remove the chairs") is None
    with pytest.raises(EditRefused, match="15 more"):
        counted_edits(selector, "quadruple the number of chairs")
    with pytest.raises(EditRefused, match="no piano"):
        counted_edits(selector, "double the number of pianos")
