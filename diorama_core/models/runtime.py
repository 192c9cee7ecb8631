"""Running networks with onnxruntime: loaded when first used, shared, freed on demand or when others need the memory.

A graphics card is used where onnxruntime offers it (CUDA, DirectML, CoreML), else the processor. DIORAMA_DEVICE=cpu and
DIORAMA_THREADS=N override.
"""

from __future__ import annotations

import logging
import os
import re
import threading
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor, wait
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from types import EllipsisType
from typing import Any

import numpy as np

from diorama_core.errors import Cancelled, UnavailableError
from diorama_core.io.bounded import shorten
from diorama_core.io.large_libraries import load_onnxruntime
from diorama_core.progress import Progress

_LOG = logging.getLogger(__name__)

MAX_THREADS = 16
"""More threads than this slow these networks down."""
POLL_S = 0.1
"""Between two looks at the cancel token while a network computes."""
ACCELERATORS = {
    "CUDAExecutionProvider": "cuda",
    "DmlExecutionProvider": "directml",
    "CoreMLExecutionProvider": "coreml",
}
"""Execution providers of graphics cards, best first, and what people call them."""
_CODES = re.compile(r"\[ONNXRuntimeError\] : \d+ : \w+ : ")
MAX_SIDE_PX = 4096
"""Side of the pictures that networks ask for; a graph that states more is another network."""

Dims = tuple[int | EllipsisType | None, ...]
"""A shape: None for any size, an ellipsis in front for any number of leading dimensions of size one."""
SINGLE: Dims = (...,)
"""One number, of whatever shape."""


class NetworkError(UnavailableError):
    """A network that is installed cannot be loaded, fails, or answers as another network would."""

    def __init__(self, graph: Path, reason: str) -> None:
        super().__init__(f"{graph}: {reason}")
        self.graph, self._reason = graph, reason

    def __reduce__(self) -> tuple[type[NetworkError], tuple[Path, str]]:
        """Errors cross processes."""
        return NetworkError, (self.graph, self._reason)


@dataclass(frozen=True)
class LoadedNetwork:
    """A loaded graph, for reports."""

    path: Path
    device: str
    """cpu, cuda, directml or coreml."""
    memory_bytes: int
    """How much the process grew by loading it; the graph's files where that cannot be told."""
    note: str = ""
    """What was unusual about loading it, for people."""


