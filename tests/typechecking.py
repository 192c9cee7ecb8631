"""How shapes and types are checked while tests run.

`tests/conftest.py` puts `check` around every function and dataclass of Diorama through jaxtyping's import hook.
`DIORAMA_CHECK_SHAPES=0` leaves it out, to measure the program alone; a test marked `unchecked` passes wrong values on
purpose, or measures time.
"""

from __future__ import annotations

import os
import random
from collections.abc import Callable
from functools import cache, wraps
from typing import Any
from unittest import mock

items = random.Random(0)
"""Chooses which item of a list is checked; apart from the tests' own chance, and seeded for each test."""

with mock.patch("random.getrandbits", items.getrandbits):  # beartype takes it when it is imported, and only then
    from beartype import BeartypeConf, beartype

CONFIGURATION = BeartypeConf(is_pep484_tower=True)
"""A whole number is a `float` too, as static checkers have it."""


def wanted() -> bool:
    """Whether this run checks shapes and types."""
    return os.environ.get("DIORAMA_CHECK_SHAPES", "1") != "0"


def check(function: Callable[..., Any]) -> Callable[..., Any]:
    """The function behind beartype's checks, compiled at its first call: a test calls few functions."""
    compiled = cache(lambda: beartype(conf=CONFIGURATION)(function))

    @wraps(function)
    def checked(*args: Any, **kwargs: Any) -> Any:
        return compiled()(*args, **kwargs)

    return checked
