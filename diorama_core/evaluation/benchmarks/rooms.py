"""The benchmark's own rooms: whether they are valid and varied, and whether its pictures show a room."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass

import cv2
import numpy as np
from jaxtyping import UInt8

from diorama_core.evaluation.benchmarks.cases import MIN_ASKED, Case, recipe, studio_of
from diorama_core.evaluation.benchmarks.photo_build import grid
from diorama_core.evaluation.reports.tables import Column, Row, Table
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import SILENT, Progress
from diorama_core.synthesis.splits import split_library
from diorama_core.synthesis.survey import RoomSurvey, ViewSurvey, count, survey_room, survey_view

THUMBNAIL = (240, 180)
SHEET_COLUMNS = 9


@dataclass(frozen=True)
class RoomsBench:
    """What was counted in every room and picture."""

    seed: int
    rooms: tuple[RoomSurvey, ...]
    views: tuple[ViewSurvey, ...]

    @property
    def faulty_views(self) -> tuple[tuple[str, tuple[str, ...]], ...]:
        """Rejected photos with the reason."""
        named = ((v.name, v.faults(MIN_ASKED)) for v in self.views)
        return tuple((name, faults) for name, faults in named if faults)

    def tables(self) -> tuple[Table, ...]:
        """One table of rooms and one of pictures."""
        return rooms_table(self.rooms), views_table(self.views)

    def to_json(self) -> dict[str, object]:
        """Tables, every room and every picture."""
        return {
            "bench": "rooms",
            "seed": self.seed,
            "tables": [t.to_json() for t in self.tables()],
            "faulty_views": [{"view": name, "faults": list(faults)} for name, faults in self.faulty_views],
            "rooms": [asdict(r) for r in self.rooms],
            "views": [asdict(v) for v in self.views],
        }


def run(
    library: ShapeLibrary, scenes: int = 60, seed: int = 0, progress: Progress = SILENT
) -> tuple[RoomsBench, UInt8[np.ndarray, "h w 3"]]:
    """Furnish rooms from test shapes, check them by exact collision, and photograph each three times, small.

    Args:
        library: where shapes come from.
        scenes: how many rooms.
        seed: of the series of rooms.
        progress: reports and cancellation.

    Returns:
        What was counted, and a sheet of all pictures.
    """
    tested = split_library(library, "test")
    rooms, views, pictures = [], [], []
    cases = recipe(scenes, 1, seed)
    for k, case in enumerate(cases):
        progress.report(k / len(cases), case.name)
        studio, cameras = studio_of(case, tested, THUMBNAIL)
        rooms.append(survey_room(case.name, studio.scene, tested))
        for number, camera in enumerate(cameras):
            view = studio.view(camera, THUMBNAIL, with_empty_room=False)
            views.append(survey_view(Case(case.seed, case.kind, number).name, view))
            pictures.append(view.inputs.photo.rgb)
    progress.report(1.0, "done")
    return RoomsBench(seed, tuple(rooms), tuple(views)), sheet(pictures, [v.name for v in views])


def rooms_table(rooms: Sequence[RoomSurvey]) -> Table:
    """Validity and variety."""
    columns = (
        Column("rooms", "d"), Column("objects"), Column("support depth"), Column("outlines"),
        Column("colliding pairs", "d", "↓"), Column("outside", "d", "↓"),
    )  # fmt: skip
    objects = [r.objects for r in rooms]
    row = Row(
        "rooms",
        (
            len(rooms),
            f"{min(objects)} to {max(objects)}, mean {np.mean(objects):.0f}" if objects else "",
            count([r.depth for r in rooms]),
            ", ".join(f"{o}: {n}" for o, n in sorted(Counter(r.outline for r in rooms).items())),
            sum(len(r.collisions) for r in rooms),
            sum(len(r.outside) for r in rooms),
        ),
    )
    return Table("Rooms", columns, (row,), "Collisions of the exact meshes, each a millimetre off what carries it.")


def views_table(views: Sequence[ViewSurvey]) -> Table:
    """What the pictures show."""
    columns = (
        Column("pictures", "d"), Column("objects asked for"), Column("floor"), Column("largest object"),
        Column("walls seen"), Column("faulty", "d", "↓"),
    )  # fmt: skip
    row = Row(
        "pictures",
        (
            len(views),
            _spread([float(v.asked) for v in views], "{:.0f}"),
            _spread([v.floor for v in views], "{:.0%}"),
            _spread([v.largest for v in views], "{:.0%}"),
            count([v.walls for v in views]),
            sum(bool(v.faults(MIN_ASKED)) for v in views),
        ),
    )
    note = "Least, middle and greatest. Faulty: too few objects, no floor, one object before all else, or too near."
    return Table("Pictures", columns, (row,), note)


def sheet(pictures: Sequence[UInt8[np.ndarray, "_ _ 3"]], names: Sequence[str]) -> UInt8[np.ndarray, "H W 3"]:
    """All pictures side by side, each with its name."""
    labelled = []
    for picture, name in zip(pictures, names, strict=True):
        copy = picture.copy()
        for colour, width in (((0, 0, 0), 3), ((255, 255, 255), 1)):
            cv2.putText(copy, name, (5, 14), cv2.FONT_HERSHEY_SIMPLEX, 0.42, colour, width, cv2.LINE_AA)
        labelled.append(copy)
    return grid(labelled, SHEET_COLUMNS)


def _spread(values: Sequence[float], form: str) -> str:
    return " / ".join(form.format(v) for v in (min(values), float(np.median(values)), max(values))) if values else ""
