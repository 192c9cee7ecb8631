"""Equality, hashing and immutability for frozen dataclasses that hold numpy arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import Field, fields
from typing import Any, ClassVar

import numpy as np
from jaxtyping import Real

Vector3 = Real[np.ndarray, "3"] | Sequence[float]
"""Three numbers along x, y and z as a caller has them; made an array of floats where they arrive."""


def read_only_array(value: Any, shape: tuple[int, ...], dtype: Any = np.float64) -> np.ndarray:
    """A read-only copy of `value` with the given shape (-1 matches any length).

    Raises:
        ValueError: when the shape differs or a number is not finite.
    """
    try:
        array = np.array(value, dtype=dtype)
    except OverflowError as error:  # a whole number of hundreds of digits
        raise ValueError("every number must be finite") from error
    fits = array.ndim == len(shape) and all(want in (-1, have) for want, have in zip(shape, array.shape, strict=True))
    if not fits:
        raise ValueError(f"expected an array of shape {shape}, got {array.shape}")
    if array.dtype.kind == "f" and not np.isfinite(array).all():
        raise ValueError("every number must be finite")
    array.setflags(write=False)
    return array


def _same(a: Any, b: Any) -> bool:
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return bool(np.array_equal(a, b))
    return bool(a == b)


def _hashable(value: Any) -> Any:
    return value.tobytes() if isinstance(value, np.ndarray) else value


class ArrayValue:
    """Base of `@dataclass(frozen=True, eq=False)` values whose fields may be arrays: equal by content."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    """As every subclass has them."""

    def __eq__(self, other: object) -> bool:
        if self is other:
            return True
        if type(self) is not type(other):
            return NotImplemented
        return all(_same(getattr(self, f.name), getattr(other, f.name)) for f in fields(self))

    def __hash__(self) -> int:
        return hash(tuple(_hashable(getattr(self, f.name)) for f in fields(self)))
