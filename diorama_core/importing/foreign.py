"""Files of other programs as scenes: their parts become objects of guessed kinds, on a floor.

What is named floor, wall or ceiling and is flat becomes the room; everything else becomes objects, each taken into a
library as a shape of its own (copies share one). Where no floor is named, there is one under the lowest object.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from diorama_core.errors import InputError, LibraryError
from diorama_core.importing.marked import MarkedFile
from diorama_core.importing.opening import Names, Opened
from diorama_core.importing.parts import Part, shape_parts
from diorama_core.importing.room import room_of, supports_of
from diorama_core.importing.storeys import rooms_of_floors
from diorama_core.library.ingest.frames import UNKNOWN
from diorama_core.library.ingest.given import Given, axis_vector
from diorama_core.library.ingest.known_shapes import KnownShapes, load_known_shapes
from diorama_core.library.ingest.models import RawModel
from diorama_core.library.ingest.names import words_of
from diorama_core.library.ingest.shaping import ModelSource, ingest_model
from diorama_core.library.ingest.sink import Ingested, ShapeSink
from diorama_core.library.record import Shape
from diorama_core.progress import Progress
from diorama_core.scene.types import Architecture, Pose, Scene, SceneObject

SAME_M = 1e-4
"""Parts whose vertices differ less than this after a turn about up are copies of one shape."""


@dataclass(frozen=True, eq=False)
class _Shaped:
    """A part with the shape it became."""

    part: Part
    record: Shape
    pose: Pose


def scene_of_parts(
    parts: Sequence[Part], path: Path, sink: ShapeSink, progress: Progress, known: KnownShapes | None = None
) -> Opened:
    """A scene from the parts of a file of another program.

    Args:
        parts: Of the file, in the world.
        path: The file, for names.
        sink: Takes the shapes in.
        progress: Where parts are counted and cancelling is noticed.
        known: Shapes to compare with; the built-in ones by default.

    Raises:
        InputError: the file has nothing in it.
        LibraryError: a shape cannot be kept.
    """
    if not parts:
        raise InputError(f"{path.name} has no geometry in it; export the scene again")
    room = room_of(parts)
    known = known or _learn(progress)
    shaped: list[_Shaped] = []
    notes = list(room.notes)
    for number, part in enumerate(room.objects):
        progress.report(0.5 + 0.5 * number / max(1, len(room.objects)), f"taking in {part.name}")
        try:
            shaped.append(_find_copy(part, shaped) or _add(part, path, sink, known))
        except LibraryError as error:
            notes.append(f"{part.name} was left out: {error}")
    objects = _objects(shaped)
    scene = Scene(architecture=Architecture(room.planes), objects=objects)
    rooms = rooms_of_floors([p for p in room.planes if p.id in room.names], room.names)
    scene = Scene(None, scene.architecture, objects, supports_of(scene), rooms=rooms)
    return Opened(scene, changes=tuple(notes))


def take_missing_shapes(
    path: Path,
    marked: MarkedFile,
    scene: Scene,
    missing: set[str],
    sink: ShapeSink,
    progress: Progress,
    known: KnownShapes | None = None,
) -> None:
    """Take shapes that no library has out of a file that Diorama wrote, under their own ids.

    Args:
        path: the file.
        marked: the marks that Diorama left in it.
        scene: that it holds.
        missing: ids of the shapes.
        sink: receives them.
        progress: reports and cancellation.
        known: how the built-in shapes look; learnt where None.

    Raises:
        InputError: the file does not hold the geometry of one of them.
        LibraryError: a shape cannot be kept.
    """
    known = known or _learn(progress)
    for number, shape_id in enumerate(sorted(missing)):
        progress.report(0.5 + 0.5 * number / len(missing), f"taking in {shape_id}")
        item = next(o for o in scene.objects if o.shape_id == shape_id)
        part = shape_parts(path, marked, item)
        if part is None:
            raise InputError(
                f"{path.name} does not hold the shape {shape_id!r}; name the library that has it: --library"
            )
        given = Given(up="+z", front="+x", unit_m=1.0, category=item.category, source=path.name, reason="the file")
        sink.add(_ingest(part, shape_id, path, given, known))


def _learn(progress: Progress) -> KnownShapes:
    message = "learning what furniture looks like (once)"
    return load_known_shapes(on_step=lambda share: progress.report(0.5 * share, message))


def _add(part: Part, path: Path, sink: ShapeSink, known: KnownShapes) -> _Shaped:
    stem = re.sub(r"[^a-z0-9]+", "-", f"{path.stem}-{part.name}".lower()).strip("-")[:80] or "shape"
    digest = hashlib.sha256(np.round(part.whole.vertices, 5).tobytes()).hexdigest()[:6]
    given = Given(up="+z", front=part.front, unit_m=1.0, category=part.category, source=path.name, reason="the file")
    item = _ingest(part, f"{stem}-{digest}", path, given, known)
    sink.add(item)
    return _Shaped(part, item.record, _pose(part, item.record))


def _ingest(part: Part, shape_id: str, path: Path, given: Given, known: KnownShapes) -> Ingested:
    raw = RawModel(part.local_scene, (part.name,), UNKNOWN, ())
    source = ModelSource(Path(f"{part.name.replace('/', ' ')}.glb"), Path(), shape_id, f"{path.name} {shape_id}", given)
    return ingest_model(raw, source, known, square=False)


def _pose(part: Part, record: Shape) -> Pose:
    """Where a shape stands: its front and up are axes of the part, its middle is the part's."""
    assert record.guess is not None
    front, up = axis_vector(record.guess.front.value), axis_vector(record.guess.up.value)
    R = np.stack([front, np.cross(up, front), up], axis=1).astype(float)
    points = part.whole.vertices @ part.turn
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    return Pose(part.turn @ R, part.turn @ middle, np.ones(3))


def _find_copy(part: Part, shaped: Sequence[_Shaped]) -> _Shaped | None:
    """An earlier part of which this one is a copy, turned about up."""
    for other in shaped:
        if part.key is None or other.part.key != part.key:
            continue
        T = part.M_world @ np.linalg.inv(other.part.M_world)
        rigid = np.abs(T[:3, :3] @ T[:3, :3].T - np.eye(3)).max() < SAME_M and np.linalg.det(T[:3, :3]) > 0
        if rigid and abs(T[2, 2] - 1) < SAME_M:
            U, _, V = np.linalg.svd(T[:3, :3] @ other.pose.R_world_object)
            centre = T[:3, :3] @ other.pose.position + T[:3, 3]
            return _Shaped(part, other.record, Pose(U @ V, centre, np.ones(3)))
    return None


def _label(name: str) -> str:
    """The last part of a path of names that says something."""
    parts = [part for part in name.split("/") if part]
    return next((part for part in reversed(parts) if words_of(part)), parts[-1] if parts else "")


def _objects(shaped: Sequence[_Shaped]) -> tuple[SceneObject, ...]:
    names, made = Names(), []
    for one in shaped:
        label = _label(one.part.name) or one.record.category
        shape = one.record
        made.append(SceneObject(names.new(shape.category), label, shape.category, shape.id, shape.size_m, one.pose))
    return tuple(made)
