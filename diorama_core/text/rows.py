"""Objects in rows: "two rows of three desks", "a row of chairs along the wall", "four chairs in a row".

Before a description is read, its phrases of rows become marks that travel with their nouns ("rowed-2x3 desks"), so that
the rest of the grammar need not know them. A room takes the rows of one kind as one block, which is placed like one
large object.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.library.taxonomy import broad, having
from diorama_core.scene.types import Pose, SceneObject, yaw_rotation

_COUNTS = {"a": 1, "an": 1, "one": 1, "single": 1, "long": 1, "two": 2, "three": 3, "four": 4, "five": 5, "six": 6,
           "seven": 7, "eight": 8, "nine": 9, "ten": 10}  # fmt: skip
_NUMBER = "one|two|three|four|five|six|seven|eight|nine|ten|10|[1-9]"
_ROWS_OF = re.compile(
    rf"\b(an?|the|{_NUMBER})(?: (?:long|straight|neat|single|short|parallel|back|front))* (?:rows?|lines?|ranks?)"
    rf"(?: each)?(?: of| with)(?: ({_NUMBER}))?(?= [a-z])"
)
_IN_ROWS = re.compile(
    rf"\b(?:in|into|as|forming) (an?|{_NUMBER})(?: (?:long|straight|neat|single|short|parallel))* (?:rows?|lines?)"
    rf"(?: of ({_NUMBER})(?: each)?)?\b(?! of\b)(?! with\b)"
)
_MARK = re.compile(r"rowed-(\d+)x(\d+)")
USUAL_IN_ROW = 3
"""In a row of which nobody says how many it has."""
MAX_IN_ROWS = 24
SIDE_GAP_M, BETWEEN_BEDS_M = 0.1, 0.7
WAY_M, WAY_AT_SEATS_M, WAY_AT_DESKS_M = 0.9, 0.55, 1.1
"""Free floor between one row and the next: to pass, to sit down, for a chair at each desk."""
AHEAD_M = 1.2
ACROSS_M = 1.4
"""Between two rows that face each other."""


def with_marks(text: str) -> tuple[str, tuple[str, ...]]:
    """A description in which marks stand for its rows, and the phrases of rows that hold too many."""
    too_many: list[str] = []

    def mark(match: re.Match[str]) -> str:
        rows, each = _count(match[1]), _count(match[2] or "0")
        if rows * max(each, 1) > MAX_IN_ROWS:
            too_many.append(match[0])
            return match[0]
        return f"rowed-{rows}x{each}"

    return _ROWS_OF.sub(mark, _IN_ROWS.sub(mark, text)), tuple(too_many)


def _count(word: str) -> int:
    return int(word) if word.isdigit() else _COUNTS.get(word, 1)


def without_marks(words: Sequence[str]) -> tuple[list[str], tuple[int, int] | None]:
    """Words without a mark, and what it says: how many rows of how many, 0 where that is open."""
    marks = [(int(m[1]), int(m[2])) for word in words if (m := _MARK.fullmatch(word))]
    return [word for word in words if not _MARK.fullmatch(word)], marks[0] if marks else None


@dataclass(frozen=True, eq=False)
class Rows:
    """Objects of one shape side by side in rows, the rows one behind the other."""

    count: int
    rows: int
    category: str
    size_m: Float[np.ndarray, "3"]
    """Size of each object."""
    face_to_face: bool = False
    """Whether two rows face each other."""
    watching: bool = False
    """Whether they face something else, which is not right before them."""

    @property
    def each(self) -> int:
        """How many the longest row has."""
        return -(-self.count // self.rows)

    @property
    def block_m(self) -> Float[np.ndarray, "3"]:
        """Extents of all rows, with the way before each where people sit at them."""
        depth = self.rows * float(self.size_m[0]) + (self.rows - 1 + self._open) * self._way_m + self._ahead_m
        width = self.each * float(self.size_m[1]) + (self.each - 1) * self._gap_m
        return np.array([depth, width, float(self.size_m[2])])

    @property
    def places(self) -> Float[np.ndarray, "n 3"]:
        """Metres forward and left of the block's middle and radians turned, of each, from the hindmost row on."""
        pitch = np.array([float(self.size_m[0]) + self._way_m, float(self.size_m[1]) + self._gap_m])
        places = np.zeros((self.count, 3))
        aside = (self._ahead_m if self._sat_at else -self._ahead_m) - self._open * self._way_m
        for k in range(self.count):
            row, column = divmod(k, self.each)
            members = min(self.each, self.count - row * self.each)
            places[k, 0] = (row - (self.rows - 1) / 2) * pitch[0] + aside / 2
            places[k, 1] = (column - (members - 1) / 2) * pitch[1]
            backward = self.face_to_face and (row == 0) == self._sat_at
            places[k, 2] = np.pi if backward else 0.0
        return places

    @property
    def _sat_at(self) -> bool:
        return broad(self.category) in ("desk", "table")

    @property
    def _open(self) -> int:
        """1 where the foremost row has a way before it, too."""
        return int(self._sat_at and self.rows > 1 and not self.face_to_face)

    @property
    def _ahead_m(self) -> float:
        """Free floor to what they look at: people look over a desk, away from its front."""
        return AHEAD_M if self.watching else 0.0

    @property
    def _gap_m(self) -> float:
        return BETWEEN_BEDS_M if broad(self.category) == "bed" else SIDE_GAP_M

    @property
    def _way_m(self) -> float:
        if self.face_to_face:
            return 0.02 if self._sat_at else ACROSS_M
        if self._sat_at:
            return WAY_AT_DESKS_M
        return WAY_AT_SEATS_M if self.category in having("single_seat") else WAY_M

    def as_one(self, one: SceneObject) -> SceneObject:
        """The block as one object: one of them, stretched over all."""
        return replace(one, pose=replace(one.pose, scale=one.pose.scale * self.block_m / self.size_m))

    def poses(self, block: Pose, scale: Float[np.ndarray, "3"]) -> list[Pose]:
        """Pose of every object where the block is placed, at the block's level."""
        R = block.R_world_object
        return [
            Pose(R @ yaw_rotation(float(turn)), block.position + x * R[:, 0] + y * R[:, 1], scale)
            for x, y, turn in self.places
        ]
