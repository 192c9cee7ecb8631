"""RoomPlan's USDZ; what both of its forms have in common is in `test_roomplan`."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("pxr", reason="needs usd-core (pip install 'diorama[usd]')")

from diorama_core.importing.roomplan_usd import read_usd
from tests.importing.roomplan_files import FURNITURE, write_usdz


def test_walls_and_things_by_their_names(tmp_path: Path) -> None:
    room = read_usd(write_usdz(tmp_path / "room.usdz"))
    assert room is not None
    assert len(room.walls) >= 4
    assert len(room.boxes) == len(FURNITURE)
