"""Weights of the terms; `weights.json` beside this module says how they were fitted and what leaving each out costs."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path

PATH = Path(__file__).with_suffix(".json")


@dataclass(frozen=True)
class FacingWeights:
    """Nats of every term's agreement (`terms.TERMS`); of the picture, a factor of its log-likelihood."""

    picture: float
    shown_seats: float
    shown_sofas: float
    shown_storage: float
    shown_screens: float
    shown_others: float
    at_table: float
    at_user: float
    back_at_wall: float
    back_at_wall_others: float
    out_of_wall: float
    as_told: float
    leaning: float
    at_middle: float
    as_carrier: float
    side_by_side: float
    as_bed: float

    def of(self, term: str) -> float:
        """The weight of a term."""
        return float(getattr(self, term))


@cache
def facing_weights() -> FacingWeights:
    """The fitted weights."""
    return FacingWeights(**json.loads(PATH.read_text(encoding="utf-8"))["weights"])
