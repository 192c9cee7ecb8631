"""Scenes as files other programs open: one module per format."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Protocol

import numpy as np
from jaxtyping import UInt8

from diorama_core.errors import ExportError
from diorama_core.export.gltf import write_glb
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import Scene


class Writer(Protocol):
    """Writes a scene as one file; raises `ExportError` when it cannot."""

    def __call__(
        self,
        scene: Scene,
        library: ShapeLibrary,
        path: Path,
        *,
        textures: Mapping[str, UInt8[np.ndarray, "h w c"]] | None = None,
    ) -> None:
        """Write `scene` to `path`, replacing what is there only when all went well."""
        ...


WRITERS: dict[str, Writer] = {"glb": write_glb}
"""Every format that can be written, by the name the command line knows it by."""


def writer(format_name: str) -> Writer:
    """The writer of a format; raises `ExportError` with the formats that exist."""
    if format_name not in WRITERS:
        raise ExportError(f"cannot export as {format_name!r}; choose one of: {', '.join(sorted(WRITERS))}")
    return WRITERS[format_name]
