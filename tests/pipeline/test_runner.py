from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from diorama_core.artefacts import LabelledBox
from diorama_core.errors import Cancelled
from diorama_core.io.code_key import Sources
from diorama_core.library.catalogue import built_in_library
from diorama_core.perception.metrology import SingleViewMetrology
from diorama_core.pipeline import runner as runner_module
from diorama_core.pipeline.runner import CACHED_PER_STAGE, Runner, _read, _write, stage_code
from diorama_core.pose import MadeToMeasure, RenderAndCompare
from diorama_core.progress import CancelToken, Progress, ProgressEvent
from tests.somebody_else import delete_first

BOX = LabelledBox((0, 0, 4, 4), "chair", "chair")
OTHER = LabelledBox((0, 0, 5, 5), "chair", "chair")


@dataclass(frozen=True)
class Widen:
    """A stage that makes a box wider and counts how often it really ran."""

    by: float = 1.0
    calls: list = field(default_factory=list, repr=False, compare=False)

    def widen(self, box: LabelledBox, progress: Progress) -> LabelledBox:
        self.calls.append(box)
        x1, y1, x2, y2 = box.box
        return LabelledBox((x1, y1, x2 + self.by, y2), box.category, box.label)


def run(folder: Path, stage: Widen, box: LabelledBox, progress: Progress | None = None) -> tuple[LabelledBox, bool]:
    runner = Runner(folder)
    result = runner.run("widen", stage, stage.widen, (box,), progress or Progress())
    return result, runner.runs[0].cached


def test_a_second_run_reads_the_first_ones_result(tmp_path: Path) -> None:
    stage = Widen()
    first, second = run(tmp_path, stage, BOX), run(tmp_path, stage, BOX)
    assert first == (LabelledBox((0, 0, 5.0, 4), "chair", "chair"), False)
    assert second == (first[0], True)
    assert len(stage.calls) == 1


def test_other_inputs_or_settings_run_again(tmp_path: Path) -> None:
    run(tmp_path, Widen(), BOX)
    assert run(tmp_path, Widen(), OTHER)[1] is False
    assert run(tmp_path, Widen(by=2.0), BOX)[1] is False
    assert run(tmp_path, Widen(), BOX)[1] is True


class Edited(Sources):
    """The package with one more line in one module."""

    def __init__(self, module: str) -> None:
        super().__init__(Path(runner_module.__file__).parents[2])
        self.module = f"diorama_core.{module}"

    def _text(self, module: str) -> str:
        return super()._text(module) + ("ADDED = 1\n" if module == self.module else "")


@pytest.mark.parametrize(
    ("stage", "used", "not_used"),
    [
        (SingleViewMetrology(), "perception.metrology.rows", "export.gltf"),
        (SingleViewMetrology(), "geometry.projection", "pose.hypotheses"),
        (MadeToMeasure(RenderAndCompare(built_in_library()), built_in_library()), "pose.hypotheses", "layout.exact"),
    ],
)
def test_an_edit_of_what_a_stage_uses_changes_its_code_and_one_elsewhere_does_not(stage, used, not_used) -> None:
    before = stage_code(stage)
    assert stage_code(stage, Edited(used)) != before
    assert stage_code(stage, Edited(not_used)) == before


def test_an_edit_of_a_stage_runs_it_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stage = SingleViewMetrology()

    def cached() -> bool:
        runner = Runner(tmp_path)
        runner.run("geometry", stage, Widen().widen, (BOX,), Progress())
        return runner.runs[0].cached

    assert [cached(), cached()] == [False, True]
    monkeypatch.setattr(runner_module, "package_sources", lambda: Edited("perception.metrology.rows"))
    assert cached() is False


def test_a_damaged_result_is_computed_again(tmp_path: Path) -> None:
    run(tmp_path, Widen(), BOX)
    file = next(tmp_path.glob("*.zip"))
    file.write_bytes(file.read_bytes()[:40])
    assert run(tmp_path, Widen(), BOX)[1] is False
    assert run(tmp_path, Widen(), BOX)[1] is True


def test_a_half_written_result_is_never_used(tmp_path: Path) -> None:
    run(tmp_path, Widen(), BOX)
    file = next(tmp_path.glob("*.zip"))
    file.rename(file.with_suffix(".123.part"))
    assert run(tmp_path, Widen(), BOX)[1] is False


def test_a_cancelled_run_resumes_after_its_finished_stages(tmp_path: Path) -> None:
    token = CancelToken()
    stage = Widen()
    runner = Runner(tmp_path)
    progress = Progress(token=token)
    done = runner.run("first", stage, stage.widen, (BOX,), progress)
    token.cancel()
    with pytest.raises(Cancelled):
        runner.run("second", stage, stage.widen, (done,), progress)
    again = Runner(tmp_path)
    result = again.run("first", stage, stage.widen, (BOX,), Progress())
    again.run("second", stage, stage.widen, (result,), Progress())
    assert [r.cached for r in again.runs] == [True, False]
    assert len(stage.calls) == 2


def test_old_results_are_cleaned_up(tmp_path: Path) -> None:
    for i in range(3 * CACHED_PER_STAGE):
        run(tmp_path, Widen(by=float(i)), BOX)
    assert len(list(tmp_path.glob("widen-*.zip"))) == CACHED_PER_STAGE


