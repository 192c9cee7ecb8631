"""While a layout is optimised: every picture moves the objects, the curves follow at their own pace."""

from __future__ import annotations

import time

from diorama_app.commands import optimise
from diorama_app.session.layout_run import LayoutRun
from diorama_core.scene import edits


class Curves:
    """Counts how often the curves are drawn."""

    def __init__(self) -> None:
        self.drawn = 0

    def refresh(self) -> None:
        self.drawn += 1


def test_curves_are_drawn_less_often_than_the_objects(session, client, monkeypatch) -> None:
    client.curves = curves = Curves()
    shown: list[float] = []
    monkeypatch.setattr(session, "preview", lambda poses: shown.append(poses["chair_1"].position[0]))
    run = LayoutRun("paper", time.monotonic(), session.scene)
    here = session.scene.object("chair_1").pose
    now = [100.0]
    monkeypatch.setattr(optimise.time, "monotonic", lambda: now[0])
    samples = []
    for step in range(20):
        samples.append((0.0625 * step, (("place", 1.0 / (step + 1)),)))
        scene = edits.place(session.scene, {"chair_1": here.moved((0.01 * step, 0.0, 0.0))})
        optimise._show_step(session, scene, run, samples)
        now[0] += 0.0625
    assert len(set(shown)) == 20
    assert curves.drawn == 3  # in 1.2 s, every half second
    assert run.times_s == [0.0625 * step for step in range(17)]  # what came since is read when the run ends
