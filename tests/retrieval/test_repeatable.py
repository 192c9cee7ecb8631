"""Retrieval is the same to the bit in every process: whatever hash seed, thread count, order and state of the cache."""

from __future__ import annotations

import json
import os
import pickle
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from diorama_core.geometry.shape_appearance import SHARED_APPEARANCES
from diorama_core.io.cache import LruCache
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import Shape
from diorama_core.perception.inputs import read_inputs
from diorama_core.pipeline.stages import embedded_stages
from diorama_core.progress import Progress
from diorama_core.retrieval import feature_cache
from diorama_core.retrieval.hierarchical import HierarchicalRetrieval
from diorama_core.synthesis.splits import Subset

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "assets" / "example"
EACH_KIND = 3
LOOKED_FOR = ("chair", "plant", "lamp", "bowl")
CHILD = "import sys; from tests.retrieval.test_repeatable import answer; sys.stdout.write(answer(sys.argv[1]))"

Answer = list[tuple[str, list[tuple[str, str]]]]


@cache
def few_shapes() -> Subset:
    """Some shapes of each kind that is looked for, and no others."""
    library = built_in_library()
    chosen: list[Shape] = [s for name in LOOKED_FOR for s in library.in_category(name)[:EACH_KIND]]
    return Subset(library, frozenset(s.id for s in chosen))


def answer(pickled: str) -> str:
    """What retrieval says about the artefacts in a file, every bit of the scores included, as JSON."""
    inputs, objects, geometry = pickle.loads(Path(pickled).read_bytes())
    found = HierarchicalRetrieval(few_shapes()).retrieve(inputs, objects, geometry, Progress())
    return json.dumps([(r.object_id, [(shape, score.hex()) for shape, score in r.ranked]) for r in found])


def elsewhere(pickled: Path, cache: Path) -> Answer:
    """A result from another process, with another hash seed and more threads."""
    counts = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "4")
    settings = {"DIORAMA_CACHE": str(cache), "PYTHONHASHSEED": "1", "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-c", CHILD, str(pickled)],
        env={**os.environ, **counts, **settings},
        capture_output=True,
        text=True,
        check=True,
        timeout=240,
    )
    return said(done.stdout)


def said(answered: str) -> Answer:
    return [(name, [(shape, score) for shape, score in ranked]) for name, ranked in json.loads(answered)]


@pytest.fixture(scope="module")
def artefacts(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example's photo, and what the embedded stages make of some boxes, three chairs among them, in a file."""
    folder = tmp_path_factory.mktemp("example")
    boxes = json.loads((EXAMPLE / "boxes.json").read_text())["boxes"]
    (folder / "boxes.json").write_text(json.dumps([b for b in boxes if b["class"] in LOOKED_FOR]))
    inputs = read_inputs(EXAMPLE / "photo.jpg", boxes=folder / "boxes.json").inputs
    stages = embedded_stages(inputs, few_shapes())
    camera = stages.camera.estimate(inputs, Progress())
    objects = stages.objects.segment(inputs, Progress())
    geometry = stages.geometry.measure(inputs, camera, objects, Progress())
    path = folder / "artefacts.pickle"
    path.write_bytes(pickle.dumps((inputs, objects, geometry)))
    return path


def test_ranks_and_scores_are_the_same_bits_in_every_process(
    artefacts: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shared, own = tmp_path / "shared", tmp_path / "own"
    cold = elsewhere(artefacts, shared)
    assert len(cold) > len(LOOKED_FOR)
    assert all(len(ranked) >= EACH_KIND for _, ranked in cold)
    retained = sorted(shared.rglob("*.npy"))
    assert len(retained) >= len(LOOKED_FOR) * EACH_KIND
    for folder in (own, shared):  # features and looks made again here, and read back
        monkeypatch.setenv("DIORAMA_CACHE", str(folder))
        monkeypatch.setattr(feature_cache, "_CACHE", LruCache(64))
        monkeypatch.setattr(SHARED_APPEARANCES, "_cached", LruCache(64))
        assert said(answer(str(artefacts))) == cold
    assert [k.read_bytes() for k in retained] == [(own / k.relative_to(shared)).read_bytes() for k in retained]


def test_the_order_in_which_objects_come_changes_nothing_for_any_of_them(artefacts: Path) -> None:
    inputs, objects, geometry = pickle.loads(artefacts.read_bytes())
    stage = HierarchicalRetrieval(few_shapes())
    found = {r.object_id: r for r in stage.retrieve(inputs, objects, geometry, Progress())}
    turned = replace(geometry, cuboids=geometry.cuboids[::-1])
    again = stage.retrieve(inputs, objects[::-1], turned, Progress())
    assert [r.object_id for r in again] == [o.id for o in objects[::-1]]
    for one in again:
        assert one.ranked == found[one.object_id].ranked
        assert np.isfinite([score for _, score in one.ranked]).all()
