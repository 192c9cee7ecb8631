"""Where people put things where nobody says."""

from __future__ import annotations

from diorama_core.editing.habits import belongs_before, carries, host_cost
from tests.editing.objects import SOFA, item


def test_habits() -> None:
    desk, chair = item("desk", (0.6, 1.2, 0.75), 0, 0), item("office chair", (0.6, 0.6, 1.0), 0, 0)
    assert carries(desk)
    assert not carries(chair)
    assert belongs_before(chair, desk, ())
    assert not belongs_before(desk, chair, ())
    monitor = item("monitor", (0.2, 0.5, 0.4), 0, 0)
    assert host_cost(monitor, desk) < host_cost(monitor, SOFA)
