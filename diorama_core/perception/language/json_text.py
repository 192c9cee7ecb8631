"""Finding the JSON object in what a model wrote."""

from __future__ import annotations

import json
import re
from typing import Any

_FENCE = "```"
_LANGUAGE = re.compile("json", re.IGNORECASE)
_MAX_STARTS = 50


def json_in(text: str) -> dict[str, Any] | None:
    """The object that a text is, holds between fences, or holds amid prose; None without any."""
    for candidate in (text, *_fenced(text)):
        try:
            document = json.loads(candidate)
        except (ValueError, RecursionError):
            continue
        if isinstance(document, dict):
            return document
    return _amid_prose(text)


def _fenced(text: str) -> list[str]:
    """What stands between pairs of fences. In one pass: replies are as long and as odd as they like."""
    inside = text.split(_FENCE)[1:-1:2]
    return [part[4:] if _LANGUAGE.match(part) else part for part in inside]


def _amid_prose(text: str) -> dict[str, Any] | None:
    """The largest object that begins at some brace."""
    decoder = json.JSONDecoder()
    best: tuple[int, dict[str, Any]] | None = None
    position = -1
    for _ in range(_MAX_STARTS):
        position = text.find("{", position + 1)
        if position < 0:
            break
        try:
            document, end = decoder.raw_decode(text, position)
        except (ValueError, RecursionError):
            continue
        if isinstance(document, dict) and (best is None or end - position > best[0]):
            best = (end - position, document)
    return None if best is None else best[1]
