"""Input fields that show the document and write to it, without echoing their own updates."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


def on_change(handle: Any, act: Callable[[Any, int], None]) -> None:
    """Call `act(value, client id)` when a person changes a field; not when the program does."""

    async def changed(event: Any) -> None:
        if event.client_id is not None:
            act(event.target.value, event.client_id)

    handle.on_update(changed)


def on_press(handle: Any, act: Callable[[int], None]) -> None:
    """Call `act(client id)` when a person presses a button."""

    async def pressed(event: Any) -> None:
        if event.client_id is not None:
            act(event.client_id)

    handle.on_click(pressed)


def show_value(handle: Any, value: Any) -> None:
    """Put a value into a field if it shows another."""
    if handle.value != value:
        handle.value = value


def show_if(visible: bool, *handles: Any) -> None:
    """Show or hide fields, touching only those that differ."""
    for handle in handles:
        if handle.visible != visible:
            handle.visible = visible


def unique_names(names: list[str]) -> list[str]:
    """The same names, later doubles numbered: 'chair', 'chair (2)'."""
    seen: dict[str, int] = {}
    result = []
    for name in names:
        seen[name] = seen.get(name, 0) + 1
        result.append(name if seen[name] == 1 else f"{name} ({seen[name]})")
    return result
