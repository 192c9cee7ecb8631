"""How edits are told."""

from __future__ import annotations

import pytest

from diorama_core.library.labels import with_article
from diorama_core.text.edit_plan import names_of
from tests.text.edited import living_room


@pytest.mark.parametrize(("words", "told"), [("armchair", "an armchair"), ("sofa", "a sofa")])
def test_words_get_the_article_that_their_first_letter_asks_for(words: str, told: str) -> None:
    assert with_article(words) == told


def test_objects_are_told_by_their_labels_in_order() -> None:
    scene = living_room()
    ids = ["sofa_1", "coffee_table_1"]
    assert names_of(scene, ids) == f"{scene.object(ids[0]).label}, {scene.object(ids[1]).label}"
    assert names_of(scene, []) == ""
