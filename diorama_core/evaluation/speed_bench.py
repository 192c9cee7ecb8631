"""How time grows: every stage against picture size and objects, the optimiser against a per-pair eager one, search
against library size. Processor time of one thread, the least of some runs, so that a busy machine changes little.
"""

from __future__ import annotations

import json
import resource
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from importlib import resources

import numpy as np
from jaxtyping import Float32, Int

from diorama_core.errors import InputError
from diorama_core.evaluation.cases import Case, photographed
from diorama_core.evaluation.layout_bench import refinement_speedup
from diorama_core.evaluation.rooms import box_library, generate_room
from diorama_core.evaluation.tables import Column, Row, Table
from diorama_core.layout.recipes import recipe as layout_recipe
from diorama_core.library.record import ShapeLibrary
from diorama_core.pipeline.build import build_scene
from diorama_core.progress import Progress

SIZES = ((320, 240), (640, 480), (1280, 960))
OBJECTS = (1, 5, 20, 50, 100, 200)
LIBRARIES = (1_000, 10_000, 100_000, 1_000_000)
FEATURES = 64
"""Numbers per shape in the search by features."""
REGRESSION_FILE = "speed_regression.json"
SLOWER = 2.0
"""A figure this many times the committed one is called a regression; less is another machine or a busy one."""


@dataclass(frozen=True)
class Series:
    """Seconds against one quantity."""

    what: str
    against: str
    points: tuple[tuple[float, float], ...]
    """(quantity, processor seconds)."""

    @property
    def exponent(self) -> float:
        """Growth: the slope of log time over log quantity."""
        return growth_exponent(self.points)


@dataclass(frozen=True)
class SpeedBench:
    """All series of one run."""

    seed: int
    series: tuple[Series, ...]
    eager_ratio: float
    """Times by which the batched refinement step beats a loop over pairs through autograd, 20 objects."""
    peak_memory_mb: float

    def tables(self) -> tuple[Table, ...]:
        """One table per quantity, and what has become slower."""
        return (
            *(speed_table(self.series, against) for against in dict.fromkeys(s.against for s in self.series)),
            regression_table(self.figures(), committed_figures()),
        )

    def figures(self) -> dict[str, float]:
        """The figures that the regression file keeps: the seconds at the largest quantity of each series."""
        kept = {f"{s.what} at {s.points[-1][0]:g} {s.against}": s.points[-1][1] for s in self.series if s.points}
        return {**kept, "eager over batched refinement": self.eager_ratio}

    def to_json(self) -> dict[str, object]:
        """Tables and figures."""
        return {
            "bench": "speed",
            "seed": self.seed,
            "tables": [t.to_json() for t in self.tables()],
            "figures": self.figures(),
            "exponents": {f"{s.what} against {s.against}": s.exponent for s in self.series},
            "peak_memory_mb": self.peak_memory_mb,
        }


def run(
    library: ShapeLibrary,
    seed: int = 0,
    progress: Progress | None = None,
    *,
    sizes: Sequence[tuple[int, int]] = SIZES,
    objects: Sequence[int] = OBJECTS,
    libraries: Sequence[int] = LIBRARIES,
) -> SpeedBench:
    """Measure all series."""
    progress = progress or Progress()
    progress.report(0.0, "stages against picture size")
    series = stages_by_size(library, seed, sizes)
    progress.report(0.6, "layout against objects")
    series += layout_by_objects(seed, objects)
    progress.report(0.9, "search against library size")
    series.append(search_by_library(seed, libraries))
    ratio = refinement_speedup(generate_room(seed, 20).observed)
    progress.report(1.0, "done")
    return SpeedBench(seed, tuple(series), ratio, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)


def stages_by_size(library: ShapeLibrary, seed: int, sizes: Sequence[tuple[int, int]]) -> list[Series]:
    """Every stage of a build with true masks and depth, and the renderer, for one room at several sizes."""
    spent: dict[str, list[tuple[float, float]]] = {}
    case = Case(seed, "living")
    # once for nothing: the first build also prepares shapes and views that later ones find ready
    build_scene(photographed(case, library, size=sizes[0]).inputs, library)
    for size in sizes:
        pixels = size[0] * size[1] / 1e6
        begun = time.process_time()
        view = photographed(case, library, size=size)
        spent.setdefault("render with truth", []).append((pixels, time.process_time() - begun))
        built = build_scene(view.inputs, library)
        for one in built.runs:
            spent.setdefault(one.stage, []).append((pixels, one.seconds))
    return [Series(name, "megapixels", tuple(points)) for name, points in spent.items()]


