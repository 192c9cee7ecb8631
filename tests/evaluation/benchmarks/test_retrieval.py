"""Halves of the query alone: words by a text search, looks among the kind's shapes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diorama_core.evaluation.benchmarks.retrieval import (
    ALONE,
    MISSED,
    RetrievalResult,
    _alone,
    _distances,
    _ranks,
    embedding_stages,
    retrieval_table,
)
from diorama_core.geometry.shape_appearance import appearance_of
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.synthesis.layout_rooms import BoxLibrary, box_library
from diorama_core.synthesis.truth import TruthView
from tests.evaluation.truth import view_of_boxes

LIBRARY: BoxLibrary = box_library()


@pytest.fixture(scope="module")
def view() -> TruthView:
    return view_of_boxes()


@pytest.mark.parametrize("name", ALONE)
def test_each_half_finds_shapes_of_the_kind_for_every_object(name: str, view: TruthView) -> None:
    found = _alone(name, LIBRARY, view)
    for index in view.indices:
        item = view.scene.objects[index]
        assert item.category in {LIBRARY.shape(s).category for s in found[item.id]}


def test_the_nearest_of_five_counts_and_nothing_is_far(view: TruthView) -> None:
    true = view.scene.objects[view.indices[0]].shape_id
    others = [s.id for s in LIBRARY.shapes() if s.id != true][:5]
    assert _distances(true, (*others[:4], true), LIBRARY)[1] == pytest.approx(0.0, abs=1e-6)
    assert _distances(true, (*others, true), LIBRARY)[1] > 0.0
    assert _distances(true, (), LIBRARY) == (MISSED, MISSED)


class ByColour:
    """A stand-in for the networks: mean colours for pictures and shapes, the same for all words."""

    weights = "stand-in"

    def text(self, text: str) -> np.ndarray:
        return np.ones(3, np.float32) / np.sqrt(np.float32(3))

    def picture(self, rgb: np.ndarray) -> np.ndarray:
        mean = rgb.reshape(-1, 3).mean(axis=0) + 1.0
        return (mean / np.linalg.norm(mean)).astype(np.float32)

    def shape(self, library: ShapeLibrary, shape: Shape) -> np.ndarray:
        mean = appearance_of(library.parts(shape.id)).face_rgba[:, :3].mean(axis=0) + 1.0
        return (mean / np.linalg.norm(mean)).astype(np.float32)


def test_each_network_gets_the_publications_rows(
    view: TruthView, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DIORAMA_CACHE", str(tmp_path))
    stages = embedding_stages({"CLIP": ByColour(), "OS": ByColour(), "DD": ByColour()})
    assert list(stages) == ["CLIP-H", "OS-H", "DD-T", "DD-V", "DD-H"]
    for stage in stages.values():
        found = _ranks(stage(LIBRARY), view)
        assert all(len(found[view.scene.objects[index].id]) >= 5 for index in view.indices)


def test_a_row_for_each_half_and_network() -> None:
    alone = (("words alone", 6.0, 7.0), ("OS-H", 1, 2))
    item = RetrievalResult("r", "a", "chair", ("furniture",), 5.0, 4.0, 9.0, 8.0, 2, True, False, alone)
    row = retrieval_table([item]).row("words alone, best of 5")
    assert (row["furniture SS"], row["furniture OOD"], row["household SS"]) == (6.0, 7.0, None)
    assert retrieval_table([item]).row("OS-H, best of 5")["furniture OOD"] == 2.0
