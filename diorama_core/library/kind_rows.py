"""Rows of `kinds.toml`: everything the program knows about a kind of object, one row a kind."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
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
    "flat",  # its thinnest side may be as thin as it likes
    "soft",  # gives way: lies against and partly in other soft objects
    "back_at_wall",  # its back stands at a wall
    "often_at_wall",  # people put its back to a wall where there is room
    "mid_wall",  # stands in the middle of its wall rather than in a corner
    "in_corner",  # stands at the edge of a room
    "mid_room",  # has free floor all around
    "lamp",  # gives light
    "portable",  # stands on the floor or on furniture, by its size
    "never_open",  # nobody looks through it: colours of its surroundings within its outline are its own
    "rug",  # lies flat on the floor, and furniture stands on it
    "seat",  # people sit on it
    "single_seat",  # for one person, and so of about one size
    "drawn_up",  # is drawn up to tables and desks; some are hard and some upholstered
    "back_varies",  # some have open backs and some filled ones
    "table_form",  # a top on a base
    "under_tables",  # often stands partly under a table
    "legroom",  # seats and bins stand partly under it
    "seldom_loaded",  # carries things only where somebody says so
    "no_front",  # looks alike from all sides, and is set down any way round
    "watched",  # people sit across a room from it
    "screen",  # shows pictures, on a stand or on a wall
    "fixed_to_wall",  # never stands free
    "never_on_objects",  # never stands on other objects, but for rugs
    "in_sets",  # those of one room are often of one shape, size and colour
    "solid",  # fills its cuboid
    "own_colours",  # its look is not one colour of one main material
    "any_proportions",  # comes in all proportions
    "flat_piece",  # one flat piece in any proportions: a tall narrow picture is no row of small ones
    "framed",  # hangs flat on a wall or stands in a frame
    "stores",  # keeps things, and shows its front to the room
    "has_boards",  # things are found in it as well as on it: on boards below its top
    "stacked_on",  # a small thing that lies on others and on which others are put
    "along_the_back",  # stands at the back of a surface
    "near_the_edge",  # lies at the front of a surface
]
"""A yes-or-no property of a kind; special kinds have those of their kin, but for the ones that their rows lack."""

FROM_KIN = frozenset({
    "carries_as", "floor_before_m", "tucked_under", "used_within_m", "too_hot_m", "seldom_without",
    "face", "ifc_class", "usual_relations", "base", "closed_sides",
})  # fmt: skip
"""Columns that a special kind has from its kin where its own row does not give them."""


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
class Company:
    """Kinds that one is seldom without: it is likelier where one of them is, and less likely where none is."""

    __pydantic_config__ = ConfigDict(extra="forbid")

    others: tuple[str, ...]
    """With their special kinds."""
    where: Literal["on it", "near", "behind it", "beside it"]
    """A sofa is behind a coffee table that stands before it, and beside a side table."""
    often: float
    """Share of things of the kind that photos show with one of the others there: rough, in homes and offices."""
    usual: float
    """Share of things that are mistaken for it which have such company."""


@dataclass(frozen=True)
class Category:
    """One canonical category: a row of the table. A column that a row does not give is None."""

    __pydantic_config__ = ConfigDict(extra="forbid")

    name: str
    # words
    synonyms: tuple[str, ...] = ()
    other_names: tuple[str, ...] | None = None
    """Words for objects that are near to the category rather than of it."""
    meant_by: Mapping[str, float] | None = None
    """How often it is meant by words that are used loosely; shares of a word need not add up to one."""
    roomplan: Mapping[str, float] | None = None
    """How readily Apple's RoomPlan says each of its words of it."""
    kin: str = ""
    """The broader category whose rules it shares (where it stands, what goes with it), for a special kind of one."""
    # sizes and matter
    sizes: tuple[tuple[float, float, float, float, float, float], ...] = field(kw_only=True)
    """Height, width and depth in metres and the sigmas of their logarithms; one a mode (a bed with and without a
    headboard), most common first."""
    mount: Mount = "floor"
    seat_height_m: float | None = None
    """Height of the surface that objects lie on, where it is below the top (seats, mattresses)."""
    middle_height_m: float | None = None
    """Height above the floor at which the middle of one usually hangs."""
    plausible_height_m: tuple[float, float] | None = None
    plausible_width_m: tuple[float, float] | None = None
    density: float = field(kw_only=True)
    """Kilograms per cubic metre of bounding box: a guess for physics, held to published masses by
    `tests/export/test_physics.py`."""
    # how usual it is, and what is taken for it
    frequency: float | None = None
    """How often a thing in a room is one, of a hundred."""
    also_said_of: Mapping[str, float] | None = None
    """Further categories that its name is used for, with the costs of those readings."""
    related: tuple[str, ...] | None = None
    """Kinds whose shapes stand in for it, nearest first."""
    rooms: tuple[str, ...] | None = None
    """Types of rooms in which it is met more often than elsewhere."""
    traits: frozenset[Trait] = frozenset()
    lacks: frozenset[Trait] = frozenset()
    """Traits of its kin that it has not."""
    # what it keeps company with
    carries_as: str | None = None
    """The kind whose loads lie on it: its own name, or that of furniture that is loaded alike."""
    lies_on: Mapping[str, float] | None = None
    """How many times more often it lies on what carries as these than it is met at all; what people put it on, too."""
    instead: tuple[str, ...] | None = None
    """Kinds that do what it does for a room."""
    usual_relations: tuple[tuple[str, tuple[str, ...]], ...] | None = None
    """Relations to others in the order of their weight; of the targets, the first that is there."""
    tucked_under: tuple[str, ...] | None = None
    """Broad categories that it is pushed under as far as the meshes allow."""
    used_within_m: float | None = None
    """How far before something it is used; farther off it is only somewhere in the room."""
    floor_before_m: float | None = None
    """Floor that people need before it, to sit down, to open it, to stand at it."""
    too_hot_m: float | None = None
    """Nobody sits nearer before it."""
    seldom_without: tuple[Company, ...] | None = None
    # what it looks like
    base: str | None = None
    """The shares of bases that it has (`usual_forms`)."""
    closed_sides: float | None = None
    """Share of its kind with padded arms; the others' frames are seen through below the arms."""
    face: tuple[str, ...] | None = None
    """Roles of the slots that wear the photo (or "main"), where it is flat. A door's handle wears what the photo shows
    in its place, or there would be two: one in the picture and one before it."""
    face_side: Literal["front", "top"] = "front"
    lumens: float | None = None
    """Luminous flux of a usual one; what has none gives no light."""
    ifc_class: str | None = None
    """All without are furniture."""

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
    def flat(self) -> bool:
        """Whether its thinnest side may be as thin as it likes."""
        return "flat" in self.traits

    @property
    def soft(self) -> bool:
        """Whether it gives way: soft objects lie against and partly in one another."""
        return "soft" in self.traits


