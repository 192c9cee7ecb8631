"""Ingestion of a folder of models: found, distributed to workers, stored one by one, resumable."""

from __future__ import annotations

import csv
import hashlib
import io
import os
import re
import signal
import sys
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path
from types import FrameType

from diorama_core.errors import DioramaError, InputError, LibraryError
from diorama_core.io.bounded import read_bytes, shortened
from diorama_core.library.ingest.guess import Given
from diorama_core.library.ingest.known_shapes import KnownShapes, known_shapes
from diorama_core.library.ingest.limits import DEFAULT_LIMITS, Limits
from diorama_core.library.ingest.models import NOT_READ, SUFFIXES
from diorama_core.library.ingest.shaping import Painter, Source, confidence, ingest_file
from diorama_core.library.ingest.sink import Ingested, ShapeSink
from diorama_core.progress import Progress
from diorama_core.workers import Workers

REVISION = 1
"""Of what ingestion makes of a file: raise it when results change, so that a repeated run takes files in anew."""
LEARNING_SHARE = 0.8
"""Of a first import's time, what goes into learning the built-in shapes."""
UNSURE = 0.6
"""Guesses less sure than this are worth a person's look."""
MAX_TABLE_BYTES = 64_000_000
_COLUMNS = ("file", "up", "front", "unit", "category", "caption", "licence")


@dataclass(frozen=True)
class Trouble:
    """A file that was not taken in, and why."""

    path: Path
    reason: str


@dataclass(frozen=True)
class Added:
    """What became of a folder."""

    added: tuple[str, ...]
    """Ids of new shapes."""
    retained: int
    """Files that were there already, unchanged."""
    failed: tuple[Trouble, ...]
    skipped: tuple[Trouble, ...]
    """Models in formats that are not read."""
    repaired: tuple[tuple[str, tuple[str, ...]], ...]
    """Id and warnings of shapes that needed repair."""
    unsure: tuple[str, ...]
    """Ids whose guess is worth a look."""


def model_files(folder: Path) -> tuple[tuple[Path, ...], tuple[Trouble, ...]]:
    """Models under a folder, in a stable order, and those in formats that are not read. Links are not followed.

    Raises:
        InputError: when the folder cannot be read.
    """
    if not folder.is_dir():
        raise InputError(f"{folder} is no folder; name the folder that holds the models")
    found: list[Path] = []
    skipped: list[Trouble] = []
    for here, folders, names in os.walk(folder):
        folders[:] = sorted(f for f in folders if not f.startswith("."))
        for name in sorted(names):
            path = Path(here, name)
            suffix = path.suffix.lower()
            if name.startswith(".") or path.is_symlink():
                continue
            if suffix in SUFFIXES:
                found.append(path)
            elif suffix in NOT_READ:
                skipped.append(Trouble(path, f"{suffix} is not supported; convert it to GLB"))
    return tuple(found), tuple(skipped)


def sources(
    folder: Path, paths: Sequence[Path], given: Given, table: Mapping[str, Given], ids: Mapping[Path, str] | None = None
) -> tuple[Source, ...]:
    """What to take in: an id for each file, and what is known of it.

    Args:
        folder: That the user named; ids follow from the paths within it.
        paths: Models in it.
        given: What holds for all of them.
        table: What holds for single files, by their path within the folder.
        ids: Ids that a data set gives its models; others are made from the path.
    """
    taken: set[str] = set()
    made = []
    for path in paths:
        within = path.relative_to(folder).as_posix()
        target = (ids or {}).get(path) or _slug(within.rsplit(".", 1)[0])
        shape_id = next(i for i in _variants(target, path.suffix[1:].lower()) if i not in taken)
        taken.add(shape_id)
        known = table[within].over(given) if within in table else given
        made.append(Source(path, folder, shape_id, _key(path, within, shape_id, known), known))
    return tuple(made)


def read_table(path: Path) -> dict[str, Given]:
    """A CSV with a column `file` (path within the folder) and any of the others of `_COLUMNS`; units in metres.

    Raises:
        InputError: when it cannot be read, or a value makes no sense; names the line.
    """
    data = read_bytes(path, MAX_TABLE_BYTES, InputError, "name a CSV file")
    try:
        reader = csv.DictReader(io.StringIO(data.decode("utf-8-sig"), newline=""))
        if "file" not in (reader.fieldnames or ()):
            raise InputError(f"{path}: the first line must name the columns, with 'file' among {', '.join(_COLUMNS)}")
        return {row["file"]: _row(path, reader.line_num, row) for row in reader if row.get("file")}
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path} cannot be read as CSV ({error})") from error


