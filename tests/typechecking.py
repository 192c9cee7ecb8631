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
from collections.abc import Callable
from dataclasses import is_dataclass
from functools import cache, wraps
from types import FunctionType
from typing import Any, get_args, get_type_hints
from unittest import mock

import jaxtyping

items = random.Random(0)
"""Chooses which item of a list is checked; apart from the tests' own chance, and seeded for each test."""

with mock.patch("random.getrandbits", items.getrandbits):  # beartype takes it when it is imported, and only then
    from beartype import BeartypeConf, beartype

CONFIGURATION = BeartypeConf(is_pep484_tower=True, violation_type=jaxtyping.TypeCheckError)
"""A whole number is a `float` too, as static checkers have it."""


CHECKED_CALLS = 5
"""Of each function, in each test."""
_calls: dict[int, list[int]] = {}
"""By a function's code, how often it was called in this test: in a list, which a call finds without looking."""
_called: list[list[int]] = []
"""Those that were called at all."""


def install() -> None:
    """Check everything of Diorama that is imported from now on."""
    checks_all = jaxtyping.jaxtyped

    def jaxtyped(*, typechecker: Callable[..., Any]) -> Callable[[Any], Any]:
        return lambda item: _first_calls_checked(item, checks_all(typechecker=typechecker))

    jaxtyping.jaxtyped = jaxtyped  # type: ignore[assignment]  # the hook takes it by this name
    jaxtyping.install_import_hook(["diorama_core", "diorama_app"], f"{__name__}.check")


def begin_test(*, unchecked: bool) -> None:
    """Check the first calls again, and the same items of lists every time."""
    for calls in _called:
        calls[0] = 0
    _called.clear()
    items.seed(0)
    jaxtyping.config.update("jaxtyping_disable", unchecked)


_MARK = "first_calls_are_checked"


def _first_calls_checked(item: Any, checking: Callable[[Any], Any]) -> Any:
    """A function, or the constructor of a dataclass, whose first calls are checked."""
    if not inspect.isclass(item):
        return _alternating(item, checking)
    if is_dataclass(item) and "__init__" in vars(item) and not hasattr(item.__init__, _MARK):
        item.__init__ = _alternating(item.__init__, checking)  # as `jaxtyping.jaxtyped` does
    return item


def _alternating(unchecked: Callable[..., Any], checking: Callable[[Any], Any]) -> Callable[..., Any]:
    """The function, checked in its first calls: what checks it is made at the first, since most are never called.

    Calls of a function within another are counted for all that the other makes of it.
    """
    checked: Callable[..., Any] | None = None
    calls = _calls.setdefault(id(unchecked.__code__), [0])

    @wraps(unchecked)
    def called(*args: Any, **kwargs: Any) -> Any:
        nonlocal checked
        if calls[0] >= CHECKED_CALLS:  # before all else: loops call some functions a million times
            return unchecked(*args, **kwargs)
        if not calls[0]:
            _called.append(calls)
        calls[0] += 1
        if jaxtyping.config.jaxtyping_disable:
            return unchecked(*args, **kwargs)
        if checked is None:
            plain = _plain_annotations(unchecked)
            checked = checking(unchecked) if plain is None else check(_annotated(unchecked, plain))
        return checked(*args, **kwargs)

    setattr(called, _MARK, True)
    return called


def _plain_annotations(function: Callable[..., Any]) -> dict[str, Any] | None:
    """What parameters and result are, where beartype alone can tell: shapes, which jaxtyping compares with one another,
    annotations that cannot be read, and those of generators are left to jaxtyping (None).
    """
    if inspect.isgeneratorfunction(function) or inspect.isasyncgenfunction(function):
        return None
    try:
        annotations = get_type_hints(function, include_extras=True)
    except Exception:
        return None
    return None if any(_holds_shapes(annotation) for annotation in annotations.values()) else annotations


def _annotated(function: Callable[..., Any], annotations: dict[str, Any]) -> Callable[..., Any]:
    """The same function with the annotations themselves in place of their text."""
    code, names = function.__code__, function.__globals__
    same = FunctionType(code, names, function.__name__, function.__defaults__, function.__closure__)
    same.__kwdefaults__, same.__annotations__ = function.__kwdefaults__, annotations
    same.__module__, same.__qualname__ = function.__module__, function.__qualname__
    return same


def _holds_shapes(annotation: Any) -> bool:
    if isinstance(annotation, list):  # the parameters of a `Callable`
        return any(map(_holds_shapes, annotation))
    is_array = inspect.isclass(annotation) and issubclass(annotation, jaxtyping.AbstractArray)
    return is_array or any(map(_holds_shapes, get_args(annotation)))


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
