"""The benchmark's recipe: which rooms, photographed from where. Seeded, so nothing but this needs to be shipped."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import Camera, Scene
from diorama_core.synthesis import ROOM_KINDS, RoomKind, TruthView, furnished_room, hold_cameras
from diorama_core.synthesis.truth import Studio

SIZE = (640, 480)
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


def furnished(case: Case, library: ShapeLibrary) -> Scene:
    """The room of a case, in the finishes and styles that are kept for tests."""
    return furnished_room(case.seed, case.kind, library, split="test")


def studio_of(case: Case, library: ShapeLibrary, size: tuple[int, int] = SIZE) -> tuple[Studio, tuple[Camera, ...]]:
    """The room of a case ready to be photographed, and where from."""
    scene = furnished(case, library)
    return Studio(scene, library), hold_cameras(scene, library, case.seed, max(VIEWS, case.view + 1), size)


def views_of(cases: tuple[Case, ...], library: ShapeLibrary) -> Iterator[tuple[Case, TruthView]]:
    """The pictures one after another; a room without enough objects in view gives its next view."""
    for case in cases:
        studio, cameras = studio_of(case, library)
        view = studio.view(cameras[case.view], SIZE, with_empty_room=False)
        for later in cameras[case.view + 1 :]:
            if len(view.asked) >= MIN_ASKED:
                break
            view = studio.view(later, SIZE, with_empty_room=False)
        yield case, view
