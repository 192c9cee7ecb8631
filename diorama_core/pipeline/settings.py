"""Settings by name: the numbers of the stages are fields of frozen values, addressed as `layout.weights.outline`.

A stage that others can do without has its own name as a setting: 0 leaves it out.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any

from diorama_core.errors import InputError
from diorama_core.pipeline.stages import Stages


def settings_of(stages: Stages) -> dict[str, float]:
    """Every number that a stage, or a value within it, has as a field; by name, in the order of the stages.

    Optional stages that are there count 1.
    """
    optional = {f.name: 1.0 for f in fields(stages) if f.default is None and getattr(stages, f.name) is not None}
    return {**optional, **dict(_numbers(stages, ""))}


def with_settings(stages: Stages, values: Mapping[str, float]) -> Stages:
    """The stages with other values in some fields; whole numbers stay whole, and a stage's own name leaves it out.

    Raises:
        InputError: a name that is none of `settings_of`.
    """
    known = settings_of(stages)
    for name in values:
        if name not in known:
            raise InputError(f"{name}: the stages have no such setting; there are {', '.join(known)}")
    for name, value in values.items():
        if "." in name:
            stages = _replace_number(stages, name.split("."), value)
        elif value == 0:
            left_out: dict[str, Any] = {name: None}
            stages = replace(stages, **left_out)
    return stages


def _numbers(value: Any, prefix: str) -> Iterator[tuple[str, float]]:
    for f in fields(value):
        value_of_field, name = getattr(value, f.name), f"{prefix}{f.name}"
        if isinstance(value_of_field, (int, float)) and not isinstance(value_of_field, bool):
            yield name, value_of_field
        elif is_dataclass(value_of_field) and not isinstance(value_of_field, type):
            yield from _numbers(value_of_field, f"{name}.")


def _replace_number(value: Any, names: list[str], number: float) -> Any:
    """The dataclass with another number in the field, or the field within a field, of these names."""
    current = getattr(value, names[0])
    if len(names) > 1:
        new = _replace_number(current, names[1:], number)
    else:
        new = round(number) if isinstance(current, int) else float(number)
    return replace(value, **{names[0]: new})