def read_rows(text: str) -> tuple[Category, ...]:
    """The categories of a table in TOML, in its order, with the traits that they have from their kin.

    Raises `LibraryError` naming the row and the column where the table is not well formed.
    """
    rows: dict[str, Any] = tomllib.loads(text)
    whole = [{"name": name} | _with_kin(name, row, rows) for name, row in rows.items()]
    try:
        return TypeAdapter(tuple[Category, ...]).validate_python(whole)
    except ValidationError as error:
        first = error.errors()[0]
        row, *column = first["loc"]
        where = ".".join(map(str, column))
        raise LibraryError(f"kinds.toml, row '{list(rows)[int(row)]}', column '{where}': {first['msg']}") from error


def _with_kin(name: str, row: dict[str, Any], rows: dict[str, Any]) -> dict[str, Any]:
    """A row with the traits and the columns that it has from its kin."""
    if "kin" not in row:
        return row
    kin = rows.get(row["kin"], {"kin": ""})
    if "kin" in kin:
        raise LibraryError(f"kinds.toml, row '{name}': kin '{row['kin']}' must be the row of a broad kind")
    traits, lacks, given = row.get("traits", []), set(row.get("lacks", ())), set(kin.get("traits", ()))
    idle = (set(traits) & given) | (lacks - given)
    if idle:
        raise LibraryError(f"kinds.toml, row '{name}': {', '.join(sorted(idle))} says what its kin says already")
    return {c: kin[c] for c in FROM_KIN & kin.keys()} | row | {"traits": [*traits, *sorted(given - lacks)]}