def layout_by_objects(seed: int, objects: Sequence[int]) -> list[Series]:
    """The default and the paper's recipe on generated rooms."""
    library = box_library()
    found = []
    for name in ("feasible", "paper"):
        stage = layout_recipe(name, library)
        points = []
        for count in objects:
            scene = generate_room(seed + 500, count).observed
            points.append((float(count), least_time(partial(stage.optimise, scene, Progress()), 2)))
        found.append(Series(f"layout {name}", "objects", tuple(points)))
    return found


def search_by_library(seed: int, libraries: Sequence[int]) -> Series:
    """One exact nearest-neighbour search by features (cosine, float32, the best 50) as the library grows."""
    rng = np.random.default_rng(seed)
    points = []
    for count in libraries:
        features = rng.standard_normal((count, FEATURES), dtype=np.float32)
        query = rng.standard_normal(FEATURES, dtype=np.float32)
        points.append((float(count), least_time(partial(_best_fifty, features, query), 3)))
    return Series("search by features", "shapes", tuple(points))


def _best_fifty(features: Float32[np.ndarray, "n d"], query: Float32[np.ndarray, " d"]) -> Int[np.ndarray, " 50"]:
    return np.argpartition(features @ query, -50)[-50:]


def least_time(work: Callable[[], object], repeats: int) -> float:
    """Least processor time of some runs, seconds."""
    spent = []
    for _ in range(repeats):
        begun = time.process_time()
        work()
        spent.append(time.process_time() - begun)
    return min(spent)


def growth_exponent(points: Sequence[tuple[float, float]]) -> float:
    """Slope of log time over log quantity, least squares; 0 for fewer than two points."""
    if len(points) < 2:
        return 0.0
    x, y = np.log(np.maximum(np.array(points).T, 1e-9))
    return float(np.polyfit(x, y, 1)[0])


def speed_table(series: Sequence[Series], against: str) -> Table:
    """Milliseconds at every quantity, and the growth exponent."""
    chosen = [s for s in series if s.against == against]
    quantities = sorted({q for s in chosen for q, _ in s.points})
    columns = (*(Column(f"{q:g}", ".1f") for q in quantities), Column("exponent", ".2f"))
    rows = []
    for s in chosen:
        known = dict(s.points)
        values = [1000 * known[q] if q in known else None for q in quantities]
        rows.append(Row(s.what, (*values, s.exponent)))
    return Table(f"Processor milliseconds against {against}", columns, tuple(rows))


def committed_figures() -> dict[str, float]:
    """The figures of the regression file that comes with the package."""
    text = resources.files("diorama_core.evaluation").joinpath(REGRESSION_FILE).read_text()
    figures: dict[str, float] = json.loads(text)["figures"]
    return figures


def regression_table(now: dict[str, float], before: dict[str, float]) -> Table:
    """Every committed figure beside today's."""
    rows = []
    for name in sorted(before):
        ratio = now[name] / before[name] if name in now and before[name] > 0 else None
        worse = ratio is not None and (1 / ratio if name.startswith("eager") else ratio) > SLOWER
        rows.append(Row(name, (before[name], now.get(name), ratio, "slower" if worse else "")))
    columns = (Column("committed", ".3f"), Column("now", ".3f"), Column("ratio", ".2f"), Column("", ""))
    return Table("Against the committed figures", columns, tuple(rows), f"Slower means more than {SLOWER:g} times.")


def regression_file(bench: SpeedBench) -> bytes:
    """What to commit as the new figures."""
    if not bench.series:
        raise InputError("a speed run without series cannot be kept; measure something")
    note = "processor seconds of one thread; refresh with: diorama bench speed --keep"
    return (json.dumps({"note": note, "figures": bench.figures()}, indent=1) + "\n").encode()
