"""Names of objects that are no category of their own, each with the category most like it in form and use.

They count as near, never as exact: the user is told which category was used. Names that the class lists of indoor
data sets and the shelves of furniture shops use.
"""

from __future__ import annotations

from functools import cache

from diorama_core.library.language import tokens
from diorama_core.library.taxonomy import column


@cache
def near_names() -> dict[tuple[str, ...], str]:
    """Normal words of each name (`language.tokens`), and the category it is near to."""
    table: dict[tuple[str, ...], str] = {}
    for category, names in column("other_names").items():
        for name in names:
            table.setdefault(tokens(name), category)
    return table
