"""Values that are dear to make and often asked for again."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable
from typing import Generic, TypeVar

Value = TypeVar("Value")


class LruCache(Generic[Value]):
    """The most recently used values by name; each is made once, by one thread, while others wait for it.

    Args:
        size: How many are kept.
    """

    def __init__(self, size: int) -> None:
        self._size = size
        self._values: OrderedDict[str, Value] = OrderedDict()
        self._making: dict[str, threading.Lock] = {}
        self._lock = threading.Lock()

    def get(self, name: str, make: Callable[[], Value]) -> Value:
        """The value kept under `name`, made now if there is none."""
        with self._lock:
            if name in self._values:
                self._values.move_to_end(name)
                return self._values[name]
            making = self._making.setdefault(name, threading.Lock())
        with making:
            with self._lock:
                if name in self._values:
                    return self._values[name]
            value = make()
            with self._lock:
                self._values[name] = value
                while len(self._values) > self._size:
                    self._values.popitem(last=False)
                self._making.pop(name, None)
            return value

    def forget(self, name: str) -> None:
        """Drop one value, so that it is made again."""
        with self._lock:
            self._values.pop(name, None)
