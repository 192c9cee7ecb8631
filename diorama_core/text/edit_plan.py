"""Edits in words, once understood: typed edits that name objects by id. A language model answers with them too."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from diorama_core.editing.relations import RelationKind
from diorama_core.scene.schema import MAX_ITEMS

MAX_EDITS = 60
MAX_COPIES = 12
MAX_WORD_CHARS, MAX_ID_CHARS = 120, 200
Words = Annotated[str, Field(max_length=MAX_WORD_CHARS)]
Id = Annotated[str, Field(max_length=MAX_ID_CHARS)]
Ids = Annotated[list[Id], Field(max_length=MAX_ITEMS)]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Place(_Strict):
    """Where an object goes."""

    relation: RelationKind
    targets: Ids = []
    """Ids of objects; two for "between", none for relations to the room."""


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
    """Of what hangs."""
    toward: Id = ""
    """Id of an object; empty where none is meant."""
    toward_m: Annotated[float, Field(ge=-20, le=20)] = 0.0
    """Toward that object along the floor; away from it where negative."""


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


class Paint(_Strict):
    """Walls, floor or ceiling in a colour."""

    do: Literal["paint"] = "paint"
    part: Literal["walls", "floor", "ceiling"]
    colour: Words


Edit = Remove | Move | Shift | Turn | Insert | Restyle | Swap | Resize | Paint


class EditPlan(_Strict):
    """What a command asks for, in order."""

    edits: Annotated[list[Edit], Field(max_length=MAX_EDITS)]
    not_understood: Annotated[list[Words], Field(max_length=20)] = []
    """Parts of the command that are none of these edits."""
