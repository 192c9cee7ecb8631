"""How often the support graph without a language model names what holds an object up."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from diorama_core.evaluation.benchmarks.cases import LeftOut, attempted, recipe
from diorama_core.evaluation.metrics.relations import RelationCount, relations_of
from diorama_core.evaluation.reports.tables import Column, Row, Table
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import Progress

WITH_DEPTH, PHOTO_ALONE = "masks and depth", "masks and the photo alone"
MISTAKES_SHOWN = 5


@dataclass(frozen=True)
class RelationsBench:
    """What was counted over some rooms."""

    seed: int
    rooms: int
    counts: tuple[tuple[str, RelationCount], ...]

    def tables(self) -> tuple[Table, ...]:
        """One row per kind of input."""
        columns = (Column("accuracy", ".3f", "↑"), Column("objects", "d"), Column("usual mistakes"))
        rows = tuple(Row(name, (c.accuracy, c.total, _mistakes(c))) for name, c in self.counts)
        note = (
            f"{self.rooms} rooms from seed {self.seed}; orientation of the camera and masks given. Objects count whose "
            "true supporter is a part of the room or is itself in the picture. The publication reports about 0.62 with "
            "GPT-4o and its own poses, on another dataset."
        )
        return (Table("Support graph from geometry", columns, rows, note),)

    def to_json(self) -> dict[str, object]:
        """Plain values."""
        return {"seed": self.seed, "rooms": self.rooms, "tables": [t.to_json() for t in self.tables()]}


def run(library: ShapeLibrary, scenes: int = 18, seed: int = 0, progress: Progress | None = None) -> RelationsBench:
    """Judge the graph of every room's first picture, with depth and without."""
    progress = progress or Progress()
    counts = {WITH_DEPTH: RelationCount(), PHOTO_ALONE: RelationCount()}
    cases = recipe(scenes, 1, seed)
    left_out: list[LeftOut] = []
    for k, (case, view) in enumerate(attempted(cases, library, left_out)):
        progress.report(k / len(cases), case.name)
        counts[WITH_DEPTH] += relations_of(view, with_depth=True)
        counts[PHOTO_ALONE] += relations_of(view, with_depth=False)
    return RelationsBench(seed, scenes - len(left_out), tuple(counts.items()))


def _mistakes(count: RelationCount) -> str:
    kinds = Counter(f"{child} on {wanted}, not {named}" for child, wanted, named in count.mistakes)
    return "; ".join(kind for kind, _ in kinds.most_common(MISTAKES_SHOWN)) or "none"
