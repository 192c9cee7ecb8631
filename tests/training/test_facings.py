"""Weights of headings fitted to rooms of known fronts."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from diorama_core.arrangement.facing.evidence import HEADINGS, FacingRoom
from diorama_core.arrangement.facing.solve import solve
from diorama_core.arrangement.facing.terms import FacingWeights
from diorama_core.training import facings
from diorama_core.training.facings import AS_TOLD, NAMES, FacingCase, FacingModel, as_settings, beginning, certificate
from tests.arrangement.facing.rooms import room, thing


def seen_from_behind(seed: int) -> FacingRoom:
    """Chairs before a table whose pictures say the contrary, as likely as not."""
    table = thing("table", 0.0, 3.0, (0.9, 3.0, 0.7), 90.0)
    picture = np.random.default_rng(seed).normal(0.0, 1.0, HEADINGS)
    return room(thing("chair", -0.7, 2.2, picture=picture), thing("chair", 0.7, 2.2, picture=picture), table)


def cases(count: int = 4) -> list[FacingCase]:
    away = np.isin(np.arange(HEADINGS), (9, 10, 11, 12, 13, 14, 15))
    return [FacingCase(f"photo {k}", seen_from_behind(k), {0: away, 1: away}) for k in range(count)]


def test_all_photos_at_once_decide_as_each_by_itself() -> None:
    model, weights = FacingModel(cases()), FacingWeights(**as_settings(beginning()))
    alone = [case.right[i][solve(case.room, weights).headings[i]] for case in cases() for i in (0, 1)]
    assert model.is_right(beginning()).tolist() == alone


def test_fitting_makes_what_was_annotated_likelier_and_leaves_what_is_told() -> None:
    model = FacingModel(cases())
    fitted = model.fit(beginning(), np.ones(8, bool))
    assert fitted[NAMES.index("at_table")] > beginning()[NAMES.index("at_table")]
    assert [float(fitted[NAMES.index(name)]) for name in AS_TOLD] == [2.0, 2.0]
    assert model.is_right(fitted).all()


def test_what_begins_at_nothing_stays_out() -> None:
    lacking = beginning()
    lacking[NAMES.index("at_table")] = 0.0
    assert FacingModel(cases(2)).fit(lacking, np.ones(4, bool))[NAMES.index("at_table")] == 0.0


def test_folds_are_of_photos_and_a_certificate_tells_every_term(monkeypatch: pytest.MonkeyPatch) -> None:
    model = FacingModel(cases(4))
    assert [model.fold(k, 2).tolist() for k in (0, 1)] == [
        [True, True, False, False] * 2,
        [False, False, True, True] * 2,
    ]
    monkeypatch.setattr(facings, "STEPS", 2)
    found = certificate(model, "command", 2)
    assert set(found["change of that without a term"]) == set(found["weights"]) == set(NAMES)
    assert found["fronts"] == 8
    torch.testing.assert_close(beginning()[0], torch.tensor(0.7, dtype=torch.float64))
