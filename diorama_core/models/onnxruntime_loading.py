"""onnxruntime as everything here loads it: it tells nobody what it runs."""

from __future__ import annotations

import os
from types import ModuleType


def load_onnxruntime() -> ModuleType:
    """onnxruntime with reports to its makers switched off.

    Since 1.29 it sends sessions, models and errors to a server unless this variable was set before it was first loaded.
    A value that people have set themselves stays.
    """
    os.environ.setdefault("ORT_DISABLE_TELEMETRY", "1")
    import onnxruntime

    return onnxruntime
