from __future__ import annotations

import pytest

from diorama_core.errors import InputError
from diorama_core.io.xml_text import MAX_DEPTH, parse_xml

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
