"""What is known of a network before it is on the machine: its files, their size, licence and source."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Role = Literal[
    "detection", "segmentation", "geometry", "foreground", "inpainting", "features", "text and image", "pose scale"
]
Tier = Literal["micro", "tiny", "lite", "default", "paper"]
TIERS: tuple[Tier, ...] = ("micro", "tiny", "lite", "default", "paper")
"""Sets of networks, smallest first."""


@dataclass(frozen=True)
class ModelFile:
    """One file of a network."""

    path: str
    """Inside the repository, and inside the network's own folder."""
    bytes: int | None = None
    sha256: str | None = None
    also_sha256: tuple[str, ...] = ()
    """Other publications of the same weights."""


@dataclass(frozen=True)
class Network:
    """One network and everything needed to fetch it."""

    id: str
    role: Role
    title: str
    licence: str
    files: tuple[ModelFile, ...]
    repo: str = ""
    """On the hub; empty where `url` is given or where users convert their own copy of a checkpoint."""
    revision: str | None = None
    """40 hexadecimal digits; a branch name or None is resolved at the first pull."""
    url: str = ""
    """Folder of the files, for networks that are not on the hub."""
    about_mb: int = 0
    """Size where the exact number of bytes is not known."""
    conversion: str = ""
    """Script that makes the files from the user's own checkpoint."""
    tiers: tuple[Tier, ...] = ()
    side: int | None = None
    """Side of the square picture it takes, where its graph leaves that open."""
    half_of: str = ""
    """Id of the network whose weights these are in half precision: for graphics cards that calculate with it."""

    @property
    def size_bytes(self) -> int:
        """All files together, about."""
        if any(f.bytes is None for f in self.files):
            return self.about_mb * 1_000_000
        return sum(f.bytes or 0 for f in self.files)

    @property
    def has_checksums(self) -> bool:
        """Whether published checksums identify all files; otherwise only what the network answers does."""
        return all(f.sha256 for f in self.files)

    @property
    def check_words(self) -> str:
        """How a download is checked, in words for people."""
        if self.has_checksums:
            return "published checksum"
        known = "size checked; " if all(f.bytes for f in self.files) else ""
        return f"{known}unverified (no published checksum): tried on a photo, then held to the first download's"

    @property
    def pullable(self) -> bool:
        """Whether the files can be fetched from somewhere."""
        return bool(self.repo or self.url)
