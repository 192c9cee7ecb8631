"""What is trained on, checked and tested: shapes, finishes and room styles share nothing across the three.

Libraries are cut into train, validation and test shapes, so that tests can ask for shapes that were never offered.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import trimesh

from diorama_core.errors import LibraryError
from diorama_core.library.catalogue import base_id
from diorama_core.library.record import Shape, ShapeLibrary

Split = Literal["train", "validation", "test"]
TEST_SHARE, VALIDATION_SHARE = 0.3, 0.1


@dataclass(frozen=True)
class Subset:
    """Some shapes of a library; implements `ShapeLibrary`."""

    library: ShapeLibrary
    ids: frozenset[str] = field(repr=False)
    name: str = ""

    @cached_property
    def _records(self) -> tuple[Shape, ...]:
        return tuple(s for s in self.library.shapes() if s.id in self.ids)

    def shapes(self) -> tuple[Shape, ...]:
        """The subset's records, in the library's order."""
        return self._records

    def in_category(self, category: str) -> tuple[Shape, ...]:
        """The subset's records of one category."""
        return tuple(s for s in self.library.in_category(category) if s.id in self.ids)

    def shape(self, shape_id: str) -> Shape:
        """One record with its support surfaces."""
        return self.library.shape(self._check(shape_id))

    def mesh(self, shape_id: str) -> trimesh.Trimesh:
        """Geometry only."""
        return self.library.mesh(self._check(shape_id))

    def parts(self, shape_id: str) -> trimesh.Scene:
        """Geometry with materials."""
        return self.library.parts(self._check(shape_id))

    def glb(self, shape_id: str) -> bytes:
        """`parts` as GLB."""
        return self.library.glb(self._check(shape_id))

    def _check(self, shape_id: str) -> str:
        if base_id(shape_id) not in self.ids:
            raise LibraryError(f"shape '{shape_id}' is not in the subset {self.name or 'of the library'}")
        return shape_id


def split_of(library: ShapeLibrary) -> dict[str, Split]:
    """For every shape its split. Within a category shapes are ordered by the hash of their id; the first are tested.

    A category with one shape is only trained on; one with two has no validation shape. A shape added later moves
    only its neighbours in that order.
    """
    by_category: dict[str, list[str]] = {}
    for shape in library.shapes():
        by_category.setdefault(shape.category, []).append(shape.id)
    return {name: split for ids in by_category.values() for name, split in share_out(ids).items()}


def share_out(names: Iterable[str], validation: float = VALIDATION_SHARE) -> dict[str, Split]:
    """For every name its split, by the order of the names' hashes; of two or more names at least one is tested."""
    ordered = sorted(names, key=lambda n: hashlib.sha256(n.encode()).digest())
    tests = round(TEST_SHARE * len(ordered)) or int(len(ordered) > 1)
    checks = round(validation * len(ordered))
    return {
        name: "test" if rank < tests else "validation" if rank < tests + checks else "train"
        for rank, name in enumerate(ordered)
    }


def split_library(library: ShapeLibrary, *wanted: Split) -> Subset:
    """The part of a library that belongs to one or more splits."""
    splits = split_of(library)
    return Subset(library, frozenset(i for i, s in splits.items() if s in wanted), "+".join(wanted))
