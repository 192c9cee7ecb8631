"""Tables: measured rows beside the paper's own, as Markdown for people and JSON for programs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

OTHER = "other dataset"
"""Said beside every row of the paper: its 344 renderings are not ours."""
Value = float | int | str | None


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
    intervals: tuple[tuple[float, float] | None, ...] = ()
    """For each value where its 90 % interval begins and ends (`intervals.bootstrap_interval`); none at all by default.
    """


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
                _written(v, c.form) + _span(span, c.form)
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


def _written(value: Value, form: str) -> str:
    if value is None:
        return "–"
    return value if isinstance(value, str) else format(value, form)


def _span(interval: tuple[float, float] | None, form: str) -> str:
    """An interval as written behind its value."""
    return "" if interval is None else f" ({_written(interval[0], form)} to {_written(interval[1], form)})"
