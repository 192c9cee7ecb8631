"""The committed figures of a speed run, and what has become slower since.

Times are kept as multiples of `speed_meter.yardstick_s`, so that another machine may compare; growth exponents and
the gain over the eager optimiser need no such help.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from importlib import resources
from pathlib import Path

from diorama_core.errors import InputError
from diorama_core.evaluation.reports.tables import Column, Row, Table

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


def regression_bytes(figures: dict[str, float]) -> bytes:
    """The content of a regression file."""
    if not figures:
        raise InputError("a speed run without series cannot be kept; measure something")
    rounded = {name: float(f"{value:.4g}") for name, value in sorted(figures.items())}
    return (json.dumps({"note": NOTE, "figures": rounded}, indent=1) + "\n").encode()


def committed_figures(path: Path | None = None) -> dict[str, float]:
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


def worse_by(name: str, before: float, now: float, tolerance: float = TOLERANCE) -> float | None:
    """How many times worse a figure has become where that is more than the tolerance; None where it is not.

    A growth exponent counts as the factor that its rise costs over a tenfold quantity.

    Args:
        name: of the figure.
        before: its value then.
        now: its value now.
        tolerance: factor that counts as noise.
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
    factors = {name: worse_by(name, before[name], now[name], tolerance) for name in sorted(before) if name in now}
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
