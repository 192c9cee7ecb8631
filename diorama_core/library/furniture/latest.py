"""The parts of the designs that were built last, because a shape's joints are asked for right after its looks."""

from __future__ import annotations

from dataclasses import replace

from diorama_core.io.cache import LruCache
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Design, Part, built
from diorama_core.library.furniture.solids import Solid

_LATEST: LruCache[int, tuple[Design, tuple[Part, ...]]] = LruCache(4)


def latest_parts(design: Design) -> tuple[Part, ...]:
    """The design's parts at its own size."""
    # Caching the design, too, keeps its id from being given to another.
    return _LATEST.get(id(design), lambda: (design, tuple(design.build(design.size_m))))[1]


def built_once(design: Design) -> list[tuple[Material, Solid]]:
    """`built`, from the same parts."""
    return built(replace(design, builder=lambda size_m, **options: list(latest_parts(design))))
