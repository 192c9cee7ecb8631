"""One file becomes one shape: read, repaired, put upright, measured and packed."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import trimesh
from jaxtyping import Float
from trimesh.visual.texture import TextureVisuals

from diorama_core.errors import LibraryError
from diorama_core.library import part_notes, taxonomy
from diorama_core.library.catalogue import BULK_DENSITY
from diorama_core.library.ingest.frames import Convention, squaring_turn
from diorama_core.library.ingest.given import Given
from diorama_core.library.ingest.guess import PROMISED_UP, Frame, frame_evidence, guess_frame
from diorama_core.library.ingest.joint import Evidence
from diorama_core.library.ingest.known_shapes import KnownShapes
from diorama_core.library.ingest.limits import DEFAULT_LIMITS, Limits
from diorama_core.library.ingest.models import RawModel, read_model
from diorama_core.library.ingest.names import NameEvidence, name_evidence, words_of
from diorama_core.library.ingest.relief import relief, symmetry_fold, turn
from diorama_core.library.ingest.repair import Repaired, repair, whole_of
from diorama_core.library.ingest.sink import Ingested
from diorama_core.library.part_notes import PartNotes, notes_of, transform
from diorama_core.library.record import Guess, Shape, ShapeLibrary, SymmetryFold, usual_contact_faces
from diorama_core.library.surfaces import support_surfaces
from diorama_core.library.taxonomy import carries_things

Painter = Callable[[ShapeLibrary, str], bytes]
"""Makes the PNG thumbnail of one shape of a library; rendering lives above the library."""
TINY_M, HUGE_M = 1e-3, 50.0
"""Shapes smaller or larger than this along their longest side are refused: no unit makes furniture of them."""


@dataclass(frozen=True)
class ModelSource:
    """One model to take in."""

    path: Path
    root: Path
    """Nothing outside is read."""
    id: str
    key: str
    """State of the file and settings (`Ingested.source_key`)."""
    given: Given = field(default_factory=Given)
    member: str = ""
    """The file within, where the path is a zip archive."""
    convention: Convention | None = None
    """What the whole pack says of its frame and unit; None leaves it to the format."""

    @property
    def stem(self) -> str:
        """The model's own name; an archive with one model lends it its name where it has none itself."""
        return Path(self.member).stem if self.member else self.path.stem


@dataclass(frozen=True, eq=False)
class LoneShape:
    """A library of one shape. Implements `ShapeLibrary`."""

    record: Shape
    scene: trimesh.Scene
    geometry: trimesh.Trimesh
    packed: bytes

    def shapes(self) -> tuple[Shape, ...]:
        """The one record."""
        return (self.record,)

    def shape(self, shape_id: str) -> Shape:
        """The record; raises `LibraryError` for any other id."""
        if shape_id != self.record.id:
            raise LibraryError(f"no shape is called '{shape_id}'; there is only '{self.record.id}'")
        return self.record

    def in_category(self, category: str) -> tuple[Shape, ...]:
        """The record when it is of the category."""
        return self.shapes() if category == self.record.category else ()

    def mesh(self, shape_id: str) -> trimesh.Trimesh:
        """Geometry only."""
        self.shape(shape_id)
        return self.geometry

    def parts(self, shape_id: str) -> trimesh.Scene:
        """Geometry with materials."""
        self.shape(shape_id)
        return self.scene

    def glb(self, shape_id: str) -> bytes:
        """The packed model."""
        self.shape(shape_id)
        return self.packed


def ingest_file(
    source: ModelSource, known: KnownShapes, painter: Painter | None = None, limits: Limits = DEFAULT_LIMITS
) -> Ingested:
    """Take in one file.

    Args:
        source: The file, its id, and what is known of it.
        known: Shapes to compare it with.
        painter: Makes the thumbnail; None makes none.
        limits: What is refused.

    Raises:
        DioramaError: with the reason, when the file cannot be used.
    """
    raw = read_model(source.path, source.root, limits, source.member)
    return ingest_model(raw, source, known, painter, limits)


def evidence_of(
    source: ModelSource, known: KnownShapes, limits: Limits = DEFAULT_LIMITS
) -> tuple[Evidence, Convention, float]:
    """What a file says of its pack's frame and unit, what its format promises, and how long its longest side is.

    Raises:
        DioramaError: with the reason, when the file cannot be used.
    """
    raw = read_model(source.path, source.root, limits, source.member)
    whole = repair(raw.scene, limits).whole
    evidence = frame_evidence(whole, relief(whole), _names(raw, source), known, source.given)
    return evidence, raw.convention, float(whole.extents.max())


def ingest_model(
    raw: RawModel,
    source: ModelSource,
    known: KnownShapes,
    painter: Painter | None = None,
    limits: Limits = DEFAULT_LIMITS,
    *,
    square: bool = True,
) -> Ingested:
    """Take in a model that was read already; see `ingest_file`.

    Args:
        raw: The model.
        source: Its file, its id, and what is known of it.
        known: Shapes to compare it with.
        painter: Makes the thumbnail; None makes none.
        limits: What is refused.
        square: Whether a model that stands turned in its file is squared; not where its own axes are known.
    """
    model, given, remarks = repair(raw.scene, limits), source.given, raw.warnings
    convention = source.convention or raw.convention
    if raw.own is not None and given.up is None and given.front is None:
        model = _turn(model, raw.own.R_file_object.T)
        facts = Given(
            up="+z", front="+x", unit_m=1.0, category=raw.own.category, reason="the file, which Diorama wrote"
        )
        given = given.override(facts)
    elif square:
        model, note = _square(model, convention, given)
        remarks = (*remarks, *note)
    whole = model.whole
    pictures = relief(whole)
    frame = guess_frame(whole, pictures, convention, _names(raw, source), known, given)
    size = frame.unit_m * whole.extents.max()
    if not TINY_M <= size <= HUGE_M:
        raise LibraryError(f"it would be {size:.3g} m large; give its unit with --unit")
    meshes = _canonical(model, frame)
    fold = symmetry_fold(whole_of(meshes), turn(pictures, frame.R_shape_file))
    record = _record(source, given, frame, fold)
    return pack_shape(record, meshes, painter, source.key, (*remarks, *model.warnings))


