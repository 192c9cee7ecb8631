"""How one person likes to work, kept in their browser: a reload and another start of the server find it again.

Browsers keep it per address, so every person who opens a shared server has settings of their own.
"""

from __future__ import annotations

import logging
from dataclasses import dataclass, replace
from typing import Literal

import viser
from pydantic import TypeAdapter, ValidationError

from diorama_app.units import Unit

log = logging.getLogger(__name__)

SizeMode = Literal["as found", "same box", "in proportion", "catalogue"]
GizmoMode = Literal["floor", "free", "size"]
RecipeName = Literal["feasible", "paper", "all-in-one"]

KEY = "diorama-settings"
ANSWER_WITHIN_S = 20.0
"""A browser that loads the scene in software answers late."""


@dataclass(frozen=True)
class Settings:
    """How one person likes to work."""

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


_JSON = TypeAdapter(Settings)


def settings_text(settings: Settings) -> str:
    """As a browser keeps it."""
    # Outlines are looked for anew in every photo, and only when somebody asks.
    return _JSON.dump_json(replace(settings, masks=False)).decode()


def read_settings(kept: str | None) -> Settings:
    """What a browser kept; as for somebody new when it kept nothing, or nothing that this program understands."""
    if kept is None:
        return Settings()
    try:
        return _JSON.validate_json(kept)
    except ValidationError as error:
        log.info("the settings of a browser are not understood: %s", error)
        return Settings()


def remember(client: viser.ClientHandle, settings: Settings) -> None:
    """Have the browser keep the settings."""
    client.local_storage.set_item(KEY, settings_text(settings))


def remembered(client: viser.ClientHandle) -> Settings:
    """What the browser kept. Waits for its answer: neither for viser's event loop nor for the desk."""
    try:
        return read_settings(client.local_storage.get_item(KEY, timeout=ANSWER_WITHIN_S))
    except (RuntimeError, TimeoutError) as error:  # it left, or keeps nothing for any page
        log.info("the settings of a browser are not known: %s", error)
        return Settings()
