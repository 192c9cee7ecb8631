"""Opening the editor loads what it needs and no more: seconds of start-up hide in a stray import."""

from __future__ import annotations

import subprocess
import sys

HEAVY = (
    "torch",
    "sklearn",
    "open3d",
    "onnxruntime",
    "openai",
    "diorama_core.pipeline.build",
    "diorama_core.pipeline.profiles",
    "diorama_core.evaluation",
)


def test_the_server_starts_without_the_pipeline_and_the_networks() -> None:
    code = f"import sys, diorama_app.server; print(*[m for m in {HEAVY!r} if m in sys.modules])"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert loaded == []
