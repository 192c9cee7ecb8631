"""Convex parts of a shape: decomposed once, read back from disk, decomposed again when the file is damaged."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diorama_core.io.cache import LruCache
from diorama_core.layout.problem import parts
from tests.primitives import PrimitiveLibrary


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
