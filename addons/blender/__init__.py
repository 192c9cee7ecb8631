"""Blender add-on: rooms of a running Diorama editor. Blender's module is imported when the add-on is switched on."""

from __future__ import annotations


def register() -> None:
    """Switch the add-on on."""
    from . import panel

    panel.register()


def unregister() -> None:
    """Switch the add-on off."""
    from . import panel

    panel.unregister()
