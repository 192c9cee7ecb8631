"""Diorama's library: one picture of a room becomes an editable 3D scene. No UI, no server."""

__version__ = "0.1.0"
