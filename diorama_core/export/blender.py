"""Blender's Python: where it is, and jobs in a process of its own that report progress and can be cancelled.

The module asks for an older numpy than this program, so it usually lives in an environment of its own; the workers need
nothing else.
"""

from __future__ import annotations

import json
import os
import queue
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterable, Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from diorama_core.errors import UnavailableError
from diorama_core.progress import SILENT, Progress

PYTHON_VARIABLE = "DIORAMA_BLENDER_PYTHON"
INSTALL = (
    "it needs Blender's module in an environment of its own: python3.11 -m venv blender && "
    f"blender/bin/pip install bpy==5.0.1 && export {PYTHON_VARIABLE}=$PWD/blender/bin/python"
)
REPORT = "diorama "
"""Start of the lines in which a worker reports: this, a fraction, a space and a message."""
WORKER = Path(__file__).with_name("blender_worker.py")
"""Saves and renders; what a job is told says which."""
_GLANCE_S = 0.2
"""How often a cancel is looked for."""


def blender_python() -> str:
    """The Python that has Blender's module: named by `DIORAMA_BLENDER_PYTHON`, or this one.

    Raises:
        UnavailableError: when there is none.
    """
    missing = missing_blender()
    if missing:
        raise UnavailableError(missing)
    return os.environ.get(PYTHON_VARIABLE) or sys.executable


def missing_blender() -> str:
    """What to do before Blender can be used, in one line; empty when it can be."""
    named = os.environ.get(PYTHON_VARIABLE)
    if named:
        is_runnable = shutil.which(named) is not None
        return (
            "" if is_runnable else f"{PYTHON_VARIABLE} names {named}, which cannot be run; name the Python that has bpy"
        )
    return "" if find_spec("bpy") is not None else f"Blender is not installed; {INSTALL}"


def run_in_blender(
    worker: Path, job: Mapping[str, Any], *, name: str, progress: Progress = SILENT, timeout_s: float = 1800.0
) -> None:
    """Run one job in Blender's Python.

    Args:
        worker: A script that reads its job, as JSON, from the file it is told, and may report lines (`REPORT`).
        job: Values of JSON.
        name: What the job is, for messages: "Cycles".
        progress: Told what the worker reports; a cancel ends the process.
        timeout_s: When to give up.

    Raises:
        UnavailableError: Blender is missing, fails or takes too long.
        Cancelled: when asked to stop.
    """
    python = blender_python()
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryFile("w+") as errors:
        file = Path(folder) / "job.json"
        file.write_text(json.dumps(dict(job)), encoding="utf-8")
        # -P: Blender's own add-on is called "cycles" too, and must not find a module beside the worker.
        command = [python, "-P", str(worker), str(file)]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=errors, text=True, errors="replace")
        try:
            _follow(process, name, progress, timeout_s)
        finally:
            process.kill()
            process.wait()
            assert process.stdout is not None
            process.stdout.close()
        errors.seek(0)
        last = [line for line in errors.read().splitlines() if line.strip()][-1:] or ["no message"]
    if process.returncode:
        raise UnavailableError(f"{name} failed: {last[0].strip()}")


def _follow(process: subprocess.Popen[str], name: str, progress: Progress, timeout_s: float) -> None:
    """Pass on what a process reports until it ends."""
    assert process.stdout is not None
    lines: queue.Queue[str | None] = queue.Queue()
    threading.Thread(target=_read, args=(process.stdout, lines), daemon=True).start()
    deadline = time.monotonic() + timeout_s
    while True:
        progress.check()
        if time.monotonic() > deadline:
            raise UnavailableError(f"{name} took more than {timeout_s:g} s; ask for less")
        try:
            line = lines.get(timeout=_GLANCE_S)
        except queue.Empty:
            continue
        if line is None:
            process.wait()
            return
        if line.startswith(REPORT):
            fraction, _, message = line.removeprefix(REPORT).strip().partition(" ")
            progress.report(float(fraction), message)


def _read(stream: Iterable[str], lines: queue.Queue[str | None]) -> None:
    try:
        for line in stream:
            lines.put(line)
    except ValueError:
        pass  # closed because the job was given up
    finally:
        lines.put(None)
