"""Ingestion of a folder of models: found, distributed to workers, stored one by one, resumable."""

from __future__ import annotations

import signal
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path
from types import FrameType

from diorama_core.errors import DioramaError, LibraryError
from diorama_core.library.ingest.finding import Trouble
from diorama_core.library.ingest.frames import Convention
from diorama_core.library.ingest.guess import MAX_METRES, MIN_METRES
from diorama_core.library.ingest.joint import Evidence, groups_of, joint_convention, sample_files
from diorama_core.library.ingest.known_shapes import KnownShapes, load_known_shapes
from diorama_core.library.ingest.limits import DEFAULT_LIMITS, Limits
from diorama_core.library.ingest.shaping import ModelSource, Painter, confidence, evidence_of, ingest_file
from diorama_core.library.ingest.sink import Ingested, ShapeSink
from diorama_core.library.record import Shape
from diorama_core.progress import SILENT, Progress
from diorama_core.workers import Workers

LEARNING_SHARE = 0.8
"""Share of a first import's time that goes into learning the built-in shapes."""
UNSURE = 0.8
"""Guesses less sure than this are worth a person's look."""


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
    shapes: tuple[Shape, ...] = ()
    """Records of what was added, without support surfaces."""


def add_models(
    models: Sequence[ModelSource],
    sink: ShapeSink,
    workers: Workers,
    *,
    painter: Painter | None = None,
    skipped: Sequence[Trouble] = (),
    limits: Limits = DEFAULT_LIMITS,
    progress: Progress = SILENT,
) -> Added:
    """Take models in; a file that fails never stops the others.

    Args:
        models: From `sources` or a data set.
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
    have = sink.source_keys()
    waiting = [s for s in models if s.key not in have]
    learnt = _learn(progress) if waiting else 0.0
    waiting = with_conventions(waiting, models, workers, limits, progress)
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
        retained=len(models) - len(waiting),
        failed=tuple(sorted(failed, key=lambda t: t.path)),
        skipped=tuple(skipped),
        repaired=tuple((i.record.id, i.warnings) for i in added if i.warnings),
        unsure=tuple(i.record.id for i in added if i.record.guess and confidence(i.record.guess) < UNSURE),
        shapes=tuple(replace(i.record, surfaces=()) for i in added),
    )


def with_conventions(
    waiting: Sequence[ModelSource], models: Sequence[ModelSource], workers: Workers, limits: Limits, progress: Progress
) -> list[ModelSource]:
    """The sources with what their whole packs say of frame and unit; some files of each pack are asked.

    Args:
        waiting: What is to be taken in.
        models: All files, those included that are there already.
        workers: Where files are asked.
        limits: What is refused.
        progress: Cancellation.
    """
    plain = {s.path: s for s in models if not s.member and s.given.unit_m is None and s.given.up is None}
    groups: dict[str, list[Path]] = {}
    for path, group in groups_of(tuple(plain), models[0].root if models else Path()).items():
        groups.setdefault(group, []).append(path)
    new = {s.path for s in waiting}
    groups = {g: paths for g, paths in groups.items() if len(paths) > 1 and new.intersection(paths)}
    asked = [plain[path] for paths in groups.values() for path in sample_files(paths)]
    evidence_of_files: dict[Path, tuple[Evidence, Convention, float]] = {}
    for piece in workers.map(partial(_evidence, limits=limits), asked):
        progress.check()
        if piece.error is None and piece.value is not None:
            evidence_of_files[piece.item.path] = piece.value
    known: dict[Path, Convention] = {}
    for paths in groups.values():
        evidences = [evidence_of_files[path] for path in paths if path in evidence_of_files]
        if evidences:
            kept = any(MIN_METRES <= longest <= MAX_METRES for _, _, longest in evidences)
            joint = replace(joint_convention(evidences[0][1], [evidence for evidence, _, _ in evidences]), kept=kept)
            known |= dict.fromkeys(paths, joint)
    return [replace(s, convention=known.get(s.path)) for s in waiting]


def _evidence(source: ModelSource, limits: Limits) -> tuple[Evidence, Convention, float]:
    _limit_memory(limits.memory_bytes)
    with _time_limit(limits.seconds):
        return evidence_of(source, _cached_shapes(), limits)


def _learn(progress: Progress) -> float:
    """See to it that known shapes are there; the share of the whole work that it was: much once, then nothing."""
    took: list[float] = []

    def step(share: float) -> None:
        progress.check()
        progress.report(LEARNING_SHARE * share, "getting to know what furniture looks like (only this once)")
        took.append(share)

    load_known_shapes(on_step=step)
    return LEARNING_SHARE if took else 0.0


def _work(source: ModelSource, painter: Painter | None, limits: Limits) -> Ingested:
    """One piece of work, in a process of its own kind: bounded in memory and time."""
    _limit_memory(limits.memory_bytes)
    with _time_limit(limits.seconds):
        return ingest_file(source, _cached_shapes(), painter, limits)


@cache
def _cached_shapes() -> KnownShapes:
    return load_known_shapes()


@cache
def _limit_memory(most: int) -> None:
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
