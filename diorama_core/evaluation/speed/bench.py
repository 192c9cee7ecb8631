"""How time and memory grow, in tables, and against the committed figures. `diorama bench speed`.

Processor time of all threads, so that a busy machine changes little. Committed times are multiples of
`meter.yardstick_s`, so that another machine may compare; growth exponents and the gain over the eager optimiser need no
such help.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from importlib import resources
from pathlib import Path

import numpy as np

from diorama_core.errors import InputError
from diorama_core.evaluation.reports.tables import Column, Row, Table, Value
from diorama_core.evaluation.speed import series as measure
from diorama_core.evaluation.speed.eager import BATCHED_GPU, EAGER, NO_GPU, OURS, WAYS
from diorama_core.evaluation.speed.meter import process_peak_mb, yardstick_s
from diorama_core.evaluation.speed.series import OBJECTS, Series
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import SILENT, Progress

MIN_RECORDED_S = 0.004
"""Shorter times are mostly noise and are not recorded."""
REGRESSION_FILE = "speed_regression.json"
TOLERANCE = 1.6
"""A figure this many times worse than the committed one has become slower; less is the machine's mood."""
EXPONENT_TOLERANCE = 0.35
GROWTH, MEMORY, GAIN = "growth of ", "memory of ", "eager over "
"""What the names of figures begin with that are not times."""
MEMORY_SLACK_MB = 60.0
NOTE = (
    "times in yardsticks (see speed_meter.yardstick_s), memory in MB, growth as exponents; "
    "refresh on a quiet machine with: diorama bench speed --keep diorama_core/evaluation/speed_regression.json"
)


@dataclass(frozen=True)
class Extent:
    """How far a run goes."""

    sizes: tuple[tuple[int, int], ...]
    large_scene_objects: tuple[int, ...]
    layout_objects: tuple[int, ...]
    step_objects: tuple[int, ...]
    feature_shapes: tuple[int, ...]
    word_shapes: tuple[int, ...]


FULL = Extent(
    sizes=((320, 240), (640, 480), (1280, 960), (1920, 1440)),
    large_scene_objects=(1, 5, 20, 60, 200),
    layout_objects=(1, 5, 20, 50, 100, 200),
    step_objects=(5, 20, 50, 100, 200),
    feature_shapes=(1_000, 10_000, 100_000, 1_000_000),
    word_shapes=(1_000, 10_000, 100_000),
)
QUICK = Extent(
    sizes=((320, 240), (640, 480)),
    large_scene_objects=(1, 5, 20),
    layout_objects=(5, 20, 50),
    step_objects=(5, 20),
    feature_shapes=(1_000, 10_000, 100_000),
    word_shapes=(1_000, 10_000),
)


@dataclass(frozen=True)
class SpeedBench:
    """All series of one run."""

    seed: int
    series: tuple[Series, ...]
    yardstick_s: float
    """Time of the yardstick on this machine, while the run went on."""
    peak_memory_mb: float
    before: Mapping[str, float]
    """Figures to compare with."""

    def tables(self) -> tuple[Table, ...]:
        """Time and memory against each quantity, the optimiser's step, and what has become slower."""
        steps = tuple(s for s in self.series if s.what in WAYS)
        others = tuple(s for s in self.series if s.what not in WAYS)
        against = tuple(dict.fromkeys(s.against for s in others))
        return (
            *(speed_table(others, quantity) for quantity in against),
            *(memory_table(others, quantity) for quantity in against),
            step_table(steps),
            regression_table(self.figures(), self.before),
        )

    def figures(self) -> dict[str, float]:
        """What the regression file keeps."""
        figures: dict[str, float] = {}
        for s in self.series:
            if s.points and s.points[-1][1] >= MIN_RECORDED_S:
                quantity = f"{s.points[-1][0]:g} {s.against}"
                figures[f"{s.what} at {quantity}"] = s.points[-1][1] / self.yardstick_s
                figures[f"{GROWTH}{s.what} from {s.points[0][0]:g} to {quantity}"] = s.exponent
                if s.peaks_mb and s.peaks_mb[-1] is not None:
                    figures[f"{MEMORY}{s.what} at {quantity}"] = s.peaks_mb[-1]
        return {**figures, **_gains(self.series)}

    def to_json(self) -> dict[str, object]:
        """Tables and figures."""
        return {
            "bench": "speed",
            "seed": self.seed,
            "tables": [t.to_json() for t in self.tables()],
            "figures": self.figures(),
            "exponents": {f"{s.what} against {s.against}": s.exponent for s in self.series if s.points},
            "yardstick_s": self.yardstick_s,
            "peak_memory_mb": self.peak_memory_mb,
        }


def run(
    library: ShapeLibrary,
    seed: int = 0,
    progress: Progress = SILENT,
    extent: Extent = FULL,
    *,
    before: Mapping[str, float] | None = None,
) -> SpeedBench:
    """Measure all series; some minutes on two cores, stopped at any point by `progress`.

    Args:
        library: What the stages build from.
        seed: Of rooms, halls and features.
        progress: Reports and cancellation.
        extent: How far to go.
        before: Figures to compare with; None takes the committed ones.
    """
    known = read_figures() if before is None else before
    sticks = [yardstick_s()]
    series = measure.stages_by_objects(library, seed, extent.large_scene_objects, progress.part(0.0, 0.55))
    sticks.append(yardstick_s())
    series += measure.stages_by_size(library, seed, extent.sizes, progress.part(0.55, 0.75))
    series += measure.layout_by_objects(seed, extent.layout_objects, progress.part(0.75, 0.8))
    series += measure.steps_by_objects(seed, extent.step_objects, progress.part(0.8, 0.87))
    sticks.append(yardstick_s())
    series += measure.features_by_library(seed, extent.feature_shapes, progress.part(0.87, 0.95))
    series += measure.words_by_library(library, extent.word_shapes, progress.part(0.95, 1.0))
    sticks.append(yardstick_s())
    progress.report(1.0, "done")
    return SpeedBench(seed, tuple(series), float(np.mean(sticks)), process_peak_mb(), known)


