"""How shapes and types are checked while tests run.

`tests/conftest.py` puts `check` around every function and dataclass of Diorama through jaxtyping's import hook. In each
test the first calls of each are checked: what the first thousand did right, the next seldom does wrong, and to check
all of them doubles the time of tests. `DIORAMA_CHECK_SHAPES=0` leaves it out, to measure the program alone; a test
marked `unchecked` passes wrong values on purpose, or measures time.
"""

from __future__ import annotations

import inspect
import os
import random
from collections import Counter
from collections.abc import Callable
from functools import cache, wraps
from typing import Any
from unittest import mock

import jaxtyping

items = random.Random(0)
"""Chooses which item of a list is checked; apart from the tests' own chance, and seeded for each test."""

with mock.patch("random.getrandbits", items.getrandbits):  # beartype takes it when it is imported, and only then
    from beartype import BeartypeConf, beartype

CONFIGURATION = BeartypeConf(is_pep484_tower=True)
"""A whole number is a `float` too, as static checkers have it."""


CHECKED_CALLS = 20
"""Of each function, in each test."""
_calls: Counter[int] = Counter()


def install() -> None:
    """Check everything of Diorama that is imported from now on."""
    checks_all = jaxtyping.jaxtyped

    def jaxtyped(*, typechecker: Callable[..., Any]) -> Callable[[Any], Any]:
        return lambda item: _first_calls_checked(item, checks_all(typechecker=typechecker))

    jaxtyping.jaxtyped = jaxtyped  # type: ignore[assignment]  # the hook takes it by this name
    jaxtyping.install_import_hook(["diorama_core", "diorama_app"], f"{__name__}.check")


def begin_test(*, unchecked: bool) -> None:
    """Check the first calls again, and the same items of lists every time."""
    _calls.clear()
    items.seed(0)
    jaxtyping.config.update("jaxtyping_disable", unchecked)


def _first_calls_checked(item: Any, checking: Callable[[Any], Any]) -> Any:
    """A function, or the constructor of a class, whose first calls are checked."""
    if inspect.isclass(item):
        unchecked = item.__init__
        made = checking(item)
        if made.__init__ is not unchecked:
            made.__init__ = _alternating(unchecked, made.__init__)
        return made
    return _alternating(item, checking(item))


def _alternating(unchecked: Callable[..., Any], checked: Callable[..., Any]) -> Callable[..., Any]:
    @wraps(unchecked)
    def called(*args: Any, **kwargs: Any) -> Any:
        _calls[key] += 1
        return (checked if _calls[key] <= CHECKED_CALLS else unchecked)(*args, **kwargs)

    key = id(called)
    return called


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
