"""Convex parts as arrays and back. Convex parts of a shape: they come along, or are decomposed once, read back, and
made again from a damaged file.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
import pytest

from diorama_core.geometry.convex import convex_parts
from diorama_core.io.cache import LruCache
from diorama_core.layout.problem import parts
from diorama_core.layout.problem.clear_places import clear_of_places
from diorama_core.layout.problem.parts import NAMES, PackedParts, pack
from diorama_core.library.catalogue import built_in_library
from tests.primitives import PrimitiveLibrary

SHAPES = ("table", "chair", "ball")


def test_parts_of_many_shapes_are_the_same_after_packing() -> None:
    library = PrimitiveLibrary()
    made = {f"key {k}": convex_parts(library.mesh(k)) for k in SHAPES}
    again = PackedParts(*pack(made).values())
    assert list(again) == list(made)
    for key, group in made.items():
        assert len(again[key]) == len(group)
        for a, b in zip(group, again[key], strict=True):
            for name in ("vertices", "normals", "edges"):
                np.testing.assert_allclose(getattr(a, name), getattr(b, name), atol=1e-6)


@pytest.mark.parametrize("name", NAMES[1:])
def test_arrays_that_do_not_belong_together_are_refused(name: str) -> None:
    library = PrimitiveLibrary()
    arrays = pack({k: convex_parts(library.mesh(k)) for k in SHAPES})
    arrays[name] = arrays[name][:-1]
    with pytest.raises(ValueError, match="belong together"):
        PackedParts(*arrays.values())


def test_parts_come_from_memory_then_disk_then_geometry(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DIORAMA_CACHE", str(tmp_path))
    made: list[int] = []
    decompose = parts.convex_parts
    monkeypatch.setattr(parts, "convex_parts", lambda mesh: made.append(1) or decompose(mesh))
    library = PrimitiveLibrary()
    shape = library.shape("table")

    def asked(*, restarted: bool) -> tuple:
        if restarted:
            monkeypatch.setattr(parts, "_CACHE", LruCache(4))
        return parts.parts_of_shape(library, shape)

    first = asked(restarted=True)
    assert asked(restarted=False) is first
    again = asked(restarted=True)
    assert len(made) == 1
    assert len(again) == len(first) > 1
    for a, b in zip(first, again, strict=True):
        for name in ("vertices", "normals", "edges"):
            np.testing.assert_array_equal(getattr(a, name), getattr(b, name))
    (file,) = (tmp_path / "parts").iterdir()
    file.write_bytes(file.read_bytes()[:100])
    assert len(asked(restarted=True)) == len(first)
    assert len(made) == 2


def test_the_parts_of_all_built_in_shapes_come_along() -> None:
    missing = [s.id for s in built_in_library().shapes() if not parts.is_built_in(s)]
    assert not missing, f"{missing[:5]} and others changed: run `python scripts/make_convex_parts.py`"


def test_the_parts_that_come_along_are_those_that_would_be_made() -> None:
    library = built_in_library()
    for shape in library.shapes()[::150]:
        mesh, places = library.mesh(shape.id), library.shape(shape.id).surfaces
        come = parts.parts_of_shape(library, library.shape(shape.id))
        made = clear_of_places(convex_parts(mesh), places, partial(library.mesh, shape.id))
        assert [len(p.vertices) for p in come] == [len(p.vertices) for p in made], shape.id
        for a, b in zip(come, made, strict=True):
            np.testing.assert_allclose(a.vertices, b.vertices, atol=1e-5)
