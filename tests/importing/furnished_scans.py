"""A furnished room as a phone scans it, made once for all tests of a run."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from diorama_core.evaluation.benchmarks.cases import furnish, recipe
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import Scene
from diorama_core.synthesis.scan import SyntheticFrame, scan
from diorama_core.synthesis.splits import split_library
from tests.few_shapes import few_shapes
from tests.made_once import made_once


@cache
def living_room() -> tuple[Scene, tuple[SyntheticFrame, ...]]:
    """The room and its frames."""

    def make() -> tuple[Scene, tuple[SyntheticFrame, ...]]:
        tested = split_library(built_in_library(), "test")
        scene = furnish(recipe(1, 1, 0)[0], tested)
        return scene, scan(scene, tested, 0, places=3, turns=8)

    return made_once("scanned living room", make)


def searched() -> ShapeLibrary:
    """A few shapes that are not in the room."""
    few = few_shapes()
    return replace(few, ids=few.ids - split_library(built_in_library(), "test").ids)
