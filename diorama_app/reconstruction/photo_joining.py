"""Another photo of the same room: it is marked, its camera is found, and what it shows comes into the scene.

The photo is part of the document from the moment it is uploaded: its boxes, its camera and the objects that it brought
are undone and saved like everything else. A photo that does not join changes nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_core.artefacts import FurtherPhoto, Inputs
from diorama_core.errors import EditRefused, InputError
from diorama_core.progress import Progress
from diorama_core.project.further_photos import MAX_PHOTOS, note_placed, still_made, still_placed
from diorama_core.project.storage import Project
from diorama_core.scene.types import Scene

if TYPE_CHECKING:
    from diorama_core.importing.opening import Opened
    from diorama_core.multiview.adding import AddedPhoto  # the whole pipeline; opening a project does without it

MIN_SAME = 3
"""Objects of a scene without a photo among which one finds its place (`multiview.camera_in_room`)."""


def take_photo(client: Client, file_name: str, inputs: Inputs) -> None:
    """Put another photo of the room beside the scene, to be marked; the scene stays as it is.

    Raises:
        EditRefused: the scene has no photo to join, or as many photos as it can have.
    """
    session = client.session
    if awaits_photo(session.scene):
        label = _("add the photo {name}").format(name=inputs.photo.name)
        session.commit(label, session.scene, inputs=inputs, by=client)
        _to_be_marked(client, None)
        return
    need_joinable(session.scene, session.inputs)
    photos = session.further_photos
    if len(photos) >= MAX_PHOTOS:
        message = _("a room can have at most {count} more photos; remove one first").format(count=MAX_PHOTOS)
        raise EditRefused(message)
    name = fresh_name(file_name, [p.name for p in photos])
    further = (*photos, FurtherPhoto(name, inputs))
    session.commit(_("add the photo {name}").format(name=name), session.scene, further=further, by=client)
    _to_be_marked(client, name)


def _to_be_marked(client: Client, name: str | None) -> None:
    client.choose_photo(name)
    client.open_tab("Photo")
    client.open_board()
    client.refresh()


def awaits_photo(scene: Scene) -> bool:
    """Whether a scene without a photo has enough in it to tell where one was taken, as scans have."""
    return scene.camera is None and len(scene.objects) >= MIN_SAME and bool(scene.architecture.planes)


def missing_for_joining(scene: Scene) -> str:
    """What must be installed before another photo can join the scene; empty where nothing is missing."""
    if awaits_photo(scene) or find_spec("pycolmap") is not None:
        return ""
    return _(
        "Adding a photo needs pycolmap, which is not installed. Run pip install 'diorama[photos]' and restart Diorama."
    )


def need_joinable(scene: Scene, inputs: Inputs | None) -> Inputs:
    """The inputs of the photo that others join; raises `EditRefused` where there is none, or no scene of it."""
    if inputs is None or scene.camera is None:
        raise EditRefused("build a scene from a first photo; then add others of the same room")
    return inputs


def fresh_name(file_name: str, taken: Sequence[str]) -> str:
    """A name of its own for a photo, from its file's."""
    stem = "".join(c if c.isalnum() or c in "-_" else "-" for c in Path(file_name).stem).strip("-")[:40] or "photo"
    return next(n for k in range(1, len(taken) + 3) for n in (stem if k == 1 else f"{stem}-{k}",) if n not in taken)


def take_out(client: Client, name: str) -> None:
    """Take a further photo away; the objects that it brought stay."""
    photos = client.session.further_photos
    further = tuple(p for p in photos if p.name != name)
    label = _("remove the photo {name}").format(name=name)
    client.session.commit(label, client.session.scene, further=further, by=client)
    client.choose_photo(None)
    client.refresh()