def test_progress_of_parts_is_on_the_whole_jobs_scale() -> None:
    events: list[ProgressEvent] = []
    part = Progress(events.append).part(0.5, 1.0).part(0.0, 0.5)
    part.report(1.0, "half of the second half")
    assert events[0].fraction == pytest.approx(0.75)


@pytest.mark.posix
def test_results_in_a_folder_of_somebody_else_are_never_deleted(tmp_path: Path) -> None:
    """A received project may have a link in place of its folder of stage results."""
    theirs = tmp_path / "theirs"
    theirs.mkdir()
    names = [f"widen-{i:024x}.zip" for i in range(9)] + ["widen-notes.zip"]
    for name in names:
        (theirs / name).write_bytes(b"theirs")
    (tmp_path / "stages").symlink_to(theirs)
    for i in range(3):
        _write(tmp_path / "stages" / f"widen-{i + 100:024x}.zip", ())
        assert _read(tmp_path / "stages" / names[i], tuple) is None
    assert all((theirs / name).read_bytes() == b"theirs" for name in names)


def test_what_was_just_written_stays_whatever_the_clock_says(tmp_path: Path) -> None:
    for i in range(6):
        path = tmp_path / f"widen-{i:024x}.zip"
        _write(path, ())
        os.utime(path, (4e9, 4e9))
    newest = tmp_path / f"widen-{99:024x}.zip"
    _write(newest, ())
    assert newest.exists()
    assert len(list(tmp_path.glob("*.zip"))) == CACHED_PER_STAGE


@dataclass(frozen=True)
class Around:
    """A stage that holds another one in a dataclass of its own."""

    inner: object


def test_stages_within_stages_count_for_the_key() -> None:
    outer = Around(Around(SingleViewMetrology()))
    assert stage_code(outer) != stage_code(outer, Edited("perception.metrology.rows"))
    assert stage_code(outer) == stage_code(outer, Edited("export.gltf"))
    assert stage_code(Around(SingleViewMetrology)) == stage_code(Around(SingleViewMetrology)), "a class is no stage"


def test_an_artefact_is_read_once_for_all_keys_and_runs_are_timed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    read: list[object] = []
    real = runner_module.codec.fingerprint
    monkeypatch.setattr(runner_module.codec, "fingerprint", lambda value: (read.append(value), real(value))[1])
    runner = Runner(tmp_path)
    for name in ("widen", "widen again"):
        runner.run(name, Widen(), Widen().widen, (BOX,), Progress())
    assert read == [BOX]
    assert all(0.0 <= run.seconds < 60.0 for run in runner.runs)


def test_a_stage_reports_its_begin_and_its_end(tmp_path: Path) -> None:
    events: list[ProgressEvent] = []
    run(tmp_path, Widen(), BOX, Progress(events.append))
    assert [(event.fraction, event.message) for event in events] == [(0.0, "widen…"), (1.0, "widen: done")]


@pytest.mark.parametrize("folder", [True, False])
def test_what_is_not_to_be_saved_is_made_each_time(tmp_path: Path, folder: bool) -> None:
    stage, runner = Widen(), Runner(tmp_path if folder else None)
    for _ in range(2):
        runner.run("widen", stage, stage.widen, (BOX,), Progress(), saved=not folder)
    assert [done.cached for done in runner.runs] == [False, False]
    assert list(tmp_path.iterdir()) == []


@dataclass(frozen=True)
class Provisional:
    provisional: bool = True


def test_a_provisional_result_is_not_saved(tmp_path: Path) -> None:
    runner = Runner(tmp_path)
    runner.run("guess", Widen(), lambda box, progress: Provisional(), (BOX,), Progress())
    assert list(tmp_path.iterdir()) == []


def test_a_result_that_was_cancelled_while_it_was_made_is_not_saved(tmp_path: Path) -> None:
    token = CancelToken()

    def make(box: LabelledBox, progress: Progress) -> LabelledBox:
        token.cancel()
        return box

    with pytest.raises(Cancelled):
        Runner(tmp_path).run("widen", Widen(), make, (BOX,), Progress(token=token))
    assert list(tmp_path.iterdir()) == []


def test_results_that_were_used_stay_longest_whoever_deletes_the_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    delete_first(monkeypatch)
    run(tmp_path, Widen(by=100.0), BOX)
    (used,) = tmp_path.glob("*.zip")
    os.utime(used, (1e9, 1e9))
    for i in range(CACHED_PER_STAGE - 1):
        run(tmp_path, Widen(by=float(i)), BOX)
    for path in tmp_path.glob("*.zip"):
        os.utime(path, (1e9 + 1.0, 1e9 + 1.0) if path != used else (1e9, 1e9))
    other = tmp_path / f"widen-more-{0:024x}.zip"
    other.write_bytes(b"of another stage")
    assert run(tmp_path, Widen(by=100.0), BOX)[1]
    run(tmp_path, Widen(by=-1.0), BOX)
    assert used.exists()
    assert other.exists()
    assert len(list(tmp_path.glob("*.zip"))) == CACHED_PER_STAGE + 1
    used.write_bytes(b"damaged")
    assert run(tmp_path, Widen(by=100.0), BOX)[1] is False, "somebody else deleted it first"
