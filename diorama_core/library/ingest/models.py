"""Reading a model file, whatever its format, into one scene in the file's own frame and unit."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import trimesh

from diorama_core.errors import DioramaError, LibraryError
from diorama_core.library.ingest import fbx, gltf
from diorama_core.library.ingest.limits import DEFAULT_LIMITS, Limits
from diorama_core.library.ingest.references import GuardedResolver, References, read_bytes


@dataclass(frozen=True)
class Convention:
    """What a format promises about its frame, or what its files usually do: probabilities, and metres per unit."""

    name: str
    up: Mapping[str, float]
    front: Mapping[str, float] = field(default_factory=dict)
    unit: Mapping[float, float] = field(default_factory=dict)


GLTF = Convention("glTF", {"+y": 0.99}, {"+z": 0.7}, {1.0: 0.85, 0.01: 0.04, 0.001: 0.03})
"""The specification: +Y up, +Z front, metres. Ups are nearly always kept, fronts mostly, units often."""
OBJ = Convention("OBJ", {"+y": 0.65, "+z": 0.3}, {}, {1.0: 0.4, 0.01: 0.3, 0.001: 0.15, 0.0254: 0.1})
PLY = Convention("PLY", {"+z": 0.5, "+y": 0.4}, {}, {1.0: 0.6, 0.001: 0.2, 0.01: 0.1})
STL = Convention("STL", {"+z": 0.75, "+y": 0.2}, {}, {0.001: 0.7, 1.0: 0.15, 0.01: 0.05, 0.0254: 0.08})
UNKNOWN = Convention("no", {}, {}, {1.0: 0.4, 0.01: 0.2, 0.001: 0.2, 0.0254: 0.1})
"""Nothing is promised; for tests of what geometry alone tells."""


@dataclass(frozen=True)
class RawModel:
    """A model as its file has it."""

    scene: trimesh.Scene
    """In the file's frame and unit."""
    names: tuple[str, ...]
    """Words of the author: nodes, meshes, materials."""
    convention: Convention
    warnings: tuple[str, ...]


SUFFIXES = (".glb", ".gltf", ".obj", ".ply", ".stl", ".fbx")
"""Formats that are read. FBX needs the optional converter (`pip install "diorama[fbx]"`)."""
NOT_READ = frozenset({".blend", ".max", ".ma", ".mb", ".c4d", ".skp", ".3ds", ".dae", ".usd", ".usdz", ".usda", ".usdc",
                      ".3mf", ".step", ".stp", ".iges", ".igs", ".off", ".x3d", ".wrl", ".3dm", ".zip"})  # fmt: skip
"""Formats that people keep models in and that are not read; they are listed as skipped, never silently passed over."""


def read_model(path: Path, root: Path, limits: Limits = DEFAULT_LIMITS) -> RawModel:
    """Read one file.

    Args:
        path: The model.
        root: Nothing outside this folder is read, whatever the model refers to.
        limits: What is refused.

    Raises:
        LibraryError: with the reason, when the file cannot be used.
    """
    readers: dict[str, Callable[[Path, References, Limits], RawModel]] = {
        ".glb": _read_gltf,
        ".gltf": _read_gltf,
        ".obj": _read_plain(OBJ, "obj"),
        ".ply": _read_plain(PLY, "ply"),
        ".stl": _read_plain(STL, "stl"),
        ".fbx": _read_fbx,
    }
    reader = readers.get(path.suffix.lower())
    if reader is None:
        raise LibraryError(f"{path.suffix or 'a file without ending'} is not supported; convert it to GLB")
    references = References(path.parent, root, limits)
    try:
        return reader(path, references, limits)
    except DioramaError:
        raise
    except MemoryError as error:
        raise LibraryError("it needs more memory than a model may take") from error
    except Exception as error:  # loaders raise anything on malformed bytes
        raise LibraryError(
            f"malformed {path.suffix[1:].upper()} ({type(error).__name__}: {str(error)[:100]})"
        ) from error


def _read_gltf(path: Path, references: References, limits: Limits) -> RawModel:
    glb = gltf.packed(_content(path, limits), references, limits)
    scene = trimesh.load_scene(io.BytesIO(glb), file_type="glb")
    return RawModel(scene, gltf.node_names(glb), GLTF, tuple(references.warnings))


def _read_plain(convention: Convention, kind: str) -> Callable[[Path, References, Limits], RawModel]:
    def read(path: Path, references: References, limits: Limits) -> RawModel:
        options: dict[str, Any] = {"split_object": False, "group_material": True} if kind == "obj" else {}
        content, resolver = _content(path, limits), GuardedResolver(references)
        scene = trimesh.load_scene(io.BytesIO(content), file_type=kind, resolver=resolver, **options)
        names = _written_names(content) if kind == "obj" else ()
        return RawModel(scene, names, convention, tuple(references.warnings))

    return read


def _read_fbx(path: Path, references: References, limits: Limits) -> RawModel:
    found = fbx.read_fbx(path, _content(path, limits), references)
    convention = Convention("FBX", {found.up: 0.9}, {found.front: 0.5}, {found.unit_m: 0.8})
    return RawModel(found.scene, found.names, convention, tuple(references.warnings))


def _written_names(obj: bytes) -> tuple[str, ...]:
    """Names of objects, groups and materials of an OBJ, each once, in its order."""
    found = re.findall(rb"^(?:o|g|usemtl)[ \t]+([^\r\n]+)", obj, re.MULTILINE)
    return tuple(dict.fromkeys(name.decode(errors="replace").strip() for name in found))


def _content(path: Path, limits: Limits) -> bytes:
    data = read_bytes(path, limits)
    if not data:
        raise LibraryError("the file is empty")
    return data