def join_photo(client: Client) -> None:
    """Find the camera of the chosen photo, and bring what it shows into the scene, as one undo step."""
    session, photo = client.session, client.further_photo
    if photo is None and session.inputs is not None and awaits_photo(session.scene):
        _join_first(client, session.inputs)
        return
    if photo is None:
        raise InputError("choose a photo that was added first")
    session.need_writable()
    inputs = need_joinable(session.scene, session.inputs)
    project, scene, photos = session.need_project(), session.scene, session.further_photos
    client.view.canvas.close()

    def work(progress: Progress) -> None:
        session.autosave.flush()
        added = _join(scene, inputs, photos, photo, project, client, progress)
        note_placed(project, added.scene)
        client.post(lambda: _show(client, project, scene, photo, added))

    session.jobs.start("join", _("Adding {name} to the scene").format(name=photo.name), work)


def _join_first(client: Client, inputs: Inputs) -> None:
    """Find where the first photo of a scanned room was taken, and bring what it shows into the scene."""
    session = client.session
    project, scene, library = session.need_project(), session.scene, session.offer
    client.view.canvas.close()

    def work(progress: Progress) -> None:
        from diorama_core.importing.opening import Opened
        from diorama_core.importing.photo_of_scan import with_photo_of_scan
        from diorama_core.layout.recipes import recipe
        from diorama_core.pipeline.presets import stages_for

        session.autosave.flush()
        opened = with_photo_of_scan(
            Opened(scene),
            inputs,
            library,
            lambda given: stages_for("auto", given, library),
            lambda free: recipe("feasible", library, free, depth_measured=True),
            progress,
        )
        client.post(lambda: _show_first(client, project, scene, inputs, opened))

    session.jobs.start("join", _("Adding {name} to the scene").format(name=inputs.photo.name), work)


def _show_first(client: Client, project: Project, before: Scene, inputs: Inputs, opened: Opened) -> None:
    session = client.session
    if session.project != project:
        return  # another project was opened here meanwhile
    if session.scene is not before or session.inputs is not inputs:
        raise EditRefused("the scene was changed while the photo was added, so it stays as it is; add the photo again")
    session.add_textures(dict(opened.textures))
    label = _("add the objects of {name}").format(name=inputs.photo.name)
    session.commit(label, opened.scene, by=client, selection=(), inputs=opened.inputs)
    session.view.show_whole_room()
    session.notice_all(f"{opened.changes[-1]}.", "good")


def _join(
    scene: Scene,
    inputs: Inputs,
    photos: Sequence[FurtherPhoto],
    photo: FurtherPhoto,
    project: Project,
    client: Client,
    progress: Progress,
) -> AddedPhoto:
    from diorama_core.layout.recipes import recipe
    from diorama_core.multiview.adding import with_photo
    from diorama_core.multiview.registration import camera_of, photos_of_scene
    from diorama_core.pipeline.presets import stages_for

    library = client.session.offer
    known = [p for p in photos_of_scene(scene, inputs, photos) if p.name != photo.name]
    if photo.camera is None:
        photo = replace(photo, camera=camera_of(photo, known, scene, library, progress.part(0.0, 0.3)))
    return with_photo(
        scene,
        known,
        photo,
        still_placed(project, scene),
        still_made(project, scene),
        library,
        lambda given: stages_for("auto", given, library),
        lambda free: recipe("feasible", library, free, depth_measured=True),
        progress.part(0.3, 1.0),
    )


def _show(client: Client, project: Project, before: Scene, photo: FurtherPhoto, added: AddedPhoto) -> None:
    """The scene with the photo; refused where somebody changed the scene meanwhile."""
    session = client.session
    now = session.further_photos
    if session.project != project:
        return  # another project was opened here meanwhile
    if session.scene is not before or not any(p is photo for p in now):
        raise EditRefused("the scene was changed while the photo was added, so it stays as it is; add the photo again")
    session.add_textures(dict(added.textures))
    further = tuple(added.photo if p is photo else p for p in now)
    label = _("add the objects of {name}").format(name=photo.name)
    session.commit(label, added.scene, by=client, selection=added.new, further=further)
    message = _("{name} is added: {new} new objects, {known} already known. Click the photo to show its view.")
    session.notice_all(message.format(name=photo.name, new=len(added.new), known=len(added.joined)), "good")
