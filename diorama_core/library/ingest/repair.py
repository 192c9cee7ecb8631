"""From a file's scene to sound triangles with plain materials; flat models get a thickness.

Extras of glTF nodes that say what a part is: `role`, `joint` and `parameter`.

They hold for a node and what is below it, as far as no node between says otherwise. In Blender they are custom
properties of an object, and are exported with the option "Custom Properties".

- `role`: a word, "door" or "seat", which names the part.
- `joint`: "revolute AXIS LOWER UPPER" (degrees), "prismatic AXIS LOWER UPPER" (metres) or "continuous AXIS". The axis
  is x, y, z, -x, -y or -z of the node's own frame, through its origin; 0 is how the file shows the part.
- `parameter`: sides of the shape ("depth", "width", "height") along which the part is stretched with it, or "rigid".
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import trimesh
from jaxtyping import Float
from PIL import Image
from trimesh.visual.color import ColorVisuals
from trimesh.visual.material import PBRMaterial
from trimesh.visual.texture import TextureVisuals

from diorama_core.errors import DioramaError, LibraryError
from diorama_core.io.bounded import shorten
from diorama_core.io.contained import quote
from diorama_core.io.text import clean_text
from diorama_core.library import part_notes
from diorama_core.library.furniture.joints import Joint, JointKind
from diorama_core.library.ingest.limits import Limits
from diorama_core.library.part_notes import PartNotes

FLAT = 1e-3
"""Share of the longest side below which a model is flat."""
THICKNESS = 0.005
"""Thickness given to a flat model, as a share of its longest side: 4 mm for a picture, 1 cm for a rug."""
KINDS: dict[str, JointKind] = {"revolute": "hinge", "prismatic": "slide", "continuous": "swivel"}
SIDES = ("depth", "width", "height")
"""Of the canonical frame's x, y and z."""
MAX_ROLE = 40
"""Characters of a role that are used."""
MAX_TURN_DEG, MAX_SLIDE_M = 360.0, 10.0


def with_thickness(meshes: Sequence[trimesh.Trimesh]) -> tuple[tuple[trimesh.Trimesh, ...], bool]:
    """The meshes, and whether they are together flat along an axis: then each is a front, a back and a rim.

    The middle plane stays where it was.
    """
    bounds = np.array([m.bounds for m in meshes])
    extents = bounds[:, 1].max(axis=0) - bounds[:, 0].min(axis=0)
    axis, longest = int(extents.argmin()), float(extents.max())
    if extents[axis] >= FLAT * longest:
        return tuple(meshes), False
    offset = np.zeros(3)
    offset[axis] = THICKNESS * longest / 2
    return tuple(_thick(mesh, offset) for mesh in meshes), True


def _thick(mesh: trimesh.Trimesh, offset: Float[np.ndarray, "3"]) -> trimesh.Trimesh:
    """A mesh as a front, a back behind it, and a rim along its border, all in its own material."""
    normals = mesh.face_normals @ offset
    faces = np.where((normals < 0)[:, None], mesh.faces[:, ::-1], mesh.faces)
    count = len(mesh.vertices)
    edges = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    _, index, counts = np.unique(np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True)
    a, b = edges[index[counts == 1]].T
    rim = np.concatenate([np.stack([a, a + count, b], axis=1), np.stack([b, a + count, b + count], axis=1)])
    vertices = np.concatenate([mesh.vertices + offset, mesh.vertices - offset])
    visual = mesh.visual
    if isinstance(visual, TextureVisuals):
        visual = TextureVisuals(uv=np.concatenate([visual.uv, visual.uv]), material=visual.material)
    elif visual.kind == "vertex":
        visual = trimesh.visual.ColorVisuals(vertex_colors=np.concatenate([visual.vertex_colors] * 2))
    everything = np.concatenate([faces, faces[:, ::-1] + count, rim])
    return trimesh.Trimesh(vertices, everything, visual=visual, process=False, metadata=dict(mesh.metadata))


_FARTHEST = 1e7
"""Coordinates beyond this (in the file's unit) are noise, not furniture."""


@dataclass(frozen=True)
class Repaired:
    """Meshes with their transforms applied, in the file's frame and unit."""

    meshes: tuple[trimesh.Trimesh, ...]
    warnings: tuple[str, ...]

    @property
    def whole(self) -> trimesh.Trimesh:
        """Geometry only, one mesh."""
        return whole_of(self.meshes)


