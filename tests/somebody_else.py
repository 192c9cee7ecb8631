"""Another program at work in the same folder."""

from __future__ import annotations

from pathlib import Path

import pytest


def delete_first(monkeypatch: pytest.MonkeyPatch) -> None:
    """From now on, whoever deletes a file finds that another program was quicker."""
    unlink = Path.unlink

    def late(self: Path, missing_ok: bool = False) -> None:
        unlink(self, missing_ok=True)
        unlink(self, missing_ok=missing_ok)

    monkeypatch.setattr(Path, "unlink", late)
