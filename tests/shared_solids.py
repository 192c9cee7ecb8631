"""Solids of built-in shapes: built by one process of a run, read by the others, and by itself when it needs them again.

A process has the latest few only, while its tests ask for the same tables and chairs over and over.
"""

from __future__ import annotations

from diorama_core.library.furniture import latest
from diorama_core.library.furniture.geometry_key import geometry_key
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Design
from diorama_core.library.furniture.solids import Solid
from tests.made_once import made_once


def built_once(design: Design) -> list[tuple[Material, Solid]]:
    """In place of `latest.built_once`."""
    return made_once(f"solids {geometry_key(design)}", lambda: latest.built_once(design))
