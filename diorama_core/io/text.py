"""Text from outside (arguments, file names, page actions, uploads) as text that can be shown and written, and XML
without entities, which unpack to much or name other files, and of bounded depth.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, NoReturn
from xml.parsers import expat

if TYPE_CHECKING:
    from diorama_core.io.bounded import Kind

REPLACEMENT = "\ufffd"
"""Stands for what is no character."""
_KEPT = "\t\n\r"
_CONTROLS = {code: REPLACEMENT for code in (*range(32), *range(127, 160)) if chr(code) not in _KEPT}


def clean_text(text: str) -> str:
    """The text with half characters and control characters replaced; halves that belong together become one."""
    if text.isascii() and text.isprintable():
        return text
    whole = text.encode("utf-16-le", "surrogatepass").decode("utf-16-le", "replace")
    return whole.translate(_CONTROLS)


def clean_strings(value: Any) -> Any:
    """A value as JSON has it (or of tuples and bytes) with every string in it cleaned, keys included."""
    match value:
        case str():
            return clean_text(value)
        case dict():
            return {clean_strings(key): clean_strings(one) for key, one in value.items()}
        case list():
            return [clean_strings(one) for one in value]
        case tuple():
            return tuple(clean_strings(one) for one in value)
    return value


def file_label(name: str) -> str:
    """A file's name as text that differs for different names: bytes that are no UTF-8 are written as `\\xe9`."""
    known = "".join(c if not 0xDC80 <= ord(c) <= 0xDCFF else f"\\x{ord(c) - 0xDC00:02x}" for c in name)
    return clean_text(known)


def number_of(count: int, noun: str = "") -> str:
    """A number with its noun in the right form, that of objects where none is given: "1 object", "3 photos"."""
    many = "" if count == 1 else "s"
    return f"{count} {noun}{many}" if noun else f"{count} object{many}"


def sentences(notes: Iterable[str]) -> str:
    """Notes one after another, each as a sentence."""
    return " ".join(f"{note[:1].upper()}{note[1:]}." for note in notes)


MAX_DEPTH = 100
"""Depth of elements within each other: a plan has five."""


def parse_xml(data: bytes, name: str, error: Kind) -> ET.Element:
    """The root element of a document.

    The parser itself looks for entities, so that it does not matter in which encoding they are written.

    Raises:
        error: no well-formed XML, entities, or elements nested too deeply.
    """
    from diorama_core.io.bounded import shorten  # which loads numpy; the command line's help does without it

    try:
        _check(data, name, error)
        return ET.fromstring(data)
    except (ET.ParseError, expat.ExpatError, ValueError, LookupError) as reason:
        raise error(f"{name} is damaged ({shorten(str(reason))}); save it again") from reason


def _check(data: bytes, name: str, error: Kind) -> None:
    depth = 0

    def refuse(*_: Any) -> NoReturn:
        raise error(f"{name} defines entities, which are not read; save it again without them")

    def open_element(*_: Any) -> None:
        nonlocal depth
        depth += 1
        if depth > MAX_DEPTH:
            raise error(f"{name} has elements nested more than {MAX_DEPTH} deep; save it again")

    def close_element(*_: Any) -> None:
        nonlocal depth
        depth -= 1

    parser = expat.ParserCreate()
    parser.EntityDeclHandler = refuse
    parser.StartElementHandler, parser.EndElementHandler = open_element, close_element
    parser.Parse(data)  # a document that is cut short is found by who reads it
