"""Designs made to measure: built at another size, with other values of their builder's parameters.

A builder's arguments are the parameters of its designs: the height of a base, the form of a back, the number of
drawers, what fills each bay of a front, the panes of a window. Materials and styles are none. What a parameter may be is
what the designs of the same builder (its family) use, numbers also a little beyond.

`night-stand-cane+made-420x480x600.base=plinth.bays=door,2` is the design `night-stand-cane` at that size in millimetres
with these two parameters changed. Nothing has to be stored: libraries derive such a shape from the one it is named after.
Some changes are of the whole form, whatever builds it (`reshaping`): its girth along the height, and its mirror image.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from jaxtyping import Float

from diorama_core.errors import LibraryError
from diorama_core.library import furniture
from diorama_core.library.furniture import reshaping
from diorama_core.library.furniture.model import Design
from diorama_core.library.record import ROUND, SymmetryFold

MARK = "+made-"
Value = bool | int | float | str | tuple[str, ...] | tuple[int, ...]
"""What a parameter may be; bays and panes are tuples."""
BEYOND_COUNT, BEYOND_SHARE = 1, 0.2
"""Counts may be so much beyond, and lengths this share beyond, what designs of the family use."""
MAX_COUNT = 24
"""Larger counts (leaves, ribs, pleats) are texture rather than form, and no parameters."""
NEAR_COUNT, LENGTHS = 2, 4
"""Alternatives of a count are at most so far from it; of a length so many, evenly spread."""
MIN_FACTOR, MAX_FACTOR = 0.2, 5.0
"""Of each extent, against the design it is derived from."""
OVAL = 1.03
"""Ratio of the sides from which on a round shape is oval."""
NO_PARAMETERS = frozenset({"seed", "style"})
"""Arguments that are not form: chance, and what runs through a whole suite of furniture."""
_SIZE = re.compile(r"(\d{1,5})x(\d{1,5})x(\d{1,5})")
_MILLI = 1000.0


@dataclass(frozen=True)
class Parameter:
    """One argument of a builder that designs may have other values of."""

    name: str
    used: tuple[Value, ...]
    """Values that the family uses, in order where they have one."""

    @property
    def is_count(self) -> bool:
        """Whether its values are whole numbers."""
        return all(isinstance(v, int) and not isinstance(v, bool) for v in self.used)

    @property
    def is_length(self) -> bool:
        """Whether its values are lengths, angles or shares."""
        return all(isinstance(v, float) for v in self.used)

    @property
    def limits(self) -> tuple[float, float]:
        """Least and greatest number that it may be."""
        numbers = [float(v) for v in self.used if isinstance(v, int | float)]
        low, high = min(numbers), max(numbers)
        if self.is_count:
            return max(low - BEYOND_COUNT, min(low, 1.0)), high + BEYOND_COUNT
        return low - BEYOND_SHARE * abs(low), high + BEYOND_SHARE * abs(high)

    def allows(self, value: Value) -> bool:
        """Whether a design may have this value."""
        if (self.is_count or self.is_length) and isinstance(value, int | float):
            least, most = self.limits
            return least - 1e-9 <= value <= most + 1e-9
        return value in self.used

    def alternatives(self, value: Value) -> tuple[Value, ...]:
        """Other values worth trying, beginning from one."""
        if self.is_count and isinstance(value, int):
            fewest, most = (int(v) for v in self.limits)
            near = range(max(fewest, value - NEAR_COUNT), min(most, value + NEAR_COUNT) + 1)
            return tuple(n for n in near if n != value)
        if self.is_length and isinstance(value, float):
            low, high = self.limits
            spread = (round(float(v), 3) for v in np.linspace(low, high, LENGTHS))
            return tuple(v for v in spread if abs(v - value) > 1e-3)
        return tuple(v for v in self.used if v != value)


def is_made(shape_id: str) -> bool:
    """Whether an id says that its shape is made to measure."""
    return MARK in shape_id


@lru_cache(maxsize=4096)
def parameters(design_id: str) -> tuple[Parameter, ...]:
    """The parameters of a built-in design, in the order of its builder; none where it is not known."""
    design = _designs().get(design_id)
    if design is None:
        return ()
    family = _family(design)
    found = []
    for name, argument in inspect.signature(design.builder).parameters.items():
        if name in NO_PARAMETERS or argument.kind in (argument.VAR_KEYWORD, argument.VAR_POSITIONAL):
            continue
        values = [_plain(d.options.get(name, argument.default)) for d in family]
        if any(v is None for v in values):
            continue
        used = tuple(sorted({v for v in values if v is not None}, key=lambda v: (str(type(v)), v)))
        if len(used) == 1 and isinstance(used[0], bool):
            used = (False, True)
        parameter = Parameter(name, used)
        texture = parameter.is_count and parameter.limits[1] > MAX_COUNT
        if not texture and (len(used) > 1 or parameter.is_count or (parameter.is_length and used[0])):
            found.append(parameter)
    return tuple(found)


def values_of(design: Design) -> dict[str, Value]:
    """What the parameters of a design are."""
    base = _designs().get(_base(design.id), design)
    arguments = inspect.signature(base.builder).parameters
    stated = {p.name: _plain(design.options.get(p.name, arguments[p.name].default)) for p in parameters(base.id)}
    return {name: value for name, value in stated.items() if value is not None}


def varied(design_id: str) -> Iterator[tuple[str, tuple[Value, ...]]]:
    """The parameters of a built-in design, each with the values worth trying instead of its own."""
    design = _designs().get(design_id)
    own = {} if design is None else values_of(design)
    for parameter in parameters(design_id):
        if parameter.name in own:
            yield parameter.name, parameter.alternatives(own[parameter.name])


def can_be_turned(design_id: str) -> bool:
    """Whether a built-in design is a body of revolution, whose girth may be another along its height."""
    design = _designs().get(design_id)
    return design is not None and design.symmetry == ROUND


def is_turned(shape_id: str) -> bool:
    """Whether an id says that its shape has another girth than its design."""
    return is_made(shape_id) and f";{reshaping.GIRTH}=" in shape_id


def can_be_made(design_id: str, size_m: Float[np.ndarray, "3"]) -> bool:
    """Whether a design can be made at a size; only built-in ones can."""
    design = _designs().get(design_id)
    if design is None:
        return False
    factors = _millimetres(size_m) / (_MILLI * np.asarray(design.size_m))
    return bool(factors.min() >= MIN_FACTOR and factors.max() <= MAX_FACTOR)


def made_id(design_id: str, size_m: Float[np.ndarray, "3"], changes: Mapping[str, Value]) -> str:
    """The id of a built-in design made to measure; arguments and errors as for `made_to_measure`."""
    design = _designs().get(design_id)
    if design is None:
        raise LibraryError(f"no built-in shape is called '{design_id}'; only those are made to measure")
    return made_to_measure(design, size_m, changes).id


def made_to_measure(base: Design, size_m: Float[np.ndarray, "3"], changes: Mapping[str, Value]) -> Design:
    """A design at another size, with some parameters changed; its id says both.

    Args:
        base: A built-in design.
        size_m: Its extents, rounded to millimetres.
        changes: Values by parameter; those that the design has already are left out.

    Raises:
        LibraryError: for a size out of reach, a parameter that the design has not, or a value that it may not have.
    """
    size, factors = _millimetres(size_m), _millimetres(size_m) / (_MILLI * np.asarray(base.size_m))
    if not can_be_made(base.id, size_m):
        raise LibraryError(f"'{base.id}' cannot be made {'x'.join(f'{v:.0f}' for v in size)} mm large")
    known, own = {p.name: p for p in parameters(base.id)}, {**reshaping.AS_BUILT, **values_of(base)}
    for name, value in changes.items():
        whole = name in reshaping.NAMES
        allowed = _may_be_whole(base, name, value) if whole else name in known and known[name].allows(value)
        if not allowed:
            raise LibraryError(f"'{base.id}' cannot be made with {name} {_told(value)}")
    changed = {name: value for name, value in sorted(changes.items()) if own.get(name) != value}
    options = {**base.options, **{n: _as_given(base, n, v) for n, v in changed.items()}}
    whole = bool(changed.keys() & reshaping.NAMES)
    words = [f"{size[0]:.0f}x{size[1]:.0f}x{size[2]:.0f}", *(f"{n}={_told(v)}" for n, v in changed.items())]
    x, y, z = (float(v) / _MILLI for v in size)
    return replace(
        base,
        id=f"{base.id}{MARK}{';'.join(words)}",
        caption=f"{base.caption}, made to measure",
        size_m=(x, y, z),
        builder=reshaping.reshaped if whole else base.builder,
        options={**options, "builder": base.builder} if whole else options,
        symmetry=_symmetry(base, factors, bool(changed.keys() - {reshaping.GIRTH})),
        mass_kg=None if base.mass_kg is None else round(base.mass_kg * float(np.prod(factors)), 3),
    )


def made_by_id(shape_id: str, base: Design) -> Design:
    """The design that an id made to measure says.

    Raises:
        LibraryError: when it is not one that `made_to_measure` gives.
    """
    design = made_to_measure(base, *_stated(shape_id, base))
    if design.id != shape_id:
        raise LibraryError(f"'{shape_id}' does not say how '{base.id}' is made")
    return design


def mirror_image(shape_id: str) -> str | None:
    """The id of a built-in design, made to measure or not, with left and right changed; None where it may not be."""
    base = _designs().get(_base(shape_id))
    if base is None or base.symmetry != 1:
        return None
    size_m, changes = _stated(shape_id, base) if is_made(shape_id) else (np.asarray(base.size_m), {})
    if changes.pop(reshaping.MIRRORED, False):
        plain = not changes and (size_m == np.asarray(base.size_m)).all()
        return base.id if plain else made_id(base.id, size_m, changes)
    return made_id(base.id, size_m, {**changes, reshaping.MIRRORED: True})


def _stated(shape_id: str, base: Design) -> tuple[Float[np.ndarray, "3"], dict[str, Value]]:
    """The size and the changed parameters that an id states; errors as for `made_by_id`."""
    words = shape_id.split(MARK, 1)[1].split(";")
    size = _SIZE.fullmatch(words[0])
    stated = [word.partition("=") for word in words[1:]]
    known = {p.name: p for p in parameters(base.id)}
    if size is None or any(not equals or name not in {*known, *reshaping.NAMES} for name, equals, _ in stated):
        raise LibraryError(f"'{shape_id}' does not say how '{base.id}' is made")
    changes = {
        name: _read_whole(name, text, shape_id) if name in reshaping.NAMES else _read(known[name], text, shape_id)
        for name, _, text in stated
    }
    return np.array([int(v) for v in size.groups()]) / _MILLI, changes


def _as_given(base: Design, name: str, value: Value) -> Any:
    """The value as the design's builder takes it: what was a list is one."""
    return list(value) if isinstance(value, tuple) and isinstance(base.options.get(name), list) else value