class Session:
    """One loaded graph."""

    def __init__(self, raw: Any, info: LoadedNetwork) -> None:
        self._raw, self.info = raw, info
        self.inputs: dict[str, Any] = {i.name: i for i in raw.get_inputs()}
        self.outputs: tuple[str, ...] = tuple(o.name for o in raw.get_outputs())

    @property
    def first_input(self) -> str:
        """Its name; raises `NetworkError` when there is none."""
        if not self.inputs:
            raise self._other("it has no inputs")
        return next(iter(self.inputs))

    @property
    def picture_input(self) -> str:
        """Name of the first input; raises `NetworkError` when it takes no pictures."""
        name = self.first_input
        if len(self.inputs[name].shape) < 3:
            raise self._other(f"input {name} takes no picture")
        return name

    def side_px(self, name: str, default: int) -> int:
        """Width of the pictures that an input takes; `default` where any will do.

        Raises:
            NetworkError: when it is no width of a picture.
        """
        shape = self.inputs[name].shape if name in self.inputs else []
        side = shape[-1] if len(shape) == 4 else 0
        if not isinstance(side, int):
            return default
        if not 0 < side <= MAX_SIDE_PX:
            raise self._other(f"input {name}: {shape}")
        return side

    def run(
        self,
        feeds: Mapping[str, np.ndarray],
        expected: Mapping[str, Dims],
        *,
        gaps: bool = False,
        progress: Progress | None = None,
    ) -> dict[str, np.ndarray]:
        """All outputs by name; inputs are converted to the graph's number types.

        Args:
            feeds: A value for every input.
            expected: Shapes of the outputs that are used.
            gaps: Whether these may hold infinities and NaN beside numbers.
            progress: Asked now and then while the network computes; a long run stops when it is cancelled.

        Raises:
            NetworkError: when the graph does not have these inputs and outputs, or fails.
            Cancelled: On request.
        """
        if set(feeds) != set(self.inputs):
            raise self._other(f"inputs {', '.join(self.inputs)}")
        try:
            converted: dict[str, np.ndarray] = {
                n: v.astype(_TYPES[self.inputs[n].type], copy=False) for n, v in feeds.items()
            }
            values = self._raw.run(None, converted) if progress is None else self._run(converted, progress)
        except Cancelled:
            raise
        except Exception as error:  # onnxruntime's errors have no base of their own
            reason = _reason(error, self.info.path)
            advice = "see `diorama doctor`" if self.info.device == "cpu" else "try DIORAMA_DEVICE=cpu"
            raise NetworkError(self.info.path, f"the network failed ({reason}); {advice}") from error
        answers = dict(zip(self.outputs, values, strict=True))
        for name, dims in expected.items():
            self.check(name, answers.get(name), dims, gaps=gaps)
        return {n: v.astype(np.float32) if v.dtype == np.float16 else v for n, v in answers.items()}

    def answer(self, feeds: Mapping[str, np.ndarray], dims: Dims, *, gaps: bool = False) -> np.ndarray:
        """The first output alone; see `run`."""
        first = self.outputs[0]
        return self.run(feeds, {first: dims}, gaps=gaps)[first]

    def _run(self, feeds: Mapping[str, np.ndarray], progress: Progress) -> list[Any]:
        """Compute in a thread; tell the graph to stop when the work was cancelled."""
        options = load_onnxruntime().RunOptions()
        with ThreadPoolExecutor(1, thread_name_prefix="network") as pool:
            future = pool.submit(self._raw.run, None, dict(feeds), options)
            while not future.done():
                wait((future,), timeout=POLL_S)
                try:
                    progress.check()
                except Cancelled:
                    options.terminate = True
                    raise
            return list(future.result())

    def check(self, name: str, value: object, dims: Dims, *, gaps: bool = False) -> None:
        """Raise `NetworkError` unless an output has a shape and consists of numbers; see `run`.

        Args:
            name: Of the output.
            value: Of the output.
            dims: Numbers, or names for any.
            gaps: Whether NaN is allowed.
        """
        if not isinstance(value, np.ndarray) or value.dtype.kind not in "fiub":
            raise self._other(f"outputs {', '.join(self.outputs)}; no numbers in {name}")
        if not value.size or not _fits(value.shape, dims):
            raise self._other(f"output {name} of shape {value.shape}")
        numbers = np.isfinite(value)
        if not (numbers.any() if gaps else numbers.all()):
            raise NetworkError(
                self.info.path, f"the network's answer ({name}) is not made of numbers; run: diorama models verify"
            )

    def _other(self, seen: str) -> NetworkError:
        return NetworkError(
            self.info.path, f"this graph is not the expected network ({shorten(seen)}); run: diorama models verify"
        )


