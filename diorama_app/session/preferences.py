"""Preferences of one client, stored in its browser and restored after a reload or a server restart.

Browsers store them per address, so every user of a shared server has their own.
"""

from __future__ import annotations

import logging
from dataclasses import dataclass, replace
from typing import Literal

import viser
from pydantic import TypeAdapter, ValidationError

from diorama_app.session.units import Unit
from diorama_core.layout.settings import RecipeName

log = logging.getLogger(__name__)

SizeMode = Literal["as found", "same box", "in proportion", "catalogue"]
GizmoMode = Literal["floor", "free", "size"]

KEY = "diorama-settings"
ANSWER_WITHIN_S = 20.0
"""A browser that loads the scene in software answers late."""


@dataclass(frozen=True)
class Preferences:
    """Preferences of one client."""

    unit: Unit = "m"
    snap: bool = False
    """Places to the grid, headings to steps; Alt inverts it while dragging."""
    slide: bool = True
    """While dragging, slide along what is in the way instead of going through it."""
    names: bool = False
    """Name tags on everything."""
    badges: bool = True
    """Marks on what collides, floats, is outside the room or unsure."""
    masks: bool = False
    """The outlines of what was found, over the photo."""
    planes: bool = False
    """The edges of floor, walls and ceiling, with their names."""
    dark: bool = False
    gizmo: GizmoMode = "floor"
    recipe: RecipeName = "feasible"
    """How a layout is found."""
    size_mode: SizeMode = "as found"
    """What size a swapped shape takes."""
    keep_colour: bool = True
    """Whether a swapped shape takes the colour of what it replaces."""
    all_alike: bool = False
    """Whether a swap goes to every object of the same shape."""
    numbers: bool = False
    """Whether the object's name, position and size are shown as fields."""
    physics: bool = False
    """Whether the object's mass, friction, joints and colliders are shown."""
    build_at_once: bool = True
    """Whether an uploaded photo without boxes is built as soon as its objects are found."""
    favourites: tuple[str, ...] = ()
    """Ids of the library's shapes that the person marked."""
    recent: tuple[str, ...] = ()
    """Ids of the shapes inserted lately, the last first."""


_JSON = TypeAdapter(Preferences)


def preferences_text(preferences: Preferences) -> str:
    """The form stored in the browser."""
    # Masks are computed for each photo, and only on request.
    return _JSON.dump_json(replace(preferences, masks=False)).decode()


def read_preferences(retained: str | None) -> Preferences:
    """Stored preferences; defaults when nothing valid is stored."""
    if retained is None:
        return Preferences()
    try:
        return _JSON.validate_json(retained)
    except ValidationError as error:
        log.info("the settings of a browser are not understood: %s", error)
        return Preferences()


def remember(viser_client: viser.ClientHandle, preferences: Preferences) -> None:
    """Store the preferences in the browser."""
    viser_client.local_storage.set_item(KEY, preferences_text(preferences))


def recall(viser_client: viser.ClientHandle) -> Preferences:
    """The preferences stored in the browser. Waits for the answer: not for viser's event loop or the UI thread."""
    try:
        return read_preferences(viser_client.local_storage.get_item(KEY, timeout=ANSWER_WITHIN_S))
    except (RuntimeError, TimeoutError) as error:  # it left, or keeps nothing for any page
        log.info("the settings of a browser are not known: %s", error)
        return Preferences()
