"""The most recently used values in memory, each made once however many threads ask for it."""

from __future__ import annotations

import threading
from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Generic, TypeVar

from cachetools import LRUCache

Key = TypeVar("Key", bound=Hashable)
Value = TypeVar("Value")


class LruCache(Generic[Key, Value]):
    """Values by key, least recently used ones dropped first; safe to share between threads.

    A value is made outside the cache's own lock, under a lock of its key: who asks for the same key waits, who asks
    for another does not. A failed attempt leaves nothing behind; the next one tries again.

    Args:
        limit: The greatest sum of sizes: how many values, or how much of what `size_of` counts.
        size_of: Size of one value, for instance its bytes; 1 by default. A value beyond the limit is not cached.
    """

    def __init__(self, limit: float, size_of: Callable[[Value], float] | None = None) -> None:
        self._values: LRUCache[Key, Value] = LRUCache(limit, size_of)
        self._making: dict[Key, _Turn] = {}
        self._lock = threading.Lock()

    def __len__(self) -> int:
        return len(self._values)

    def get(self, key: Key, make: Callable[[], Value]) -> Value:
        """The cached value, or that of `make()`, whose exceptions pass through.

        `make` may use this cache for other keys.
        """
        with self._lock:
            if key in self._values:
                return self._values[key]
        with self._turn(key):
            with self._lock:
                if key in self._values:
                    return self._values[key]
            value = make()
            with self._lock:
                self._put(key, value)
            return value

    def find(self, key: Key) -> Value | None:
        """The cached value, which counts as a use, or None."""
        with self._lock:
            return self._values.get(key)

    def forget(self, key: Key) -> None:
        """Drop one value, so that it is made again."""
        with self._lock:
            self._values.pop(key, None)

    def clear(self) -> None:
        """Drop all values."""
        with self._lock:
            self._values.clear()

    def _put(self, key: Key, value: Value) -> None:
        try:
            self._values[key] = value
        except ValueError:  # larger than the whole cache: made again each time
            self._values.pop(key, None)

    @contextmanager
    def _turn(self, key: Key) -> Iterator[None]:
        """Exclusive access to a key. Its lock exists while it is held or awaited."""
        with self._lock:
            turn = self._making.setdefault(key, _Turn())
            turn.threads += 1
        try:
            with turn.lock:
                yield
        finally:
            with self._lock:
                turn.threads -= 1
                if not turn.threads:
                    del self._making[key]


@dataclass
class _Turn:
    # Re-entrant, so that a value that needs itself ends in a RecursionError and not in silence.
    lock: threading.RLock = field(default_factory=threading.RLock)
    threads: int = 0