def _fits(shape: tuple[int, ...], dims: Dims) -> bool:
    if dims[:1] == (...,):
        leading = len(shape) - len(dims) + 1
        return leading >= 0 and set(shape[:leading]) <= {1} and _fits(shape[leading:], dims[1:])
    return len(shape) == len(dims) and all(d in (None, s) for s, d in zip(shape, dims, strict=True))


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
            NetworkError: when the file is absent or damaged.
        """
        path = path.resolve()
        with self._lock:
            session = self._loaded.pop(path, None)
            if session is None:
                self._make_room(_file_bytes(path))
                session = _load(path)
                info = session.info
                _LOG.info("%s: loaded on %s, %.0f MB", path.name, info.device, info.memory_bytes / 1e6)
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


@dataclass(frozen=True)
class GraphNetwork:
    """A network that is one graph."""

    graph: Path = field(repr=False)
    weights: str = ""
    """Identity of the weights, for cache keys."""
    pool: SessionPool = field(default=SHARED_SESSIONS, repr=False, compare=False, kw_only=True)

    @property
    def session(self) -> Session:
        """The loaded graph; raises `NetworkError`."""
        return self.pool.get(self.graph)


def thread_count() -> int:
    """Threads of one network: the cores this process may use, at most `MAX_THREADS`.

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
    """Execution providers in the order of preference; the processor comes last and alone with DIORAMA_DEVICE=cpu."""
    cpu = ["CPUExecutionProvider"]
    if os.environ.get("DIORAMA_DEVICE", "").lower() == "cpu":
        return cpu
    offered = load_onnxruntime().get_available_providers()
    cards = [name for name in ACCELERATORS if name in offered]
    if "CUDAExecutionProvider" in cards:
        _preload_cuda()
    return [*cards[:1], *cpu]


def calculates_in_half() -> bool:
    """Whether networks run where half precision is faster than single: on CUDA cards, not on processors."""
    return providers()[0] == "CUDAExecutionProvider"


@cache
def _preload_cuda() -> None:
    """Let onnxruntime find the CUDA and cuDNN libraries that pip installed, where its version can."""
    getattr(load_onnxruntime(), "preload_dlls", lambda: None)()


def _load(path: Path) -> Session:
    if not path.is_file():
        raise NetworkError(path, "this network is not on this machine; run: diorama models pull tiny")
    before = _resident_bytes()
    try:
        raw, note = _session(path)
    except Exception as error:  # onnxruntime's errors have no base of their own
        reason = _reason(error, path)
        raise NetworkError(path, f"cannot be loaded ({reason}); run: diorama models verify") from error
    grown = _resident_bytes() - before
    device = ACCELERATORS.get(raw.get_providers()[0], "cpu")
    return Session(raw, LoadedNetwork(path, device, grown if grown > 0 else _file_bytes(path), note))


def _reason(error: Exception, path: Path) -> str:
    """What onnxruntime says, without its codes and the path, which every message begins with."""
    message = _CODES.sub("", str(error)).replace(str(path), path.name)
    return shorten(message) or type(error).__name__


def _session(path: Path) -> tuple[Any, str]:
    """The graph and what was unusual: on a graphics card where there is one and it serves; else on the processor; and
    with fewer graph optimisations where the full ones fail, as they do for some half-precision graphs.
    """
    onnxruntime = load_onnxruntime()
    fewer = onnxruntime.GraphOptimizationLevel.ORT_ENABLE_BASIC
    wanted = providers()
    tries = [(wanted, None, ""), (wanted[-1:], fewer, "loaded with fewer graph optimisations")]
    if len(wanted) > 1:
        tries.insert(1, (wanted[-1:], None, "the graphics card cannot be used; DIORAMA_DEVICE=cpu avoids the try"))
    first: Exception | None = None
    for names, level, note in tries:
        try:
            raw = onnxruntime.InferenceSession(str(path), _options(level), providers=names)
        except Exception as error:  # as above; the first one is raised where every try fails
            first = first or error
            continue
        if note and first is not None:
            _LOG.warning("%s: %s (%s)", path.name, note, " ".join(str(first).split())[:120])
        return raw, note
    raise first or NetworkError(path, "cannot be loaded")


def _options(level: Any) -> Any:
    options = load_onnxruntime().SessionOptions()
    options.intra_op_num_threads = thread_count()
    options.inter_op_num_threads = 1
    options.log_severity_level = 3
    if level is not None:
        options.graph_optimization_level = level
    return options


def _file_bytes(path: Path) -> int:
    """Bytes of a graph and its external data: about what its weights take in memory."""
    return sum(p.stat().st_size for p in (path, path.with_name(path.name + "_data")) if p.exists())


def _half_of_memory() -> int:
    """Half of this machine's memory; four gigabytes where the system does not tell."""
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
