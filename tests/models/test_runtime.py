"""Where networks run and with how many threads, decided without a graphics card at hand."""

from __future__ import annotations

import os
from pathlib import Path

import onnxruntime
import pytest

from diorama_core.errors import UnavailableError
from diorama_core.models import runtime
from diorama_core.models.runtime import SessionPool, providers, thread_count
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
    ],
    ids=["cuda", "cuda not wanted", "cuda among others", "no cuda", "cuda wanted in vain"],
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
