"""What the system bench gives."""

from __future__ import annotations

import pytest

from diorama_core.artefacts import LabelledBox
from diorama_core.evaluation.benchmarks.system import loosen_name


def said_of(kind: str) -> tuple[str, str]:
    box = loosen_name(LabelledBox((0.0, 0.0, 9.0, 9.0), kind, kind))
    return box.label, box.category


@pytest.mark.parametrize(
    ("kind", "word"), [("desk", "table"), ("sideboard", "cabinet"), ("office chair", "chair"), ("floor lamp", "lamp")]
)
def test_kinds_are_called_by_the_plain_word_that_people_use_for_them(kind: str, word: str) -> None:
    assert said_of(kind) == (word, word)


@pytest.mark.parametrize("kind", ["toilet", "vase"])
def test_what_has_no_looser_word_keeps_its_own(kind: str) -> None:
    assert said_of(kind) == (kind, kind)


def test_a_word_that_is_seldom_said_of_a_kind_is_not_taken() -> None:
    assert said_of("kitchen island")[0] != "table"
