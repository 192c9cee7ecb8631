"""What a project keeps of several photos of one room: the photos beside its own, and where the program put objects.

`photos/NAME.zip` holds a photo with its boxes and its camera, `photos/NAME.jpg` is the picture for people, and
`project.json` lists the names that belong to the scene as it is. `stages/placed.json` holds the poses that a build gave
every object: an object at another pose was moved by a person.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from diorama_core.artefacts import FurtherPhoto
from diorama_core.errors import ProjectError
from diorama_core.io.atomic import write_atomically
from diorama_core.io.bounded import read_bytes, read_json
from diorama_core.pipeline import codec
from diorama_core.project.storage import Project, jpeg
from diorama_core.scene.types import Pose, Scene

MAX_PHOTOS = 64
MAX_POSES = 8
"""Of one object: after an undo, those of earlier builds are the program's, too."""
SAME_M = 1e-4


def save_photos(project: Project, photos: Sequence[FurtherPhoto], saved: Sequence[FurtherPhoto] = ()) -> None:
    """Keep the further photos of a project; those that were saved as they are now are not written again.

    Raises:
        ProjectError: the folder cannot be written.
    """
    for photo in photos:
        if any(photo is one for one in saved):
            continue
        folder = project.folder / "photos"
        write_atomically(folder / f"{photo.name}.zip", codec.dump(photo), error=ProjectError)
        picture = folder / f"{photo.name}.jpg"
        if not picture.exists():
            write_atomically(picture, jpeg(photo.inputs.photo.rgb), error=ProjectError)
    project.update_info(photos=[p.name for p in photos])


def load_photos(project: Project) -> tuple[tuple[FurtherPhoto, ...], tuple[str, ...]]:
    """The further photos, and a line for each that cannot be read."""
    names = project.info().get("photos", [])
    found: list[FurtherPhoto] = []
    damage: list[str] = []
    for name in names[:MAX_PHOTOS] if isinstance(names, list) else []:
        path = project.folder / "photos" / f"{Path(str(name)).name}.zip"
        try:
            found.append(codec.load(read_bytes(path, codec.MAX_BYTES, ProjectError), FurtherPhoto))
        except ProjectError as error:
            damage.append(f"{path}: this photo cannot be read back ({error}); add it again")
    return tuple(found), tuple(damage)


def note_placed(project: Project, scene: Scene) -> None:
    """Remember where the program put the objects of a scene.

    Raises:
        ProjectError: the folder cannot be written.
    """
    known = _placed(project)
    now = {o.id: _with(_row(o.pose), known.get(o.id, [])) for o in scene.objects}
    path = project.stages_folder / "placed.json"
    write_atomically(path, json.dumps({**known, **now}).encode(), error=ProjectError)


def still_placed(project: Project, scene: Scene) -> frozenset[str]:
    """Ids of the objects that are where the program put them, and not locked; none where that was not noted."""
    known = _placed(project)
    return frozenset(o.id for o in scene.objects if not o.locked and _is_at(o.pose, known.get(o.id, ())))


def _placed(project: Project) -> dict[str, list[list[float]]]:
    path = project.stages_folder / "placed.json"
    if not path.exists():
        return {}
    document = read_json(path, ProjectError, most=32_000_000, advice="build the scene again")
    return document if isinstance(document, dict) else {}


def _row(pose: Pose) -> list[float]:
    values = np.concatenate([pose.position, pose.R_world_object.ravel(), np.broadcast_to(pose.scale, 3)])
    return [round(float(v), 6) for v in values]


def _with(row: list[float], rows: list[list[float]]) -> list[list[float]]:
    """The newest first, each once."""
    return [row, *(r for r in rows if r != row)][:MAX_POSES]


def _is_at(pose: Pose, rows: Iterable[object]) -> bool:
    own = np.array(_row(pose))
    for row in rows:
        there = np.array(row, dtype=float) if isinstance(row, list) else np.zeros(0)
        if there.shape == own.shape and np.abs(there - own).max() < SAME_M:
            return True
    return False
