from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest

from diorama_core.errors import InputError, LibraryError
from diorama_core.workers import LocalWorkers, RayWorkers, WorkerDied, Workers, map_threads, workers
from tests.processes import runs
from tests.waiting import until


def power(number: int, exponent: int) -> int:
    return number**exponent


def square_or_fail(number: int) -> int:
    if number == 3:
        raise LibraryError("three is malformed")
    if number == 5:
        os._exit(9)  # as the system does to a process that takes all memory
    return number * number


@pytest.fixture(scope="module")
def local_ray() -> Iterator[Workers]:
    ray = pytest.importorskip("ray", reason="needs Ray (pip install 'diorama[cluster]')")
    yield RayWorkers("local", 2)
    ray.shutdown()


def _check(pool: Workers) -> None:
    answers = {done.item: done for done in pool.map(square_or_fail, range(12))}
    assert sorted(answers) == list(range(12))
    assert {i: d.value for i, d in answers.items() if d.error is None} == {
        i: i * i for i in range(12) if i not in (3, 5)
    }
    assert isinstance(answers[3].error, LibraryError)
    assert str(answers[3].error) == "three is malformed"
    assert isinstance(answers[5].error, WorkerDied)
    with pytest.raises(LibraryError):
        answers[3].unwrap()
    assert answers[4].unwrap() == 16
    cubes = pool.map(partial(power, exponent=3), [1, 2, 3])
    assert sorted(done.unwrap() for done in cubes) == [1, 8, 27]


def test_failures_and_killed_processes_cost_only_their_own_piece() -> None:
    _check(LocalWorkers(2))


POOL = """
import time
from diorama_core.workers import LocalWorkers
from tests.test_workers import own_id
if __name__ == "__main__":
    for done in LocalWorkers(1).map(own_id, [0.0, 60.0]):
        print(done.value, flush=True)
"""


def own_id(wait_s: float) -> int:
    time.sleep(wait_s)
    return os.getpid()


def test_processes_end_with_the_program_that_was_killed(tmp_path: Path) -> None:
    (tmp_path / "pool.py").write_text(POOL)
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).resolve().parents[1])}
    program = subprocess.Popen(
        [sys.executable, str(tmp_path / "pool.py")], stdout=subprocess.PIPE, text=True, env=environment
    )
    assert program.stdout is not None
    worker = int(program.stdout.readline())
    program.kill()
    program.wait()
    program.stdout.close()
    until(lambda: not runs(worker), "a process of the pool ends with the program")


def test_the_same_on_ray(local_ray: Workers) -> None:
    assert local_ray.count == 2
    _check(local_ray)


def test_items_are_drawn_as_needed_and_the_rest_is_dropped() -> None:
    drawn = []

    def numbers() -> Iterator[int]:
        for number in range(10, 10_000):
            drawn.append(number)
            yield number

    answers = LocalWorkers(1).map(square_or_fail, numbers())
    assert next(answers).value == 100
    answers.close()
    assert len(drawn) < 10


def test_a_senseless_count_is_refused() -> None:
    with pytest.raises(InputError, match="at least one"):
        workers(count=0)
    assert workers(count=3).count == 3


def kill_first_time(folder: Path, number: int) -> int:
    """Number 1 kills its process; the others say how often they were begun."""
    if number == 1:
        time.sleep(0.5)  # the others are begun meanwhile
        os._exit(9)
    mark = folder / str(number)
    mark.write_text(mark.read_text() + "." if mark.exists() else ".")
    time.sleep(1.0)  # longer than number 1 lives
    return len(mark.read_text())


def test_a_process_that_dies_takes_nothing_of_the_others_with_it(tmp_path: Path) -> None:
    done = {d.item: d for d in LocalWorkers(2).map(partial(kill_first_time, tmp_path), range(6))}
    assert isinstance(done[1].error, WorkerDied)
    assert [done[n].value for n in (0, 2, 3, 4, 5)] == [1] * 5, "each was begun once"


def test_each_works_in_order_by_two_threads_and_errors_arrive() -> None:
    names = set()

    def work(k: int) -> int:
        names.add(threading.current_thread().name)
        return k * k

    assert map_threads(work, range(50)) == [k * k for k in range(50)]
    assert len(names) <= 2
    with pytest.raises(ZeroDivisionError):
        map_threads(lambda k: 1 // k, [1, 0])
