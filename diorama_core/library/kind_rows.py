"""Rows of `kinds.toml`: everything the program knows about a kind of object, one row a kind."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
from jaxtyping import Float
from pydantic import ConfigDict, TypeAdapter, ValidationError

from diorama_core.errors import LibraryError

PATH = Path(__file__).with_name("kinds.toml")

Mount = Literal["floor", "surface", "wall", "ceiling"]
"""Where an object of a category is usually found: standing on the floor, on another object, or hung."""

Trait = Literal[
    "supports_objects",  # people put objects on it, so that its shapes must come empty
    "quarter_turns_free",  # often stands at odd angles to the room (chairs, plants)
    "soft",  # gives way: lies against and partly in other soft objects
    "back_at_wall",  # its back stands at a wall
    "lamp",  # gives light
    "portable",  # stands on the floor or on furniture, by its size
    "never_open",  # nobody looks through it: colours of its surroundings within its outline are its own
]
"""A yes-or-no property of a kind; special kinds have those of their kin, but for the ones that their rows lack."""


@dataclass(frozen=True)
class SizePrior:
    """Log-normal sizes of a category: medians in metres and standard deviations of their logarithms."""

    height_m: float
    width_m: float
    """Left to right, seen from the front (object y)."""
    depth_m: float
    """Front to back (object x)."""
    sigma_height: float
    sigma_width: float
    sigma_depth: float

    @property
    def log_median_xyz(self) -> Float[np.ndarray, "3"]:
        """Logarithms of the medians in object order: x (depth), y (width), z (height)."""
        return np.log([self.depth_m, self.width_m, self.height_m])

    @property
    def log_sigma_xyz(self) -> Float[np.ndarray, "3"]:
        """Standard deviations of the logarithms in object order."""
        return np.array([self.sigma_depth, self.sigma_width, self.sigma_height])


@dataclass(frozen=True)
class Category:
    """One canonical category: a row of the table."""

    __pydantic_config__ = ConfigDict(extra="forbid", strict=False)

    name: str
    sizes: tuple[tuple[float, float, float, float, float, float], ...]
    """Height, width and depth in metres and the sigmas of their logarithms; one a mode (a bed with and without a
    headboard), most common first."""
    mount: Mount = "floor"
    synonyms: tuple[str, ...] = ()
    seat_height_m: float | None = None
    """Height of the surface that objects lie on, where it is below the top (seats, mattresses)."""
    kin: str = ""
    """The broader category whose rules it shares (where it stands, what goes with it), for a special kind of one."""
    traits: frozenset[Trait] = frozenset()
    lacks: frozenset[Trait] = frozenset()
    """Traits of its kin that it has not."""

    def __hash__(self) -> int:
        return hash(self.name)

    @property
    def priors(self) -> tuple[SizePrior, ...]:
        """One per mode, most common first."""
        return tuple(SizePrior(*row) for row in self.sizes)

    @property
    def supports_objects(self) -> bool:
        """Whether people put objects on it, so that its shapes must come empty."""
        return "supports_objects" in self.traits

    @property
    def quarter_turns_free(self) -> bool:
        """Whether it often stands at odd angles to the room (chairs, plants)."""
        return "quarter_turns_free" in self.traits

    @property
    def soft(self) -> bool:
        """Whether it gives way: soft objects lie against and partly in one another."""
        return "soft" in self.traits


def read_rows(text: str) -> tuple[Category, ...]:
    """The categories of a table in TOML, in its order, with the traits that they have from their kin.

    Raises `LibraryError` naming the row and the column where the table is not well formed.
    """
    rows: dict[str, Any] = tomllib.loads(text)
    try:
        found = TypeAdapter(tuple[Category, ...]).validate_python([{"name": n, **row} for n, row in rows.items()])
    except ValidationError as error:
        first = error.errors()[0]
        row, *column = first["loc"]
        where = ".".join(map(str, column))
        raise LibraryError(f"kinds.toml, row '{list(rows)[int(row)]}', column '{where}': {first['msg']}") from error
    by_name = {c.name: c for c in found}
    return tuple(_with_traits_of_kin(c, by_name) for c in found)


def _with_traits_of_kin(category: Category, by_name: dict[str, Category]) -> Category:
    if not category.kin:
        return category
    kin = by_name.get(category.kin)
    if kin is None or kin.kin:
        raise LibraryError(f"kinds.toml, row '{category.name}': kin '{category.kin}' must be the row of a broad kind")
    idle = (category.traits & kin.traits) | (category.lacks - kin.traits)
    if idle:
        raise LibraryError(
            f"kinds.toml, row '{category.name}': {', '.join(sorted(idle))} says what its kin says already"
        )
    return replace(category, traits=category.traits | (kin.traits - category.lacks))
