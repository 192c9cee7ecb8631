"""Artefacts as files: a zip of one JSON tree and raw arrays, and fingerprints of their content.

Nothing in such a file is ever executed: only the artefact classes listed here are constructed, with fields of the types
that the classes state, so a project folder received from someone else is safe to open. Sizes are checked before
memory is taken: a small file can state to hold very much.
"""

from __future__ import annotations

import hashlib
import io
import json
import zipfile
from dataclasses import Field, fields, is_dataclass
from typing import Any

import numpy as np

from diorama_core import artefacts, provenance
from diorama_core.errors import ProjectError
from diorama_core.geometry import rotations
from diorama_core.io.arrays import array_of, entry
from diorama_core.io.bounded import as_member, field_types, fits, parse_json, shorten
from diorama_core.io.text import clean_strings
from diorama_core.scene import light_settings, types

MAX_BYTES = 400_000_000
"""Unpacked: two hundred masks of a photo of 1600 x 1200."""
MAX_TREE_BYTES = 32_000_000
MAX_ENTRIES = 20_000

_CLASSES: dict[str, type] = {
    c.__name__: c
    for c in (
        artefacts.Photo,
        artefacts.LabelledBox,
        artefacts.Inputs,
        artefacts.FurtherPhoto,
        artefacts.CameraHypothesis,
        artefacts.CameraEstimate,
        artefacts.DetectedObject,
        artefacts.SeenKinds,
        artefacts.Reason,
        artefacts.Cuboid,
        artefacts.ObjectGeometry,
        artefacts.DepthMap,
        artefacts.DepthPrediction,
        artefacts.SceneGraph,
        artefacts.ArchitectureEstimate,
        artefacts.RankedShapes,
        artefacts.PosedCandidates,
        artefacts.LayoutReport,
        rotations.CameraAttitude,
        provenance.CameraSource,
        provenance.RoomSource,
        provenance.GraphSource,
        provenance.LanguageModelUse,
        types.Intrinsics,
        types.Camera,
        types.Pose,
        types.SurfaceFinish,
        light_settings.LightSettings,
        types.Plane,
        types.Architecture,
        types.Candidate,
        types.SceneObject,
        types.Support,
        types.RoomLight,
        types.PhotoMaterial,
        types.Scene,
    )
}
_FORMER_CLASSES = {"Held": "CameraAttitude"}
_FORMER_FIELDS = {("Inputs", "held"): "camera_attitude", ("CameraAttitude", "tilt_rad"): "pitch_rad"}
"""Names that have changed in what a user gave, which must stay readable: no stage can compute it again."""


def dump(value: Any) -> bytes:
    """An artefact (or tuple of artefacts) as bytes: the same value gives the same bytes, at any time of day."""
    arrays: list[np.ndarray] = []
    tree = _encode(value, arrays)
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr(zipfile.ZipInfo("tree.json"), json.dumps(clean_strings(tree), allow_nan=False))
        for i, array in enumerate(arrays):
            raw = io.BytesIO()
            np.lib.format.write_array(raw, array, allow_pickle=False)
            sparse = array.dtype == bool or array.dtype == np.int32
            packing = zipfile.ZIP_DEFLATED if sparse else zipfile.ZIP_STORED
            archive.writestr(zipfile.ZipInfo(f"{i}.npy"), raw.getvalue(), packing, compresslevel=1)
    return buffer.getvalue()


def load(data: bytes, expected: Any = Any) -> Any:
    """The artefact that `dump` wrote.

    Raises:
        ProjectError: when the bytes are damaged, of an unknown kind or larger than any real result.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            names = _array_names(archive)
            tree = parse_json(entry(archive, "tree.json"), "tree.json", ProjectError, advice="it is made again")
            arrays = [array_of(entry(archive, name)) for name in names]
        value = _decode(tree, arrays)
        if not fits(value, type(value)) or not fits(value, expected):
            raise ValueError("a value of another kind than it states")
    except Exception as error:  # damaged bytes make zip, number and class raise almost anything; it means the same
        reason = shorten(str(error), 120) or type(error).__name__
        raise ProjectError(f"a saved stage result is damaged ({reason}); it will be computed again") from error
    return value


def _array_names(archive: zipfile.ZipFile) -> list[str]:
    """Names of the arrays in order, after the stated sizes of all entries were checked."""
    infos = archive.infolist()
    if len(infos) > MAX_ENTRIES or sum(i.file_size for i in infos) > MAX_BYTES:
        raise ValueError(f"it would unpack to more than {MAX_ENTRIES} entries or {MAX_BYTES / 1e6:.0f} MB")
    names = [f"{i}.npy" for i in range(len(infos) - 1)]
    if {i.filename for i in infos} != {"tree.json", *names}:
        raise ValueError("entries are missing or doubled")
    if archive.getinfo("tree.json").file_size > MAX_TREE_BYTES:
        raise ValueError("its tree is too large")
    return names


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
        content = {f.name: _encode(getattr(value, f.name), arrays) for f in fields(value) if not _is_omitted(value, f)}
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


def _is_omitted(value: Any, known: Field[Any]) -> bool:
    """Whether a field came later and says nothing: values from before it keep their bytes, and saved results hold."""
    return "absent when none" in known.metadata and getattr(value, known.name) is None


def _decode(tree: Any, arrays: list[np.ndarray]) -> Any:
    if not isinstance(tree, dict):
        return tree
    if "array" in tree:
        return arrays[tree["array"]]
    if "class" in tree:
        return _instance(tree["class"], {name: _decode(v, arrays) for name, v in tree["fields"].items()})
    if "tuple" in tree:
        return tuple(_decode(v, arrays) for v in tree["tuple"])
    return {k: _decode(v, arrays) for k, v in tree["dict"]}


def _instance(saved_name: str, content: dict[str, Any]) -> Any:
    """An artefact of a class and fields under the names they have or had, with strings as the enums' members."""
    name = _FORMER_CLASSES.get(saved_name, saved_name)
    hints = field_types(_CLASSES[name])
    renamed = {_FORMER_FIELDS.get((name, field), field): value for field, value in content.items()}
    return _CLASSES[name](**{field: as_member(value, hints.get(field)) for field, value in renamed.items()})
