"""What all things of a photo are, decided together: what lies on what, and which type of room it is.

Every thing has at most one carrier, a larger box that its foot is in, so that carriers make a forest: given the type of
room, sums over all combinations of kinds are exact (belief propagation, Pearl 1988), and types of rooms are mixed by
how well they explain the whole.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from math import fsum

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.library.labels import meanings
from diorama_core.library.taxonomy import (
    CARRIES_AS,
    CATEGORIES,
    HARDLY_CARRIED,
    ROOMS,
    SELDOM_CARRIED,
    UNKNOWN,
    category,
    column,
)
from diorama_core.scene.values import ArrayValue

Box = tuple[float, float, float, float]


@dataclass(frozen=True)
class KindsTogetherSettings:
    """Weights of the joint decision of kinds."""

    lies_on_it: float = 0.4
    """How likely a thing with its foot in a larger box lies on what is there, and does not stand before or behind
    it."""
    no_carrier: float = 0.25
    """How often boxes are found in one of a kind that carries nothing, relative to one that does."""
    at_home: float = 2.5
    """How many times more often a kind is met in the rooms that it belongs to."""
    room_trust: float = 0.5
    """Power of what a photo says about its room: things of a room do not come independently."""
    larger: float = 1.05
    foot_slack: float = 0.1
    lowest_foot: float = 0.03
    """How far a foot may be above a carrier's box, in the thing's heights, and must be above its lower edge, in its
    own."""


SETTINGS = KindsTogetherSettings()
_NAMES = tuple(c.name for c in CATEGORIES)
_INDEX = {name: i for i, name in enumerate(_NAMES)}


@dataclass(frozen=True, eq=False)
class Lying(ArrayValue):
    """What a thing's box says for its lying on its carrier."""

    kinds: tuple[str, ...]
    """That it may be of."""
    carrier_kinds: tuple[str, ...]
    ratio: Float[np.ndarray, "k c"]
    """How many times likelier the box is for a kind on a kind of carrier than for the kind anywhere."""


def carries(kind: str) -> bool:
    """Whether things of a kind carry others."""
    return bool(_carriers()[_INDEX[kind]])


def carriers(boxes: Sequence[Box]) -> list[int | None]:
    """For every box the smallest larger one that its foot is in, as an index; None where there is none."""
    rows = np.asarray(boxes, dtype=np.float64).reshape(-1, 4)
    left, top, right, bottom = rows.T
    area, height, middle = (right - left) * (bottom - top), bottom - top, (left + right) / 2
    across = (left[None] <= middle[:, None]) & (middle[:, None] <= right[None])
    above = (top[None] - SETTINGS.foot_slack * height[:, None] <= bottom[:, None]) & (
        bottom[:, None] <= (bottom - SETTINGS.lowest_foot * height)[None]
    )
    possible = across & above & (area[None] > SETTINGS.larger * area[:, None])
    best = np.where(possible, area[None], np.inf)
    return [int(row.argmin()) if np.isfinite(row).any() else None for row in best]


def kinds_together(
    alone: Sequence[Mapping[str, float]], carrier_of: Sequence[int | None], lying: Sequence[Lying | None] | None = None
) -> list[Mapping[str, float]]:
    """For every thing how likely it is of each kind, given all others.

    Args:
        alone: how likely it is of each kind by itself; kinds that are not there are impossible.
        carrier_of: for every thing the one that its foot is in; no thing carries itself, not even through others.
        lying: for every thing what its box says for its lying there; nothing by default.
    """
    if not alone:
        return []
    index = _INDEX
    unary = np.zeros((len(alone), len(index)))
    for row, of_one in zip(unary, alone, strict=True):
        for kind, share in of_one.items():
            row[index[kind]] = share
    edges = [_edge(of_one) for of_one in lying or [None] * len(alone)]
    explained = [_room_marginals(unary * usual, carrier_of, edges) for usual in _rooms()]
    says = SETTINGS.room_trust * np.array([log for _, log in explained])
    weight = np.exp(says - says.max())
    mixed = np.einsum("t,tnk->nk", weight / weight.sum(), np.stack([beliefs for beliefs, _ in explained]))
    return [{kind: float(row[index[kind]]) for kind in of_one} for row, of_one in zip(mixed, alone, strict=True)]