def whole_of(meshes: Sequence[trimesh.Trimesh]) -> trimesh.Trimesh:
    """The geometry of several meshes as one."""
    counts = np.cumsum([0, *(len(m.vertices) for m in meshes)])
    faces = np.concatenate([m.faces + c for m, c in zip(meshes, counts, strict=False)])
    return trimesh.Trimesh(np.concatenate([m.vertices for m in meshes]), faces, process=False)


def repair(scene: trimesh.Scene, limits: Limits) -> Repaired:
    """Sound triangles of a scene.

    Left out, with a warning: points that are not finite and triangles on them, triangles without area, lines and point
    clouds. Kept as they are: open and non-manifold surfaces (nothing here needs closed solids), with a warning.

    Raises:
        LibraryError: when no triangle with area is left, there are too many, or the file's numbers make no sense.
    """
    try:
        return _repair(scene, limits)
    except DioramaError:
        raise
    except Exception as error:  # loaders hand on whatever malformed bytes say
        reason = f"{type(error).__name__}: {shorten(str(error), 100)}"
        raise LibraryError(f"malformed geometry ({reason}); export the model again") from error


def _repair(scene: trimesh.Scene, limits: Limits) -> Repaired:
    notes: list[str] = []
    meshes = []
    total = 0
    materials: dict[int, PBRMaterial] = {}
    for name, mesh, T, part in _parts(scene, notes):
        total += len(mesh.faces)
        if total > limits.triangles:
            raise LibraryError(f"more than {limits.triangles} triangles; simplify it first")
        vertices = trimesh.transform_points(np.asarray(mesh.vertices, dtype=float), T)
        faces = _sound_faces(vertices, np.asarray(mesh.faces), notes)
        if np.linalg.det(T[:3, :3]) < 0:
            faces = faces[:, ::-1]
        if len(faces):
            made = _compact(vertices, faces, _visual(mesh, faces, materials, limits), name)
            made.metadata |= {} if part is None else {part_notes.KEY: part.as_json()}
            meshes.append(made)
    if not meshes:
        raise LibraryError("no triangle with area is in it")
    whole = whole_of(meshes)
    if not (whole.extents > 0).any() or np.sort(whole.extents)[1] < 1e-9:
        raise LibraryError("it has no extent")
    thick, was_flat = with_thickness(meshes)
    notes += [f"it was flat and got a thickness of {THICKNESS:.1%} of its longest side"] if was_flat else []
    notes += _openness(whole)
    return Repaired(thick, tuple(dict.fromkeys(notes)))


def _parts(
    scene: trimesh.Scene, notes: list[str]
) -> Iterator[tuple[str, trimesh.Trimesh, Float[np.ndarray, "4 4"], PartNotes | None]]:
    for node in scene.graph.nodes_geometry:
        T, name = scene.graph[node]
        mesh = scene.geometry[name]
        if not isinstance(mesh, trimesh.Trimesh):
            notes.append("lines and points were left out")
        elif np.ndim(mesh.vertices) != 2 or np.shape(mesh.vertices)[1] != 3 or np.ndim(mesh.faces) != 2:
            notes.append("a part whose points are not in space was left out")
        elif not np.isfinite(T).all():
            notes.append("a part with a broken transform was left out")
        else:
            yield str(name), mesh, np.asarray(T, dtype=float), notes_of_node(scene, node, notes)


def _sound_faces(vertices: np.ndarray, faces: np.ndarray, notes: list[str]) -> np.ndarray:
    """Triangles whose corners exist, are finite and span an area."""
    inside = ((faces >= 0) & (faces < len(vertices))).all(axis=1)
    if not inside.all():
        notes.append(f"{int((~inside).sum())} triangles named points that do not exist; they were left out")
        faces = faces[inside]
    usable = np.isfinite(vertices).all(axis=1) & (np.abs(np.nan_to_num(vertices)) < _FARTHEST).all(axis=1)
    finite = usable[faces].all(axis=1)
    if not finite.all():
        notes.append(f"{int((~finite).sum())} triangles had points that are not finite; they were left out")
        faces = faces[finite]
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return faces[np.linalg.norm(np.cross(b - a, c - a), axis=1) > 0]


