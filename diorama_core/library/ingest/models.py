"""Reading a model file, whatever its format, into one scene in the file's own frame and unit.

What a file is, its content says first: `MODEL_FORMS` is the table of what is read.
"""

from __future__ import annotations

import io
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import trimesh

from diorama_core.errors import DioramaError, LibraryError, UnavailableError
from diorama_core.io.contained import unpack
from diorama_core.io.file_heads import FileHead, head_of, what_else
from diorama_core.io.text import parse_xml
from diorama_core.library.ingest import fbx, gltf
from diorama_core.library.ingest.frames import GLTF, OBJ, PLY, STL, THREE_DS, Convention, OwnFrame
from diorama_core.library.ingest.limits import DEFAULT_LIMITS, Limits
from diorama_core.library.ingest.obj import absolute_indices
from diorama_core.library.ingest.references import GuardedResolver, References, read_bytes
from diorama_core.library.ingest.three_ds import read_3ds
from diorama_core.library.ingest.three_mf import read_3mf


@dataclass(frozen=True)
class RawModel:
    """A model as its file has it."""

    scene: trimesh.Scene
    """In the file's frame and unit."""
    names: tuple[str, ...]
    """Words of the author: nodes, meshes, materials."""
    convention: Convention
    warnings: tuple[str, ...]
    own: OwnFrame | None = None
    """The frame of the object, where Diorama wrote the file."""


@dataclass(frozen=True)
class ModelForm:
    """A format that is read."""

    name: str
    suffixes: tuple[str, ...]
    tells: Callable[[FileHead], bool]
    """Whether a file's content is of it; its name alone counts where content says nothing."""
    read: Callable[[Path, References, Limits], RawModel]
    note: str = ""
    """What else to know, for people."""


def form_of(head: FileHead) -> ModelForm | None:
    """The format of a file: as its content says, else as its name does; None where it is none that is read."""
    known_form = next((form for form in MODEL_FORMS if form.tells(head)), None)
    if known_form is not None or (head.size and what_else(head) is not None):
        return known_form
    return next((form for form in MODEL_FORMS if head.suffix in form.suffixes), None)


def read_model(path: Path, root: Path, limits: Limits = DEFAULT_LIMITS, member: str = "") -> RawModel:
    """Read one file.

    Args:
        path: The model, or a zip archive.
        root: Nothing outside this folder is read, whatever the model refers to.
        limits: What is refused.
        member: Which file of the archive.

    Raises:
        LibraryError: with the reason, when the file cannot be used.
        UnavailableError: its format needs an optional library.
    """
    if member:
        with unpack(path, limits.file_bytes) as folder:
            return read_model(folder / member, folder, limits)
    head = head_of(path)
    form = form_of(head)
    if form is None:
        other = what_else(head)
        known = f"it is {other.name}: {other.advice}" if other else "it is no model in a format that is read"
        raise LibraryError(f"{known} ({', '.join(f.name for f in MODEL_FORMS)})" if other is None else known)
    try:
        return form.read(path, References(path.parent, root, limits), limits)
    except DioramaError:
        raise
    except MemoryError as error:
        raise LibraryError("it needs more memory than a model may take") from error
    except Exception as error:  # loaders raise anything on malformed bytes
        reason = f"{type(error).__name__}: {str(error)[:100]}"
        raise LibraryError(f"malformed {form.name} ({reason}); export it again") from error


def _read_gltf(path: Path, references: References, limits: Limits) -> RawModel:
    glb = gltf.pack_glb(_content(path, limits), references, limits)
    scene = trimesh.load_scene(io.BytesIO(glb), file_type="glb")
    names, frame = gltf.node_names(glb), gltf.frame_of_own(glb)
    return RawModel(scene, names, GLTF, tuple(references.warnings), frame)


def _read_obj(path: Path, references: References, limits: Limits) -> RawModel:
    content = absolute_indices(_content(path, limits))
    options: dict[str, Any] = {"split_object": False, "group_material": True}
    resolver = GuardedResolver(references)
    scene = trimesh.load_scene(io.BytesIO(content), file_type="obj", resolver=resolver, **options)
    return RawModel(scene, _obj_names(content), OBJ, tuple(references.warnings))


def _read_plain(convention: Convention, kind: str) -> Callable[[Path, References, Limits], RawModel]:
    def read(path: Path, references: References, limits: Limits) -> RawModel:
        content, resolver = _content(path, limits), GuardedResolver(references)
        scene = trimesh.load_scene(io.BytesIO(content), file_type=kind, resolver=resolver)
        return RawModel(scene, (), convention, tuple(references.warnings))

    return read


def _read_fbx(path: Path, references: References, limits: Limits) -> RawModel:
    scene, names, unit_m = fbx.read_fbx(path, _content(path, limits), references)
    return RawModel(
        scene, names, Convention("FBX", {"+y": 0.9}, {"+z": 0.5}, {unit_m: 0.8}), tuple(references.warnings)
    )


