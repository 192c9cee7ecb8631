"""Descriptions and commands in German, French and Spanish."""

from __future__ import annotations

import pytest

from diorama_core.errors import EditRefused
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.taxonomy import CATEGORIES
from diorama_core.text.editing_by_words import propose_edits
from diorama_core.text.foreign_words import LANGUAGES, _phrases, _words, to_english
from diorama_core.text.prompt import read_prompt
from tests.text.edited import living_room

ROOMS = {
    "ein Wohnzimmer mit einem Sofa und zwei Sesseln": {"sofa": 1, "armchair": 2},
    "Ein Schlafzimmer mit Bett, Kleiderschrank und einem Nachttisch": {"bed": 1, "wardrobe": 1, "night stand": 1},
    "un salon avec un canapé et deux fauteuils": {"sofa": 1, "armchair": 2},
    "une chambre avec un lit, une armoire et une table de chevet": {"bed": 1, "wardrobe": 1, "night stand": 1},
    "una sala con un sofá, dos sillones y una mesa de centro": {"sofa": 1, "armchair": 2, "coffee table": 1},
}


@pytest.mark.parametrize("prompt", ROOMS)
def test_rooms_are_described_in_other_languages(prompt: str) -> None:
    request = read_prompt(prompt)
    assert {o.category: o.count for o in request.objects} == ROOMS[prompt]
    assert request.ignored == ()


@pytest.mark.parametrize("prompt", ["ein Wohnzimmer mit einem Sofa und zwei Zorkmids", "un salon avec un zorkmid"])
def test_what_is_not_understood_is_named(prompt: str) -> None:
    assert any("zorkmid" in words for words in read_prompt(prompt).ignored)


def test_every_kind_has_a_name_in_every_language() -> None:
    for language in LANGUAGES:
        assert {c.name for c in CATEGORIES} <= set(_phrases(language).values()), language


COMMANDS = {
    "Entferne den Teppich": "remove rug 1",
    "Stell die Lampe auf den Couchtisch": "move lamp 1 on coffee table 1",
    "Mach die Wände hellblau": "make the walls light blue",
    "Verschiebe das Sofa 50 cm nach links": "move sofa 1 0.5 m to the left",
    "Mach das Sofa 2 m breit": "make sofa 1 2.00 m in width",
    "Enlève le tapis": "remove rug 1",
    "Peins les murs en bleu clair": "make the walls light blue",
    "Déplace le canapé de 50 cm vers la gauche": "move sofa 1 0.5 m to the left",
    "Quita la alfombra": "remove rug 1",
    "Pon la lámpara sobre la mesa de centro": "move lamp 1 on coffee table 1",
    "Pinta las paredes de azul": "make the walls blue",
}


@pytest.mark.parametrize("command", COMMANDS)
def test_commands_in_other_languages(command: str) -> None:
    assert propose_edits(command, living_room(), built_in_library()).lines == (COMMANDS[command],)


def test_a_word_that_is_not_known_is_named_in_the_refusal() -> None:
    with pytest.raises(EditRefused, match="zorkmid"):
        propose_edits("Stell die Lampe neben den Zorkmid", living_room(), built_in_library())


@pytest.mark.parametrize(
    "text",
    ["make the sofa red and put a rug under it", "a sofa, a rug, a lamp", "Remove it!", "", "paint the walls rose"],
)
def test_english_stays_as_it_is(text: str) -> None:
    assert to_english(text) == text


def test_plurals_and_cases_are_known() -> None:
    german = _phrases("de")
    for form, english in {
        "Stühlen": "chairs",
        "Sofas": "sofa",
        "Bücherregale": "bookshelves",
        "Tischen": "tables",
    }.items():
        assert german[_words(form)] in (english, f"{english}s")
