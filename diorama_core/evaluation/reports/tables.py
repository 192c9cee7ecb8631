"""Tables: measured rows beside the paper's own, as Markdown for people and JSON for programs, with bootstrap intervals
of means over rooms.

Whole rooms are drawn, since the objects of one room share its camera and its scale.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

OTHER = "other dataset"
"""Said beside every row of the paper: its 344 renderings are not ours."""
Value = float | int | str | None
Interval = tuple[float, float]


@dataclass(frozen=True)
class Column:
    """One column: its name, how its numbers are written, and which way is better."""

    name: str
    form: str = ".2f"
    better: str = ""
    """An arrow, or nothing."""


@dataclass(frozen=True)
class Row:
    """One method: its name and a value for each column; None where there is none."""

    name: str
    values: tuple[Value, ...]
    from_paper: bool = False
    intervals: tuple[Interval | None, ...] = ()
    """For each value where its 90 % interval begins and ends (`bootstrap_interval`); none at all by default."""


@dataclass(frozen=True)
class Table:
    """A table with its caption."""

    title: str
    columns: tuple[Column, ...]
    rows: tuple[Row, ...]
    note: str = ""

    def to_markdown(self) -> str:
        """A GitHub table; the paper's rows say "other dataset"."""
        heads = [f"{c.name} {c.better}".strip() for c in self.columns]
        lines = [f"### {self.title}", "", f"| | {' | '.join(heads)} |", f"|---|{'---:|' * len(heads)}"]
        for row in self.rows:
            name = f"{row.name} (paper, {OTHER})" if row.from_paper else f"**{row.name}**"
            spans = row.intervals or (None,) * len(row.values)
            cells = [
                _format(v, c.form) + _span(span, c.form)
                for v, c, span in zip(row.values, self.columns, spans, strict=True)
            ]
            lines.append(f"| {name} | {' | '.join(cells)} |")
        return "\n".join(lines) + (f"\n\n{self.note}" if self.note else "") + "\n"

    def to_json(self) -> dict[str, object]:
        """Plain values for JSON."""
        return {
            "title": self.title,
            "columns": [c.name for c in self.columns],
            "rows": [
                {
                    "name": r.name,
                    "source": f"paper, {OTHER}" if r.from_paper else "measured",
                    "values": dict(zip((c.name for c in self.columns), r.values, strict=True)),
                    "intervals": {c.name: list(span) for c, span in zip(self.columns, r.intervals) if span is not None},
                }
                for r in self.rows
            ],
            "note": self.note,
        }

    def row(self, name: str) -> Mapping[str, Value]:
        """The values of a measured row by column name; raises `KeyError` when there is none."""
        for row in self.rows:
            if row.name == name and not row.from_paper:
                return dict(zip((c.name for c in self.columns), row.values, strict=True))
        raise KeyError(name)


def paper_rows(rows: Mapping[str, Sequence[Value]]) -> tuple[Row, ...]:
    """Rows of the publication."""
    return tuple(Row(name, tuple(values), from_paper=True) for name, values in rows.items())


@dataclass(frozen=True)
class Figure:
    """What a column says of some cases."""

    column: Column
    of: Callable[[Any], float | None]
    """None where nothing can be said of the cases."""
    interval: Callable[[Any], Interval | None] = lambda _: None


def figures_table(
    title: str,
    cases_by_row: Iterable[tuple[str, Any]],
    figures: Sequence[Figure],
    note: str = "",
    published: Mapping[str, Sequence[Value]] | None = None,
) -> Table:
    """Every figure of each row's cases.

    Args:
        title: of the table.
        cases_by_row: names of rows, with what their figures are of.
        figures: the columns.
        note: below the table.
        published: rows of the publication.
    """
    rows = (
        Row(name, tuple(f.of(cases) for f in figures), intervals=tuple(f.interval(cases) for f in figures))
        for name, cases in cases_by_row
    )
    return Table(title, tuple(f.column for f in figures), (*rows, *paper_rows(published or {})), note)


def mean(values: Iterable[float | None]) -> float | None:
    """The mean of the values that are known and finite; None without any."""
    known = [v for v in values if v is not None and np.isfinite(v)]
    return float(np.mean(known)) if known else None


def difference(new: float | None, old: float | None) -> float | None:
    """What a figure changed by; None where either is unknown."""
    return None if new is None or old is None else new - old


def _format(value: Value, form: str) -> str:
    if value is None:
        return "–"
    return value if isinstance(value, str) else format(value, form)


def _span(interval: Interval | None, form: str) -> str:
    """An interval as written behind its value."""
    return "" if interval is None else f" ({_format(interval[0], form)} to {_format(interval[1], form)})"


Group = TypeVar("Group")

COVERAGE = 0.9
"""Share of the resampled means that lie within an interval."""
DRAWS = 2000
GROUP_DRAWS = 500
"""Fewer, since a statistic of whole groups is computed anew for every sample."""


def bootstrap_interval(values: Sequence[float | None], weights: Sequence[float] | None = None) -> Interval | None:
    """The percentile interval of a weighted mean over rooms; None with fewer than two values. Deterministic.

    Args:
        values: One per room; None where a room has no value, and such rooms are left out.
        weights: What each room counts, such as its objects; equal by default.
    """
    known = [k for k, v in enumerate(values) if v is not None and np.isfinite(v)]
    if len(known) < 2:
        return None
    x = np.array([values[k] for k in known], dtype=float)
    w = np.ones(len(known)) if weights is None else np.array([weights[k] for k in known], dtype=float)
    if w.sum() <= 0:
        return None
    drawn = np.random.default_rng(0).integers(len(x), size=(DRAWS, len(x)))
    total = w[drawn].sum(axis=1)
    return _percentiles(((w * x)[drawn].sum(axis=1)[total > 0] / total[total > 0]).tolist())


def statistic_interval(
    groups: Sequence[Group],
    statistic: Callable[[Sequence[Group]], float | None],
) -> Interval | None:
    """The percentile interval of any statistic of groups of objects; None with fewer than two groups. Deterministic.

    Draws for which the statistic is None are left out.
    """
    rng, count = np.random.default_rng(0), len(groups)
    draws = (rng.integers(count, size=count).tolist() for _ in range(GROUP_DRAWS if count > 1 else 0))
    values = (statistic([groups[k] for k in drawn]) for drawn in draws)
    return _percentiles([v for v in values if v is not None])


def paired_interval(
    before: Sequence[Group],
    after: Sequence[Group],
    statistic: Callable[[Sequence[Group]], float | None],
) -> Interval | None:
    """`statistic_interval` of what a statistic changes by, the same groups in the same order drawn before and after."""

    def change(pairs: Sequence[tuple[Group, Group]]) -> float | None:
        old, new = zip(*pairs, strict=True)
        return difference(statistic(new), statistic(old))

    return statistic_interval(list(zip(before, after, strict=True)), change)


def _percentiles(known: Sequence[float]) -> Interval | None:
    if not known:
        return None
    low, high = np.quantile(known, [(1 - COVERAGE) / 2, (1 + COVERAGE) / 2])
    return float(low), float(high)
