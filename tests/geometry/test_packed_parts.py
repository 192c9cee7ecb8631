"""Convex parts as arrays and back."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.geometry.convex import convex_parts
from diorama_core.geometry.packed_parts import NAMES, PackedParts, packed
from tests.primitives import PrimitiveLibrary

SHAPES = ("table", "chair", "ball")


def test_parts_of_many_shapes_are_the_same_after_packing() -> None:
    library = PrimitiveLibrary()
    made = {f"key {k}": convex_parts(library.mesh(k)) for k in SHAPES}
    again = PackedParts(*packed(made).values())
    assert list(again) == list(made)
    for key, group in made.items():
        assert len(again[key]) == len(group)
        for a, b in zip(group, again[key], strict=True):
            for name in ("vertices", "normals", "edges"):
                np.testing.assert_allclose(getattr(a, name), getattr(b, name), atol=1e-6)


@pytest.mark.parametrize("name", NAMES[1:])
def test_arrays_that_do_not_belong_together_are_refused(name: str) -> None:
    library = PrimitiveLibrary()
    arrays = packed({k: convex_parts(library.mesh(k)) for k in SHAPES})
    arrays[name] = arrays[name][:-1]
    with pytest.raises(ValueError, match="belong together"):
        PackedParts(*arrays.values())
