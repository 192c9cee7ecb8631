"""The pinned versions and their hashes are of the same packages."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PIN = re.compile(r"^([A-Za-z0-9._-]+)==([^ +;\\\n]+)", re.MULTILINE)


def pins(text: str) -> dict[str, str]:
    return {re.sub(r"[-_.]+", "-", name).lower(): version for name, version in PIN.findall(text)}


def test_hashes_are_of_the_pinned_versions() -> None:
    plain = (ROOT / "constraints.txt").read_text()
    hashed = (ROOT / "constraints-hashed.txt").read_text()
    assert pins(plain) == pins(hashed), "make constraints-hashed.txt anew; its first lines say how"
    assert len(pins(plain)) > 100
    for entry in re.split(r"\n(?=[A-Za-z0-9])", hashed.split("\n", 4)[4]):
        assert re.search(r"--hash=sha256:[0-9a-f]{64}", entry), entry[:80]
