"""The words that an open-vocabulary detector is asked for where nobody named any."""

from __future__ import annotations

from diorama_core.library.taxonomy import ARCHITECTURE_WORDS, CATEGORIES, UNKNOWN

INDOOR_WORDS: tuple[str, ...] = tuple(
    c.name for c in CATEGORIES if c is not UNKNOWN and c.name not in ARCHITECTURE_WORDS
)
"""One word for every category that a scene can hold. Synonyms would compete with each other at one threshold, cost a
run of the text tower each, and find nothing that the library has a shape for.
"""
