"""The parts of the designs that were built last, because a shape's joints are asked for right after its looks."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Design, Part, built
from diorama_core.library.furniture.solids import Solid


def latest_parts(design: Design) -> tuple[Part, ...]:
    """The design's parts at its own size."""
    return _parts(_ByIdentity(design))


def built_once(design: Design) -> list[tuple[Material, Solid]]:
    """`built`, from the same parts."""
    return built(replace(design, builder=lambda size_m, **options: list(latest_parts(design))))


class _ByIdentity:
    """A design as a key: designs hold dictionaries, which have no hash."""

    def __init__(self, design: Design) -> None:
        self.design = design

    def __hash__(self) -> int:
        return id(self.design)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _ByIdentity) and other.design is self.design


@lru_cache(maxsize=4)
def _parts(key: _ByIdentity) -> tuple[Part, ...]:
    return tuple(key.design.build(key.design.size_m))