def _openness(mesh: trimesh.Trimesh) -> list[str]:
    """What a reader should know of edges that are not shared by exactly two triangles."""
    keys = np.round((mesh.vertices - mesh.bounds[0]) / mesh.extents.max() * 1e6).astype(np.int64)
    corner = np.unique(keys, axis=0, return_inverse=True)[1].reshape(-1)[mesh.faces]
    edges = np.sort(corner[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    counts = np.unique(edges, axis=0, return_counts=True)[1]
    return ["its surface is not closed and manifold; it is used as it is"] if (counts > 2).any() else []


def _compact(vertices: np.ndarray, faces: np.ndarray, visual: Any, name: str) -> trimesh.Trimesh:
    used, flat = np.unique(faces, return_inverse=True)
    if isinstance(visual, TextureVisuals) and visual.uv is not None:
        visual = TextureVisuals(uv=np.nan_to_num(np.asarray(visual.uv)[used]), material=visual.material)
    elif isinstance(visual, ColorVisuals) and visual.kind == "vertex":
        visual = ColorVisuals(vertex_colors=visual.vertex_colors[used])
    return trimesh.Trimesh(vertices[used], flat.reshape(-1, 3), visual=visual, process=False, metadata={"name": name})


def _visual(mesh: trimesh.Trimesh, faces: np.ndarray, materials: dict[int, PBRMaterial], limits: Limits) -> Any:
    """Colours or a physically based material, whatever the file had."""
    visual = mesh.visual
    if isinstance(visual, TextureVisuals):
        key = id(visual.material)
        if key not in materials:
            materials[key] = _material(visual.material, limits)
        uv = visual.uv if visual.uv is not None and len(visual.uv) == len(mesh.vertices) else None
        uv = uv if uv is None else np.asarray(uv) * _uv_scale(visual.material)
        return TextureVisuals(uv=uv if uv is not None else np.zeros((len(mesh.vertices), 2)), material=materials[key])
    if isinstance(visual, ColorVisuals) and visual.kind == "vertex":
        return visual
    colour = visual.main_color if isinstance(visual, ColorVisuals) and visual.kind == "face" else (190, 187, 182, 255)
    plain = PBRMaterial(baseColorFactor=np.asarray(colour, dtype=np.uint8), metallicFactor=0.0, roughnessFactor=0.8)
    return TextureVisuals(uv=np.zeros((len(mesh.vertices), 2)), material=plain)


def _material(material: Any, limits: Limits) -> PBRMaterial:
    made = material if isinstance(material, PBRMaterial) else _physical(material)
    for name in (
        "baseColorTexture",
        "normalTexture",
        "metallicRoughnessTexture",
        "occlusionTexture",
        "emissiveTexture",
    ):
        image = getattr(made, name, None)
        if image is not None:
            setattr(made, name, _small(image, limits.texture_side_px))
    return made


def _physical(material: Any) -> PBRMaterial:
    """A material of an OBJ file as a physically based one. Without `Pm` it is no metal: glTF's default is all metal."""
    made = material.to_pbr()
    made.metallicFactor = _share(material, "pm", 0.0)
    made.roughnessFactor = _share(material, "pr", made.roughnessFactor)
    return made


def _uv_scale(material: Any) -> Float[np.ndarray, "2"]:
    """How often a picture repeats, where an MTL says so (`-s`)."""
    try:
        scale = np.array(material.kwargs["uv_scale"], dtype=float).ravel()[:2]
    except (AttributeError, KeyError, TypeError, ValueError):
        return np.ones(2)
    return scale if scale.shape == (2,) and np.isfinite(scale).all() and (scale != 0).all() else np.ones(2)


def _share(material: Any, name: str, default: float) -> float:
    """A number from 0 to 1 among a material's further entries."""
    try:
        value = float(np.ravel(material.kwargs[name])[0])
    except (AttributeError, KeyError, IndexError, TypeError, ValueError):
        return default
    return min(max(value, 0.0), 1.0) if np.isfinite(value) else default


def _small(image: Image.Image, side_px: int) -> Image.Image | None:
    """A texture no larger than `side_px`, in a format that every viewer reads; None when its bytes are broken."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            alpha = "A" in image.getbands() or "transparency" in image.info
            plain = image.convert("RGBA" if alpha else "RGB")
            plain.thumbnail((side_px, side_px))
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        return None
    opaque = not alpha or plain.getchannel("A").getextrema()[0] == 255
    plain = plain.convert("RGB") if opaque else plain
    plain.format = "JPEG" if opaque else "PNG"
    return plain


def notes_of_node(scene: trimesh.Scene, node: str, warnings: list[str]) -> PartNotes | None:
    """The notes on a node of a file, its joint in the file's frame; None where nothing is said.

    Args:
        scene: as the file has it.
        node: one with a mesh.
        warnings: gets a line for each extra that cannot be read, which is then left out.
    """
    role, stretches, joint = "", None, None
    for holder, extras in _extras(scene, node):
        if not role and "role" in extras:
            role = clean_text(str(extras["role"])).strip()[:MAX_ROLE]
        if stretches is None and "parameter" in extras:
            stretches = _stretches(str(extras["parameter"]), holder, warnings)
        if joint is None and "joint" in extras:
            T_file_node = np.asarray(scene.graph[holder][0], float)
            joint = _joint(str(extras["joint"]), str(extras.get("role") or holder), T_file_node, warnings)
    notes = PartNotes(role, joint, stretches)
    return None if notes == PartNotes() else notes


def _extras(scene: trimesh.Scene, node: str) -> Iterator[tuple[str, dict[str, Any]]]:
    """The extras of a node, of its parent, and so on up to the root."""
    tree = scene.graph.transforms
    while node in tree.parents:
        parent = tree.parents[node]
        extras = tree.edge_data[parent, node].get("metadata")
        if isinstance(extras, dict):
            yield str(node), extras
        node = parent


def _stretches(words: str, node: str, warnings: list[str]) -> tuple[bool, bool, bool] | None:
    sides = words.replace(",", " ").lower().split()
    if sides != ["rigid"] and (not sides or set(sides) - set(SIDES)):
        warnings.append(
            f'node {quote(node)}: parameter {quote(words)} is left out; write "rigid", or sides such as "width height"'
        )
        return None
    return SIDES[0] in sides, SIDES[1] in sides, SIDES[2] in sides


def _joint(words: str, name: str, T_file_node: Float[np.ndarray, "4 4"], warnings: list[str]) -> Joint | None:
    """The joint that a text describes; the mirror image of a turn goes the other way."""
    try:
        kind, axis, lower, upper = _parse(words.lower())
    except ValueError:
        warnings.append(
            f'{quote(name)}: joint {quote(words)} is left out; write "revolute y 0 110" (degrees, from -360 to 360), '
            '"prismatic z 0 0.4" (metres) or "continuous y"; 0 is within the limits'
        )
        return None
    turn = T_file_node[:3, :3]
    direction = turn @ axis * (np.sign(np.linalg.det(turn)) if kind != "slide" else 1.0)
    if abs(lower) > upper:  # open is where the part is farthest from where it stands
        lower, upper, direction = -upper, -lower, -direction
    length = float(np.linalg.norm(direction))
    if not (np.isfinite(T_file_node).all() and length > 0):
        return None  # the part itself is left out, with a warning of its own
    dx, dy, dz = (float(v) for v in direction / length)
    x, y, z = (float(v) for v in T_file_node[:3, 3])
    return Joint(clean_text(name).strip()[:MAX_ROLE], kind, (x, y, z), (dx, dy, dz), lower, upper)


def _parse(words: str) -> tuple[JointKind, Float[np.ndarray, "3"], float, float]:
    """Kind, axis and limits (radians or metres); raises `ValueError` for any other text."""
    kind, axis, *limits = words.replace(",", " ").split()
    if kind not in KINDS or axis.removeprefix("-") not in ("x", "y", "z"):
        raise ValueError(words)
    direction = np.eye(3)["xyz".index(axis[-1])] * (-1.0 if axis.startswith("-") else 1.0)
    if KINDS[kind] == "swivel" and not limits:
        return KINDS[kind], direction, 0.0, 0.0
    lower, upper = (float(limit) for limit in limits)
    most = MAX_TURN_DEG if kind == "revolute" else MAX_SLIDE_M
    if not (-most <= lower <= 0.0 <= upper <= most and lower < upper) or KINDS[kind] == "swivel":
        raise ValueError(words)
    unit = np.pi / 180.0 if kind == "revolute" else 1.0
    return KINDS[kind], direction, lower * unit, upper * unit
