"""Files that a model refers to: read only when they lie in the folder that the user named."""

from __future__ import annotations

import io
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import trimesh
from PIL import Image

from diorama_core.errors import LibraryError
from diorama_core.io import bounded
from diorama_core.io.contained import ContainedFiles, quote
from diorama_core.library.ingest.limits import Limits
from diorama_core.library.ingest.obj import plain_mtl

IMAGE_FORMATS = ("PNG", "JPEG", "WEBP", "BMP", "TGA", "TIFF", "GIF", "DDS", "AVIF")
IMAGE_SUFFIXES = frozenset({".png", ".jpg", ".jpeg", ".webp", ".bmp", ".tga", ".tif", ".tiff", ".gif", ".dds", ".avif"})
KTX2 = b"\xabKTX 20\xbb"


def read_bytes(path: Path, limits: Limits) -> bytes:
    """A whole file; raises `LibraryError` when it is too large or cannot be read."""
    return bounded.read_bytes(path, limits.file_bytes, LibraryError, "reduce it, or leave it out")


@dataclass
class References:
    """Reads what one model refers to, and remembers what had to be left out.

    A name may be relative to the model and may climb, but never out of `root`. A name that leads nowhere is looked for
    beside the model, because many exporters write the path of the author's own disk.
    """

    folder: Path
    """Where the model lies."""
    root: Path
    """The folder that the user named; nothing outside is read."""
    limits: Limits
    warnings: list[str] = field(default_factory=list)

    def read(self, name: str) -> bytes:
        """The bytes of a referenced file.

        Raises:
            LibraryError: when it lies outside the folder, is a web address, is too large or does not exist.
        """
        return read_bytes(self._resolve(name), self.limits)

    def image(self, name: str) -> bytes | None:
        """A referenced picture, or None with a warning when it is missing, unsafe, broken or too large."""
        try:
            data = self.read(name)
        except LibraryError as error:
            self.warn(f"texture left out: {error}")
            return None
        return self.check_image(data, name)

    def check_image(self, data: bytes, name: str) -> bytes | None:
        """The picture when it can be unpacked safely, else None with a warning."""
        problem = image_problem(data, self.limits)
        if problem:
            self.warn(f"texture left out: {quote(name)} {problem}")
            return None
        return data

    def warn(self, message: str) -> None:
        """Remember a repair, once."""
        if message not in self.warnings:
            self.warnings.append(message)

    def _resolve(self, name: str) -> Path:
        """The file of a name; where it leads nowhere, one whose path ends as the name does, capitals or not.

        A path of the author's own disk ends as the file lies here: `C:/Users/me/textures/cloth.png`.
        """
        files = ContainedFiles(self.root, LibraryError)
        try:
            return files.path_or_beside(name, self.folder)
        except LibraryError:
            parts = unquote(name).replace("\\", "/").strip().split("/")
            ends = (parts[start:] for start in range(len(parts)))
            folders = dict.fromkeys((self.folder, self.root))
            matches = (_matching(folder, end) for end in ends if "://" not in name for folder in folders)
            alike = next((path for path in matches if path is not None and files.holds(path)), None)
            if alike is None:
                raise
            return alike


def _matching(folder: Path, parts: Sequence[str]) -> Path | None:
    """A path within a folder whose parts are named so, capitals or not."""
    for part in parts:
        if not part or part in (".", "..") or not folder.is_dir():
            return None
        exact = folder / part
        try:
            folder = exact if exact.exists() else next(p for p in folder.iterdir() if p.name.lower() == part.lower())
        except (StopIteration, OSError, ValueError):
            return None
    return folder


class GuardedResolver(trimesh.resolvers.Resolver):  # type: ignore[misc]  # untyped base
    """Hands referenced files to trimesh's loaders, through `References`."""

    def __init__(self, references: References) -> None:
        self._references = references

    def get(self, name: Any) -> bytes:
        """The file's bytes; raises `KeyError` when it may not or cannot be read."""
        key = name.decode(errors="replace") if isinstance(name, bytes) else str(name)
        if Path(key.replace("\\", "/")).suffix.lower() in IMAGE_SUFFIXES:
            data = self._references.image(key)
        else:
            try:
                data = self._references.read(key)
                data = plain_mtl(data) if key.lower().endswith(".mtl") else data
            except LibraryError as error:
                self._references.warn(f"left out: {error}")
                data = None
        if data is None:
            raise KeyError(key)
        return data

    def write(self, name: str, data: Any) -> None:
        """Loaders write nothing."""
        raise NotImplementedError

    def namespaced(self, namespace: str) -> GuardedResolver:
        """Return this resolver: names in any namespace are relative to the model."""
        return self

    def keys(self) -> Iterator[str]:
        """What can be asked for is not known beforehand."""
        return iter(())


def image_problem(data: bytes, limits: Limits) -> str:
    """Why a picture cannot be used, read from its header alone; empty when it can."""
    if data.startswith(KTX2):
        return "is KTX2 (Basis), which is not read; export the model with PNG or JPEG textures"
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            with Image.open(io.BytesIO(data), formats=IMAGE_FORMATS) as image:
                width, height = image.size
    except Image.DecompressionBombError:
        return "is a decompression bomb"
    except Exception as error:  # a broken header may raise anything
        return f"is no picture that can be read ({type(error).__name__})"
    if width * height > limits.image_pixels:
        return f"would unpack to {width} x {height} pixels"
    return ""
