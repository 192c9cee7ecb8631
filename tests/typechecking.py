"""How shapes and types are checked while tests run.

`tests/conftest.py` puts `check` around every function and dataclass of Diorama through jaxtyping's import hook. In each
test the first calls of each are checked: what the first thousand did right, the next seldom does wrong, and to check
all of them doubles the time of tests. `DIORAMA_CHECK_SHAPES=0` leaves it out, to measure the program alone; a test
marked `unchecked` passes wrong values on purpose, or measures time.
"""

from __future__ import annotations

import gc
import inspect
import os
import random
import threading
import warnings
from collections.abc import Callable
from dataclasses import is_dataclass
from functools import cache, wraps
from importlib.util import cache_from_source
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any, get_args, get_type_hints
from unittest import mock

import jaxtyping
from jaxtyping import _import_hook

PACKAGES = ("diorama_core", "diorama_app")

items = random.Random(0)
"""Chooses which item of a list is checked; apart from the tests' own chance, and seeded for each test."""

with mock.patch("random.getrandbits", items.getrandbits):  # beartype takes it when it is imported, and only then
    from beartype import BeartypeConf, beartype

CONFIGURATION = BeartypeConf(is_pep484_tower=True, violation_type=jaxtyping.TypeCheckError)
"""A whole number is a `float` too, as static checkers have it."""


CHECKED_CALLS = 2
"""Of each function, in each test."""
_calls: dict[int, list[int]] = {}
"""By a function's code, how often it was called in this test."""
_counted: list[list[int]] = []
"""Those that are not 0."""
_called: dict[int, tuple[FunctionType, CodeType]] = {}
"""Functions that were called, by their identity, each with the code that checks."""


def install() -> None:
    """Check everything of Diorama that is imported from now on."""
    checks_all = jaxtyping.jaxtyped

    def jaxtyped(*context: str, typechecker: Callable[..., Any] | None = None) -> Any:
        if context:
            return checks_all(*context)
        return lambda item: _first_calls_checked(item, checks_all(typechecker=typechecker))

    jaxtyping.jaxtyped = jaxtyped  # type: ignore[assignment]  # the hook takes it by this name
    _import_hook._optimized_cache_from_source = compiled_at
    _import_hook._JaxtypingLoader.source_to_code = _undisturbed(_import_hook._JaxtypingLoader.source_to_code)
    jaxtyping.install_import_hook(PACKAGES, f"{__name__}.check")


_compiling = threading.RLock()


def _undisturbed(compiles: Callable[..., CodeType]) -> Callable[..., CodeType]:
    """Compile one module at a time, without collecting garbage meanwhile.

    Where CPython 3.11 makes a tree of Python objects, it counts the depth for all threads together: if a finalizer lets
    another thread begin a tree there, it raises `SystemError: AST constructor recursion depth mismatch`.
    """

    def compile_alone(*args: Any, **kwargs: Any) -> CodeType:
        with _compiling:
            collecting = gc.isenabled()
            gc.disable()
            try:
                return compiles(*args, **kwargs)
            finally:
                if collecting:
                    gc.enable()

    return compile_alone


_OURS = tuple(str(Path(__file__).resolve().parents[1] / package) for package in PACKAGES)
_apart = _import_hook._optimized_cache_from_source


def compiled_at(checks: str, /, path: str, debug_override: bool | None = None) -> str:
    """Where the compiled form of a file lies: Diorama's with the checks apart, that of all others where it always does.

    jaxtyping keeps whatever a checked module imports apart too, so that other packages would be compiled twice.
    """
    if str(path).startswith(_OURS):
        return _apart(checks, path, debug_override)
    return cache_from_source(path, debug_override)


def begin_test(*, unchecked: bool) -> None:
    """Check the first calls again, and the same items of lists every time."""
    while _counted:
        _counted.pop()[0] = 0
    while _called:  # threads of a test before may still call
        _, (function, checking) = _called.popitem()
        function.__code__ = checking
    items.seed(0)
    jaxtyping.config.update("jaxtyping_disable", unchecked)


def _first_calls_checked(item: Any, checking: Callable[[Any], Any]) -> Any:
    """A function, or the constructor of a dataclass, whose first calls are checked."""
    if not inspect.isclass(item):
        _check_first_calls(item, checking)
    elif is_dataclass(item) and "__init__" in vars(item) and not hasattr(item.__init__, "__wrapped__"):
        _check_first_calls(item.__init__, checking)  # as `jaxtyping.jaxtyped` does
    return item


_IS_ASKED_FOR = inspect.CO_GENERATOR | inspect.CO_COROUTINE | inspect.CO_ASYNC_GENERATOR
"""What others ask a function's code for, so that it must not change between two calls."""


def _check_first_calls(function: FunctionType, checking: Callable[..., Any]) -> None:
    """Check the function's first calls: what checks it is made at the first, since most are never called.

    Until then its code is one that checks, later its own again, so that the million calls of a loop cost nothing.
    Calls of a function within another are counted for all that the other makes of it.
    """
    code = function.__code__
    calls = _calls.setdefault(id(code), [0])
    if calls[0] >= CHECKED_CALLS:
        return
    plain = _copy(function)
    checked: Callable[..., Any] | None = None

    def called(*args: Any, **kwargs: Any) -> Any:
        nonlocal checked
        if not calls[0]:
            _counted.append(calls)
        calls[0] += 1
        if id(function) not in _called:
            _called[id(function)] = function, own_checks
        if calls[0] >= CHECKED_CALLS and not code.co_flags & _IS_ASKED_FOR:
            function.__code__ = code
        if jaxtyping.config.jaxtyping_disable or calls[0] > CHECKED_CALLS:
            return plain(*args, **kwargs)
        if checked is None:
            annotations = _plain_annotations(plain)
            checked = checking(plain) if annotations is None else check(_copy(plain, annotations))
        return checked(*args, **kwargs)

    own_checks = _calling(called, code)
    function.__code__ = own_checks
    function.__wrapped__ = plain  # whose signature it has


@cache
def _template(held: int) -> CodeType:
    """Code of a function that holds so many names from around it, and calls the number 0 with whatever it is given."""
    names = ", ".join(f"name_{i}" for i in range(held))
    text = (
        f"def around({names}):\n def calling(*args, **kwargs):\n  if 0: {names or 'pass'}\n  return 0(*args, **kwargs)"
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SyntaxWarning)  # a number is not called: the function that takes its place is
        around = compile(text, __file__, "exec").co_consts[0]
    return next(part for part in around.co_consts if isinstance(part, CodeType))


def _calling(called: Callable[..., Any], code: CodeType) -> CodeType:
    """Code that can take the place of a function's own and calls another function with the same arguments."""
    template = _template(len(code.co_freevars))
    constants = tuple(called if constant == 0 else constant for constant in template.co_consts)
    return template.replace(co_consts=constants, co_name=code.co_name)


def _copy(function: FunctionType, annotations: dict[str, Any] | None = None) -> FunctionType:
    """A copy of a function, with the annotations themselves in place of their text where they are given."""
    code, names = function.__code__, function.__globals__
    same = FunctionType(code, names, function.__name__, function.__defaults__, function.__closure__)
    same.__kwdefaults__, same.__doc__ = function.__kwdefaults__, function.__doc__
    same.__annotations__ = function.__annotations__ if annotations is None else annotations
    same.__module__, same.__qualname__ = function.__module__, function.__qualname__
    return same


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