def speed_table(series: Sequence[Series], against: str) -> Table:
    """Milliseconds at every quantity, and the growth exponent."""
    return _table(f"Processor milliseconds against {against}", series, against, ".1f", _milliseconds, exponent=True)


def memory_table(series: Sequence[Series], against: str) -> Table:
    """Megabytes at every quantity: the highest resident memory above the memory in use before."""
    return _table(f"Memory in MB against {against}", series, against, ".0f", lambda s: s.peaks_mb, exponent=False)


def step_table(series: Sequence[Series]) -> Table:
    """One step of the optimiser, ours and others."""
    note = "" if any(s.what == BATCHED_GPU and s.points for s in series) else f"GPU: {NO_GPU}."
    title = "Milliseconds of one refinement step against objects"
    return replace(_table(title, series, OBJECTS, ".2f", _milliseconds, exponent=True), note=note)


def _milliseconds(series: Series) -> tuple[float | None, ...]:
    return tuple(1000 * seconds for _, seconds in series.points)


def _table(
    title: str,
    series: Sequence[Series],
    against: str,
    form: str,
    values_of: Callable[[Series], Sequence[float | None]],
    *,
    exponent: bool,
) -> Table:
    chosen = [s for s in series if s.against == against]
    quantities = sorted({q for s in chosen for q, _ in s.points})
    columns = tuple(Column(_quantity(q), form) for q in quantities)
    rows = []
    for s in chosen:
        values = values_of(s)
        if not values and not s.missing:
            continue
        known: dict[float, Value] = {q: v for (q, _), v in zip(s.points, values, strict=True)}
        cells: list[Value] = [s.missing or known.get(q) for q in quantities]
        rows.append(Row(s.what, (*cells, None if s.missing else s.exponent) if exponent else tuple(cells)))
    return Table(title, (*columns, Column("exponent", ".2f")) if exponent else columns, tuple(rows))


def _quantity(value: float) -> str:
    return f"{value:,.0f}" if value == round(value) else f"{value:.2f}"


def _gains(series: Sequence[Series]) -> dict[str, float]:
    """Times by which our step beats the pair by pair one, at each number of objects."""
    by_name = {s.what: dict(s.points) for s in series}
    ours, eager = by_name.get(OURS, {}), by_name.get(EAGER, {})
    return {f"{GAIN}ours, a step at {n:g} {OBJECTS}": eager[n] / ours[n] for n in eager if n in ours and ours[n] > 0}


def regression_bytes(figures: dict[str, float]) -> bytes:
    """The content of a regression file."""
    if not figures:
        raise InputError("a speed run without series cannot be kept; measure something")
    rounded = {name: float(f"{value:.4g}") for name, value in sorted(figures.items())}
    return (json.dumps({"note": NOTE, "figures": rounded}, indent=1) + "\n").encode()


def read_figures(path: Path | None = None) -> dict[str, float]:
    """The figures of a regression file; None reads the one that comes with the package.

    Raises:
        InputError: when the file is missing or is not one.
    """
    try:
        if path is None:
            text = resources.files("diorama_core.evaluation").joinpath(REGRESSION_FILE).read_text(encoding="utf-8")
        else:
            text = path.read_text(encoding="utf-8")
        figures = json.loads(text)["figures"]
        return {str(name): float(value) for name, value in figures.items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise InputError(f"{path} is not a file of speed figures ({error}); write one with --keep FILE") from error


def _worse_by(name: str, before: float, now: float, tolerance: float = TOLERANCE) -> float | None:
    """How many times worse a figure has become where that is more than the tolerance; None where it is not.

    A growth exponent counts as the factor that its rise costs over a tenfold quantity.
    """
    if not (math.isfinite(before) and math.isfinite(now)):
        return math.inf
    if name.startswith(GROWTH):
        return 10 ** (now - before) if now - before > EXPONENT_TOLERANCE else None
    if min(before, now) <= 0:
        return None
    if name.startswith(MEMORY) and now - before < MEMORY_SLACK_MB:
        return None
    ratio = before / now if name.startswith(GAIN) else now / before
    return ratio if ratio > tolerance else None


def slower(now: Mapping[str, float], before: Mapping[str, float], tolerance: float = TOLERANCE) -> dict[str, float]:
    """The figures measured both times that have become worse, with how many times."""
    factors = {name: _worse_by(name, before[name], now[name], tolerance) for name in sorted(before) if name in now}
    return {name: times for name, times in factors.items() if times is not None}


def regression_table(now: Mapping[str, float], before: Mapping[str, float]) -> Table:
    """Every committed figure beside today's."""
    worse = slower(now, before, TOLERANCE)
    rows = []
    for name in sorted(before):
        ratio = now[name] / before[name] if name in now and before[name] > 0 else None
        word = "slower" if name in worse else "" if name in now else "not measured"
        rows.append(Row(name, (before[name], now.get(name), ratio, word)))
    columns = (Column("committed", ".3f"), Column("now", ".3f"), Column("ratio", ".2f"), Column("", ""))
    note = (
        f"Times in yardsticks, memory in MB, growth as exponents. Slower: more than {TOLERANCE:g} times, or an "
        f"exponent higher by more than {EXPONENT_TOLERANCE:g}; an eager gain is better when larger."
    )
    return Table("Against the committed figures", columns, tuple(rows), note)
