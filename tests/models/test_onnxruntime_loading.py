"""onnxruntime tells nobody what it runs."""

from __future__ import annotations

import subprocess
import sys


def test_reports_are_switched_off_before_it_is_loaded() -> None:
    code = """
import os, sys
from diorama_core.models.runtime import providers
assert "onnxruntime" not in sys.modules
providers()
assert "onnxruntime" in sys.modules and os.environ["ORT_DISABLE_TELEMETRY"] == "1"
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, env={})
    assert done.returncode == 0, done.stderr[-2000:]
