"""The protocols are what a researcher implements: each method says what it takes, gives and raises."""

from __future__ import annotations

import inspect

import pytest

from diorama_core import protocols

METHODS = [
    method
    for protocol in vars(protocols).values()
    if inspect.isclass(protocol) and protocol.__module__ == protocols.__name__
    for name, method in vars(protocol).items()
    if inspect.isfunction(method) and not name.startswith("_")
]


def test_there_is_one_method_per_stage_and_one_that_fills_what_objects_hide() -> None:
    assert len(METHODS) == 15


@pytest.mark.parametrize("method", METHODS, ids=lambda m: m.__qualname__)
def test_every_argument_result_and_error_is_documented(method: object) -> None:
    assert inspect.isfunction(method)
    documented = inspect.getdoc(method) or ""
    for argument in list(inspect.signature(method).parameters)[1:]:
        assert f"\n    {argument}: " in documented, argument
    assert "\nReturns:\n" in documented
    if method.__name__ != "depth":  # fails only as every stage may: see the module
        assert "\nRaises:\n" in documented
