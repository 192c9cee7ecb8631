"""Libraries of few shapes, for builds whose choice among many is not what a test asks about.

What is met in a photo is compared with all shapes of its kind, each of which is first seen from all sides.
"""

from __future__ import annotations

import hashlib
from collections import Counter
from dataclasses import replace
from functools import cache
from typing import Final

from diorama_app.projects.example import EXAMPLE
from diorama_core.library.catalogue import base_id, built_in_library
from diorama_core.library.ingest.sink import Ingested
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.store import create_library
from diorama_core.project.storage import Project
from diorama_core.scene.types import Scene
from diorama_core.synthesis.splits import Subset

OF_A_KIND = 2
SEATS: Final = "few-seats"
"""Name of the stored library, for commands and servers that are given one."""


def few_shapes(*scenes: Scene, of_a_kind: int = OF_A_KIND) -> Subset:
    """The first built-in shapes of every kind, and those of the scenes."""
    first = _first_of_every_kind(of_a_kind)
    return replace(first, ids=first.ids | {base_id(o.shape_id) for scene in scenes for o in scene.objects})


def example_scene() -> Scene:
    """The room that comes with Diorama."""
    return Project.open(EXAMPLE / "project").load_scene()


@cache
def stored_seats() -> str:
    """The name of a stored library of three chairs and a sofa, whose ids begin with `my-`."""
    built_in, store = built_in_library(), create_library(SEATS)
    for category, count in (("chair", 3), ("sofa", 1)):
        for listed in built_in.in_category(category)[:count]:
            store.add(stored_copy(built_in, listed.id, f"my-{listed.id}"))
    return SEATS


def stored_copy(library: ShapeLibrary, shape_id: str, name: str) -> Ingested:
    """A shape of a library as a stored one has it, called `name`: its content is its file, which is read back."""
    glb = library.glb(shape_id)
    digest = hashlib.sha256(glb).hexdigest()[:24]
    record = replace(library.shape(shape_id), id=name, source="tests", content_hash=digest)
    return Ingested(record, glb, None, shape_id)


@cache
def _first_of_every_kind(count: int) -> Subset:
    library, met, chosen = built_in_library(), Counter[str](), list[str]()
    for shape in library.shapes():
        met[shape.category] += 1
        if met[shape.category] <= count:
            chosen.append(shape.id)
    return Subset(library, frozenset(chosen), "few")
