"""The cache against a plain model of it, and under many threads."""

from __future__ import annotations

import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.io.cache import LruCache

STEPS = st.lists(st.tuples(st.sampled_from(["get", "find", "forget", "clear"]), st.integers(0, 6)), max_size=60)


@given(limit=st.integers(1, 4), steps=STEPS)
def test_the_most_recently_used_values_are_there(limit: int, steps: list[tuple[str, int]]) -> None:
    cache: LruCache[int, str] = LruCache(limit)
    recent: list[int] = []  # the last is the one used last
    for step, key in steps:
        known = key in recent
        if step == "get":
            made: list[int] = []
            assert cache.get(key, lambda k=key, made=made: made.append(k) or f"value {k}") == f"value {key}"
            assert bool(made) != known
            recent = [*(k for k in recent if k != key), key][-limit:]
        elif step == "find":
            assert cache.find(key) == (f"value {key}" if known else None)
            recent = [*(k for k in recent if k != key), key] if known else recent
        elif step == "forget":
            cache.forget(key)
            recent = [k for k in recent if k != key]
        else:
            cache.clear()
            recent = []
        assert len(cache) == len(recent)


@given(limit=st.integers(0, 50), sizes=st.lists(st.integers(0, 60), max_size=30))
def test_values_never_take_more_bytes_than_the_limit(limit: int, sizes: list[int]) -> None:
    cache: LruCache[int, bytes] = LruCache(limit, size_of=len)
    for key, size in enumerate(sizes):
        assert len(cache.get(key, lambda size=size: b"x" * size)) == size
        assert (cache.find(key) is not None) == (size <= limit)
        assert sum(len(found) for k in range(len(sizes)) if (found := cache.find(k))) <= limit


def test_a_key_is_made_once_by_many_threads() -> None:
    cache: LruCache[str, int] = LruCache(8)
    made: list[str] = []
    start = threading.Barrier(16)

    def ask(number: int) -> int:
        key = f"key {number % 4}"

        def make() -> int:
            made.append(key)
            time.sleep(0.02)  # the others ask meanwhile
            return number % 4

        start.wait()
        return cache.get(key, make)

    with ThreadPoolExecutor(16) as threads:
        assert list(threads.map(ask, range(16))) == [n % 4 for n in range(16)]
    assert sorted(made) == [f"key {n}" for n in range(4)]


def test_one_key_does_not_wait_for_another() -> None:
    cache: LruCache[str, str] = LruCache(8)
    go_on, entered = threading.Event(), threading.Event()

    def slow() -> str:
        entered.set()
        assert go_on.wait(5)
        return "slow"

    with ThreadPoolExecutor(1) as threads:
        waiting = threads.submit(cache.get, "slow", slow)
        assert entered.wait(5)
        assert cache.get("quick", lambda: "quick") == "quick"
        assert not waiting.done()
        go_on.set()
        assert waiting.result(5) == "slow"


def test_who_waited_for_a_failure_tries_again() -> None:
    cache: LruCache[str, int] = LruCache(8)
    attempts: list[int] = []
    start = threading.Barrier(4)

    def make() -> int:
        attempts.append(1)
        time.sleep(0.01)  # as above
        if len(attempts) == 1:
            raise OSError("the first attempt fails")
        return 7

    def ask(_: int) -> int | None:
        start.wait()
        try:
            return cache.get("key", make)
        except OSError:
            return None

    with ThreadPoolExecutor(4) as threads:
        found = list(threads.map(ask, range(4)))
    assert sorted(found, key=str) == [7, 7, 7, None]
    assert len(attempts) == 2
    assert not cache._making


def test_a_value_may_need_another_but_not_itself() -> None:
    cache: LruCache[str, int] = LruCache(8)
    assert cache.get("outer", lambda: 1 + cache.get("inner", lambda: 1)) == 2

    def itself() -> int:
        return cache.get("endless", itself)

    with pytest.raises(RecursionError):
        itself()


def test_many_threads_and_few_places_give_right_values_and_leave_no_locks() -> None:
    cache: LruCache[int, int] = LruCache(2)
    with ThreadPoolExecutor(8) as threads:
        found = list(threads.map(lambda n: cache.get(n % 5, lambda: n % 5), range(2000)))
    assert found == [n % 5 for n in range(2000)]
    assert len(cache) <= 2
    assert not cache._making
