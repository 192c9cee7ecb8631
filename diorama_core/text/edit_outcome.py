"""What an edit by words made of a scene, and how it is told."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from diorama_core.scene.types import Scene


@dataclass(frozen=True, eq=False)
class Done:
    """A scene after edits, and what was done."""

    scene: Scene
    lines: tuple[str, ...]
    """One for each edit, in words."""
    touched: tuple[str, ...] = ()
    """Ids of objects that were changed last: what "it" means next."""
    notes: tuple[str, ...] = ()
    """What was done otherwise than asked, in words."""


def names_of(scene: Scene, ids: Sequence[str]) -> str:
    """The labels of objects in a row."""
    return ", ".join(scene.object(i).label for i in ids)
