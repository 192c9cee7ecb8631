from __future__ import annotations

from diorama_core.export.names import Labels, slug_of, unique_name


def test_slugs_are_identifiers() -> None:
    assert slug_of("night stand (2)") == "night_stand_2"
    assert slug_of("3 chairs").isidentifier()
    assert slug_of("—").isidentifier()


def test_names_differ_even_where_case_is_ignored() -> None:
    taken: set[str] = set()
    assert [unique_name(n, taken) for n in ("Lamp", "lamp", "LAMP")] == ["Lamp", "lamp 2", "LAMP 3"]
    labels = Labels()
    assert [labels.slug("a b"), labels.slug("a-b"), labels.key("a b")] == ["a_b", "a_b_2", "a_b"]
    assert labels.name("") == "object"