def _names(raw: RawModel, source: ModelSource) -> NameEvidence:
    return name_evidence(source.stem, _folders(source), raw.names)


def _square(model: Repaired, convention: Convention, given: Given) -> tuple[Repaired, tuple[str, ...]]:
    """A model that stands turned about what may be its vertical, squared; and a line that says so."""
    up = given.up or (PROMISED_UP if convention.promises else None)
    R, angle = squaring_turn(model.whole, (0, 1, 2) if up is None else ("xyz".index(up[1]),))
    if angle == 0.0:
        return model, ()
    return _turn(model, R), (f"it stood turned by {abs(np.degrees(angle)):.0f} degrees in its file",)


def _turn(model: Repaired, R: Float[np.ndarray, "3 3"]) -> Repaired:
    T = np.eye(4)
    T[:3, :3] = R
    return Repaired(tuple(transform(m, T) for m in model.meshes), model.warnings)


def pack_shape(
    record: Shape, meshes: Sequence[trimesh.Trimesh], painter: Painter | None, key: str, warnings: tuple[str, ...]
) -> Ingested:
    """Measure and pack meshes in the canonical frame; what follows from them replaces what the record says.

    Args:
        record: what is known of the shape.
        meshes: in the object frame (m).
        painter: makes its preview; None leaves it out.
        key: of the file that it came from.
        warnings: of reading it.
    """
    scene = trimesh.Scene()
    for number, mesh in enumerate(meshes):
        name = f"{number:03d} {mesh.metadata.get('name', '')}"[:60].strip()
        scene.add_geometry(mesh, node_name=name, geom_name=name)
    glb = scene.export(file_type="glb", include_normals=True)
    if not isinstance(glb, bytes):
        raise LibraryError("the shape could not be written as GLB")
    whole = whole_of(meshes)
    x, y, z = (float(round(e, 6)) for e in whole.extents)
    record = replace(
        record,
        size_m=(x, y, z),
        mass_kg=round(max(BULK_DENSITY.get(record.category, 100.0) * x * y * z, 0.01), 2),
        content_hash=hashlib.sha256(glb).hexdigest()[:24],
        triangles=len(whole.faces),
        surfaces=support_surfaces(whole, carries=carries_things(record.category)),
    )
    picture = None if painter is None else painter(LoneShape(record, scene, whole, glb), record.id)
    return Ingested(record, glb, picture, key, warnings)


def _folders(source: ModelSource) -> list[str]:
    """Folders between the model and the root, the innermost first."""
    try:
        return list(reversed(source.path.parent.relative_to(source.root).parts))
    except ValueError:
        return []


def _canonical(model: Repaired, frame: Frame) -> list[trimesh.Trimesh]:
    """The meshes turned, scaled and centred; one for each material of each part with notes of its own."""
    T = np.eye(4)
    T[:3, :3] = frame.R_shape_file.astype(float) * frame.unit_m
    points = np.concatenate([m.vertices for m in model.meshes]) @ T[:3, :3].T
    T[:3, 3] = -(points.min(axis=0) + points.max(axis=0)) / 2
    groups: dict[tuple[int, PartNotes | None], list[trimesh.Trimesh]] = {}
    for mesh in model.meshes:
        textured = isinstance(mesh.visual, TextureVisuals)
        key = id(mesh.visual.material) if textured else -1 - len(groups)
        groups.setdefault((key, notes_of(mesh)), []).append(mesh)
    return [_join(group, T) for group in groups.values()]


def _join(group: Sequence[trimesh.Trimesh], T: Float[np.ndarray, "4 4"]) -> trimesh.Trimesh:
    whole = whole_of(group)
    notes, visual = notes_of(group[0]), group[0].visual
    noted = {} if notes is None else {part_notes.KEY: notes.transform(T).as_json()}
    if isinstance(visual, TextureVisuals):
        visual = TextureVisuals(uv=np.concatenate([m.visual.uv for m in group]), material=visual.material)
    return trimesh.Trimesh(
        whole.vertices @ T[:3, :3].T + T[:3, 3],
        whole.faces,
        visual=visual,
        process=False,
        metadata={"name": group[0].metadata.get("name", "")} | noted,
    )


def _record(source: ModelSource, given: Given, frame: Frame, fold: SymmetryFold) -> Shape:
    words = " ".join(words_of(source.stem))
    return Shape(
        id=source.id,
        category=frame.category,
        caption=given.caption or words or frame.category,
        size_m=(0.0, 0.0, 0.0),
        source=given.source or source.path.name,
        licence=given.licence or "unknown",
        symmetry=fold,
        synonyms=given.synonyms,
        contact_faces=usual_contact_faces(taxonomy.category(frame.category).mount),
        guess=frame.guess,
    )


def confidence(guess: Guess) -> float:
    """How sure the least sure of the assumptions that matter to placement is."""
    return min(guess.up.confidence, guess.unit.confidence, guess.category.confidence)
