"""USD and USDZ files: opening them with care, and their frame."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float
from shapely.errors import ShapelyError

from diorama_core.errors import InputError, UnavailableError
from diorama_core.io.bounded import megabytes, shorten
from diorama_core.io.contained import ContainedFiles
from diorama_core.library.ingest.limits import DEFAULT_LIMITS

Z_UP = np.array([[1.0, 0, 0, 0], [0, 0, -1.0, 0], [0, 1.0, 0, 0], [0, 0, 0, 1.0]])
"""A frame with +Y up (glTF's, USD's usual one) to one with +Z up."""


def open_stage(path: Path) -> Any:
    """A USD stage.

    Raises:
        UnavailableError: when usd-core is missing.
        InputError: when the file is too large, is no USD, or refers to files outside its folder.
    """
    try:
        from pxr import Usd
    except ImportError as error:
        raise UnavailableError("reading USD needs an optional library: pip install 'diorama[usd]'") from error
    if path.stat().st_size > DEFAULT_LIMITS.file_bytes:
        raise InputError(f"{path.name} has more than the {megabytes(DEFAULT_LIMITS.file_bytes)} that are read")
    with usd_errors(path):
        _stay_beside(path)
        return Usd.Stage.Open(str(path))


@contextmanager
def usd_errors(path: Path) -> Iterator[None]:
    """What OpenUSD raises while it opens a file or gives values from it, and values that make no sense, as one line.

    Raises:
        InputError: for each of them.
    """
    from pxr import Tf

    try:
        yield
    except Tf.ErrorException as error:
        raise InputError(f"{path.name} cannot be read as USD ({_reason(error, path)}); export it again") from error
    except (ValueError, TypeError, LookupError, ArithmeticError, ShapelyError) as error:
        reason = shorten(str(error))
        raise InputError(f"{path.name}: something in it makes no sense ({reason}); export it again") from error


def _reason(error: Exception, path: Path) -> str:
    """Last words of "Error in '...' at line ... : 'Failed to open layer @/path/room.usdz@'", enough to read."""
    try:
        words = str(error)
    except UnicodeDecodeError:  # OpenUSD quotes bytes of the file
        return "it is damaged"
    last = words.strip().rpartition("\n")[2].rpartition(" : ")[2]
    return shorten(last.replace(f"@{path}@", "").replace(str(path), path.name).strip(" '")) or "it is damaged"


def _stay_beside(path: Path) -> None:
    """Refuse layers outside the file's folder: a received file must not name what else is on this machine."""
    from pxr import Sdf

    files = ContainedFiles(path.resolve().parent, InputError)
    waiting, seen = [str(path.resolve())], set[str]()
    while waiting:
        name = waiting.pop()
        layer = None if name in seen else Sdf.Layer.FindOrOpen(name)
        seen.add(name)
        if layer is None:
            continue
        for asset in layer.GetCompositionAssetDependencies():
            if not asset:
                continue  # within the layer itself
            other = layer.ComputeAbsolutePath(asset)
            place = Path(other.partition("[")[0])  # of "room.usdz[chair.usdc]" the package
            if not os.path.lexists(place):
                continue
            if not files.holds(place):
                raise InputError(f"{path.name} refers to a file outside its folder ({shorten(asset)}); put it beside")
            waiting.append(other)


def world_of(stage: Any) -> Float[np.ndarray, "4 4"]:
    """The stage's frame and unit to the world: +Z up, metres."""
    up, metres = frame_of(stage)
    turn = Z_UP if up == "+y" else np.eye(4)
    return turn @ np.diag([metres, metres, metres, 1.0])


def frame_of(stage: Any) -> tuple[str, float]:
    """The axis that a stage says is up, and metres in one of its units."""
    from pxr import UsdGeom

    up = "+y" if UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.y else "+z"
    return up, float(UsdGeom.GetStageMetersPerUnit(stage))


def matrix_of(matrix: Any) -> Float[np.ndarray, "4 4"]:
    """A USD matrix (rows are axes) as one that multiplies columns."""
    return np.array(matrix, dtype=np.float64).reshape(4, 4).T
