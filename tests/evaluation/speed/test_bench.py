"""Speed figures: growth is recovered, what became slower is named, stages are told apart, tables keep their shape."""

from __future__ import annotations

import json
import time

import numpy as np
import pytest

from diorama_core.errors import Cancelled, InputError
from diorama_core.evaluation.speed.bench import (
    SpeedBench,
    memory_table,
    read_figures,
    regression_bytes,
    regression_table,
    slower,
    speed_table,
    step_table,
)
from diorama_core.evaluation.speed.eager import BATCHED, BATCHED_GPU, EAGER, OURS, step_seconds
from diorama_core.evaluation.speed.meter import StageClock, cost_of, growth_exponent, yardstick_s
from diorama_core.evaluation.speed.series import Series, features_by_library, large_scene, words_by_library
from diorama_core.library.catalogue import built_in_library
from diorama_core.progress import CancelToken, Progress


def test_growth_is_the_power_of_the_quantity():
    for power in (0.0, 1.0, 2.5):
        assert growth_exponent([(q, 3.0 * q**power) for q in (1, 7, 50)]) == pytest.approx(power)
    assert growth_exponent([(1, 2.0)]) == 0


def test_memory_of_work_is_what_it_holds():
    retained: list[np.ndarray] = []
    cost = cost_of(lambda: retained.append(np.ones(8_000_000)))
    assert cost.peak_mb is None or 50 < cost.peak_mb < 90
    freed = cost_of(lambda: float(np.ones(8_000_000).sum()))
    assert freed.peak_mb is None or 50 < freed.peak_mb < 90


def test_stages_are_told_apart_by_their_progress():
    clock = StageClock(("pose", "layout"))
    progress = clock.watch(Progress())
    progress.report(0.0, "pose…")
    _work(0.05)
    progress.report(0.5, "chair 3")
    progress.report(0.6, "pose: done")
    _work(0.03)
    progress.report(0.7, "layout…")
    progress.report(1.0, "done")
    assert set(clock.costs) == {"pose", "layout"}
    assert clock.costs["pose"].seconds >= 0.05
    assert clock.costs["layout"].seconds < 0.03


def _work(seconds: float) -> None:
    begun = time.process_time()
    while time.process_time() - begun < seconds:
        pass


def test_a_stopped_run_stops_its_stages():
    token = CancelToken()
    token.cancel()
    with pytest.raises(Cancelled):
        StageClock(("pose",)).watch(Progress(token=token)).report(0.0, "pose…")


def test_what_became_slower_is_named():
    before = {"a at 5": 1.0, "growth of a": 1.0, "memory of a": 10.0, "memory of b": 500.0, "eager over ours": 100.0}
    assert slower(before, before) == {}
    now = {"a at 5": 2.0, "growth of a": 1.5, "memory of a": 40.0, "memory of b": 900.0, "eager over ours": 50.0}
    found = slower(now, before)
    assert set(found) == {"a at 5", "growth of a", "memory of b", "eager over ours"}
    assert found["a at 5"] == pytest.approx(2)
    assert found["growth of a"] == pytest.approx(10**0.5)
    assert found["eager over ours"] == pytest.approx(2)
    assert slower({**now, "a at 5": 1.5}, before, tolerance=1.4)["a at 5"] == pytest.approx(1.5)
    assert set(slower({"a at 5": float("nan")}, before)) == {"a at 5"}
    words = {r.name: r.values[-1] for r in regression_table({"a at 5": 2.0}, before).rows}
    assert words["a at 5"] == "slower"
    assert words["growth of a"] == "not measured"


def test_figures_survive_their_file(tmp_path):
    path = tmp_path / "figures.json"
    path.write_bytes(regression_bytes({"a": 1.23456, "b": 2.0}))
    assert read_figures(path) == {"a": 1.235, "b": 2.0}
    with pytest.raises(InputError, match="measure something"):
        regression_bytes({})
    path.write_text("[]")
    with pytest.raises(InputError, match="--keep"):
        read_figures(path)


def test_the_committed_figures_cover_stages_and_growth():
    figures = read_figures()
    assert all(np.isfinite(v) for v in figures.values())
    for stage in ("pose", "layout", "retrieval", "render with truth", "whole build"):
        assert f"{stage} at 20 objects" in figures
        assert f"growth of {stage} from 1 to 20 objects" in figures
    assert figures["eager over ours, a step at 20 objects"] > 20


def test_tables_say_what_was_not_measured():
    ours = Series(OURS, "objects", ((5.0, 0.001), (20.0, 0.002)))
    gpu = Series(BATCHED_GPU, "objects", (), missing="no GPU here")
    eager = Series(EAGER, "objects", ((5.0, 0.01), (20.0, 0.16)))
    pose = Series("pose", "objects", ((1.0, 0.5), (20.0, 10.0)), (None, 80.0))
    bench = SpeedBench(0, (pose, ours, gpu, eager), 0.02, 1.0, {"pose at 20 objects": 100.0})
    text = step_table((ours, gpu, eager)).to_markdown()
    assert "no GPU here" in text
    assert bench.figures()["eager over ours, a step at 20 objects"] == pytest.approx(80)
    assert bench.figures()["pose at 20 objects"] == pytest.approx(500)
    assert bench.figures()["memory of pose at 20 objects"] == 80
    assert memory_table((pose,), "objects").row("pose") == {"1": None, "20": 80.0}
    assert speed_table((pose,), "objects").row("pose")["20"] == pytest.approx(10_000)
    for table in bench.tables():
        rows = [line for line in table.to_markdown().splitlines() if line.startswith("|")]
        assert len({line.count("|") for line in rows}) <= 1
    assert json.loads(json.dumps(bench.to_json()))["bench"] == "speed"


def test_ours_beats_pair_by_pair():
    ours, batched, eager = (step_seconds(way, 12, 0) or 0.0 for way in (OURS, BATCHED, EAGER))
    assert 0 < ours < eager / 5
    assert batched > 0


def test_a_store_on_disk_is_searched_as_it_grows():
    opened, nearest = features_by_library(0, (200, 400), Progress())
    assert [q for q, _ in nearest.points] == [q for q, _ in opened.points] == [200, 400]


def test_words_are_searched_as_the_library_grows():
    index, find = words_by_library(built_in_library(), (300, 600), Progress())
    assert [q for q, _ in index.points] == [300, 600]
    assert all(seconds > 0 for _, seconds in find.points)


def test_a_large_scene_has_what_was_asked_for_side_by_side():
    scene, camera = large_scene(built_in_library(), 30, 0)
    assert len(scene.objects) == 30
    centres = np.array([o.pose.position[:2] for o in scene.objects])
    apart = np.linalg.norm(centres[:, None] - centres, axis=2) + 9 * np.eye(30)
    assert apart.min() > 1.0
    seen = camera.project(np.array([o.pose.position for o in scene.objects]))
    inside = (seen > 0).all(axis=1) & (seen < [camera.intrinsics.width, camera.intrinsics.height]).all(axis=1)
    assert inside.mean() > 0.85
    again, _ = large_scene(built_in_library(), 30, 0)
    assert again == scene


def test_the_yardstick_is_short():
    assert 0.001 < yardstick_s() < 2
