"""The table of licences names every pinned package."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def test_every_pinned_package_has_its_licence() -> None:
    pinned = re.findall(r"^([A-Za-z0-9._-]+)==(\S+)", (ROOT / "constraints.txt").read_text(), re.MULTILINE)
    rows = re.findall(r"^\| (\S+) \| (\S+) \| (.+) \|$", (ROOT / "docs" / "licences.md").read_text(), re.MULTILINE)
    assert len(pinned) > 100
    assert {(name, version) for name, version, _ in rows if name != "package"} - {("---", "---")} == set(pinned)
