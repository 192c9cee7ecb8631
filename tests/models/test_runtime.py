"""Where networks run and with how many threads, decided without a graphics card at hand."""

from __future__ import annotations

import os
import threading
import time
from pathlib import Path

import numpy as np
import onnx.parser
import onnxruntime
import pytest

from diorama_core.errors import Cancelled, UnavailableError
from diorama_core.models import runtime
from diorama_core.models.runtime import SessionPool, providers, thread_count
from diorama_core.progress import Progress
from tests.models import tiny_networks

CUDA, CPU = "CUDAExecutionProvider", "CPUExecutionProvider"


@pytest.fixture(autouse=True)
def _no_settings(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("DIORAMA_DEVICE", raising=False)
    monkeypatch.delenv("DIORAMA_THREADS", raising=False)


@pytest.mark.parametrize(
    ("offered", "setting", "chosen"),
    [
        ([CUDA, CPU], "", [CUDA, CPU]),
        ([CUDA, CPU], "cpu", [CPU]),
        (["TensorrtExecutionProvider", CUDA, CPU], "", [CUDA, CPU]),
        (["AzureExecutionProvider", CPU], "", [CPU]),
        ([CPU], "cuda", [CPU]),
        (["DmlExecutionProvider", CPU], "", ["DmlExecutionProvider", CPU]),
        (["CoreMLExecutionProvider", CPU], "", ["CoreMLExecutionProvider", CPU]),
    ],
    ids=["cuda", "cuda not wanted", "cuda among others", "no cuda", "cuda wanted in vain", "DirectML", "CoreML"],
)
def test_cuda_is_used_where_it_is_offered_and_wanted(
    monkeypatch: pytest.MonkeyPatch, offered: list[str], setting: str, chosen: list[str]
) -> None:
    monkeypatch.setattr(onnxruntime, "get_available_providers", lambda: offered)
    monkeypatch.setenv("DIORAMA_DEVICE", setting)
    assert providers() == chosen


class _Card:
    """Stands for onnxruntime with a card: loads on the processor, remembers what was asked, says where it runs."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, *, broken: bool) -> None:
        self.asked: list[list[str]] = []
        load = onnxruntime.InferenceSession

        def session(path: str, options: object, providers: list[str]) -> object:
            self.asked.append(providers)
            if broken and CUDA in providers:
                raise RuntimeError("CUDA failure 35: driver version is insufficient")
            made = load(path, options, providers=[CPU])
            made.get_providers = lambda: providers
            return made

        monkeypatch.setattr(onnxruntime, "get_available_providers", lambda: [CUDA, CPU])
        monkeypatch.setattr(onnxruntime, "InferenceSession", session)


def test_a_graph_on_a_card_is_reported_as_such(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    card = _Card(monkeypatch, broken=False)
    pool = SessionPool()
    pool.get(tiny_networks.migan(tmp_path / "model.onnx"))
    assert card.asked == [[CUDA, CPU]]
    assert [n.device for n in pool.report()] == ["cuda"]


def test_a_card_that_fails_is_given_up_for_the_processor(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    card = _Card(monkeypatch, broken=True)
    pool = SessionPool()
    pool.get(tiny_networks.migan(tmp_path / "model.onnx"))
    assert card.asked == [[CUDA, CPU], [CPU]]
    assert [n.device for n in pool.report()] == ["cpu"]
    assert "DIORAMA_DEVICE=cpu" in caplog.text


def test_networks_that_were_not_used_for_longest_make_room(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    first, second, third = (tiny_networks.migan(tmp_path / f"{name}.onnx") for name in ("first", "second", "third"))
    roomy, narrow = SessionPool(), SessionPool(budget_bytes=1)
    with caplog.at_level("INFO"):
        for pool in (roomy, narrow):
            pool.get(first)
            pool.get(second)
    assert "second.onnx: loaded on cpu" in caplog.text
    assert "first.onnx: freed" in caplog.text
    assert [n.path.name for n in narrow.report()] == ["second.onnx"]
    roomy.get(first)
    roomy.budget_bytes = sum(n.memory_bytes for n in roomy.report())
    roomy.get(third)
    assert "second.onnx" not in [n.path.name for n in roomy.report()]
    assert roomy.report()[-1].path.name == "third.onnx"


@pytest.mark.parametrize(("cores", "threads"), [(1, 1), (2, 2), (8, 8), (64, 16)])
def test_threads_follow_the_cores_up_to_a_bound(monkeypatch: pytest.MonkeyPatch, cores: int, threads: int) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: set(range(cores)), raising=False)
    assert thread_count() == threads
    monkeypatch.setenv("DIORAMA_THREADS", "3")
    assert thread_count() == 3


def test_a_wrong_number_of_threads_is_one_clear_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DIORAMA_THREADS", "many")
    with pytest.raises(UnavailableError, match="DIORAMA_THREADS"):
        runtime.thread_count()


def test_a_graph_that_fails_with_all_optimisations_is_loaded_with_fewer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    load, all_of_them = onnxruntime.InferenceSession, onnxruntime.GraphOptimizationLevel.ORT_ENABLE_ALL

    def session(path: str, options: onnxruntime.SessionOptions, providers: list[str]) -> object:
        if options.graph_optimization_level == all_of_them:
            raise RuntimeError("SimplifiedLayerNormFusion: type mismatch")
        return load(path, options, providers=providers)

    monkeypatch.setattr(onnxruntime, "InferenceSession", session)
    monkeypatch.setenv("DIORAMA_DEVICE", "cpu")
    pool = SessionPool()
    pool.get(tiny_networks.migan(tmp_path / "model.onnx"))
    assert "fewer graph optimisations" in caplog.text
    assert [n.note for n in pool.report()] == ["loaded with fewer graph optimisations"]


def test_a_long_run_stops_when_it_is_cancelled(tmp_path: Path) -> None:
    session = SessionPool().get(_endless(tmp_path / "endless.onnx"))
    progress = Progress()
    threading.Timer(0.3, progress.token.cancel).start()
    begun = time.perf_counter()
    with pytest.raises(Cancelled):
        session.run({"x": np.eye(64, dtype=np.float32)}, {}, progress=progress)
    assert time.perf_counter() - begun < 20


def _endless(path: Path) -> Path:
    """A graph that multiplies matrices for minutes."""
    model = onnx.parser.parse_model("""
        <ir_version: 9, opset_import: ["": 17]>
        endless (float[64, 64] x) => (float[64, 64] y) <int64 turns = {100000000}, bool go = {1}> {
            y = Loop (turns, go, x) <body = body (int64 turn, bool go_in, float[64, 64] value_in)
                => (bool go_out, float[64, 64] value_out) {
                    value_out = MatMul (value_in, value_in)
                    go_out = Identity (go_in)
                }>
        }
    """)
    onnx.save(model, path)
    return path
