"""Tables of annotated photos: all together, fronts by kind, form, folds, and the figures that perturbations change."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from diorama_core.evaluation.benchmarks.photo_build import PhotoScores
from diorama_core.evaluation.metrics.annotated import ObjectResult
from diorama_core.evaluation.reports.tables import (
    Column,
    Figure,
    Row,
    Table,
    Value,
    difference,
    mean,
    paired_interval,
    statistic_interval,
)

Results = Sequence[PhotoScores]


def _median(values: Iterable[float | None]) -> float | None:
    known = [v for v in values if v is not None]
    return float(np.median(known)) if known else None


def _pool_objects(
    value: Callable[[ObjectResult], float | None], pooled: Callable[[Iterable[float | None]], float | None] = mean
) -> Callable[[Results], float | None]:
    return lambda results: pooled([value(o) for r in results for o in r.objects])


def _form(results: Results) -> float | None:
    return mean([right for r in results for o in r.objects for right in o.form.values()])


def _pool_photos(value: Callable[[PhotoScores], float | None]) -> Callable[[Results], float | None]:
    return lambda results: mean([value(r) for r in results if not r.failure])


OF_OBJECTS = (
    Figure(Column("kind first", better="↑"), _pool_objects(lambda o: o.kind_first)),
    Figure(Column("among", better="↑"), _pool_objects(lambda o: o.kind_among)),
    Figure(Column("loose", better="↑"), _pool_objects(lambda o: o.kind_first if o.loose else None)),
    Figure(Column("form", better="↑"), _form),
    Figure(Column("colour", ".1f", "↓"), _pool_objects(lambda o: o.colour_difference, _median)),
    Figure(
        Column("no colour", better="↓"), _pool_objects(lambda o: None if o.has_colour is None else not o.has_colour)
    ),
    Figure(Column("front", better="↑"), _pool_objects(lambda o: o.front)),
    Figure(Column("supporter", better="↑"), _pool_objects(lambda o: o.supporter)),
    Figure(Column("box IoU", better="↑"), _pool_objects(lambda o: o.iou)),
)
OF_PHOTOS = (
    Figure(Column("ghosts", better="↓"), _pool_photos(lambda r: r.ghosts)),
    Figure(Column("unmarked", better="↓"), _pool_photos(lambda r: r.ghosts_unmarked)),
    Figure(Column("time s", ".1f", "↓"), _pool_photos(lambda r: r.seconds)),
)
FIGURES = (*OF_OBJECTS, *OF_PHOTOS)
_OBJECTS = Column("objects", "d")
_INTERVALS = "In brackets the 90 % interval (bootstrap over photos)."


def overall_table(results: Results, *, named: bool, missing: Sequence[str] = ()) -> Table:
    """All photos together, then every photo."""
    spans = tuple(statistic_interval(results, figure.of) for figure in OF_OBJECTS)
    rows = [
        Row("all", _values(results), intervals=(None, *spans, *(None for _ in OF_PHOTOS))),
        *(Row(r.photo, _values([r])) for r in results),
    ]
    notes = [f"not in the folder: {', '.join(missing)}"] if missing else []
    notes += [f"{r.title} failed: {r.failure}" for r in results if r.failure]
    note = f"{_INTERVALS} Photos that fail count as wrong. {'; '.join(notes)}"
    columns = (_OBJECTS, *(figure.column for figure in FIGURES))
    return Table(f"Annotated photos, {'plain words' if named else 'no words'}", columns, tuple(rows), note.strip())


def fronts_table(results: Results) -> Table:
    """Fronts by the true kind, the most frequent first."""
    of = _group((o.kind, o.front) for r in results for o in r.objects if o.front is not None)
    rows = tuple(_right_row(kind, of[kind]) for kind in sorted(of, key=lambda kind: (-len(of[kind]), kind)))
    return Table("Fronts by kind", (_OBJECTS, Column("front", better="↑")), rows, "Right within 45 degrees.")


def form_table(results: Results) -> Table:
    """The attributes of form."""
    of = _group(pair for r in results for o in r.objects for pair in o.form.items())
    rows = tuple(_right_row(name, right) for name, right in sorted(of.items()))
    note = "Of objects whose annotation and whose chosen shape's design both state the attribute."
    return Table("Form", (_OBJECTS, Column("right", better="↑")), rows, note)


def _group(pairs: Iterable[tuple[str, bool]]) -> dict[str, list[bool]]:
    of: dict[str, list[bool]] = {}
    for name, right in pairs:
        of.setdefault(name, []).append(right)
    return of


def _right_row(name: str, right: Sequence[bool]) -> Row:
    return Row(name, (len(right), mean(right)))


def folds_table(folds: Sequence[Results], *, fitted: bool) -> Table:
    """The figures of each fold of photos, and their mean and spread."""
    named = [(f"fold {k + 1}", _values(fold)) for k, fold in enumerate(folds)]
    values = [[row[c] for _, row in named] for c in range(len(FIGURES) + 1)]
    known = [[float(v) for v in column if isinstance(v, (int, float))] for column in values]
    means: tuple[Value, ...] = (round(float(np.mean(known[0]))), *(mean(column) for column in known[1:]))
    spread: tuple[Value, ...] = (None, *(float(np.std(c, ddof=1)) if len(c) > 1 else None for c in known[1:]))
    rows = (*(Row(name, row) for name, row in named), Row("mean", means), Row("spread", spread))
    note = "Settings of each fold were fitted on the others." if fitted else "Every fold with the same settings."
    columns = (_OBJECTS, *(figure.column for figure in FIGURES))
    return Table("Folds of photos", columns, rows, f"{note} Spread: standard deviation over folds.")


def perturbation_tables(plain: Results, perturbed: Mapping[str, Results]) -> tuple[Table, Table]:
    """The figures under each perturbation, and their differences from the same objects in the photos as they are."""
    columns = (_OBJECTS, *(figure.column for figure in OF_OBJECTS))
    of_photo = {r.photo: r for r in plain}
    rows, differences = [Row("as they are", _values(plain)[: len(columns)])], []
    for name, results in perturbed.items():
        pairs = [(_restrict(of_photo[r.photo], r), r) for r in results if r.photo in of_photo]
        before, after = [a for a, _ in pairs], [b for _, b in pairs]
        rows.append(Row(name, _values(after)[: len(columns)]))
        changes = [difference(figure.of(after), figure.of(before)) for figure in OF_OBJECTS]
        spans = [paired_interval(before, after, figure.of) for figure in OF_OBJECTS]
        differences.append(Row(name, (_count(after), *changes), intervals=(None, *spans)))
    note = f"Perturbed less unperturbed, of the same objects. {_INTERVALS}"
    return (
        Table("Perturbed photos", columns, tuple(rows)),
        Table("What perturbations change", columns, tuple(differences), note),
    )


def _restrict(plain: PhotoScores, perturbed: PhotoScores) -> PhotoScores:
    """The plain result of the objects, and the attributes of them, that the perturbed one has too."""
    places = {o.index for o in perturbed.objects}
    return replace(plain, objects=tuple(o for o in plain.objects if o.index in places))


def _values(results: Results) -> tuple[Value, ...]:
    return (_count(results), *(figure.of(results) for figure in FIGURES))


def _count(results: Results) -> int:
    return sum(len(r.objects) for r in results)