def _millimetres(size_m: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
    return np.maximum(np.round(np.asarray(size_m) * _MILLI), 1.0)


def _symmetry(base: Design, factors: Float[np.ndarray, "3"], changed: bool) -> SymmetryFold:
    """Turns that leave it the same: of an oval half turns only, of another form nobody knows."""
    if base.symmetry == 1 or changed:
        return 1
    uneven = max(factors[:2]) / min(factors[:2]) > OVAL
    if not uneven:
        return base.symmetry
    return 2 if base.symmetry == ROUND or base.symmetry % 2 == 0 else 1


def _told(value: Value) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        return ",".join(str(v) for v in value)
    return f"{value:g}" if isinstance(value, float) else str(value)


def _read(parameter: Parameter, text: str, shape_id: str) -> Value:
    """The value that `_told` wrote."""
    said = next((v for v in parameter.used if _told(v) == text), None)
    if said is not None:
        return said
    try:
        if parameter.is_count:
            return int(text)
        if parameter.is_length and np.isfinite(float(text)):
            return float(text)
    except ValueError:
        pass
    raise LibraryError(f"'{shape_id}': {parameter.name} cannot be '{text[:40]}'")


def _may_be_whole(base: Design, name: str, value: Value) -> bool:
    if name == reshaping.MIRRORED:
        return value is True and base.symmetry == 1
    percents = value if isinstance(value, tuple) else ()
    within = all(isinstance(v, int) and reshaping.MIN_PERCENT <= v <= reshaping.MAX_PERCENT for v in percents)
    return base.symmetry == ROUND and len(percents) == reshaping.KNOTS and within


def _read_whole(name: str, text: str, shape_id: str) -> Value:
    value = reshaping.read(name, text)
    if value is None:
        raise LibraryError(f"'{shape_id}': {name} cannot be '{text[:40]}'")
    return value


def _plain(value: Any) -> Value | None:
    """An argument's value where it is one of a parameter; None for materials, styles and functions."""
    if isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, Sequence) and value:
        if all(isinstance(v, str) for v in value):
            return tuple(str(v) for v in value)
        if all(isinstance(v, int) for v in value):
            return tuple(int(v) for v in value)
    return None


def _base(design_id: str) -> str:
    return design_id.split(MARK, 1)[0]


@lru_cache(maxsize=1)
def _designs() -> dict[str, Design]:
    return {d.id: d for d in furniture.designs()}


@lru_cache(maxsize=1)
def _families() -> dict[Any, tuple[Design, ...]]:
    found: dict[Any, list[Design]] = {}
    for design in _designs().values():
        found.setdefault(design.builder, []).append(design)
    return {builder: tuple(members) for builder, members in found.items()}


def _family(design: Design) -> tuple[Design, ...]:
    return _families()[design.builder]
