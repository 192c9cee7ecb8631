"""What the library's parts cost, and how that grows with the number of shapes.

python scripts/bench_library.py [--sizes 1000 10000 60000 100000] [--models DIR] [--built-in] [--index] [--json FILE]
python scripts/bench_library.py --index-sizes 10000 100000 1000000      # LanceDB alone: time, memory, recall

Large libraries are synthetic: random records with captions, and random unit features of 512 numbers. Times are those of
the wall clock, the best of several for things that are quick; the processor's own seconds stand beside them,
because a busy machine makes the first longer and not the second.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import TypeVar
from unittest.mock import patch

import numpy as np
import trimesh

from diorama_core.library import taxonomy
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.ingest.sink import Ingested
from diorama_core.library.record import Shape
from diorama_core.library.search import find
from diorama_core.library.store import StoredLibrary
from diorama_core.library.store.features import INDEX_FOLDER, FeatureMatrix
from diorama_core.library.store.vectors import LanceIndex
from diorama_core.render.templates import PAPER_GRID, render_templates

T = TypeVar("T")
WIDTH = 512
NEAREST = 50
QUERIES = 100
"""Asked of an index."""
WORDS = (
    "oak walnut pine white black grey blue green brass steel leather linen velvet round square tall low modern rustic "
    "industrial slatted padded panelled turned tapered ribbed curved folding stacking buttoned glazed drawers legs"
)


@dataclass(frozen=True)
class Row:
    """One measured thing."""

    what: str
    shapes: int
    seconds: float
    cpu_seconds: float
    asked: str = ""

    def line(self) -> str:
        """For people."""
        count = f"{self.shapes:,}" if self.shapes else ""
        return f"{self.what:<46} {count:>9}  {_shown(self.seconds):>10}  {_shown(self.cpu_seconds):>10}  {self.asked}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="+", default=[1_000, 10_000, 60_000, 100_000], metavar="N")
    parser.add_argument("--models", type=Path, metavar="DIR", help="also ingest the models in this folder")
    parser.add_argument(
        "--built-in", action="store_true", help="also build the built-in library from nothing (minutes)"
    )
    parser.add_argument("--index", action="store_true", help="also make a LanceDB index at the greatest size (minutes)")
    parser.add_argument("--index-sizes", type=int, nargs="+", metavar="N", help="measure only features, at these sizes")
    parser.add_argument("--json", type=Path, metavar="FILE")
    arguments = parser.parse_args()
    rows: list[Row] = []
    print(f"{'':<46} {'shapes':>9}  {'wall':>10}  {'processor':>10}")
    for row in measured(arguments):
        rows.append(row)
        print(row.line(), flush=True)
    for line in growth(rows):
        print(line)
    if arguments.json:
        arguments.json.write_text(json.dumps([asdict(r) for r in rows], indent=1))
    return 0


def measured(arguments: argparse.Namespace) -> Iterator[Row]:
    """What the command line asks for."""
    if arguments.index_sizes:
        for size in sorted(arguments.index_sizes):
            with tempfile.TemporaryDirectory() as folder:
                yield from measure_features(size, Path(folder), index=True)
        return
    yield from measure_templates()
    yield from measure_built_in_start()
    if arguments.built_in:
        yield measure_built_in_build()
    if arguments.models:
        yield measure_ingestion(arguments.models)
    for size in sorted(arguments.sizes):
        with tempfile.TemporaryDirectory() as folder:
            yield from measure_store(size, Path(folder), index=arguments.index and size == max(arguments.sizes))


def measure_templates() -> Iterator[Row]:
    """One core's views a second, of a ball (which fills its views) and of a thing with about as many triangles."""
    meshes = {"ball": trimesh.creation.icosphere(subdivisions=5), "sofa": built_in_library().mesh("sofa-chesterfield")}
    for name, mesh in meshes.items():
        _, wall, cpu = _timed(partial(render_templates, mesh))
        rate = len(PAPER_GRID) / cpu
        yield Row(f"180 views, {name} of {len(mesh.faces):,} triangles: {rate:.0f}/s", 0, wall, cpu, "60/s a core")


def measure_built_in_start() -> Iterator[Row]:
    """Opening the built-in library and listing it."""
    yield _best(
        "built-in library: open and list",
        len(built_in_library().shapes()),
        lambda: built_in_library().shapes(),
        "under 1 s",
    )


def measure_built_in_build() -> Row:
    """Preparing every built-in shape in an empty cache, on all cores."""
    from diorama_core.pipeline.prepare import prepare_library

    with tempfile.TemporaryDirectory() as folder, patch.dict(os.environ, DIORAMA_CACHE=folder):
        made, *took = _timed(prepare_library)
    return Row("built-in library: built from nothing", made.count, *took, "under 60 s on two cores")


def measure_ingestion(models: Path) -> Row:
    """Bringing in a folder of models, with surfaces and thumbnails."""
    from diorama_app.cli import main as diorama

    with tempfile.TemporaryDirectory() as folder:
        words = ["library", "add", str(models), "--name", f"{folder}/models"]
        status, *took = _timed(lambda: diorama(words))
        count = len(StoredLibrary(Path(folder) / "models"))
    return Row(f"ingestion (exit status {status})", count, *took, "128 models under 3 minutes")


def measure_store(size: int, folder: Path, *, index: bool) -> Iterator[Row]:
    """A synthetic library of a size: written, opened, read, searched by words and by features."""
    stored = partial(StoredLibrary, folder / "library")
    yield _best("records: written", size, lambda: write_synthetic(stored(create=True), size), times=1)
    yield _best("records: library opened and listed", size, lambda: stored().shapes(), "1 s")
    library = stored()
    library.shapes()
    yield _best("records: one with its surfaces", size, lambda: library.shape(f"synthetic-{size // 2:07d}"))
    yield _best("words: first search (index made)", size, lambda: find(library, "first words"), times=1)
    yield _best("words: 'small rustic oak table'", size, lambda: find(library, "small rustic oak table", NEAREST))
    yield from measure_features(size, folder, index=index)