def _read_dae(path: Path, references: References, limits: Limits) -> RawModel:
    try:
        import collada  # noqa: F401
    except ImportError as error:
        raise UnavailableError("Collada needs a reader; run: pip install pycollada, or convert to GLB") from error
    content = _content(path, limits)
    parse_xml(content, "its XML", LibraryError)  # refuses entities, whatever the encoding
    scene = trimesh.load_scene(io.BytesIO(content), file_type="dae", resolver=GuardedResolver(references))
    unit = re.search(rb'<unit[^>]*\bmeter="([0-9.eE+-]+)"', content)
    axis = re.search(rb"<up_axis>\s*([XYZ])_UP", content)
    up = f"+{axis[1].decode().lower()}" if axis else "+y"
    metres = {float(unit[1]): 0.9} if unit else {1.0: 0.6}
    names = re.findall(rb'<(?:node|geometry|material)[^>]*\bname="([^"]+)"', content)
    words = tuple(dict.fromkeys(n.decode(errors="replace") for n in names))
    return RawModel(scene, words, Convention("Collada", {up: 0.97}, {}, metres), tuple(references.warnings))


def _read_3mf(path: Path, references: References, limits: Limits) -> RawModel:
    scene, unit_m = read_3mf(_content(path, limits), limits)
    return RawModel(scene, (), Convention("3MF", {"+z": 0.9}, {"-y": 0.5}, {unit_m: 0.85}), ())


def _read_3ds(path: Path, references: References, limits: Limits) -> RawModel:
    scene, names = read_3ds(_content(path, limits))
    return RawModel(scene, names, THREE_DS, ())


def _read_usd(path: Path, references: References, limits: Limits) -> RawModel:
    from diorama_core.library.ingest.usd_meshes import usd_scene
    from diorama_core.library.ingest.usd_stage import frame_of, open_stage, usd_errors

    stage = open_stage(path)
    with usd_errors(path):
        up, unit_m = frame_of(stage)
        scene = usd_scene(stage)
    names = tuple(part for name in scene.graph.nodes_geometry for part in str(name).strip("/").split("/"))
    convention = Convention("USD", {up: 0.98}, {"+z" if up == "+y" else "-y": 0.5}, {unit_m: 0.9})
    return RawModel(scene, tuple(dict.fromkeys(names)), convention, ())


def _obj_names(obj: bytes) -> tuple[str, ...]:
    """Names of objects, groups and materials of an OBJ, each once, in its order."""
    names = re.findall(rb"^(?:o|g|usemtl)[ \t]+([^\r\n]+)", obj, re.MULTILINE)
    return tuple(dict.fromkeys(name.decode(errors="replace").strip() for name in names))


def _content(path: Path, limits: Limits) -> bytes:
    data = read_bytes(path, limits)
    if not data:
        raise LibraryError("the file is empty")
    return data


_OBJ_LINE = re.compile(rb"^\s*(?:v\s+[-\d.]|f\s+[-\d]|mtllib |usemtl |o |g )", re.MULTILINE)
USD_SUFFIXES = (".usd", ".usda", ".usdc", ".usdz")
MODEL_FORMS = (
    ModelForm(
        "glTF", (".glb", ".gltf"),
        lambda h: h.head[:4] == b"glTF" or (h.text.startswith("{") and '"asset"' in h.text), _read_gltf,
        "Draco, meshopt, WebP and specular-glossiness are read; metres and +Y up are believed",
    ),
    ModelForm("PLY", (".ply",), lambda h: h.head.startswith((b"ply\n", b"ply\r")), _read_plain(PLY, "ply")),
    ModelForm("FBX", (".fbx",), lambda h: h.head.startswith((b"Kaydara FBX", b"; FBX")), _read_fbx,
              "needs diorama[fbx]"),
    ModelForm("USD", USD_SUFFIXES,
              lambda h: h.head.startswith((b"#usda", b"PXR-USDC")) or (h.is_zip and h.has(".usdc", ".usda", ".usd")),
              _read_usd, "needs diorama[usd]; plain colours"),
    ModelForm("Collada", (".dae",), lambda h: "<COLLADA" in h.text[:2000], _read_dae),
    ModelForm("3MF", (".3mf",), lambda h: h.is_zip and h.has(".model"), _read_3mf),
    ModelForm("3DS", (".3ds",), lambda h: h.head[:2] == b"MM" and h.suffix == ".3ds", _read_3ds, "plain colours"),
    ModelForm("OFF", (".off",), lambda h: h.head.startswith((b"OFF", b"COFF", b"NOFF")), _read_plain(STL, "off")),
    ModelForm("OBJ", (".obj",), lambda h: h.suffix == ".obj" or bool(_OBJ_LINE.search(h.head) and h.suffix == ""),
              _read_obj, "with its MTL and pictures, names as any system writes them"),
    ModelForm("STL", (".stl",), lambda h: h.suffix == ".stl", _read_plain(STL, "stl")),
)  # fmt: skip
"""The first that tells a file is its format."""
SUFFIXES = tuple(s for form in MODEL_FORMS for s in form.suffixes)
"""Endings of model files. FBX needs the optional converter, USD an optional library."""
