"""The processes that share the work of a build have loaded what they need. What a stage loads while others work: step
by step, not longer than they do, and without a say in their result.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from itertools import count

import pytest

from diorama_core import processes
from diorama_core.artefacts import LabelledBox
from diorama_core.errors import LibraryError
from diorama_core.pipeline.beside import looking_ahead, prepare_processes
from diorama_core.processes import are_ready, call_beside
from tests.waiting import until


def loaded(name: str) -> bool:
    return name in sys.modules


def test_the_work_of_a_build_is_loaded_before_it_is_sent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LOKY_MAX_CPU_COUNT", "2")
    monkeypatch.setattr(processes, "_POOL", processes._Pool())
    prepare_processes()
    until(are_ready)
    for module in ("diorama_core.appearance.photo_appearance", "diorama_core.pose.made_to_measure", "open3d"):
        assert call_beside(loaded, module)
    assert not call_beside(loaded, "diorama_app")


BOXES = (LabelledBox((0.0, 0.0, 10.0, 10.0), "chair", "chair"),)


class Steps:
    """A stage that says when it is at its second step and waits there."""

    def __init__(self, error: Exception | None = None) -> None:
        self.error = error
        self.asked: list[str] = []
        self.begun, self.go_on = threading.Event(), threading.Event()
        self.taken = 0

    def ahead(self, boxes) -> Iterator[None]:
        self.asked = [box.label for box in boxes]
        for _ in count():
            yield
            self.taken += 1
            self.begun.set()
            if self.error is not None:
                raise self.error
            assert self.go_on.wait(30)


def test_steps_are_taken_beside_others_and_end_with_them() -> None:
    stage = Steps()
    with looking_ahead(stage, BOXES):
        assert stage.begun.wait(30)  # while this thread is here
        threading.Timer(0.05, stage.go_on.set).start()
    assert stage.asked == ["chair"]
    assert stage.taken >= 1
    assert not any(t.name == "look-ahead" for t in threading.enumerate())


def test_it_ends_when_the_others_fail() -> None:
    stage = Steps()
    stage.go_on.set()
    with pytest.raises(ZeroDivisionError), looking_ahead(stage, BOXES):
        _ = 1 / (not stage.begun.wait(30))
    assert not any(t.name == "look-ahead" for t in threading.enumerate())


def test_what_cannot_be_loaded_is_left_to_the_stage() -> None:
    stage = Steps(LibraryError("no such shape"))
    with looking_ahead(stage, BOXES):
        assert stage.begun.wait(30)
    assert stage.taken == 1


def test_stages_that_load_nothing_ahead_are_left_alone() -> None:
    with looking_ahead(object(), BOXES):
        assert not any(t.name == "look-ahead" for t in threading.enumerate())
