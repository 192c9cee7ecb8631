"""Which of the networks on a machine takes a stage."""

from __future__ import annotations

from pathlib import Path

import onnxruntime
import pytest

from diorama_core.models.manifest import NETWORKS, network
from diorama_core.models.store import ModelStore
from diorama_core.pipeline import network_stages
from diorama_core.pipeline.choices import DEPTH_NETWORKS, DETECTORS, ROUGH_DEPTH, SEGMENTERS, best_here, profile_status
from tests.models.tiny_networks import install


@pytest.fixture
def store(tmp_path: Path) -> ModelStore:
    return ModelStore(tmp_path / "models")


def _put(store: ModelStore, folder: Path, *ids: str) -> None:
    file = folder / "some.onnx"
    file.write_bytes(b"not looked at")
    for network_id in ids:
        install(store, network_id, [file] * len(network(network_id).files))


def _offer(monkeypatch: pytest.MonkeyPatch, *names: str) -> None:
    monkeypatch.setattr(onnxruntime, "get_available_providers", lambda: [*names, "CPUExecutionProvider"])


def test_every_choice_is_a_network_of_its_role() -> None:
    for role, ids in {
        "detection": DETECTORS,
        "segmentation": SEGMENTERS,
        "geometry": (*DEPTH_NETWORKS, *ROUGH_DEPTH),
    }.items():
        assert {n.id for n in NETWORKS if n.role == role} == set(ids)


def test_half_precision_is_taken_on_cuda_and_nowhere_else(
    store: ModelStore, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert best_here(store, DETECTORS) is None
    _put(store, tmp_path, "yolox-nano", "owlv2-base", "owlv2-base-fp16")
    for offered, expected in {
        "CUDAExecutionProvider": "owlv2-base-fp16",
        "DmlExecutionProvider": "owlv2-base",
        "CoreMLExecutionProvider": "owlv2-base",
    }.items():
        _offer(monkeypatch, offered)
        found = best_here(store, DETECTORS)
        assert found is not None
        assert found.id == expected
    _offer(monkeypatch, "CUDAExecutionProvider")
    monkeypatch.setenv("DIORAMA_DEVICE", "cpu")
    assert best_here(store, DETECTORS) == network("owlv2-base")
    store.forget(network("owlv2-base"))
    assert best_here(store, DETECTORS) == network("owlv2-base-fp16")
    assert not next(s for s in profile_status(store=store) if s.stage == "detection").advice, "as good as the full one"


def test_a_better_network_wins_over_half_precision(
    store: ModelStore, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _offer(monkeypatch, "CUDAExecutionProvider")
    _put(store, tmp_path, "owlv2-large", "owlv2-base-fp16")
    assert best_here(store, DETECTORS) == network("owlv2-large")


@pytest.mark.parametrize(
    ("network_id", "described"),
    [("sam3-tracker", "side=1008"), ("hq-sam-base", "HqSam"), ("sam2.1-base-plus-fp16", "side=1024")],
)
def test_segmenters_are_made_of_their_files(store: ModelStore, tmp_path: Path, network_id: str, described: str) -> None:
    _put(store, tmp_path, network_id)
    made = network_stages.segmenter(store, network(network_id))
    assert described in repr(made)
    assert network_id in repr(made)
    encoder, decoder = (getattr(made, part).name for part in ("encoder", "decoder"))
    assert "encoder" in encoder
    assert "decoder" in decoder
    assert encoder != decoder


def test_depth_anything_is_made_of_its_file(store: ModelStore, tmp_path: Path) -> None:
    _put(store, tmp_path, "da3-metric-large")
    made = network_stages.depth_network(store, network("da3-metric-large"))
    assert "DepthAnything3" in repr(made)
