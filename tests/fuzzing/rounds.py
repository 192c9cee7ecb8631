"""A round of damaged inputs through one reader, and what was found."""

from __future__ import annotations

import time
import traceback
from dataclasses import dataclass, field

import numpy as np

from diorama_core.errors import DioramaError
from tests.fuzzing.parsers import Parser

MAX_LINE = 600
SLOW_S = 3.0
"""Of the processor: other work on the machine does not count."""


class Wrong(Exception):  # noqa: N818
    """A reader's line or time is not as promised."""


@dataclass
class Round:
    """Inputs made from a seed, so that a finding can be found again."""

    parser: Parser
    seed: int
    read: int = 0
    refused: int = 0
    longest_s: float = 0.0
    longest_line: int = 0
    findings: list[tuple[bytes, Exception]] = field(default_factory=list)

    def run(self, *, seconds: float = 1e9, count: int = 10**9) -> Round:
        """So many inputs, or for so long."""
        random = np.random.default_rng(self.seed)
        samples = self.parser.samples()
        self.parser.read(samples[0])  # what is loaded on first use is not the input's time
        until = time.monotonic() + seconds
        while time.monotonic() < until and self.read + self.refused + len(self.findings) < count:
            sample = samples[int(random.integers(0, len(samples)))]
            self.one(self.parser.mutate(sample, random))
        return self

    def one(self, data: bytes) -> None:
        """One input through the reader."""
        began = time.process_time()
        try:
            try:
                self.parser.read(data)
                self.read += 1
            except DioramaError as error:
                line = str(error)
                self.longest_line = max(self.longest_line, len(line))
                if len(line) > MAX_LINE or "\n" in line or not line:
                    raise Wrong(f"{len(line)} characters: {line[:80]!r}") from error
                line.encode()
                self.refused += 1
            took = time.process_time() - began
            self.longest_s = max(self.longest_s, took)
            if took > SLOW_S:
                raise Wrong(f"{took:.1f} s")
        except Exception as error:
            self.findings.append((data, error))

    @property
    def kinds(self) -> dict[str, tuple[bytes, Exception]]:
        """The smallest input of each kind of finding, by where it was raised."""
        found: dict[str, tuple[bytes, Exception]] = {}
        for data, error in self.findings:
            frames = [f for f in traceback.extract_tb(error.__traceback__) if "diorama" in f.filename]
            at = frames[-1] if frames else None
            kind = f"{type(error).__name__} at {at.filename.split('/')[-1]}:{at.lineno}" if at else type(error).__name__
            if kind not in found or len(data) < len(found[kind][0]):
                found[kind] = (data, error)
        return found

    @property
    def summary(self) -> str:
        """One line."""
        total = self.read + self.refused + len(self.findings)
        return (
            f"{total:7} inputs, {self.read:6} read, {self.refused:6} refused, {len(self.findings):4} wrongly; "
            f"longest {self.longest_s:.2f} s, line {self.longest_line}"
        )
