from __future__ import annotations

import pytest

from diorama_core.library.ingest.names import OF_A_PART, name_evidence, words_of


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("chairDesk_02", ("chair", "desk")),
        ("SM_Sofa_Leather", ("sofa", "leather")),
        ("bookcaseClosedWide", ("bookcase", "closed", "wide")),
        ("model_normalized", ()),
        ("TVStand", ("tv", "stand")),
        ("a1b2", ()),
    ],
)
def test_names_fall_into_words(name: str, words: tuple[str, ...]) -> None:
    assert words_of(name) == words


@pytest.mark.parametrize(
    ("stem", "category"),
    [
        ("chairDesk", "office chair"),
        ("lampRoundFloor", "floor lamp"),
        ("tableCoffeeSquare", "coffee table"),
        ("cabinetBed", "night stand"),
        ("cabinetTelevision", "tv stand"),
        ("SM_Sofa_Leather", "sofa"),
        ("bookcases", "bookshelf"),
        ("old_wooden_stool_3", "stool"),
    ],
)
def test_a_name_speaks_of_a_category(stem: str, category: str) -> None:
    found = name_evidence(stem).weights
    assert found is not None
    assert max(found, key=lambda c: found[c]) == category


def test_a_compound_is_not_also_its_parts() -> None:
    assert set(name_evidence("chairDesk").weights or ()) == {"office chair"}


def test_folders_and_parts_speak_when_the_name_does_not() -> None:
    assert set(name_evidence("0001", ["chairs", "models"]).weights or ()) == {"chair"}
    of_part = name_evidence("0001", [], ["seat", "Armchair_base"])
    assert set(of_part.weights or ()) == {"armchair", "object"}
    assert of_part.certainty == OF_A_PART


def test_an_unknown_word_is_told_from_no_word() -> None:
    assert name_evidence("flugelhorn").weights == {}
    assert name_evidence("0001").weights is None
