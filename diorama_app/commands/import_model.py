"""Uploaded model files: checked, oriented, sized, added to the user's library and placed."""

from __future__ import annotations

import hashlib
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from diorama_app.commands.insert import start_placing
from diorama_app.commands.swap import candidate_for, swap_shape
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_app.strings import N_, _
from diorama_core.errors import EditRefused, InputError
from diorama_core.library.user_library import UserLibrary
from diorama_core.progress import Progress
from diorama_core.scene.types import Scene

if TYPE_CHECKING:
    from diorama_core.library.ingest.shaping import ModelSource


def import_model(client: Client, name: str, content: bytes) -> None:
    """Add a model file to the user's library; the next click in the view places it."""
    session = client.session
    user_library = session.library
    if not isinstance(user_library, UserLibrary):
        raise EditRefused("models cannot be added to this library")
    file_name = Path(name).name or "model.glb"

    def work(progress: Progress) -> None:
        shape_id = _take_in(user_library, file_name, content, progress)

        def show() -> None:
            client.toast(_("{file} is in the library.").format(file=file_name), False)
            start_placing(client, shape_id)

        client.post(show)

    session.jobs.start("import", _("Reading {file}…").format(file=file_name), work)


def _take_in(user_library: UserLibrary, name: str, content: bytes, progress: Progress) -> str:
    from diorama_core.library.ingest.adding import add_models
    from diorama_core.library.ingest.finding import model_files, slug, sources
    from diorama_core.library.ingest.given import Given
    from diorama_core.workers import workers

    with tempfile.TemporaryDirectory(prefix="upload-") as folder:
        (Path(folder) / name).write_bytes(content)
        paths, skipped = model_files(Path(folder))
        if not paths:
            reason = skipped[0].reason if skipped else N_("not a readable 3D model; upload a GLB, OBJ, PLY or STL")
            raise InputError(f"{name}: {_(reason)}")
        # By its content: another file of the same name must not take the place of one that scenes hold.
        content_id = f"{slug(Path(name).stem)}-{hashlib.sha256(content).hexdigest()[:8]}"
        models = sources(Path(folder), paths, Given(), {}, {paths[0]: content_id})
        have = {shape.id for shape in user_library.own().shapes()}
        new = [source for source in models if source.id not in have]
        report = add_models(new, user_library.own(), workers(None, 1), progress=progress)
        if report.failed:
            raise InputError(f"{name}: {_(report.failed[0].reason)}")
        _note_names(user_library, models, Path(name).stem)
        return models[0].id


def _note_names(user_library: UserLibrary, found: Sequence[ModelSource], stem: str) -> None:
    """Each model has its file's name until its owner gives another; one added again is deleted no more."""
    models = user_library.own_models
    for source in found:
        models = models.restore(source.id)
        if source.id not in models.names:
            models = models.rename(source.id, Path(source.member).stem or stem)
    user_library.keep_order(models)


@dataclass(frozen=True)
class Fix:
    """One kind of wrong guess about a model, and the change that corrects it."""

    name: str
    hint: str
    up: str = "+z"
    """Current axis of the shape that becomes up."""
    front: str | None = None
    """Current axis of the shape that becomes the front."""
    scale: float = 1.0


FIXES: dict[str, Fix] = {
    "left": Fix(N_("Front is left"), N_("Make the left side the front"), front="+y"),
    "back": Fix(N_("Front is back"), N_("Make the back the front"), front="-x"),
    "tip": Fix(N_("Rotate forward 90°"), N_("Turn the back to the top"), up="-x", front="+z"),
    "roll": Fix(N_("Rotate sideways 90°"), N_("Turn the left side to the top"), up="+y", front="+x"),
    "flip": Fix(N_("Upside down"), N_("Turn the bottom to the top"), up="-z", front="+x"),
    "metres": Fix("× 100", N_("The file is in metres, not centimetres"), scale=100.0),
    "centimetres": Fix("÷ 100", N_("The file is in centimetres, not metres"), scale=0.01),
    "inches": Fix("× 2.54", N_("The file is in inches, not centimetres"), scale=2.54),
}
"""The corrections that a person can choose from."""


def is_own_model(session: EditorSession, shape_id: str) -> bool:
    """Whether a shape was uploaded, so that it can be corrected."""
    user_library = session.library
    return isinstance(user_library, UserLibrary) and user_library.has_own(shape_id)


def correct_model(client: Client, object_id: str, fix: Fix | None = None, *, category: str | None = None) -> None:
    """Correct an uploaded model and swap the object to it, at the corrected size.

    The corrected model gets an id of its own: undo leads back to the one before.

    Args:
        client: the browser that asked.
        object_id: of the object.
        fix: turn or scale of the model; None leaves them.
        category: what it is; None leaves it.

    Raises:
        EditRefused: when the shape is not one of one's own.
        InputError: when the category is unknown.
    """
    from diorama_core.library.ingest.correct import correct

    session = client.session
    item, user_library = session.scene.object(object_id), session.library
    if not isinstance(user_library, UserLibrary) or not user_library.has_own(item.shape_id):
        raise EditRefused("only models that you uploaded can be corrected; upload one in the Library tab")
    store, change = user_library.own(), fix or Fix("", "")
    ingested = correct(store, item.shape_id, up=change.up, front=change.front, scale=change.scale, category=category)
    stem = item.shape_id.partition("~")[0]
    record = replace(
        ingested.record, id=f"{stem}~{ingested.record.content_hash[:6]}-{ingested.record.category.replace(' ', '-')}"
    )
    store.add(replace(ingested, record=record))
    what = _(change.name).lower() if fix is not None else _(record.category)

    def take(scene: Scene) -> Scene:
        return swap_shape(scene, item, candidate_for(session.library, item, record.id, "catalogue"), keep_colour=True)

    try:
        session.edit(_("correct the model ({what})").format(what=what), take, by=client)
    except EditRefused:
        store.remove([record.id])
        raise
    user_library.keep_order(user_library.own_models.supersede(item.shape_id, record.id))
