"""Whether processes that tests started are still there."""

from __future__ import annotations

from pathlib import Path

import pytest


def runs(process: int) -> bool:
    """Whether a process exists and has not ended."""
    if not Path("/proc/self/stat").exists():
        pytest.skip("needs /proc")
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
