"""Typed edits that name objects by id: what words, language models and other programs ask for as JSON, and what an edit
made of a scene.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from diorama_core.editing.relations import RelationKind
from diorama_core.scene.schema import MAX_ITEMS
from diorama_core.scene.types import Scene

MAX_EDITS = 60
MAX_COPIES = 12
MAX_CORNERS = 64
MAX_WORD_CHARS, MAX_ID_CHARS = 120, 200
Words = Annotated[str, Field(max_length=MAX_WORD_CHARS)]
Id = Annotated[str, Field(max_length=MAX_ID_CHARS)]
Ids = Annotated[list[Id], Field(max_length=MAX_ITEMS)]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


Side = Literal["", "left", "right", "back", "front", "other"]
"""A side of the room, as seen from where the photo was taken; "other" than where an object is."""


class Place(_Strict):
    """Where an object goes."""

    relation: RelationKind
    targets: Ids = []
    """Ids of objects; two for "between", none for relations to the room."""
    side: Side = ""
    """Which wall or corner of the room is meant; any where empty."""


class Remove(_Strict):
    """Objects go, with what stands on them."""

    do: Literal["remove"] = "remove"
    objects: Ids


class Move(_Strict):
    """Objects go elsewhere, with what stands on them."""

    do: Literal["move"] = "move"
    objects: Ids
    places: Annotated[list[Place], Field(max_length=4)]


class Shift(_Strict):
    """Objects move by a distance: as seen by somebody who looks at the room from where the photo was taken, or toward
    an object."""

    do: Literal["shift"] = "shift"
    objects: Ids
    right_m: Annotated[float, Field(ge=-20, le=20)] = 0.0
    away_m: Annotated[float, Field(ge=-20, le=20)] = 0.0
    """Away from the viewer."""
    up_m: Annotated[float, Field(ge=-5, le=5)] = 0.0
    """Upward, for what hangs."""
    toward: Id = ""
    """Id of an object; empty where none is meant."""
    toward_m: Annotated[float, Field(ge=-20, le=20)] = 0.0
    """Toward that object along the floor; away from it where negative."""
    off_wall_m: Annotated[float, Field(ge=-20, le=20)] = 0.0
    """Away from the nearest wall; toward it where negative."""


class Turn(_Strict):
    """Objects turn toward an object, or by an angle, counter-clockwise seen from above."""

    do: Literal["turn"] = "turn"
    objects: Ids
    toward: Id = ""
    """Id of an object; empty for a turn by degrees."""
    degrees: Annotated[float, Field(ge=-360, le=360)] = 0.0


class Insert(_Strict):
    """New objects from the library."""

    do: Literal["insert"] = "insert"
    what: Words
    """Noun and attributes: "small round table"."""
    count: Annotated[int, Field(ge=1, le=MAX_COPIES)] = 1
    places: Annotated[list[Place], Field(max_length=4)] = []
    name: Words = ""
    """What later edits of the list call the (first) new object; empty where none does."""


class Restyle(_Strict):
    """Objects in another colour or material."""

    do: Literal["restyle"] = "restyle"
    objects: Ids
    look: Words
    """Such as "light blue" or "wooden"."""


class Swap(_Strict):
    """Other shapes from the library in the place of objects."""

    do: Literal["swap"] = "swap"
    objects: Ids
    what: Words
    """Noun and attributes; attributes alone keep the category."""


class Resize(_Strict):
    """Objects larger or smaller, standing where they stand."""

    do: Literal["resize"] = "resize"
    objects: Ids
    factor: Annotated[float, Field(ge=0.2, le=5.0)]


class Measure(_Strict):
    """One side of objects longer or shorter, standing where they stand: to a length, by a length, or by a factor."""

    do: Literal["measure"] = "measure"
    objects: Ids
    side: Literal["width", "depth", "height"]
    to_m: Annotated[float, Field(ge=0, le=50)] = 0.0
    by_m: Annotated[float, Field(ge=-50, le=50)] = 0.0
    factor: Annotated[float, Field(ge=0.1, le=10)] = 1.0


class Copy(_Strict):
    """Copies of objects, beside them where no place is said."""

    do: Literal["copy"] = "copy"
    objects: Ids
    count: Annotated[int, Field(ge=1, le=MAX_COPIES)] = 1
    places: Annotated[list[Place], Field(max_length=4)] = []


class Exchange(_Strict):
    """Two objects each go where the other one is."""

    do: Literal["exchange"] = "exchange"
    objects: Annotated[list[Id], Field(min_length=2, max_length=2)]


class SetState(_Strict):
    """Objects locked, hidden, open, or lit."""

    do: Literal["set"] = "set"
    objects: Ids
    state: Literal["locked", "unlocked", "hidden", "shown", "open", "closed", "on", "off"]


class Rename(_Strict):
    """An object is called otherwise."""

    do: Literal["rename"] = "rename"
    objects: Annotated[list[Id], Field(min_length=1, max_length=1)]
    to: Words


class Align(_Strict):
    """Objects in one line, or with equal gaps between them."""

    do: Literal["align"] = "align"
    objects: Ids
    how: Literal["in line", "evenly"]


class Paint(_Strict):
    """Walls, floor or ceiling in a colour or covering: "light blue", "brick", "oak boards", "darker"."""

    do: Literal["paint"] = "paint"
    part: Literal["walls", "floor", "ceiling"]
    colour: Words
    behind: Id = ""
    """Id of an object: only the wall behind it; all walls where empty."""
    wall: Side = ""
    """Only the wall on this side of the room."""


class RoomLength(_Strict):
    """The room higher, longer (its longer side) or wider (its shorter side): to a length or by a length."""

    do: Literal["room"] = "room"
    side: Literal["height", "length", "width"]
    to_m: Annotated[float, Field(ge=0, le=50)] = 0.0
    by_m: Annotated[float, Field(ge=-50, le=50)] = 0.0


class Light(_Strict):
    """The light: a time of day, brighter or darker by stops, or all lamps."""

    do: Literal["light"] = "light"
    hour: Annotated[float, Field(ge=0, le=24)] | None = None
    brighter_ev: Annotated[float, Field(ge=-4, le=4)] = 0.0
    lamps: Literal["", "on", "off"] = ""


class InsertOpening(_Strict):
    """A door or a window in a wall."""

    do: Literal["opening"] = "opening"
    what: Words
    wall: Side = ""
    behind: Id = ""
    """Id of an object that stands or hangs at the wall."""


Point = tuple[FiniteFloat, FiniteFloat]
"""x and y in the world, metres."""


class SetPlace(_Strict):
    """One object exactly so, with what stands on it; what is null stays. It may meet others: a note says so."""

    do: Literal["place"] = "place"
    objects: Annotated[list[Id], Field(min_length=1, max_length=1)]
    base_m: tuple[FiniteFloat, FiniteFloat, FiniteFloat] | None = None
    """The middle of its underside in the world, metres, +Z up."""
    heading_deg: FiniteFloat | None = None
    """Where its front points: counter-clockwise seen from above, 0 along +X."""
    size_m: tuple[FiniteFloat, FiniteFloat, FiniteFloat] | None = None
    """Depth, width and height."""


class SetSupport(_Strict):
    """Objects onto another object, the floor, a wall or the ceiling, and moved there; or held by nothing."""

    do: Literal["support"] = "support"
    objects: Ids
    parent: Id = ""
    """Id of an object or plane; empty: they stay where they are and nothing holds them."""
    against: Id = ""
    """Id of a wall that they also stand against; empty for none."""


class MoveWall(_Strict):
    """A wall, the floor or the ceiling moved; the planes that it meets follow."""

    do: Literal["wall"] = "wall"
    plane: Id
    outward_m: Annotated[float, Field(ge=-20, le=20)]
    """Out of the room; into it where negative."""


class DrawRoom(_Strict):
    """The room anew, over an outline."""

    do: Literal["outline"] = "outline"
    corners: Annotated[list[Point], Field(min_length=3, max_length=MAX_CORNERS)]
    """In order around the room."""


Edit = (
    Remove
    | Move
    | Shift
    | Turn
    | Insert
    | Restyle
    | Swap
    | Resize
    | Measure
    | Copy
    | Exchange
    | SetState
    | Rename
    | Align
    | Paint
    | RoomLength
    | Light
    | InsertOpening
    | SetPlace
    | SetSupport
    | MoveWall
    | DrawRoom
)
TypedEdit = Annotated[Edit, Field(discriminator="do")]
"""An edit of another program, which must name its kind: what is wrong with it is then told in one line."""


class EditPlan(_Strict):
    """What a command asks for, in order."""

    edits: Annotated[list[Edit], Field(max_length=MAX_EDITS)]
    not_understood: Annotated[list[Words], Field(max_length=20)] = []
    """Parts of the command that are none of these edits."""


@dataclass(frozen=True, eq=False)
class Done:
    """A scene after edits, and what was done."""

    scene: Scene
    lines: tuple[str, ...]
    """One for each edit, in words."""
    touched: tuple[str, ...] = ()
    """Ids of objects that were changed last: what "it" means next."""
    notes: tuple[str, ...] = ()
    """What was done otherwise than asked, in words."""


def names_of(scene: Scene, ids: Sequence[str]) -> str:
    """The labels of objects in a row."""
    return ", ".join(scene.object(i).label for i in ids)
