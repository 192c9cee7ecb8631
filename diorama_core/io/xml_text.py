"""XML from elsewhere: without entities, which unpack to much or name other files, and of bounded depth."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Any, NoReturn
from xml.parsers import expat

from diorama_core.io.bounded import Kind, shortened

MAX_DEPTH = 100
"""Depth of elements within each other: a plan has five."""


def parse_xml(data: bytes, name: str, error: Kind) -> ET.Element:
    """The root element of a document.

    The parser itself looks for entities, so that it does not matter in which encoding they are written.

    Raises:
        error: no well-formed XML, entities, or elements nested too deeply.
    """
    try:
        _check(data, name, error)
        return ET.fromstring(data)
    except (ET.ParseError, expat.ExpatError, ValueError, LookupError) as reason:
        raise error(f"{name} is damaged ({shortened(str(reason))}); save it again") from reason


def _check(data: bytes, name: str, error: Kind) -> None:
    depth = 0

    def refuse(*_: Any) -> NoReturn:
        raise error(f"{name} defines entities, which are not read; save it again without them")

    def opened(*_: Any) -> None:
        nonlocal depth
        depth += 1
        if depth > MAX_DEPTH:
            raise error(f"{name} has elements nested more than {MAX_DEPTH} deep; save it again")

    def closed(*_: Any) -> None:
        nonlocal depth
        depth -= 1

    parser = expat.ParserCreate()
    parser.EntityDeclHandler = refuse
    parser.StartElementHandler, parser.EndElementHandler = opened, closed
    parser.Parse(data)  # a document that is cut short is found by who reads it
