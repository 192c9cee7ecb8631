"""What all things of a photo are, decided together: what lies on what, and which type of room it is.

Every thing has at most one carrier, a larger box that its foot is in, so that carriers make a forest: given the type of
room, sums over all combinations of kinds are exact (belief propagation, Pearl 1988), and types of rooms are mixed by
how well they explain the whole.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from math import fsum

import numpy as np
from jaxtyping import Float

from diorama_core.library.company import CARRIED, HARDLY_CARRIED, ROOMS, SELDOM_CARRIED
from diorama_core.library.hyponyms import meanings
from diorama_core.library.taxonomy import CATEGORIES, UNKNOWN, category

Box = tuple[float, float, float, float]

_LIES_ON_IT = 0.4
"""How likely a thing with its foot in a larger box lies on what is there, and does not stand before or behind it."""
_NO_CARRIER = 0.25
"""How often boxes are found in one of a kind that carries nothing, relative to one that does."""
_AT_HOME = 2.5
"""How many times more often a kind is met in the rooms that it belongs to."""
_ROOM_TRUST = 0.5
"""Power of what a photo says about its room: things of a room do not come independently."""
_LARGER = 1.05
_FOOT_SLACK, _LOWEST_FOOT = 0.1, 0.03
"""How far a foot may be above a carrier's box, in the thing's heights, and must be above its lower edge, in its own."""


def carriers(boxes: Sequence[Box]) -> list[int | None]:
    """For every box the smallest larger one that its foot is in, as an index; None where there is none."""
    rows = np.asarray(boxes, dtype=np.float64).reshape(-1, 4)
    left, top, right, bottom = rows.T
    area, height, middle = (right - left) * (bottom - top), bottom - top, (left + right) / 2
    across = (left[None] <= middle[:, None]) & (middle[:, None] <= right[None])
    above = (top[None] - _FOOT_SLACK * height[:, None] <= bottom[:, None]) & (
        bottom[:, None] <= (bottom - _LOWEST_FOOT * height)[None]
    )
    possible = across & above & (area[None] > _LARGER * area[:, None])
    best = np.where(possible, area[None], np.inf)
    return [int(row.argmin()) if np.isfinite(row).any() else None for row in best]


def kinds_together(alone: Sequence[Mapping[str, float]], carrier_of: Sequence[int | None]) -> list[Mapping[str, float]]:
    """For every thing how likely it is of each kind, given all others.

    Args:
        alone: how likely it is of each kind by itself; kinds that are not there are impossible.
        carrier_of: for every thing the one that its foot is in; no thing carries itself, not even through others.
    """
    if not alone:
        return []
    index = {name: i for i, name in enumerate(_names())}
    own = np.zeros((len(alone), len(index)))
    for row, of_one in zip(own, alone, strict=True):
        for kind, share in of_one.items():
            row[index[kind]] = share
    explained = [_in_room(own * usual, carrier_of) for usual in _rooms()]
    says = _ROOM_TRUST * np.array([log for _, log in explained])
    weight = np.exp(says - says.max())
    mixed = np.einsum("t,tnk->nk", weight / weight.sum(), np.stack([beliefs for beliefs, _ in explained]))
    return [{kind: float(row[index[kind]]) for kind in of_one} for row, of_one in zip(mixed, alone, strict=True)]


def _in_room(own: Float[np.ndarray, "n k"], carrier_of: Sequence[int | None]) -> tuple[Float[np.ndarray, "n k"], float]:
    """Marginals in one type of room, and the logarithm of how well it explains everything."""
    together = _together()
    upward, inward = np.ones_like(own), own.copy()
    order = _children_first(carrier_of)
    logs: list[float] = []
    said: list[list[np.ndarray]] = [[] for _ in own]
    for i in order:  # what everything on a thing says of it, up to the things that nothing carries
        if said[i]:  # sorted: the order of the objects must not show in a bit
            inward[i] *= np.sort(np.stack(said[i]), axis=0).prod(axis=0)
        total = inward[i].sum()
        inward[i] /= total
        logs.append(float(np.log(total)))
        parent = carrier_of[i]
        if parent is not None:
            upward[i] = inward[i] @ together
            said[parent].append(upward[i])
    beliefs = inward.copy()
    for i in reversed(order):  # and back down again
        parent = carrier_of[i]
        if parent is not None:
            without = beliefs[parent] / upward[i]
            beliefs[i] = inward[i] * (together @ (without / without.sum()))
            beliefs[i] /= beliefs[i].sum()
    return beliefs, fsum(logs)


def _children_first(carrier_of: Sequence[int | None]) -> list[int]:
    """All indices, every one before its carrier."""

    def depth(i: int | None) -> int:
        return 0 if i is None else 1 + depth(carrier_of[i])

    return sorted(range(len(carrier_of)), key=lambda i: -depth(i))


@cache
def _names() -> tuple[str, ...]:
    return tuple(c.name for c in CATEGORIES)


@cache
def _frequency() -> Float[np.ndarray, "k"]:
    """Of every kind among all things."""
    shares = meanings(UNKNOWN.name, UNKNOWN.name)
    return np.array([shares.get(name, 0.0) for name in _names()])


@cache
def _together() -> Float[np.ndarray, "k k"]:
    """How many times more often a thing of each kind (row) has its foot in the box of one of each kind (column)."""
    names = _names()
    index = {name: i for i, name in enumerate(names)}
    lies = np.array([category(name).mount == "surface" for name in names])
    ratio = np.ones((len(names), len(names)))
    often = np.full(len(names), _NO_CARRIER)
    for row in CARRIED:
        for carrier in sorted(row.carriers):
            column = np.where(lies, SELDOM_CARRIED, HARDLY_CARRIED)
            column[[index[kind] for kind in row.kinds]] = list(row.kinds.values())
            ratio[:, index[carrier]] = column
            often[index[carrier]] = 1.0
    ratio = ratio / (_frequency() @ ratio)
    return (1.0 - _LIES_ON_IT) + _LIES_ON_IT * ratio * often


@cache
def _rooms() -> tuple[Float[np.ndarray, "k"], ...]:
    """For every type of room how many times more often each kind is met there."""
    found = []
    for kinds in ROOMS.values():
        ratio = np.array([_AT_HOME if name in kinds else 1.0 for name in _names()])
        found.append(ratio / float(_frequency() @ ratio))
    return tuple(found)