def add_models(
    found: Sequence[Source],
    sink: ShapeSink,
    workers: Workers,
    *,
    painter: Painter | None = None,
    skipped: Sequence[Trouble] = (),
    limits: Limits = DEFAULT_LIMITS,
    progress: Progress | None = None,
) -> Added:
    """Take models in; a file that fails never stops the others.

    Args:
        found: From `sources` or a data set.
        sink: Keeps each shape as it is ready, so that a stopped run resumes there.
        workers: Where the work is done.
        painter: Makes thumbnails; must be importable by name (or a partial of such).
        skipped: Reported along.
        limits: What is refused.
        progress: Reports and cancellation.

    Raises:
        Cancelled: on request; what is kept stays.
        LibraryError: when the sink cannot keep a shape.
    """
    progress = progress or Progress()
    have = sink.source_keys()
    waiting = [s for s in found if s.key not in have]
    learnt = _learn(progress) if waiting else 0.0
    added: list[Ingested] = []
    failed: list[Trouble] = []
    done = workers.map(partial(_work, painter=painter, limits=limits), waiting)
    for number, piece in enumerate(done, 1):
        if piece.error is None and piece.value is not None:
            sink.add(piece.value)
            added.append(replace(piece.value, glb=b"", thumbnail_png=None))
        else:
            failed.append(Trouble(piece.item.path, _reason(piece.error)))
        share = learnt + (1.0 - learnt) * number / len(waiting)
        progress.report(share, f"{number} of {len(waiting)}: {piece.item.path.name}")
    added.sort(key=lambda i: i.record.id)
    return Added(
        added=tuple(i.record.id for i in added),
        retained=len(found) - len(waiting),
        failed=tuple(sorted(failed, key=lambda t: t.path)),
        skipped=tuple(skipped),
        repaired=tuple((i.record.id, i.warnings) for i in added if i.warnings),
        unsure=tuple(i.record.id for i in added if i.record.guess and confidence(i.record.guess) < UNSURE),
    )


def _learn(progress: Progress) -> float:
    """See to it that known shapes are there; the share of the whole work that it was: much once, then nothing."""
    took: list[float] = []

    def step(share: float) -> None:
        progress.check()
        progress.report(LEARNING_SHARE * share, "getting to know what furniture looks like (only this once)")
        took.append(share)

    known_shapes(on_step=step)
    return LEARNING_SHARE if took else 0.0


def _work(source: Source, painter: Painter | None, limits: Limits) -> Ingested:
    """One piece of work, in a process of its own kind: bounded in memory and time."""
    _bound_memory(limits.memory_bytes)
    with _time_limit(limits.seconds):
        return ingest_file(source, _known(), painter, limits)


@cache
def _known() -> KnownShapes:
    return known_shapes()


@cache
def _bound_memory(most: int) -> None:
    """Let this process take no more than `most` of address space besides what it has, where the system can do that.

    What it has may be much: Ray's workers map the memory that they share.
    """
    if sys.platform == "linux" and threading.current_thread() is threading.main_thread():
        import resource

        most += int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
        _, hard = resource.getrlimit(resource.RLIMIT_AS)
        resource.setrlimit(resource.RLIMIT_AS, (most if hard < 0 else min(most, hard), hard))


@contextmanager
def _time_limit(seconds: float) -> Iterator[None]:
    """Raise `LibraryError` in what runs longer, where the system has timers."""
    if not hasattr(signal, "setitimer") or threading.current_thread() is not threading.main_thread():
        yield
        return

    end = time.monotonic() + seconds

    def stop(number: int, frame: FrameType | None) -> None:
        raise LibraryError(f"it took longer than {seconds:.0f} s")

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds, 1.0)  # again and again: a loader may swallow what it is told
    try:
        yield
        if time.monotonic() > end:
            stop(0, None)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def _reason(error: Exception | None) -> str:
    if isinstance(error, DioramaError):
        return str(error)
    if isinstance(error, MemoryError):
        return "it needs more memory than a model may take"
    return f"it cannot be used ({type(error).__name__}: {str(error)[:100]})"


def _row(path: Path, line: int, row: Mapping[str, str | None]) -> Given:
    value = {k: (row.get(k) or "").strip() for k in _COLUMNS}
    try:
        return Given(
            up=value["up"] or None,
            front=value["front"] or None,
            unit_m=float(value["unit"]) if value["unit"] else None,
            category=value["category"] or None,
            caption=value["caption"],
            licence=value["licence"],
            reason=f"{path.name}",
        )
    except (InputError, ValueError) as error:
        raise InputError(f"{path}, line {line}: {shortened(str(error))}") from error


def _slug(text: str) -> str:
    return re.sub(r"[^a-z0-9]+", "-", re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "-", text).lower()).strip("-")[:120] or "shape"


def _variants(target: str, suffix: str) -> Iterator[str]:
    yield target
    yield f"{target}-{suffix}"
    number = 2
    while True:
        yield f"{target}-{number}"
        number += 1


def _key(path: Path, within: str, shape_id: str, given: Given) -> str:
    try:
        state = path.stat()
        stamp = f"{state.st_size} {state.st_mtime_ns}"
    except OSError:
        stamp = "unreadable"
    return hashlib.sha256(f"{REVISION} {within} {shape_id} {stamp} {given}".encode()).hexdigest()[:32]
