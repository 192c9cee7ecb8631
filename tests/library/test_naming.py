from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.library import taxonomy
from diorama_core.library.language import narrower, normal, size_in, tokens
from diorama_core.library.naming import other_names, size_distance, understand


@pytest.mark.parametrize(
    ("text", "category"),
    [
        ("couch", "sofa"), ("settee", "sofa"), ("nightstand", "night stand"), ("bedside table", "night stand"),
        ("night-stand", "night stand"), ("telly", "television"), ("TVs", "television"), ("settees", "sofa"),
        ("centre table", "coffee table"), ("center tables", "coffee table"), ("arm chair", "armchair"),
        ("a wooden armchair with cushions", "armchair"), ("chests of drawers", "dresser"), ("desk lamp", "lamp"),
        ("lamp for the bedside table", "lamp"), ("set of 4 dining chairs", "chair"), ("a pair of lamps", "lamp"),
        ("kitchen table", "table"), ("tall oak shelving", "bookshelf"), ("stack of books", "books"),
        ("book", "books"), ("shelf", "shelves"), ("fridge", "refrigerator"), ("wardrobes", "wardrobe"),
    ],
)  # fmt: skip
def test_names_that_are_known(text: str, category: str) -> None:
    query = understand(text)
    assert query.categories == (category,)
    assert query.exact
    assert query.note == ""


@pytest.mark.parametrize(
    ("text", "category", "says"),
    [
        ("chifforobe", "wardrobe", "no class of its own"), ("church pews", "bench", "no class of its own"),
        ("easel", "floor lamp", "no class of its own"), ("sofaa", "sofa", "read as 'sofa'"),
        ("a red armchiar", "armchair", "read as 'armchair'"), ("pouffette", "ottoman", "read as 'pouffe'"),
        ("crowdbench", "bench", "taken for a kind of 'bench'"),
    ],
)  # fmt: skip
def test_unknown_nouns_fall_back_to_the_nearest_name_and_say_so(text: str, category: str, says: str) -> None:
    query = understand(text)
    assert query.categories == (category,)
    assert not query.exact
    assert says in query.note


def test_without_any_likeness_the_size_decides_and_says_so() -> None:
    assert understand("flurbl").categories == ()
    assert "not known" in understand("flurbl").note
    long_low = understand("flurbl", size_m=(0.95, 2.0, 0.85))
    assert long_low.categories == ("sofa",)
    assert "name and size" in long_low.note
    written = understand("flurbl 62x86x82 cm")
    assert written.size_m == pytest.approx((0.86, 0.62, 0.82))
    assert written.categories != long_low.categories


def test_two_objects_at_once() -> None:
    assert understand("sofas and rugs").categories == ("sofa", "rug")


def test_words_that_describe_are_retained_apart_from_the_noun() -> None:
    query = understand("grey armchairs with cushions")
    assert query.words == ("gray", "cushion")
    assert query.naming == ("armchair",)
    assert understand("desk lamp").words == ("desk",)
    assert understand("").words == ()


@pytest.mark.parametrize(
    ("british", "american"),
    [("grey", "gray"), ("colours", "color"), ("panelled", "paneled"), ("centre", "center"), ("aluminium", "aluminum")],
)
def test_spellings(british: str, american: str) -> None:
    assert normal(british) == normal(american)


@pytest.mark.parametrize(
    ("many", "one"),
    [("boxes", "box"), ("shelves", "shelf"), ("benches", "bench"), ("vases", "vase"), ("glass", "glass"),
     ("canvas", "canvas"), ("curtains", "curtain"), ("bookcases", "bookcase"), ("bouclé", "boucle")],
)  # fmt: skip
def test_plurals(many: str, one: str) -> None:
    assert normal(many) == one


def test_sizes_in_words() -> None:
    assert size_in("desk 120 x 60 x 75 cm") == ("desk  ", pytest.approx((0.6, 1.2, 0.75)))
    assert size_in("desk 1.2x0.6x0.75")[1] == pytest.approx((0.6, 1.2, 0.75))
    assert size_in("1200 by 600 by 750 mm desk")[1] == pytest.approx((0.6, 1.2, 0.75))
    assert size_in("table for 4 x 2")[1] is None


def test_concepts_know_their_kinds() -> None:
    assert "oak" in narrower("wooden")
    assert "navy" in narrower("blue")


def test_near_names_lead_to_categories_and_are_no_names_of_categories() -> None:
    names = {c.name for c in taxonomy.CATEGORIES}
    assert set(other_names().values()) <= names
    shadowed = {tokens(s): c.name for c in taxonomy.CATEGORIES for s in (c.name, *c.synonyms)}
    for words, category in other_names().items():
        if words in shadowed and words not in {("ottoman", "box")}:
            assert understand(" ".join(words)).categories == (shadowed[words],), f"{words} is listed near {category}"


def test_every_name_in_the_taxonomy_is_understood() -> None:
    for category in taxonomy.CATEGORIES:
        if category is not taxonomy.UNKNOWN:
            assert understand(category.name).categories == (category.name,)
            for word in category.synonyms:
                assert understand(word).exact, word


def test_size_distance_knows_both_ways_round() -> None:
    sofa = (0.95, 1.95, 0.84)
    assert size_distance("sofa", sofa) < 0.1
    assert size_distance("sofa", (1.95, 0.95, 0.84)) < 0.1
    assert size_distance("cup", sofa) > 100


@given(st.text(max_size=60))
def test_any_text_is_survived(text: str) -> None:
    query = understand(text)
    assert set(query.categories) <= {c.name for c in taxonomy.CATEGORIES}
