"""Artefacts as files: a zip of one JSON tree and raw arrays, and fingerprints of their content.

Nothing in such a file is ever executed: only the artefact classes listed here are constructed, so a project folder
received from someone else is safe to open.
"""

from __future__ import annotations

import hashlib
import io
import json
import zipfile
from dataclasses import Field, fields, is_dataclass
from typing import Any

import numpy as np

from diorama_core import artefacts
from diorama_core.errors import ProjectError
from diorama_core.geometry import camera_attitude
from diorama_core.scene import types

_CLASSES: dict[str, type] = {
    c.__name__: c
    for c in (
        artefacts.Photo,
        artefacts.LabelledBox,
        artefacts.Inputs,
        artefacts.CameraHypothesis,
        artefacts.CameraEstimate,
        artefacts.DetectedObject,
        artefacts.Cuboid,
        artefacts.ObjectGeometry,
        artefacts.DepthMap,
        artefacts.DepthPrediction,
        artefacts.SceneGraph,
        artefacts.ArchitectureEstimate,
        artefacts.RankedShapes,
        artefacts.PosedCandidates,
        artefacts.LayoutReport,
        camera_attitude.CameraAttitude,
        types.Intrinsics,
        types.Camera,
        types.Pose,
        types.Plane,
        types.Architecture,
        types.Candidate,
        types.SceneObject,
        types.Support,
        types.Scene,
    )
}


def dump(value: Any) -> bytes:
    """An artefact (or tuple of artefacts) as bytes: the same value gives the same bytes, at any time of day."""
    arrays: list[np.ndarray] = []
    tree = _encode(value, arrays)
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr(zipfile.ZipInfo("tree.json"), json.dumps(tree, allow_nan=False))
        for i, array in enumerate(arrays):
            raw = io.BytesIO()
            np.lib.format.write_array(raw, array, allow_pickle=False)
            sparse = array.dtype == bool or array.dtype == np.int32
            packing = zipfile.ZIP_DEFLATED if sparse else zipfile.ZIP_STORED
            archive.writestr(zipfile.ZipInfo(f"{i}.npy"), raw.getvalue(), packing, compresslevel=1)
    return buffer.getvalue()


def load(data: bytes) -> Any:
    """The artefact that `dump` wrote.

    Raises:
        ProjectError: when the bytes are damaged or of an unknown kind.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            tree = json.loads(archive.read("tree.json"))
            count = len(archive.namelist()) - 1
            arrays = [
                np.lib.format.read_array(io.BytesIO(archive.read(f"{i}.npy")), allow_pickle=False) for i in range(count)
            ]
        return _decode(tree, arrays)
    except (zipfile.BadZipFile, KeyError, ValueError, TypeError, EOFError) as error:
        raise ProjectError(f"a saved stage result is damaged ({error}); it will be computed again") from error


def fingerprint(value: Any) -> str:
    """A hash of an artefact's whole content."""
    digest = hashlib.sha256()
    arrays: list[np.ndarray] = []
    digest.update(json.dumps(_encode(value, arrays), allow_nan=False).encode())
    for array in arrays:
        digest.update(f"{array.dtype.str}{array.shape}".encode())
        digest.update(np.ascontiguousarray(array).data)
    return digest.hexdigest()


def _encode(value: Any, arrays: list[np.ndarray]) -> Any:
    if isinstance(value, np.ndarray):
        arrays.append(value)
        return {"array": len(arrays) - 1}
    if is_dataclass(value) and type(value).__name__ in _CLASSES:
        content = {f.name: _encode(getattr(value, f.name), arrays) for f in fields(value) if not _left_out(value, f)}
        return {"class": type(value).__name__, "fields": content}
    if isinstance(value, tuple):
        return {"tuple": [_encode(v, arrays) for v in value]}
    if isinstance(value, dict):
        return {"dict": [[k, _encode(v, arrays)] for k, v in value.items()]}
    if isinstance(value, np.generic):
        return value.item()
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    raise TypeError(f"{type(value).__name__} is not an artefact")


def _left_out(value: Any, known: Field[Any]) -> bool:
    """Whether a field came later and says nothing: values from before it keep their bytes, and saved results hold."""
    return "absent when none" in known.metadata and getattr(value, known.name) is None


def _decode(tree: Any, arrays: list[np.ndarray]) -> Any:
    if not isinstance(tree, dict):
        return tree
    if "array" in tree:
        array = arrays[tree["array"]]
        array.setflags(write=False)
        return array
    if "class" in tree:
        content = {name: _decode(v, arrays) for name, v in tree["fields"].items()}
        return _CLASSES[tree["class"]](**content)
    if "tuple" in tree:
        return tuple(_decode(v, arrays) for v in tree["tuple"])
    return {k: _decode(v, arrays) for k, v in tree["dict"]}
