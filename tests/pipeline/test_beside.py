"""The processes that share the work of a build have loaded what they need."""

from __future__ import annotations

import sys

import pytest

from diorama_core import processes
from diorama_core.pipeline.beside import prepare_processes
from diorama_core.processes import are_ready, there
from tests.waiting import until


def loaded(name: str) -> bool:
    return name in sys.modules


def test_the_work_of_a_build_is_loaded_before_it_is_sent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LOKY_MAX_CPU_COUNT", "2")
    monkeypatch.setattr(processes, "_KEPT", processes._Kept())
    prepare_processes()
    until(are_ready)
    for module in ("diorama_core.appearance.photo_appearance", "diorama_core.pose.made_to_measure", "open3d"):
        assert there(loaded, module)
    assert not there(loaded, "diorama_app")
