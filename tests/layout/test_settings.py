from __future__ import annotations

from dataclasses import fields, replace
from functools import cache

import numpy as np
import pytest

from diorama_core.artefacts import LayoutReport
from diorama_core.errors import InputError
from diorama_core.layout.published.staged import StageSchedule
from diorama_core.layout.recipes import NAMES, recipe
from diorama_core.layout.settings import AS_IT_IS, DEFAULT_COSTS, PUBLISHED_COSTS, Weights, cost_names
from diorama_core.progress import Progress
from diorama_core.protocols import LayoutStage
from diorama_core.scene.types import Camera, Intrinsics, Scene
from diorama_core.synthesis.layout_rooms import box_library, generate_room

LIBRARY = box_library()


def observed() -> Scene:
    scene = generate_room(3, 8).observed
    T = np.eye(4)
    T[:3, :3] = np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]])
    T[:3, 3] = scene.architecture.planes[0].polygon.mean(axis=0) + np.array([0.1, -2.0, 1.5])
    return replace(scene, camera=Camera(Intrinsics.from_fov(640, 480, 1.2), T))


def brief(name: str, weights: Weights = AS_IT_IS) -> LayoutStage:
    """A recipe; all terms at once take a quarter of their steps, which are slow."""
    made = recipe(name, LIBRARY, weights=weights)
    return replace(made, schedule=StageSchedule(steps=100, decay_every=25)) if name == "all-in-one" else made


@cache
def as_it_is(name: str) -> tuple[Scene, LayoutReport, set[str]]:
    """What a recipe makes of the scene without other weights, and the costs that it tells on the way."""
    told: set[str] = set()
    scene, report = brief(name).optimise(observed(), Progress(), lambda _, costs: told.update(n for n, _ in costs))
    return scene, report, told


@pytest.mark.parametrize("name", NAMES)
def test_weights_of_one_are_the_recipe_as_it_is(name: str) -> None:
    ones = Weights(**{f.name: 1.0 for f in fields(Weights)})
    weighted, _ = brief(name, ones).optimise(observed(), Progress())
    assert as_it_is(name)[0] == weighted


@pytest.mark.parametrize(
    ("name", "cost"),
    [("paper", c) for c in PUBLISHED_COSTS] + [("all-in-one", "place"), *(("feasible", c) for c in DEFAULT_COSTS)],
)
def test_every_weight_makes_a_difference_to_its_recipe(name: str, cost: str) -> None:
    assert cost in cost_names(name)
    plain = as_it_is(name)[0]
    changed, _ = brief(name, replace(AS_IT_IS, **{cost: 0.0})).optimise(observed(), Progress())
    far = [np.abs(o.pose.matrix - plain.object(o.id).pose.matrix).max() for o in changed.objects]
    assert max(far) > 1e-4


def test_without_the_cost_of_touching_objects_float() -> None:
    _, loose = recipe("paper", LIBRARY, weights=Weights(place=0.0)).optimise(observed(), Progress())
    assert as_it_is("paper")[1].after["placement"] > 0.9 > loose.after["placement"]


@pytest.mark.parametrize("name", NAMES)
def test_every_cost_is_told_while_it_runs(name: str) -> None:
    assert as_it_is(name)[2] == ({"overlap_m", "moved_m"} if name == "feasible" else set(PUBLISHED_COSTS))


@pytest.mark.parametrize("value", [-1.0, 11.0, float("nan")])
def test_absurd_weights_are_refused(value: float) -> None:
    with pytest.raises(InputError, match="weight of align"):
        Weights(align=value)
