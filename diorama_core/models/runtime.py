"""Running networks with onnxruntime: loaded when first used, shared, freed on demand or when others need the room.

CUDA is used where onnxruntime offers it, else the processor. DIORAMA_DEVICE=cpu and DIORAMA_THREADS=N override.
"""

from __future__ import annotations

import logging
import os
import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from diorama_core.errors import UnavailableError

_LOG = logging.getLogger(__name__)

MAX_THREADS = 16
"""More threads than this slow these networks down."""


@dataclass(frozen=True)
class LoadedNetwork:
    """A loaded graph, for reports."""

    path: Path
    device: str
    memory_bytes: int
    """How much the process grew by loading it; the graph's files where that cannot be told."""


class Session:
    """One loaded graph."""

    def __init__(self, raw: Any, info: LoadedNetwork) -> None:
        self._raw, self.info = raw, info
        self.inputs: dict[str, Any] = {i.name: i for i in raw.get_inputs()}
        self.outputs: tuple[str, ...] = tuple(o.name for o in raw.get_outputs())

    def run(self, feeds: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        """All outputs by name; inputs are converted to the graph's number types.

        Raises:
            UnavailableError: when the graph does not have the expected inputs, or fails.
        """
        unknown = sorted(set(feeds) - set(self.inputs))
        lacking = sorted(set(self.inputs) - set(feeds))
        if unknown or lacking:
            raise UnavailableError(
                f"{self.info.path}: this graph is not the expected network (inputs {', '.join(self.inputs)}); "
                "run: diorama models verify"
            )
        converted: dict[str, np.ndarray] = {
            name: value.astype(_TYPES[self.inputs[name].type], copy=False) for name, value in feeds.items()
        }
        try:
            values = self._raw.run(None, converted)
        except Exception as error:
            reason = " ".join(str(error).split())[:200]
            advice = "try DIORAMA_DEVICE=cpu" if self.info.device == "cuda" else "see `diorama doctor`"
            raise UnavailableError(f"{self.info.path}: the network failed ({reason}); {advice}") from error
        return {
            name: v.astype(np.float32) if v.dtype == np.float16 else v
            for name, v in zip(self.outputs, values, strict=True)
        }


_TYPES = {
    "tensor(float)": np.float32,
    "tensor(float16)": np.float16,
    "tensor(double)": np.float64,
    "tensor(int64)": np.int64,
    "tensor(int32)": np.int32,
    "tensor(uint8)": np.uint8,
    "tensor(bool)": np.bool_,
}


@dataclass(eq=False)
class SessionPool:
    """Graphs by path; each is loaded once, by whoever needs it first.

    Before another is loaded, those that were not used for longest are freed until all fit into `budget_bytes`.
    """

    budget_bytes: int | None = None
    """Half of the machine's memory where None."""
    _loaded: dict[Path, Session] = field(default_factory=dict)
    _lock: threading.RLock = field(default_factory=threading.RLock)

    def get(self, path: Path) -> Session:
        """The loaded graph.

        Raises:
            UnavailableError: when the file is absent or damaged.
        """
        path = path.resolve()
        with self._lock:
            session = self._loaded.pop(path, None)
            if session is None:
                self._make_room(_file_bytes(path))
                session = _load(path)
                told = session.info
                _LOG.info("%s: loaded on %s, %.0f MB", path.name, told.device, told.memory_bytes / 1e6)
            self._loaded[path] = session  # the last is the one used last
            return session

    def _make_room(self, needed: int) -> None:
        budget = _half_of_memory() if self.budget_bytes is None else self.budget_bytes
        while self._loaded and needed + sum(s.info.memory_bytes for s in self._loaded.values()) > budget:
            oldest = next(iter(self._loaded))
            del self._loaded[oldest]
            _LOG.info("%s: freed for another network", oldest.name)

    def release(self, path: Path | None = None) -> None:
        """Free one graph, or all of them; whoever runs one at this moment finishes first."""
        with self._lock:
            if path is None:
                self._loaded.clear()
            else:
                self._loaded.pop(path.resolve(), None)

    def report(self) -> tuple[LoadedNetwork, ...]:
        """What is loaded now and what it takes."""
        with self._lock:
            return tuple(s.info for s in self._loaded.values())


SHARED_SESSIONS = SessionPool()
"""What a process uses unless told otherwise."""


def thread_count() -> int:
    """Threads of one network: the cores this process may use, at most `MOST_THREADS`.

    Raises:
        UnavailableError: when DIORAMA_THREADS is no number.
    """
    stated = os.environ.get("DIORAMA_THREADS", "").strip()
    if stated:
        if not (stated.isdigit() and int(stated) > 0):
            raise UnavailableError(f"DIORAMA_THREADS={stated[:40]!r} is no number of threads; correct or unset it")
        return int(stated)
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return max(1, min(cores, MAX_THREADS))


def providers() -> list[str]:
    """Execution providers in the order of preference."""
    import onnxruntime

    cpu = ["CPUExecutionProvider"]
    if os.environ.get("DIORAMA_DEVICE", "").lower() == "cpu":
        return cpu
    cuda = "CUDAExecutionProvider"
    return [cuda, *cpu] if cuda in onnxruntime.get_available_providers() else cpu


def _load(path: Path) -> Session:
    import onnxruntime

    if not path.is_file():
        raise UnavailableError(f"{path}: this network is not on this machine; run: diorama models pull lite")
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = thread_count()
    options.inter_op_num_threads = 1
    options.log_severity_level = 3
    before = _resident_bytes()
    try:
        raw = _session(path, options)
    except Exception as error:
        reason = " ".join(str(error).split())[:160]
        raise UnavailableError(f"{path}: cannot be loaded ({reason}); run: diorama models verify") from error
    grown = _resident_bytes() - before
    device = "cuda" if raw.get_providers()[0].startswith("CUDA") else "cpu"
    return Session(raw, LoadedNetwork(path, device, grown if grown > 0 else _file_bytes(path)))


def _session(path: Path, options: Any) -> Any:
    """On a graphics card where there is one; on the processor where the card cannot be used after all."""
    import onnxruntime

    wanted = providers()
    try:
        return onnxruntime.InferenceSession(str(path), options, providers=wanted)
    except Exception as error:
        if len(wanted) == 1:
            raise
        raw = onnxruntime.InferenceSession(str(path), options, providers=wanted[-1:])
        reason = " ".join(str(error).split())[:120]
        _LOG.warning("%s: the graphics card cannot be used (%s); DIORAMA_DEVICE=cpu avoids the try", path.name, reason)
        return raw


def _file_bytes(path: Path) -> int:
    """Of a graph and its external data: about what its weights take in memory."""
    return sum(p.stat().st_size for p in (path, path.with_name(path.name + "_data")) if p.exists())


def _half_of_memory() -> int:
    """Of this machine; four gigabytes where the system does not tell."""
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2
    except (AttributeError, OSError, ValueError):
        return 4_000_000_000


def _resident_bytes() -> int:
    """Memory of this process; 0 where the system does not tell."""
    try:
        pages = int(Path("/proc/self/statm").read_text().split()[1])
    except (OSError, IndexError, ValueError):
        return 0
    return pages * os.sysconf("SC_PAGE_SIZE")
