"""Whether a value read back is of the type that the code says it is."""

from __future__ import annotations

import types
from dataclasses import fields, is_dataclass
from enum import StrEnum
from functools import cache
from typing import Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np


def fits(value: Any, annotation: Any) -> bool:
    """Whether a value is of an annotated type, its parts included.

    Understands classes, `None`, unions, `Literal`, `tuple`, `dict`, jaxtyping's arrays (number type and dimensions, not
    named sizes) and dataclasses of these. Whole numbers pass as `float`; numbers must be finite.
    """
    origin, arguments = get_origin(annotation), get_args(annotation)
    if annotation is Any or isinstance(annotation, TypeVar):
        return True
    if annotation is None or annotation is type(None):
        return value is None
    if origin in (Union, types.UnionType):
        return any(fits(value, one) for one in arguments)
    if origin is Literal:
        return value in arguments
    if origin is tuple or annotation is tuple:
        return isinstance(value, tuple) and _tuple_fits(value, arguments)
    if origin is dict:
        return isinstance(value, dict) and all(
            fits(k, arguments[0]) and fits(v, arguments[1]) for k, v in value.items()
        )
    return isinstance(annotation, type) and _instance_fits(value, annotation)


def _tuple_fits(value: tuple, arguments: tuple) -> bool:
    if not arguments:
        return True
    if len(arguments) == 2 and arguments[1] is Ellipsis:
        return all(fits(one, arguments[0]) for one in value)
    return len(value) == len(arguments) and all(map(fits, value, arguments))


def _instance_fits(value: Any, annotation: type) -> bool:
    if annotation in (int, float):
        kinds = (int,) if annotation is int else (int, float)
        return isinstance(value, kinds) and not isinstance(value, bool) and abs(value) < float("inf")
    if not isinstance(value, annotation):
        return False
    if is_dataclass(value):
        return all(fits(getattr(value, name), hint) for name, hint in field_types(value.__class__).items())
    return not isinstance(value, np.ndarray) or value.dtype.kind != "f" or bool(np.isfinite(value).all())


@cache
def field_types(kind: type) -> dict[str, Any]:
    """The annotated types of a dataclass's fields by name."""
    hints = get_type_hints(kind)
    return {f.name: hints[f.name] for f in fields(kind)}


def as_member(value: Any, annotation: Any) -> Any:
    """A string as the member of the `StrEnum` that is asked for; any other value as it is.

    Raises:
        ValueError: when the enum has no such member.
    """
    named = isinstance(annotation, type) and issubclass(annotation, StrEnum) and isinstance(value, str)
    return annotation(value) if named else value
