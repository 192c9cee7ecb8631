"""Values of parsed JSON with the type that a reader needs, or none where a file holds something else."""

from __future__ import annotations

from typing import Any

MAX_SIDE = 1e6
"""In pixels: no picture is larger, so that what is larger is no side of one."""


def objects_of(value: object) -> list[dict[str, Any]]:
    """The entries of a list of objects; none where it is no list, or one that holds anything else."""
    return value if isinstance(value, list) and all(isinstance(v, dict) for v in value) else []


def whole_numbers(value: object) -> list[int]:
    """The entries of a list of numbers.

    Raises:
        ValueError: it is no such list.
    """
    if not isinstance(value, list) or not all(isinstance(v, int | float) for v in value):
        raise ValueError("no list of numbers")
    return [int(v) for v in value]


def size_of(width: object, height: object) -> tuple[int, int] | None:
    """Width and height of a picture; None where they are no numbers, or no sides of a picture."""
    if not isinstance(width, int | float) or not isinstance(height, int | float):
        return None
    return (int(width), int(height)) if 1 < width < MAX_SIDE and 1 < height < MAX_SIDE else None
