"""What a project keeps of several photos of one room: the photos beside its own, and where the program put objects.

`photos/NAME.zip` holds a photo with its boxes and its camera, `photos/NAME.jpg` is the picture for people, and
`project.json` lists the names that belong to the scene as it is. `stages/placed.json` holds the poses that a build gave
every object and the corners that it gave every plane: an object at another pose was moved by a person.
`stages/looks.json` holds what a build made of every object, its shape and its colours.
"""

from __future__ import annotations

import logging
from collections.abc import Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from diorama_core.artefacts import FurtherPhoto
from diorama_core.errors import ProjectError
from diorama_core.io.atomic import write_atomically, write_document, write_json
from diorama_core.io.bounded import read_bytes, read_json, shorten
from diorama_core.pipeline import codec
from diorama_core.project.storage import Project, jpeg
from diorama_core.scene.types import Plane, Pose, Scene, SceneObject

log = logging.getLogger(__name__)

MAX_PHOTOS = 64
MAX_POSES = 8
"""Remembered poses of one object: after an undo, those of earlier builds are the program's, too."""
MAX_NOTED_BYTES = 32_000_000
SAME_M, DIGITS = 1e-4, 6
"""How close a pose is the same, and the decimals that are noted."""
PLANE = "plane "
"""Before the ids of planes among those of objects, which have no blanks."""


def save_photos(project: Project, photos: Sequence[FurtherPhoto], saved: Sequence[FurtherPhoto] = ()) -> None:
    """Keep the further photos of a project; those that were saved as they are now are not written again.

    Raises:
        ProjectError: the folder cannot be written.
    """
    for photo in photos:
        if any(photo is one for one in saved):
            continue
        folder = project.folder / "photos"
        path = folder / f"{photo.name}.zip"
        write_document(path, codec.dump(photo), partial(_photo_of, name=path.stem), ProjectError, most=codec.MAX_BYTES)
        picture = folder / f"{photo.name}.jpg"
        if not picture.exists():
            write_atomically(picture, jpeg(photo.inputs.photo.rgb), error=ProjectError)
    project.update_info(photos=[p.name for p in photos])


def load_photos(project: Project) -> tuple[tuple[FurtherPhoto, ...], tuple[str, ...]]:
    """The further photos, and a line for each that cannot be read."""
    names = project.info().get("photos", [])
    photos: list[FurtherPhoto] = []
    damage: list[str] = []
    for name in names[:MAX_PHOTOS] if isinstance(names, list) else []:
        path = project.folder / "photos" / f"{Path(str(name)).name}.zip"
        try:
            photos.append(_photo_of(read_bytes(path, codec.MAX_BYTES, ProjectError), path.stem))
        except ProjectError as error:
            damage.append(f"{path}: this photo cannot be read back ({error}); add it again")
    return tuple(photos), tuple(damage)


def _photo_of(data: bytes, name: str) -> FurtherPhoto:
    photo: FurtherPhoto = codec.load(data, FurtherPhoto)
    if photo.name != name:  # which names the files that are written
        raise ProjectError(f"it is the photo {shorten(photo.name)!r}")
    return photo


def note_placed(project: Project, scene: Scene) -> None:
    """Remember where the program put the objects and planes of a scene, and what it made of the objects.

    Raises:
        ProjectError: the folder cannot be written.
    """
    known = _notes(project, "placed.json")
    now = {o.id: _with(_row(o.pose), known.get(o.id, [])) for o in scene.objects}
    now |= {PLANE + p.id: _with(_corners(p), known.get(PLANE + p.id, [])) for p in scene.architecture.planes}
    write_json(project.stages_folder / "placed.json", {**known, **now}, ProjectError, most=MAX_NOTED_BYTES)
    looks = _notes(project, "looks.json")
    made = {o.id: _with(_look(o), looks.get(o.id, [])) for o in scene.objects}
    write_json(project.stages_folder / "looks.json", {**looks, **made}, ProjectError, most=MAX_NOTED_BYTES)


def still_placed(project: Project, scene: Scene) -> frozenset[str]:
    """Ids of the objects and planes that are where the program put them, not locked; none where none were noted."""
    known = _notes(project, "placed.json")
    objects = [o.id for o in scene.objects if not o.locked and _is_at(_row(o.pose), known.get(o.id, ()))]
    planes = [p.id for p in scene.architecture.planes if _is_at(_corners(p), known.get(PLANE + p.id, ()))]
    return frozenset((*objects, *planes))


def still_made(project: Project, scene: Scene) -> frozenset[str]:
    """Ids of the objects that have the shape and the colours that the program gave them, and are not locked."""
    known = _notes(project, "looks.json")
    return frozenset(o.id for o in scene.objects if not o.locked and _look(o) in known.get(o.id, ()))


def _notes(project: Project, name: str) -> dict[str, list[list[Any]]]:
    """What was noted, by id; nothing where the file is damaged: then everything is as a person left it, and stays."""
    path = project.stages_folder / name
    if not path.exists():
        return {}
    try:
        document = read_json(path, ProjectError, most=MAX_NOTED_BYTES)
    except ProjectError as error:
        log.warning("%s; nothing is moved that was built before", error)
        return {}
    noted = document.items() if isinstance(document, dict) else ()
    return {id: [row for row in rows if isinstance(row, list)] for id, rows in noted if isinstance(rows, list)}


def _look(item: SceneObject) -> list[str]:
    """What a person may have chosen of an object, as text."""
    materials = [f"{m.slot}={m.texture or _colour(m.colour)}" for m in item.photo_materials]
    look = (item.label, item.category, item.shape_id, _colour(item.colour), str(item.finish), item.material_source)
    return [*look, *materials]


def _colour(colour: tuple[float, float, float] | None) -> str:
    return "none" if colour is None else " ".join(f"{c:.2f}" for c in colour)


def _corners(plane: Plane) -> list[float]:
    return [round(float(v), DIGITS) for v in plane.polygon.ravel()]


def _row(pose: Pose) -> list[float]:
    values = np.concatenate([pose.position, pose.R_world_object.ravel(), np.broadcast_to(pose.scale, 3)])
    return [round(float(v), DIGITS) for v in values]


def _with(row: list[Any], rows: list[list[Any]]) -> list[list[Any]]:
    """The newest first, each once."""
    return [row, *(r for r in rows if r != row)][:MAX_POSES]


def _is_at(row_now: list[float], rows: Iterable[list[Any]]) -> bool:
    return any(len(row) == len(row_now) and all(map(_is_near, row, row_now)) for row in rows)


def _is_near(noted: object, now: float) -> bool:
    return isinstance(noted, float | int) and now - SAME_M < noted < now + SAME_M