def _edge(lying: Lying | None) -> Float[np.ndarray, "k k"]:
    """How well every kind of a thing (row) goes with every kind of its carrier (column)."""
    other_shares = _together()
    if lying is not None:
        rows, columns = ([_INDEX[kind] for kind in kinds] for kinds in (lying.kinds, lying.carrier_kinds))
        other_shares = other_shares.copy()
        other_shares[np.ix_(rows, columns)] *= lying.ratio
    return (1.0 - SETTINGS.lies_on_it) + SETTINGS.lies_on_it * other_shares


def _room_marginals(
    unary: Float[np.ndarray, "n k"], carrier_of: Sequence[int | None], edges: Sequence[Float[np.ndarray, "k k"]]
) -> tuple[Float[np.ndarray, "n k"], float]:
    """Marginals in one type of room, and the logarithm of how well it explains everything."""
    upward, inward = np.ones_like(unary), unary.copy()
    order = _children_first(carrier_of)
    logs: list[float] = []
    messages: list[list[np.ndarray]] = [[] for _ in unary]
    for i in order:  # what everything on a thing says of it, up to the things that nothing carries
        if messages[i]:  # sorted: the order of the objects must not show in a bit
            inward[i] *= np.sort(np.stack(messages[i]), axis=0).prod(axis=0)
        total = inward[i].sum()
        inward[i] /= total
        logs.append(float(np.log(total)))
        parent = carrier_of[i]
        if parent is not None:
            upward[i] = inward[i] @ edges[i]
            messages[parent].append(upward[i])
    beliefs = inward.copy()
    for i in reversed(order):  # and back down again
        parent = carrier_of[i]
        if parent is not None:
            without = beliefs[parent] / upward[i]
            beliefs[i] = inward[i] * (edges[i] @ (without / without.sum()))
            beliefs[i] /= beliefs[i].sum()
    return beliefs, fsum(logs)


def _children_first(carrier_of: Sequence[int | None]) -> list[int]:
    """All indices, every one before its carrier."""

    def depth(i: int | None) -> int:
        return 0 if i is None else 1 + depth(carrier_of[i])

    return sorted(range(len(carrier_of)), key=lambda i: -depth(i))


@cache
def _frequency() -> Float[np.ndarray, "k"]:
    """Frequency of every kind among all things."""
    shares = meanings(UNKNOWN.name, UNKNOWN.name)
    return np.array([shares.get(name, 0.0) for name in _NAMES])


@cache
def _together() -> Float[np.ndarray, "k k"]:
    """How many times more often a thing of each kind (row) lies on one of each kind (column) than it is met at all."""
    names, index = _NAMES, _INDEX
    lies = np.array([category(name).mount == "surface" for name in names])
    ratio = np.ones((len(names), len(names)))
    for carrier, like in CARRIES_AS.items():
        loads = {kind: often[like] for kind, often in column("lies_on").items() if like in often}
        ratio[:, index[carrier]] = np.where(lies, SELDOM_CARRIED, HARDLY_CARRIED)
        ratio[[index[kind] for kind in loads], index[carrier]] = list(loads.values())
    return np.where(_carriers(), 1.0, SETTINGS.no_carrier) * ratio / (_frequency() @ ratio)


@cache
def _carriers() -> Bool[np.ndarray, "k"]:
    """Which kinds carry things."""
    return np.isin(_NAMES, list(CARRIES_AS))


@cache
def _rooms() -> tuple[Float[np.ndarray, "k"], ...]:
    """For every type of room how many times more often each kind is met there."""
    rooms = []
    for kinds in ROOMS.values():
        ratio = np.array([SETTINGS.at_home if name in kinds else 1.0 for name in _NAMES])
        rooms.append(ratio / float(_frequency() @ ratio))
    return tuple(rooms)
