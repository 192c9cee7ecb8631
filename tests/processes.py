"""Processes that tests start: whether they are still there, and quick ones for builds."""

from __future__ import annotations

import multiprocessing
import sys
from pathlib import Path

import pytest

from diorama_core import workers

BUILDING = [
    "diorama_app.projects.folder_build",
    "diorama_app.projects.report",
    "diorama_core.project.build",
    "tests.small_planes",
]
"""Modules whose import is most of what a process that builds a small photo does."""


@pytest.fixture
def quick_workers(monkeypatch: pytest.MonkeyPatch) -> None:
    """Worker processes fork from one that has imported what a build needs and runs no thread. `tests/test_workers.py`
    starts them as the program does.
    """
    if sys.platform != "linux":
        return
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(BUILDING)
    monkeypatch.setattr(workers, "get_context", lambda method: context)


def runs(process: int) -> bool:
    """Whether a process exists and has not ended."""
    if not Path("/proc/self/stat").exists():
        pytest.skip("needs /proc")
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
