"""Input fields that show the document and write to it, without echoing their own updates."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

QUIET_COLOUR = (84, 96, 114)
"""Colour of secondary buttons; viser's grey looks disabled."""
GO_COLOUR = (24, 108, 66)
"""Colour of buttons that begin something large; on viser's green the words are black."""


def on_change(handle: Any, act: Callable[[Any], None]) -> None:
    """Call `act(value)` from the event loop when the user changes a field; not when the program does."""

    async def changed(event: Any) -> None:
        if event.client_id is not None:
            act(event.target.value)

    handle.on_update(changed)


def on_press(handle: Any, act: Callable[[], None]) -> None:
    """Call `act()` from the event loop when the person presses a button."""

    async def pressed(event: Any) -> None:
        if event.client_id is not None:
            act()

    handle.on_click(pressed)


def show_value(handle: Any, value: Any) -> None:
    """Put a value into a field if it shows another."""
    if handle.value != value:
        handle.value = value


def enable(handle: Any, possible: bool) -> None:
    """Enable or disable fields."""
    if handle.disabled == possible:
        handle.disabled = not possible


def show_if(visible: bool, *handles: Any) -> None:
    """Show or hide fields, touching only those that differ."""
    for handle in handles:
        if handle.visible != visible:
            handle.visible = visible


def show_options(handle: Any, options: tuple[str, ...], value: str) -> None:
    """Offer these choices in a drop-down, with this one chosen."""
    if tuple(handle.options) != options:
        handle.options = options
    show_value(handle, value if value in options else options[0])


def unique_names(names: list[str]) -> list[str]:
    """The names, with later doubles numbered: 'chair', 'chair (2)'."""
    seen: dict[str, int] = {}
    result = []
    for name in names:
        seen[name] = seen.get(name, 0) + 1
        result.append(name if seen[name] == 1 else f"{name} ({seen[name]})")
    return result
