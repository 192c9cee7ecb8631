from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Literal

import numpy as np
import pytest
from jaxtyping import Float32

from diorama_core.io.typed import as_member, fits


@dataclass(frozen=True)
class Leaf:
    name: str
    share: float = 0.5


@dataclass(frozen=True)
class Tree:
    leaves: tuple[Leaf, ...]
    kind: Literal["oak", "ash"]
    depth: Float32[np.ndarray, "h w"] | None = None


DEPTH = np.zeros((2, 3), np.float32)
GOOD = Tree((Leaf("a"),), "oak", DEPTH)


@pytest.mark.parametrize(
    ("value", "annotation"),
    [
        (3, int), (3, float), (2.5, float), ("x", str), (None, None), (None, str | None), ("x", str | None),
        ((1, "a"), tuple[int, str]), ((1, 2, 3), tuple[int, ...]), ((), tuple[int, ...]), ((1, "a"), tuple),
        ({"a": 1}, dict[str, int]), (object(), Any), ("oak", Literal["oak"]), (DEPTH, Float32[np.ndarray, "h w"]),
        (GOOD, Tree), (Tree((), "ash"), Tree),
    ],
)  # fmt: skip
def test_values_of_their_type_fit(value, annotation) -> None:
    assert fits(value, annotation)


@pytest.mark.parametrize(
    ("value", "annotation"),
    [
        (True, int), (True, float), (2.5, int), (float("nan"), float), (float("inf"), float), ("3", int), (None, str),
        ((1,), tuple[int, str]), ((1, 2), tuple[int, str]), ([1], tuple[int, ...]), ((1, "a"), tuple[int, ...]),
        ({1: 1}, dict[str, int]), ({"a": "b"}, dict[str, int]), ([], dict[str, int]), ("elm", Literal["oak"]),
        (DEPTH[0], Float32[np.ndarray, "h w"]), (DEPTH.astype(float), Float32[np.ndarray, "h w"]),
        (np.full((2, 3), np.nan, np.float32), Float32[np.ndarray, "h w"]),
        (Tree((Leaf(3),), "oak"), Tree), (Tree((), "elm"), Tree), (Tree([], "oak"), Tree), (Leaf("a"), Tree),
    ],
)  # fmt: skip
def test_others_do_not(value, annotation) -> None:
    assert not fits(value, annotation)


class Wood(StrEnum):
    OAK = "oak"


def test_strings_become_the_members_that_are_asked_for_and_nothing_else_changes() -> None:
    assert as_member("oak", Wood) is Wood.OAK
    with pytest.raises(ValueError, match="elm"):
        as_member("elm", Wood)
    for value, annotation in ((5, Wood), ("oak", str), ("oak", Literal["oak"]), ("oak", None), (GOOD, Tree)):
        assert as_member(value, annotation) is value
