"""Names in files: each used once, because many programs address nodes by name."""

from __future__ import annotations

import re

from diorama_core.io.text import clean_text


class Labels:
    """Gives out names, slugs and keys, each of them unique among its kind."""

    def __init__(self) -> None:
        self._names: set[str] = set()
        self._slugs: set[str] = set()
        self._keys: set[str] = set()

    def name(self, text: str) -> str:
        """A readable name."""
        return unique_name(clean_text(text) or "object", self._names, " ")

    def slug(self, text: str) -> str:
        """An identifier of a node."""
        return unique_name(slug_of(text), self._slugs, "_")

    def key(self, text: str) -> str:
        """An identifier of a mesh."""
        return unique_name(slug_of(text), self._keys, "_")


def slug_of(text: str) -> str:
    """An ASCII identifier that resembles the text: a letter first, then letters, digits and underscores."""
    plain = re.sub(r"[^A-Za-z0-9]+", "_", text).strip("_")
    return plain if plain[:1].isalpha() else f"n_{plain}".rstrip("_")


def unique_name(text: str, taken: set[str], separator: str = " ") -> str:
    """The text, with a number where it was used before; `taken` is extended.

    Case is ignored, because some disks do so when files are named by it; `taken` holds case-folded names.
    """
    candidate, number = text, 2
    while candidate.casefold() in taken:
        candidate, number = f"{text}{separator}{number}", number + 1
    taken.add(candidate.casefold())
    return candidate
