"""Reliefs of known shapes are taken once each."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from diorama_core.library.ingest import known_shapes as module
from diorama_core.library.ingest.known_shapes import load_known_shapes
from diorama_core.library.record import Shape
from tests.primitives import PrimitiveLibrary


class Renewed(PrimitiveLibrary):
    """A library after a change to one shape."""

    def shapes(self) -> tuple[Shape, ...]:
        first, *others = super().shapes()
        return replace(first, content_hash="another"), *others


def test_only_a_changed_shape_is_taken_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    taken: list[int] = []
    relief = module.relief
    monkeypatch.setattr(module, "relief", lambda mesh: taken.append(len(mesh.faces)) or relief(mesh))
    library = PrimitiveLibrary()
    first = load_known_shapes(tmp_path, library=library)
    assert len(taken) == len(first.categories) == len(first.features)
    again = load_known_shapes(tmp_path, library=library)
    assert len(taken) == len(first.categories)
    assert np.array_equal(again.features, first.features)
    renewed = load_known_shapes(tmp_path, library=Renewed())
    assert len(taken) == len(first.categories) + 1
    assert np.array_equal(renewed.features, first.features)


def test_a_damaged_file_is_taken_again(tmp_path: Path) -> None:
    first = load_known_shapes(tmp_path, library=PrimitiveLibrary())
    (retained,) = (tmp_path / "reliefs").iterdir()
    retained.write_bytes(retained.read_bytes()[:200])
    assert np.array_equal(load_known_shapes(tmp_path, library=PrimitiveLibrary()).features, first.features)
