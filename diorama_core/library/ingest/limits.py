"""How much of a foreign file is read before it is refused."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Limits:
    """Bounds on one model and everything it refers to; what lies beyond is refused or left out, with a reason."""

    file_bytes: int = 512 * 2**20
    """Size of any one file read, referenced ones included."""
    json_bytes: int = 64 * 2**20
    triangles: int = 1_500_000
    nodes: int = 50_000
    image_pixels: int = 8192 * 8192
    """A picture that would unpack to more is left out."""
    texture_side_px: int = 1024
    """Kept textures are made no larger than this."""
    seconds: float = 180.0
    """Processor time for one model."""
    memory_bytes: int = 8 * 2**30
    """Address space of a worker process."""


DEFAULT_LIMITS = Limits()
