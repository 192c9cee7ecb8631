"""Runs stages: each result is cached under the hash of its inputs, settings, weights and source.

A run that was cancelled or killed leaves the finished stages' files, so the next run resumes after them.
Correcting one artefact re-runs only what is downstream, because only those keys change.
"""

from __future__ import annotations

import hashlib
import inspect
import logging
import os
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, is_dataclass
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

from diorama_core.errors import ProjectError
from diorama_core.io.atomic import write_atomically
from diorama_core.io.bounded import read_bytes
from diorama_core.io.code_key import Sources, package_sources
from diorama_core.pipeline import codec
from diorama_core.progress import Progress

T = TypeVar("T")
log = logging.getLogger(__name__)

KEY_DIGITS = 24
CACHED_PER_STAGE = 4
"""Number of cached results per stage on disk, so that undoing a correction is instant."""


@dataclass(frozen=True)
class StageRun:
    """What happened to one stage in one run."""

    stage: str
    used: str
    """The implementation, with its settings."""
    seconds: float
    cached: bool


@dataclass
class Runner:
    """Runs one photo's stages in order, remembering what each took."""

    folder: Path | None = None
    """Cache folder; None disables caching."""
    runs: list[StageRun] = field(default_factory=list)
    lost: list[str] = field(default_factory=list)
    """A line for each stage that the run went on without."""
    _fingerprints: dict[int, tuple[Any, str]] = field(default_factory=dict)

    def run(
        self,
        name: str,
        stage: object,
        call: Callable[..., T],
        artefacts: tuple[Any, ...],
        progress: Progress,
        *,
        saved: bool = True,
    ) -> T:
        """`call(*artefacts, progress)`, or its saved result.

        Args:
            name: stage name, also the file's stem.
            stage: its `repr` names settings and weights and is part of the key.
            call: the bound stage method.
            artefacts: everything the result depends on.
            progress: this stage's part of the job; checked for cancellation before it starts.
            saved: whether its result is saved, and may be a saved one.
        """
        started = time.perf_counter()
        progress.report(0.0, f"{name}…")
        path = (
            None
            if self.folder is None or not saved
            else self.folder / f"{name.replace(' ', '_')}-{self._key(name, stage, artefacts)}.zip"
        )
        result = _read(path, get_type_hints(call).get("return", Any))
        cached = result is not None
        if result is None:
            result = call(*artefacts, progress)
            progress.check()
            if not getattr(result, "provisional", False):
                _write(path, result)
        progress.report(1.0, f"{name}: done")
        self.runs.append(StageRun(name, repr(stage), time.perf_counter() - started, cached))
        return result

    def _key(self, name: str, stage: object, artefacts: tuple[Any, ...]) -> str:
        parts = [stage_code(stage), name, repr(stage), *(self._fingerprint(a) for a in artefacts)]
        return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:KEY_DIGITS]

    def _fingerprint(self, artefact: Any) -> str:
        known = self._fingerprints.get(id(artefact))
        if known is None or known[0] is not artefact:
            known = (artefact, codec.fingerprint(artefact))
            self._fingerprints[id(artefact)] = known
        return known[1]


def stage_code(stage: object, sources: Sources | None = None) -> str:
    """A hash of the source that a stage runs: its class's module, those of what it holds, and all that they import."""
    return (sources or package_sources()).key((type(stage).__module__, *_modules_held(stage)))


def _modules_held(value: object) -> Iterator[str]:
    for inner in getattr(value, "__dict__", {}).values():
        yield (inner if inspect.isroutine(inner) else type(inner)).__module__ or ""
        if is_dataclass(inner) and not isinstance(inner, type):
            yield from _modules_held(inner)


def _read(path: Path | None, expected: Any) -> Any:
    """A saved result; a damaged one is removed, so that it is made again."""
    if path is None or not path.exists():
        return None
    try:
        result = codec.load(read_bytes(path, codec.MAX_BYTES, ProjectError), expected)
    except ProjectError as error:
        log.warning("%s: %s", path.name, error)
        if not path.parent.is_symlink():
            path.unlink(missing_ok=True)
        return None
    os.utime(path)
    return result


def _write(path: Path | None, result: Any) -> None:
    """Save a result; raises `ProjectError` when the disk is full, with finished stages still cached."""
    if path is None:
        return
    write_atomically(path, codec.dump(result), error=ProjectError)
    stem = path.name.rsplit("-", 1)[0]
    if path.parent.is_symlink():
        return  # results of somebody else may lie there
    siblings = [p for p in path.parent.glob(f"{stem}-*.zip") if len(p.name) == len(path.name) and not p.is_symlink()]
    newest_first = sorted((p for p in siblings if p != path), key=lambda p: p.stat().st_mtime, reverse=True)
    for old in newest_first[CACHED_PER_STAGE - 1 :]:
        old.unlink(missing_ok=True)
