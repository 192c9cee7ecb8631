"""Work in processes beside this one, which may be there, missing, busy or killed: results are the same."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path
from threading import Lock

import pytest

from diorama_core import processes
from diorama_core.errors import Cancelled, InputError
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.user_library import UserLibrary
from diorama_core.pose.made_to_measure import MadeToMeasure
from diorama_core.pose.render_and_compare import RenderAndCompare
from diorama_core.processes import are_ready, call_beside, map_beside, prepare
from diorama_core.progress import Progress, ProgressEvent
from diorama_core.workers import LocalWorkers
from tests.few_shapes import stored_copy
from tests.processes import runs
from tests.waiting import until


def load() -> None:
    """Nothing is needed."""


def doubled(number: int) -> int:
    return 2 * number


def process_of(_: object) -> int:
    return os.getpid()


def slow_process_of(_: object) -> int:
    time.sleep(0.05)
    return os.getpid()


def refused(number: int) -> int:
    raise InputError(f"{number} is refused")


def killed_elsewhere(here: int) -> str:
    if os.getpid() != here:
        os.kill(os.getpid(), signal.SIGKILL)
    return "done"


@pytest.fixture(autouse=True)
def _two_processors(monkeypatch: pytest.MonkeyPatch) -> None:
    if (os.cpu_count() or 1) < 2:
        pytest.skip("one processor: there are no processes beside")
    monkeypatch.setenv("LOKY_MAX_CPU_COUNT", "2")
    monkeypatch.setattr(processes, "_POOL", processes._Pool())


@pytest.fixture
def ready(_two_processors: None) -> None:
    prepare(load)
    until(are_ready)


def test_work_is_done_in_another_process(ready: None) -> None:
    assert call_beside(doubled, 21) == 42
    assert call_beside(process_of, None) != os.getpid()


def test_results_come_in_order_from_here_and_there(ready: None) -> None:
    assert map_beside(doubled, [(k,) for k in range(50)]) == [2 * k for k in range(50)]
    who = set(map_beside(slow_process_of, [(k,) for k in range(20)]))
    assert os.getpid() in who
    assert len(who) > 1
    assert map_beside(doubled, []) == []
    assert map_beside(doubled, [(1,)]) == [2]


def test_what_cannot_be_sent_is_done_here(ready: None) -> None:
    assert call_beside(process_of, Lock()) == os.getpid()


def test_one_processor_has_no_process_beside(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LOKY_MAX_CPU_COUNT", "1")
    monkeypatch.setattr(processes, "_POOL", processes._Pool())
    prepare(load)
    assert not are_ready()
    assert call_beside(process_of, None) == os.getpid()
    assert map_beside(doubled, [(k,) for k in range(5)]) == [0, 2, 4, 6, 8]


def test_a_process_that_is_one_of_several_starts_no_more(ready: None) -> None:
    assert call_beside(how_many, None) == 0
    assert [done.unwrap() for done in LocalWorkers(2).map(how_many, [None])] == [0]


def how_many(_: object) -> int:
    return processes._Pool().count


def test_errors_pass_through(ready: None) -> None:
    with pytest.raises(InputError, match="3 is refused"):
        call_beside(refused, 3)
    with pytest.raises(InputError, match="is refused"):
        map_beside(refused, [(k,) for k in range(4)])


@pytest.mark.posix
def test_a_killed_process_loses_nothing(ready: None) -> None:
    assert call_beside(killed_elsewhere, os.getpid()) == "done"
    assert call_beside(doubled, 2) == 4  # done here
    prepare(load)  # the next build starts another
    assert call_beside(doubled, 3) == 6


def test_cancelling_drops_what_has_not_begun(ready: None) -> None:
    done: list[float] = []

    def stop(event: ProgressEvent) -> None:
        done.append(event.fraction)
        if len(done) == 2:
            raise Cancelled

    with pytest.raises(Cancelled):
        map_beside(slow_process_of, [(k,) for k in range(100)], Progress(stop))
    assert done[-1] < 0.5


def test_libraries_open_again_where_they_are_sent(ready: None) -> None:
    library = built_in_library()
    stage = MadeToMeasure(RenderAndCompare(library), library)
    assert call_beside(repr, stage) == repr(stage)
    process, *told = call_beside(answers, library, library.in_category("chair")[0].id)
    assert process != os.getpid()
    assert told == list(answers(library, library.in_category("chair")[0].id)[1:])


def test_they_end_with_a_process_that_is_killed() -> None:
    script = """
        import os, time
        from diorama_core.processes import are_ready, prepare, call_beside
        from tests.test_processes import load, process_of
        prepare(load)
        while not are_ready(): time.sleep(0.02)
        print(call_beside(process_of, None), flush=True)
        time.sleep(600)
    """  # without a guard: the script is not run again in the other process
    started = subprocess.Popen([sys.executable, "-c", textwrap.dedent(script)], stdout=subprocess.PIPE, text=True)
    assert started.stdout is not None
    beside = int(started.stdout.readline())
    assert runs(beside)
    started.kill()
    started.wait()
    until(lambda: not runs(beside))


def test_libraries_of_ones_own_are_sent_with_the_others(
    ready: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DIORAMA_LIBRARIES", str(tmp_path))
    built_in, library = built_in_library(), UserLibrary(built_in_library())
    chair = built_in.in_category("chair")[0]
    library.own().add(stored_copy(built_in, chair.id, "my-chair"))
    process, *told = call_beside(answers, library, "my-chair")
    assert process != os.getpid()
    assert told == list(answers(library, "my-chair")[1:])


def answers(library: ShapeLibrary, shape_id: str) -> tuple[int, list[float], int]:
    return os.getpid(), library.mesh(shape_id).extents.tolist(), len(library.shapes())
