"""Scenes as files other programs open: one module per format, imported when it is used."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, cast, runtime_checkable

from diorama_core.errors import ExportError

if TYPE_CHECKING:
    import numpy as np
    from jaxtyping import UInt8

    from diorama_core.library.record import ShapeLibrary
    from diorama_core.scene.types import Scene


@runtime_checkable
class Writer(Protocol):
    """Writes a scene as one file; raises `ExportError` when it cannot."""

    def __call__(
        self,
        scene: Scene,
        library: ShapeLibrary,
        path: Path,
        *,
        textures: Mapping[str, UInt8[np.ndarray, "_ _ _"]] | None = None,
    ) -> None:
        """Write `scene` to `path`, replacing what is there only when all went well."""
        ...


FORMATS: Mapping[str, str] = {"glb": "gltf:write_glb"}
"""Every format by the name the command line knows it by, and where its writer is: `module:function`."""


def writer(format_name: str) -> Writer:
    """The writer of a format; raises `ExportError` with the formats that exist."""
    if format_name not in FORMATS:
        raise ExportError(f"cannot export as {format_name!r}; choose one of: {', '.join(sorted(FORMATS))}")
    module, function = FORMATS[format_name].split(":")
    return cast(Writer, getattr(import_module(f"diorama_core.export.{module}"), function))
