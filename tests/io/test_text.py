from __future__ import annotations

import os

import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.errors import InputError
from diorama_core.io.text import (
    MAX_DEPTH,
    REPLACEMENT,
    clean_strings,
    clean_text,
    file_label,
    number_of,
    parse_xml,
    sentences,
)

ANY_TEXT = st.text(st.characters(categories=None, codec=None), max_size=40)  # halves and controls included


@given(ANY_TEXT)
def test_clean_text_can_be_written_and_stays_as_it_is_when_cleaned_again(text: str) -> None:
    clean = clean_text(text)
    assert clean.encode().decode() == clean
    assert not any(ord(c) < 32 and c not in "\t\n\r" for c in clean)
    assert clean_text(clean) == clean


@given(st.text(st.characters(exclude_categories=("Cs", "Cc")), max_size=40))
def test_text_stays_as_it_is(text: str) -> None:
    assert clean_text(text) == text


def test_halves_that_belong_together_become_one_character() -> None:
    assert clean_text("a\ud83d\ude00b") == "a\U0001f600b"
    assert clean_text("a\ud83db\udce9") == f"a{REPLACEMENT}b{REPLACEMENT}"
    assert clean_text("a\0b\x1b[31m") == f"a{REPLACEMENT}b{REPLACEMENT}[31m"


def test_every_string_of_a_value_is_cleaned() -> None:
    half = "\ud800"
    value = {half: [half, (half, 1, None)], "plain": {"a": half}, "bytes": memoryview(b"x")}
    found = clean_strings(value)
    assert found == {REPLACEMENT: [REPLACEMENT, (REPLACEMENT, 1, None)], "plain": {"a": REPLACEMENT}, "bytes": b"x"}


def test_names_of_files_differ_as_the_files_do() -> None:
    names = [os.fsdecode(name) for name in (b"b\xe9te", b"b\xe8te", b"\x80", b"\xff", "b\u00eate".encode())]
    assert file_label("\udc7f\udd00") == 2 * REPLACEMENT
    assert [file_label(name) for name in names] == ["b\\xe9te", "b\\xe8te", "\\x80", "\\xff", "b\u00eate"]


def test_numbers_have_their_noun_in_the_right_form() -> None:
    assert number_of(1) == "1 object"
    assert number_of(0) == "0 objects"
    assert number_of(3, "photo") == "3 photos"


def test_notes_become_sentences() -> None:
    assert sentences(("the photo is dark", "25% is unsure")) == "The photo is dark. 25% is unsure."


BOMB = '<?xml version="1.0" encoding="{}"?><!DOCTYPE a [<!ENTITY b "bbbb">]><a>&b;</a>'


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-16-le", "utf-16-be", "iso-8859-1", "cp037"])
def test_entities_are_refused_in_any_encoding(encoding: str) -> None:
    """Looked for as bytes, `<!ENTITY` passed in UTF-16."""
    with pytest.raises(InputError, match=r"^home (defines entities|is damaged)"):
        parse_xml(BOMB.format(encoding).encode(encoding), "home", InputError)


def test_entities_of_parameters_and_files_are_refused() -> None:
    for declared in ('% b "c"', 'b SYSTEM "file:///etc/hostname"', '% b SYSTEM "file:///etc/hostname"'):
        with pytest.raises(InputError, match="defines entities"):
            parse_xml(f"<!DOCTYPE a [<!ENTITY {declared}>]><a/>".encode(), "home", InputError)


def test_depth_is_bounded_and_damage_is_one_line() -> None:
    def nested(depth: int) -> bytes:
        return b"<a>" * depth + b"</a>" * depth

    beside = b"<b/>" * MAX_DEPTH  # which say nothing of how deep what follows is
    assert parse_xml(nested(MAX_DEPTH), "home", InputError).tag == "a"
    assert len(parse_xml(b"<a>" + beside + nested(MAX_DEPTH - 1) + b"</a>", "home", InputError)) == MAX_DEPTH + 1
    with pytest.raises(InputError, match="has elements nested"):
        parse_xml(b"<a>" + beside + nested(MAX_DEPTH) + b"</a>", "home", InputError)
    for data in (
        nested(MAX_DEPTH + 1),
        b"<a>" * 2_000_000,
        b"<a",
        b"",
        b"\xff\xfe",
        b'<?xml version="1.0" encoding="rot13"?><a/>',
    ):
        with pytest.raises(InputError, match=r"^home (has elements nested|is damaged)"):
            parse_xml(data, "home", InputError)


def test_text_in_utf_16_is_read() -> None:
    assert (
        parse_xml('<?xml version="1.0" encoding="utf-16"?><a b="é"/>'.encode("utf-16"), "home", InputError).get("b")
        == "é"
    )
