"""Settings by name: found within the stages, changed without touching anything else, wrong names said."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from diorama_core.architecture.single_view import settings as photo_room
from diorama_core.architecture.walls import settings as walls
from diorama_core.artefacts import Inputs, Photo
from diorama_core.errors import InputError
from diorama_core.layout.settings import LAYOUT, REFINEMENT
from diorama_core.library.catalogue import built_in_library
from diorama_core.perception.camera import vanishing as lines
from diorama_core.perception.measured import cloud as measured_objects
from diorama_core.perception.metrology import settings as metrology
from diorama_core.pipeline.settings import settings_of, with_settings
from diorama_core.pipeline.stages import Stages, embedded_stages
from diorama_core.pose import settings as posing
from diorama_core.retrieval import settings as retrieval


@cache
def stages_for(measured: bool) -> Stages:
    photo = Photo(np.zeros((48, 64, 3), np.uint8), "p.png", (64, 48))
    return embedded_stages(
        Inputs(photo, depth_m=np.ones((48, 64), np.float32) if measured else None), built_in_library()
    )


@pytest.fixture(scope="module")
def stages():
    return stages_for(measured=False)


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


@pytest.mark.parametrize(
    ("measured", "name", "owner", "other"),
    [
        (False, "retrieval.settings.pools.related_factor", retrieval.SETTINGS.pools, 0.1),
        (False, "camera.settings.few_segments", lines.SETTINGS, 7.0),
        (False, "geometry.settings.placement.sure_cost", metrology.SETTINGS.placement, 11.0),
        (False, "architecture.settings.search.clearance_m", photo_room.SETTINGS.search, 0.07),
        (True, "geometry.settings.voxel_m", measured_objects.SETTINGS, 0.05),
        (True, "architecture.settings.seen_through", walls.SETTINGS, 0.5),
        (True, "pose.settings.shapes.good_fit", posing.SETTINGS.shapes, 0.1),
        (True, "pose.stage.settings.search.fit_steps", posing.SETTINGS.search, 6.0),
    ],
)
def test_numbers_of_stages_are_settings_and_in_their_keys(measured, name, owner, other):
    stages = stages_for(measured)
    assert settings_of(stages)[name] == getattr(owner, name.rsplit(".", 1)[1]) != other
    changed = with_settings(stages, {name: other})
    assert settings_of(changed)[name] == other
    stage = name.split(".", 1)[0]
    assert repr(getattr(changed, stage)) != repr(getattr(stages, stage))
