"""Settings by name: found within the stages, changed without touching anything else, wrong names said."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.artefacts import Inputs, Photo
from diorama_core.errors import InputError
from diorama_core.layout.settings import LAYOUT, REFINEMENT
from diorama_core.library.catalogue import built_in_library
from diorama_core.pipeline.settings import settings_of, with_settings
from diorama_core.pipeline.stages import embedded_stages


@pytest.fixture(scope="module")
def stages():
    photo = Photo(np.zeros((48, 64, 3), np.uint8), "p.png", (64, 48))
    return embedded_stages(Inputs(photo), built_in_library())


def test_numbers_within_stages_have_names(stages):
    known = settings_of(stages)
    assert known["layout.weights.outline"] == stages.layout.weights.outline
    assert known["layout.rounds"] == stages.layout.rounds
    assert known["layout.settings.max_stretch"] == LAYOUT.max_stretch
    assert known["refinement.settings.sigma"] == REFINEMENT.sigma
    assert known["retrieval.settings.similarity.edges"] == stages.retrieval.settings.similarity.edges
    assert all(isinstance(value, (int, float)) for value in known.values())


def test_other_values_change_the_stage_and_so_its_key(stages):
    changed = with_settings(stages, {"layout.weights.outline": 3, "layout.rounds": 2.0})
    assert (changed.layout.weights.outline, changed.layout.rounds) == (3.0, 2)
    assert isinstance(changed.layout.rounds, int)
    assert repr(changed.layout) != repr(stages.layout)
    assert changed.pose is stages.pose


def test_unknown_names_are_said(stages):
    with pytest.raises(InputError, match=r"layout.weights.nothing: the stages have no such setting; there are"):
        with_settings(stages, {"layout.weights.nothing": 1.0})


def test_an_optional_stage_is_left_out_by_its_name(stages):
    assert settings_of(stages)["naming"] == 1.0
    assert with_settings(stages, {"naming": 0}).naming is None
    assert with_settings(stages, {"naming": 1}) == stages
    with pytest.raises(InputError, match="pose: the stages have no such setting"):
        with_settings(stages, {"pose": 0})


def test_numbers_of_retrieval_are_settings_of_its_stage(stages):
    name = "retrieval.settings.pools.related_factor"
    changed = with_settings(stages, {name: 0.1})
    assert changed.retrieval.settings.pools.related_factor == 0.1
    assert repr(changed.retrieval) != repr(stages.retrieval)
