"""Several photos of a room: the rows of the table, the pictures, and a whole run of one room."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from jaxtyping import Float

from diorama_core.artefacts import LabelledBox
from diorama_core.evaluation.benchmarks import views
from diorama_core.evaluation.benchmarks.cases import Case, LeftOut, recipe
from diorama_core.evaluation.benchmarks.views import ALONE, SPHERE, RoomView, ViewsBench, ViewsResult, photograph, run
from diorama_core.evaluation.metrics.pose import Alignment
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import SceneObject
from diorama_core.synthesis.sphere import SphereTruth, sphere_photo
from diorama_core.synthesis.splits import split_library
from diorama_core.synthesis.truth import Studio
from tests.few_marked import few_marked
from tests.few_shapes import few_shapes
from tests.made_once import made_once
from tests.multiview.two_photos import SMALL, AsItIs


def result(case: str, way: str, acc: float, count: int, failure: str = "") -> ViewsResult:
    return ViewsResult(case, way, Alignment("object-focus", count, 0.9, 0.8, 0.7, acc), 2.0, failure)


def test_rooms_count_by_their_objects_and_failures_are_told() -> None:
    rows = (result("a", ALONE, 0.2, 10), result("b", ALONE, 0.5, 5), result("a", "2 photos", 0.0, 10, "it broke"))
    (table,) = ViewsBench(rows, (LeftOut("c", "too small"),)).tables()
    assert [r.name for r in table.rows] == [ALONE, "2 photos"]
    assert table.rows[0].values[0] == pytest.approx(0.3)
    assert table.rows[0].values[4] == 15
    assert "1 builds failed" in table.note
    assert "c (too small)" in table.note
    assert ViewsBench(rows).to_json()["scenes"][2]["failure"] == "it broke"


SEED = 38


@cache
def pictures() -> tuple[RoomView, ...]:
    """Pictures of the first room of a series, from two places."""
    tested = split_library(built_in_library(), "test")
    return made_once("two views", lambda: photograph(recipe(1, 1, SEED)[0], tested, 2, SMALL))


def test_pictures_show_one_room_from_different_places() -> None:
    first, second = pictures()
    assert set(first.truth.indices) & set(second.truth.indices)
    assert ((first.camera.position - second.camera.position) ** 2).sum() > 0.04


MARKED = 2
"""Objects of the first picture that are marked, in both where both show them: a quarter of the work of all."""


def marked(case: Case, library: ShapeLibrary, count: int) -> tuple[RoomView, ...]:
    """The pictures of a case in which few things are marked."""
    assert (case, count) == (recipe(1, 1, SEED)[0], 2)
    first, further = (view.truth.indices for view in pictures())
    chosen = sorted(first, key=lambda k: k not in further)[:MARKED]

    def few(view: RoomView) -> RoomView:
        inputs, scene = view.truth.inputs, view.truth.scene
        boxes = {scene.objects[k].box_px for k in chosen}
        objects = [o if k in chosen else replace(o, mask_id=None, box_px=None) for k, o in enumerate(scene.objects)]
        truth = replace(view.truth, scene=replace(scene, objects=tuple(objects)), inputs=few_marked(inputs, boxes))
        return replace(view, truth=truth)

    return tuple(few(v) for v in pictures())


@dataclass(frozen=True, eq=False)
class FewMarked(SphereTruth):
    """A 360 degree photo in which few objects are marked."""

    def boxes(self, objects: Sequence[SceneObject]) -> dict[int, LabelledBox]:
        return dict(list(super().boxes(objects).items())[:MARKED])


def marked_sphere(studio: Studio, T_world_sphere: Float[np.ndarray, "4 4"]) -> FewMarked:
    seen = sphere_photo(studio, T_world_sphere, 1024)
    return FewMarked(seen.rgb, seen.object_ids, seen.T_world_sphere)


@pytest.mark.slow
def test_a_room_is_built_from_two_photos(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(views, "photograph", marked)
    monkeypatch.setattr(views, "sphere_photo", marked_sphere)
    monkeypatch.setattr(views, "layout_recipe", lambda *given, **more: AsItIs())
    monkeypatch.setattr(
        views, "split_library", lambda whole, *of: few_shapes() if len(of) > 1 else split_library(whole, *of)
    )
    bench = run(built_in_library(), 1, SEED, counts=(2,))
    assert [r.way for r in bench.results] == [ALONE, "2 photos with their cameras", SPHERE]
    assert all(not r.failure for r in bench.results)
    assert bench.results[1].own.count == MARKED
    assert bench.results[2].room > 0.8