def measure_features(size: int, folder: Path, *, index: bool) -> Iterator[Row]:
    """Synthetic features of a size: written, opened, searched row by row, and by an index."""
    values = synthetic_features(size)
    keys, opened = [f"h{i}" for i in range(size)], partial(FeatureMatrix, folder / "features", WIDTH)
    yield _best("features: written", size, lambda: opened().append(keys, values), times=1)
    yield _best("features: opened", size, opened)
    matrix = opened()
    rng = np.random.default_rng(1)
    queries = values[rng.integers(size, size=QUERIES), 0] + 0.02 * rng.standard_normal((QUERIES, WIDTH))
    del values
    query = queries[0]
    yield _best(f"features: nearest {NEAREST}, exactly", size, lambda: matrix.top(query, NEAREST), "30 ms at 60,000")
    if index:
        yield from measure_index(matrix, queries)


def measure_index(matrix: FeatureMatrix, queries: np.ndarray) -> Iterator[Row]:
    """The LanceDB index of a matrix: made, asked, and compared with what comparing every row finds."""
    made, *took = _timed(lambda: LanceIndex(matrix))
    disk = sum(f.stat().st_size for f in (matrix.folder / INDEX_FOLDER).rglob("*") if f.is_file()) / 1e9
    yield Row(f"LanceDB index: made, {disk:.2f} GB on disk", len(matrix), *took, f"{_memory_gb():.1f} GB")
    found, *took = _timed(lambda: [made.top(query, NEAREST) for query in queries])
    wall, cpu = (seconds / len(queries) for seconds in took)
    yield Row(f"LanceDB index: nearest {NEAREST}", len(matrix), wall, cpu)
    shares = [
        len({n.key for n in near} & {n.key for n in matrix.top(query, NEAREST)}) / NEAREST
        for near, query in zip(found, queries, strict=True)
    ]
    recall = f"{np.mean(shares):.3f} of the nearest {NEAREST}, {np.min(shares):.2f} at worst"
    yield Row(f"LanceDB index finds {recall}", len(matrix), 0.0, 0.0, f"{_memory_gb():.1f} GB")


def _memory_gb() -> float:
    """The most that this process has had in memory so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9


def write_synthetic(library: StoredLibrary, size: int, batch: int = 5_000) -> None:
    """Fill a library with random records that share one small model."""
    rng = np.random.default_rng(0)
    glb = trimesh.Scene(trimesh.creation.box()).export(file_type="glb")
    categories, words = [c.name for c in taxonomy.CATEGORIES], WORDS.split()
    for start in range(0, size, batch):
        numbers = range(start, min(start + batch, size))
        library.add_all(_synthetic(i, categories, words, rng, glb) for i in numbers)


def _synthetic(number: int, categories: list[str], words: list[str], rng: np.random.Generator, glb: bytes) -> Ingested:
    category = categories[rng.integers(len(categories))]
    caption = " ".join([*(words[w] for w in rng.integers(len(words), size=3)), category])
    x, y, z = (float(v) for v in np.round(rng.uniform(0.2, 2.0, 3), 3))
    record = Shape(
        f"synthetic-{number:07d}", category, caption, (x, y, z), source="synthetic", content_hash=f"h{number}"
    )
    return Ingested(record, glb, None, f"source {number}")


def synthetic_features(size: int) -> np.ndarray:
    """Random unit rows around some thousand centres, as embeddings of kinds of things lie."""
    rng = np.random.default_rng(0)
    centres = rng.standard_normal((1_000, WIDTH), dtype=np.float32)
    values = np.empty((size, 1, WIDTH), np.float16)
    for start in range(0, size, 10_000):
        count = min(10_000, size - start)
        part = centres[rng.integers(1_000, size=count)] + 0.8 * rng.standard_normal((count, WIDTH), dtype=np.float32)
        values[start : start + count, 0] = part / np.linalg.norm(part, axis=1, keepdims=True)
    return values


def growth(rows: list[Row]) -> Iterator[str]:
    """How many times longer each thing takes at the greatest size than at the least."""
    names = dict.fromkeys(r.what for r in rows)
    for name in names:
        same = sorted((r for r in rows if r.what == name and r.shapes), key=lambda r: r.shapes)
        if len(same) > 1:
            first, last = same[0], same[-1]
            more, longer = last.shapes / first.shapes, last.cpu_seconds / max(first.cpu_seconds, 1e-9)
            yield f"{name}: {longer:.1f} times the processor time for {more:.0f} times the shapes"


def _timed(call: Callable[[], T]) -> tuple[T, float, float]:
    """What a call gives, and the seconds that it takes by the clock and of the processor."""
    wall, cpu = time.perf_counter(), time.process_time()
    value = call()
    return value, time.perf_counter() - wall, time.process_time() - cpu


def _best(what: str, shapes: int, call: Callable[[], object], asked: str = "", times: int = 7) -> Row:
    """The best of several calls."""
    wall, cpu = np.min([_timed(call)[1:] for _ in range(times)], axis=0).tolist()
    return Row(what, shapes, wall, cpu, asked)


def _shown(seconds: float) -> str:
    return f"{1000 * seconds:.2f} ms" if seconds < 1 else f"{seconds:.2f} s"


if __name__ == "__main__":
    raise SystemExit(main())
