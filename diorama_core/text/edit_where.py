"""Phrases of place as places of edits: to which objects of the scene they refer."""

from __future__ import annotations

import re
from collections.abc import Sequence

from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.text.edit_plan import Place
from diorama_core.text.phrases import PlacePhrase
from diorama_core.text.selecting import Selector


def places_of_phrases(selector: Selector, places: Sequence[PlacePhrase]) -> list[Place]:
    """Where phrases of place say that something goes; raises `EditRefused` where they name what is not there."""
    found = []
    for place in places:
        if place.words in ("", "each other", "one another"):
            found.append(Place(relation=place.kind, targets=[]))
        elif re.fullmatch(r"(?:the |this )?(?:\w+ )?(?:room|bedroom|kitchen|office|scene|floor|ground)", place.words):
            continue
        elif re.fullmatch(r"(?:the |a )?(?:\w+ )?walls?", place.words):
            found.append(Place(relation="against wall", targets=[]))
        else:
            targets = list(selector.targets(place.words))
            openings = all(selector.scene.object(t).category in OPENING_CATEGORIES for t in targets)
            by = place.kind == "under" and openings  # under a window is at it, on the floor
            found.append(Place(relation="near" if by else place.kind, targets=targets))
    return found
