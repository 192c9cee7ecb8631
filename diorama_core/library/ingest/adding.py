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
from diorama_core.io.file_heads import head_of
from diorama_core.io.other_files import OtherFile, what_else
from diorama_core.library.ingest.convention import Convention
from diorama_core.library.ingest.guess import MAX_METRES, MIN_METRES, Given
from diorama_core.library.ingest.joint import Evidence, asked_of, groups_of, joint_convention
from diorama_core.library.ingest.known_shapes import KnownShapes, known_shapes
from diorama_core.library.ingest.limits import DEFAULT_LIMITS, Limits
from diorama_core.library.ingest.models import SUFFIXES, form_of
from diorama_core.library.ingest.shaping import Painter, Source, confidence, evidence_of, ingest_file
from diorama_core.library.ingest.sink import Ingested, ShapeSink
from diorama_core.library.record import Shape
from diorama_core.progress import Progress
from diorama_core.workers import Workers

REVISION = 2
"""Of what ingestion makes of a file: raise it when results change, so that a repeated run takes files in anew."""
LEARNING_SHARE = 0.8
"""Of a first import's time, what goes into learning the built-in shapes."""
UNSURE = 0.8
"""Guesses less sure than this are worth a person's look."""
MAX_TABLE_BYTES = 64_000_000
BESIDE = frozenset(
    [
        ".mtl",
        ".bin",
        ".png",
        ".jpg",
        ".jpeg",
        ".tga",
        ".bmp",
        ".webp",
        ".tif",
        ".tiff",
        ".gif",
        ".dds",
        ".ktx2",
        ".txt",
        ".md",
        ".csv",
        ".json",
        ".html",
        ".pdf",
        ".url",
        ".psd",
        ".license",
        ".py",
        ".xml",
    ]
)
"""What lies beside models: pictures and texts, which nobody takes for a model."""
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
    shapes: tuple[Shape, ...] = ()
    """Records of what was added, without support surfaces."""


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
            if name.startswith(".") or path.is_symlink():
                continue
            if path.suffix.lower() in (*SUFFIXES, ".zip"):
                found.append(path)
            else:
                other = _other(path)
                skipped += [Trouble(path, f"{other.name}: {other.advice}")] if other is not None else []
    return tuple(found), tuple(skipped)


def _other(path: Path) -> OtherFile | None:
    """What a file is that is no model, where people may have meant it as one."""
    if path.suffix.lower() in BESIDE:
        return None
    try:
        return what_else(head_of(path))
    except InputError:
        return None


def members_of(path: Path) -> tuple[str, ...]:
    """Models in a zip archive, of several formats of one model the first that is read; nothing of another file."""
    head = head_of(path)
    if path.suffix.lower() != ".zip" or not head.is_zip or form_of(head) is not None:
        return ()
    order = {suffix: k for k, suffix in enumerate(SUFFIXES)}
    best: dict[str, str] = {}
    for name in sorted(head.names):
        stem, suffix = str(Path(name).with_suffix("")), Path(name).suffix.lower()
        if suffix in order and order[suffix] < order.get(Path(best.get(stem, "")).suffix.lower(), len(order)):
            best[stem] = name
    return tuple(best.values())


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
        members = members_of(path)
        for member in members or ("",):
            stem = within.rsplit(".", 1)[0]
            named = f"{stem}/{Path(member).with_suffix('').as_posix()}" if len(members) > 1 else stem
            target = (ids or {}).get(path) or slug(named)
            shape_id = next(i for i in _variants(target, path.suffix[1:].lower()) if i not in taken)
            taken.add(shape_id)
            known = table[within].over(given) if within in table else given
            key = _key(path, f"{within}{member}", shape_id, known)
            made.append(Source(path, folder, shape_id, key, known, member))
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
    waiting = with_conventions(waiting, found, workers, limits, progress)
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
        shapes=tuple(replace(i.record, surfaces=()) for i in added),
    )


def with_conventions(
    waiting: Sequence[Source], found: Sequence[Source], workers: Workers, limits: Limits, progress: Progress
) -> list[Source]:
    """The sources with what their whole packs say of frame and unit; some files of each pack are asked.

    Args:
        waiting: What is to be taken in.
        found: All files, those included that are there already.
        workers: Where files are asked.
        limits: What is refused.
        progress: Cancellation.
    """
    plain = {s.path: s for s in found if not s.member and s.given.unit_m is None and s.given.up is None}
    groups: dict[str, list[Path]] = {}
    for path, group in groups_of(tuple(plain), found[0].root if found else Path()).items():
        groups.setdefault(group, []).append(path)
    new = {s.path for s in waiting}
    groups = {g: paths for g, paths in groups.items() if len(paths) > 1 and new.intersection(paths)}
    asked = [plain[path] for paths in groups.values() for path in asked_of(paths)]
    said: dict[Path, tuple[Evidence, Convention, float]] = {}
    for piece in workers.map(partial(_asked, limits=limits), asked):
        progress.check()
        if piece.error is None and piece.value is not None:
            said[piece.item.path] = piece.value
    known: dict[Path, Convention] = {}
    for paths in groups.values():
        told = [said[path] for path in paths if path in said]
        if told:
            kept = any(MIN_METRES <= longest <= MAX_METRES for _, _, longest in told)
            joint = replace(joint_convention(told[0][1], [evidence for evidence, _, _ in told]), kept=kept)
            known |= dict.fromkeys(paths, joint)
    return [replace(s, convention=known.get(s.path)) for s in waiting]


def _asked(source: Source, limits: Limits) -> tuple[Evidence, Convention, float]:
    _bound_memory(limits.memory_bytes)
    with _time_limit(limits.seconds):
        return evidence_of(source, _known(), limits)


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


def slug(text: str) -> str:
    """A text as an id: small letters, digits and hyphens."""
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
