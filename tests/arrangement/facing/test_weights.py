"""The fitted weights and what is told of them."""

from __future__ import annotations

import json
from dataclasses import asdict

from diorama_core.arrangement.facing.weights import PATH, facing_weights


def test_every_weight_is_fitted_and_says_what_leaving_it_out_costs() -> None:
    document = json.loads(PATH.read_text())
    weights = asdict(facing_weights())
    assert all(weight > 0 for weight in weights.values())
    assert document["command"].startswith("python -m diorama_core.training facings")
    assert set(document["change of that without a term"]) == set(weights)
