"""The benchmark's cases: rooms and cameras, generated from seeds."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TypeVar

from diorama_core.errors import Cancelled, InputError
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import Camera, Scene
from diorama_core.synthesis import ROOM_KINDS, RoomKind, TruthView, furnish_room, sample_cameras
from diorama_core.synthesis.truth import Studio

log = logging.getLogger(__name__)

Made = TypeVar("Made")

SIZE = (640, 480)
SEEDS: Mapping[str, tuple[int, ...]] = {"development": (0, 91, 1000), "reporting": (2000, 3000, 4000)}
"""Series of rooms on which methods are chosen, and those on which figures are told; the two share no room."""
VIEWS = 3
STANDARD_SCENES = 60
MIN_ASKED = 4
"""Views that show fewer objects are passed over for the next one of the room."""


@dataclass(frozen=True)
class Case:
    """One picture of the benchmark, by name."""

    seed: int
    kind: RoomKind
    view: int = 0

    @property
    def name(self) -> str:
        """`living-3-0`."""
        return f"{self.kind}-{self.seed}-{self.view}"


def recipe(scenes: int = STANDARD_SCENES, views: int = VIEWS, seed: int = 0) -> tuple[Case, ...]:
    """The benchmark's cases: kinds of rooms in turn, `views` pictures of each room.

    The standard benchmark is `recipe()`: 60 rooms of 9 kinds, 180 pictures.
    """
    return tuple(
        Case(seed + k, ROOM_KINDS[k % len(ROOM_KINDS)], view) for k in range(scenes) for view in range(max(1, views))
    )


def furnish(case: Case, library: ShapeLibrary) -> Scene:
    """The room of a case, in the finishes and styles reserved for tests."""
    return furnish_room(case.seed, case.kind, library, split="test")


def studio_of(case: Case, library: ShapeLibrary, size: tuple[int, int] = SIZE) -> tuple[Studio, tuple[Camera, ...]]:
    """The room of a case ready to be photographed, and where from."""
    scene = furnish(case, library)
    return Studio(scene, library), sample_cameras(scene, library, case.seed, max(VIEWS, case.view + 1), size)


def parse_seeds(words: str | None, alone: int) -> tuple[int, ...]:
    """Seeds of series of rooms: a name of `SEEDS`, or numbers with commas; one alone by default.

    Raises:
        InputError: where a word is neither.
    """
    if not words:
        return (alone,)
    if words in SEEDS:
        return SEEDS[words]
    try:
        return tuple(int(word) for word in words.split(","))
    except ValueError:
        names = " or ".join(SEEDS)
        raise InputError(f"--seeds {words}: give whole numbers with commas between them, or {names}") from None


@dataclass(frozen=True)
class LeftOut:
    """A room that could not be made, and why: nothing is measured on it, nothing counts against a method."""

    case: str
    reason: str

    def __str__(self) -> str:
        return f"{self.case} ({self.reason})"


def make_views(
    cases: tuple[Case, ...], library: ShapeLibrary, left_out: list[LeftOut]
) -> Iterator[tuple[Case, TruthView]]:
    """`view_of` each, going on with the next room where one cannot be furnished or photographed."""
    return attempt(cases, lambda case: view_of(case, library), left_out)


def attempt(
    cases: tuple[Case, ...], make: Callable[[Case], Made], left_out: list[LeftOut]
) -> Iterator[tuple[Case, Made]]:
    """Whatever is made of each case; what could not be made is added to `left_out`, and the next one follows."""
    for case in cases:
        result, reason = attempt_one(case.name, make, case, fate="is left out")
        if result is None:
            left_out.append(LeftOut(case.name, reason))
        else:
            yield case, result


def attempt_one(name: str, work: Callable[..., Made], *given: object, fate: str = "failed") -> tuple[Made | None, str]:
    """What work makes of what it is given; where it fails, None and why, and the log says what becomes of `name`.

    Raises:
        Cancelled: on request.
    """
    try:
        return work(*given), ""
    except Cancelled:
        raise
    except Exception as error:  # whatever goes wrong, the other results are worth keeping
        log.warning("%s %s: %s", name, fate, error)
        return None, f"{type(error).__name__}: {error}"


def view_of(case: Case, library: ShapeLibrary) -> TruthView:
    """The picture of a case; where it has not enough objects in view, the room's next one."""
    studio, cameras = studio_of(case, library)
    view = studio.view(cameras[case.view], SIZE, with_empty_room=False)
    for later in cameras[case.view + 1 :]:
        if len(view.indices) >= MIN_ASKED:
            break
        view = studio.view(later, SIZE, with_empty_room=False)
    return view
