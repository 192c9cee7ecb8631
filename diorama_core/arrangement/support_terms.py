"""What speaks against a supporter: one small function a term, all with fitted weights in nats.

Weights are the maximum-likelihood fit of a conditional logit over all hypotheses of each object, made by
`scripts/fit_supports.py`; `support_weights.json` says on what, and what leaving each term out costs.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from diorama_core.arrangement.support_hypotheses import SupportHypothesis
from diorama_core.library.labels import with_article
from diorama_core.library.taxonomy import PORTABLE, often_carried

PATH = Path(__file__).with_name("support_weights.json")
FAR_TOLERANCES = 5.0
"""Gaps beyond the tolerance count up to this many tolerances: what is that far away is just elsewhere."""
FAR_WIDTHS = 0.5
LEAST_OFTEN, MOST_OFTEN = -2.5, 2.7
"""Bounds of the logarithm of how often a kind lies on another: the counts are rough."""


_USUALLY = {"floor": "the floor", "surface": "furniture", "wall": "a wall", "ceiling": "the ceiling"}


@dataclass(frozen=True)
class SupportTerm:
    """One reason for or against a supporter."""

    name: str
    sentence: str
    """Says it to a person; `{kind}` and `{carrier}` are replaced."""
    value: Callable[[SupportHypothesis], float]


def gap(h: SupportHypothesis) -> float:
    """Distance of the object from the supporter beyond the tolerance of its observed pose."""
    return float(np.clip(h.gap - 1.0, 0.0, FAR_TOLERANCES)) / FAR_TOLERANCES


def distance_beside(h: SupportHypothesis) -> float:
    """Distance of an object from the wall or ceiling that it is beside, as a share of `FAR_WIDTHS`."""
    return min(h.outside, FAR_WIDTHS) / FAR_WIDTHS if h.role in ("wall", "ceiling") else 0.0


def company(h: SupportHypothesis) -> float:
    """How seldom things of this kind lie on things of that kind."""
    if h.carrier is None:
        return 0.0
    often = float(np.log(max(often_carried(h.kind.name, h.carrier.name), 1e-3)))
    return -float(np.clip(often, LEAST_OFTEN, MOST_OFTEN))


def carries_nothing(h: SupportHypothesis) -> float:
    """Nobody puts things on it."""
    return float(h.carrier is not None and not h.carrier.supports_objects)


def hard_on_seat(h: SupportHypothesis) -> float:
    """Seats and beds carry soft things."""
    return float(h.carrier is not None and h.carrier.seat_height_m is not None and not h.kind.soft)


def portable(h: SupportHypothesis) -> float:
    """What usually stands on the floor and is small stands on furniture, too."""
    return float(h.carrier is not None and h.kind.mount == "floor" and h.kind.name in PORTABLE)


TERMS: tuple[SupportTerm, ...] = (
    SupportTerm("other belief", "boxes and depth say so", lambda h: float(not h.believed)),
    SupportTerm("gap", "it was seen there", gap),
    SupportTerm("beside", "it was seen in front of it", distance_beside),
    SupportTerm("turned", "its back is parallel to it", lambda h: h.turned),
    SupportTerm("averted", "the wall faces the camera", lambda h: float(h.averted)),
    SupportTerm("company", "{kind} is often on {carrier}", company),
    SupportTerm("carries nothing", "people put objects on {carrier}", carries_nothing),
    SupportTerm("hard on seat", "{carrier} is no seat", hard_on_seat),
    SupportTerm("portable", "{kind} is small enough to stand on furniture", portable),
    SupportTerm("seen below", "it is seen just below", lambda h: h.below),
    SupportTerm("foot in box", "its lower end is within its outline", lambda h: float(h.foot_in_box)),
)
"""Every term but the usual places of kinds (`place_name`), which have one weight a place."""


USUAL_PLACE = "usual place"
"""Name of what `place_name` says."""


def sentence_of(term: str, h: SupportHypothesis) -> str:
    """What a term says for a supporter, in plain words; empty where it is about carriers and this is none."""
    if term == USUAL_PLACE:
        return f"{with_article(h.kind.name)} is usually on {_USUALLY[h.kind.mount]}"
    sentence = next(t.sentence for t in TERMS if t.name == term)
    if h.carrier is None and "{carrier}" in sentence:
        return ""
    carrier = "" if h.carrier is None else with_article(h.carrier.name)
    return sentence.format(kind=with_article(h.kind.name), carrier=carrier)


def place_name(h: SupportHypothesis) -> str:
    """How a kind is usually mounted, and where it would be: each pair has a weight of its own."""
    return f"{h.kind.mount} kind on {h.role}"


@dataclass(frozen=True)
class SupportWeights:
    """Weights of all terms, nats."""

    terms: Mapping[str, float]
    places: Mapping[str, float]
    walls: Mapping[str, Mapping[str, float]]
    """For standing against a wall (`standing.STANDING_TERMS`), with measured distances and with reasoned ones."""

    def shares(self, h: SupportHypothesis) -> dict[str, float]:
        """What each term says against a supporter, nats."""
        shares = {term.name: self.terms.get(term.name, 0.0) * term.value(h) for term in TERMS}
        return {USUAL_PLACE: self.places.get(place_name(h), 0.0), **shares}

    def cost(self, h: SupportHypothesis) -> float:
        """Everything that speaks against a supporter, nats."""
        return sum(self.shares(h).values())


@cache
def support_weights() -> SupportWeights:
    """The weights that come with the program."""
    weights = json.loads(PATH.read_text(encoding="utf-8"))
    return SupportWeights(weights["terms"], weights["places"], weights["walls"])
