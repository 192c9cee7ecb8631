"""All headings of a room in one inference: message passing over the objects and the terms that join them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from diorama_core.arrangement.facing.evidence import HEADINGS, STEP_RAD, FacingRoom, HeadingCosts
from diorama_core.arrangement.facing.terms import TERMS, FacingWeights, Term, pairs_of
from diorama_core.artefacts import Reason

PICTURE = "picture"
ROUNDS, DAMPING = 20, 0.5
"""Rounds of messages, and how much of the earlier ones stays: rooms have few circles, which settle in ten."""


CLEARLY_OTHER = 3
"""Steps beyond which a heading is another reading: 45 degrees, from which on a front counts as wrong."""


@dataclass(frozen=True, eq=False)
class Factors:
    """A room's terms in their own units, before their weights."""

    room: FacingRoom
    ones: tuple[tuple[str, int, Float[np.ndarray, "24"]], ...]
    pairs: tuple[tuple[str, int, int, Float[np.ndarray, "24 24"]], ...]

    @classmethod
    def of(cls, room: FacingRoom, terms: Sequence[Term] = TERMS) -> Factors:
        """All terms of a room."""
        count = range(len(room.objects))
        single = [(t.name, i, t.one(room, i)) for t in terms if t.one is not None for i in count]
        ones = [(name, i, pair) for name, i, pair in single if pair is not None]
        ones += [(PICTURE, i, item.picture) for i, item in enumerate(room.objects)]
        return cls(room, tuple(ones), tuple((t.name, *pair) for t in terms for pair in pairs_of(room, t)))


@dataclass(frozen=True, eq=False)
class Facings:
    """The headings that agree best, together."""

    room: FacingRoom
    headings: Int[np.ndarray, "n"]
    costs: Float[np.ndarray, "n 24"]
    """Cost of each heading from all terms and from the other objects, without the object's own picture; 0 for the best
    heading, in the units of `FacingObject.picture`."""
    likely: Float[np.ndarray, "n 24"]
    """Logarithms of how likely headings are by everything, up to a constant for each object."""
    shares: tuple[Reason, ...]
    """Why, term by term."""

    def costs_of(self, object_id: str) -> HeadingCosts:
        """The costs of one object's headings."""
        k = self._index(object_id)
        return HeadingCosts(self.room.objects[k].yaw_rad, self.costs[k])

    def probabilities_of(self, object_id: str) -> tuple[float, ...]:
        """Probabilities of headings of one object, from +X of the world on, to the nearest of them."""
        k = self._index(object_id)
        shares = np.exp(self.likely[k] - self.likely[k].max())
        turned = np.roll(shares / shares.sum(), round(self.room.objects[k].yaw_rad / STEP_RAD))
        return tuple(turned.tolist())

    def _index(self, object_id: str) -> int:
        return next(k for k, item in enumerate(self.room.objects) if item.object_id == object_id)


def solve(room: FacingRoom, weights: FacingWeights) -> Facings:
    """The likeliest headings of all objects together, by damped max-product messages."""
    factors = Factors.of(room)
    unary, context = beliefs(factors, weights)
    headings = (unary + context).argmax(axis=1)
    costs = (context.max(axis=1, keepdims=True) - context) / weights.picture
    return Facings(room, headings, costs, unary + context, _shares(factors, weights, headings, unary + context))


def beliefs(factors: Factors, weights: FacingWeights) -> tuple[Float[np.ndarray, "n 24"], Float[np.ndarray, "n 24"]]:
    """For every object what its picture says of headings, and what everything else says, the others at their best."""
    count = len(factors.room.objects)
    picture, single = np.zeros((count, HEADINGS)), np.zeros((count, HEADINGS))
    for name, i, values in factors.ones:
        (picture if name == PICTURE else single)[i] += weights.weight_of(name) * values
    tables: dict[tuple[int, int], np.ndarray] = {}
    for name, i, j, values in factors.pairs:
        for a, b, table in ((i, j, values), (j, i, values.T)):
            tables[a, b] = tables.get((a, b), 0.0) + weights.weight_of(name) * table
    messages = {edge: np.zeros(HEADINGS) for edge in tables}  # from the second to the first
    incoming = np.zeros((count, HEADINGS))
    for _ in range(ROUNDS if tables else 0):
        total = picture + single + incoming
        new = {}
        for (a, b), table in tables.items():
            best = (table + (total[b] - messages[b, a])[None]).max(axis=1)
            new[a, b] = DAMPING * messages[a, b] + (1 - DAMPING) * (best - best.max())
        messages, incoming = new, np.zeros((count, HEADINGS))
        for (a, _), message in messages.items():
            incoming[a] += message
    return picture, single + incoming


def _shares(
    factors: Factors, weights: FacingWeights, headings: Int[np.ndarray, "n"], total: Float[np.ndarray, "n 24"]
) -> tuple[Reason, ...]:
    """What every term says for the chosen headings rather than the likeliest clearly other ones, the others given."""
    sentences = {t.name: t.sentence for t in TERMS} | {PICTURE: "the picture shows it so"}
    off = np.abs((np.arange(HEADINGS) - headings[:, None] + HEADINGS // 2) % HEADINGS - HEADINGS // 2)
    rivals = np.where(off > CLEARLY_OTHER, total, -np.inf).argmax(axis=1)
    shares: dict[tuple[int, str], float] = {}
    terms_of_pair = [(i, name, values) for name, i, values in factors.ones]
    for name, i, j, table in factors.pairs:
        terms_of_pair += [(i, name, table[:, headings[j]]), (j, name, table[headings[i]])]
    for i, name, values in terms_of_pair:
        nats = weights.weight_of(name) * float(values[headings[i]] - values[rivals[i]])
        shares[i, name] = shares.get((i, name), 0.0) + nats
    ids = [item.object_id for item in factors.room.objects]
    return tuple(
        Reason(ids[i], "front", name, nats, "nats", sentences[name]) for (i, name), nats in shares.items() if nats
    )
