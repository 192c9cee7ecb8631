"""What a number or a stage is worth: figures with it left out, halved and doubled, against those as it is.

The same photos and rooms are built each way, so that intervals are of the differences (paired bootstrap over photos or
rooms). What comes out is a certificate: the number, the command, on what, and what leaving it out costs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from diorama_core.artefacts import Inputs
from diorama_core.evaluation.benchmarks import photos as photos_bench
from diorama_core.evaluation.benchmarks import system as system_bench
from diorama_core.evaluation.benchmarks.photo_build import PhotoScores
from diorama_core.evaluation.benchmarks.photo_tables import OF_OBJECTS
from diorama_core.evaluation.benchmarks.photos import PhotoPlan
from diorama_core.evaluation.benchmarks.system_tables import CaseResult
from diorama_core.evaluation.metrics.pose import pool
from diorama_core.evaluation.reports.tables import Interval, paired_interval
from diorama_core.library.record import ShapeLibrary
from diorama_core.pipeline.settings import with_settings
from diorama_core.pipeline.stages import Stages, embedded_stages
from diorama_core.progress import SILENT, Progress

FACTORS: Mapping[str, float] = {"left out": 0.0, "halved": 0.5, "doubled": 2.0}


@dataclass(frozen=True)
class Figures:
    """Photos and rooms built one way."""

    photos: tuple[PhotoScores, ...]
    rooms: tuple[CaseResult, ...] = ()


@dataclass(frozen=True)
class Change:
    """What a figure changes by."""

    by: float
    interval: Interval | None
    """90 %, paired; None with fewer than two photos or rooms."""


def build(
    values: Mapping[str, float],
    plan: PhotoPlan,
    library: ShapeLibrary,
    *,
    rooms: int = 0,
    processes: int = 1,
    progress: Progress = SILENT,
) -> Figures:
    """Build the photos and some rendered rooms with other values of settings.

    Args:
        values: names and values as `pipeline.settings` has them; none for the builds as they are.
        plan: the photos.
        library: where shapes come from.
        rooms: rendered rooms, from the photo alone.
        processes: photos built at once.
        progress: reports and cancellation.
    """
    changed = replace(plan, tasks=tuple(replace(task, settings=dict(values)) for task in plan.tasks))
    bench = photos_bench.run(changed, library, processes=processes, progress=progress.part(0.0, 0.8))
    if not rooms:
        return Figures(bench.results)

    def stages(inputs: Inputs, searched: ShapeLibrary) -> Stages:
        return with_settings(embedded_stages(inputs, searched), values)

    way = replace(system_bench.WAYS["photo"], stages=stages)
    system = system_bench.run(library, rooms, (0,), progress.part(0.8, 1.0), ways=(way,))
    return Figures(bench.results, system.results[0][1])


def changes(before: Figures, after: Figures) -> dict[str, Change]:
    """What each figure changes by, of photos and of rooms that were built both ways."""
    changes_by_name: dict[str, Change] = {}
    of = {r.title: r for r in after.photos}
    pairs = [(r, of[r.title]) for r in before.photos if r.title in of]
    old, new = [a for a, _ in pairs], [b for _, b in pairs]
    for figure in OF_OBJECTS:
        changes_by_name |= _change(figure.column.name, old, new, figure.of)
    if before.rooms and after.rooms:
        changes_by_name |= _change("rooms, own Acc", before.rooms, after.rooms, _own_acc)
    return changes_by_name


def certificate(value: float, before: Figures, after: Mapping[str, Figures], command: str) -> dict[str, object]:
    """What is written of one number.

    Args:
        value: the number as it is; 1 for a stage.
        before: figures with it.
        after: figures with it changed, by how.
        command: that was run.
    """
    return {
        "number": value,
        "command": command,
        "cases": {
            "photos": len(before.photos),
            "objects": sum(len(r.objects) for r in before.photos),
            "rooms": len(before.rooms),
        },
        "changes": {
            how: {
                name: {"by": round(c.by, 4), "interval": c.interval and [round(v, 4) for v in c.interval]}
                for name, c in changes(before, figures).items()
            }
            for how, figures in after.items()
        },
    }


def _change(
    name: str, before: Sequence[object], after: Sequence[object], of: Callable[..., float | None]
) -> dict[str, Change]:
    old, new = of(before), of(after)
    if old is None or new is None:
        return {}
    return {name: Change(new - old, paired_interval(before, after, of))}


def _own_acc(rooms: Sequence[CaseResult]) -> float:
    return pool([case.scores.pairs for case in rooms]).acc
