"""The longest job: building a scene from a photo, beside everything else.

While it runs, the project's file says so: after a program that was killed, the next one offers to go on. Results of
stages are in the project already, so going on takes up where it ended.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from diorama_app.reconstruction.networks import can_find_furniture
from diorama_app.session.project_contents import limit_notes
from diorama_app.session.session import BUILDING, EditorSession
from diorama_app.session.shared_document import Textures
from diorama_app.strings import N_, _, plural
from diorama_core.artefacts import FurtherPhoto, Inputs, LabelledBox, Reason
from diorama_core.errors import DioramaError, InputError
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import Progress
from diorama_core.project.storage import Project
from diorama_core.scene.types import Camera, Scene

if TYPE_CHECKING:
    from diorama_core.multiview.rebuilding import Rebuilt  # the whole pipeline; opening a project does without it
    from diorama_core.multiview.sphere_scene import SphereScene
    from diorama_core.pipeline.run import Built


UNASKED = N_("Building what was found")
"""Title of a build with what was found in a photo, of which nobody looked at anything."""
BUILT = (
    "The scene has {count} object. Click it to change it.",
    "The scene has {count} objects. Click one to change it.",
)
AWAITED = "build_when_seen"
"""What a project's file says of an uploaded photo that is to be built as soon as its objects are found."""


@dataclass(frozen=True, eq=False)
class NewScene:
    """What a build gives to be shown, as it is in memory; all of it but the scene is in the project's folder."""

    scene: Scene
    textures: Textures
    inputs: Inputs
    notes: tuple[str, ...]
    reasons: tuple[Reason, ...] = ()
    again: Rebuilt | None = None
    """The other photos, where some had joined the scene before."""

    @classmethod
    def of(cls, built: Built, inputs: Inputs, warnings: Sequence[str], again: Rebuilt | None) -> NewScene:
        """What was built of one photo, and what others that joined it anew made of that.

        Args:
            built: the scene of the photo.
            inputs: as they are saved.
            warnings: about the inputs.
            again: the other photos.
        """
        scene = built.scene if again is None else again.scene
        textures = dict(built.textures) if again is None else {**built.textures, **again.textures}
        return cls(scene, textures, inputs, limit_notes([*warnings, *built.notes]), built.reasons, again)


def ready_to_build(inputs: Inputs | None) -> bool:
    """Whether a scene with objects can be built."""
    if inputs is None:
        return False
    given = bool(inputs.boxes) or inputs.instances is not None or bool(inputs.photo.equirectangular)
    return given or can_find_furniture()


def builds_unasked(session: EditorSession) -> bool:
    """Whether a build runs that whoever marks something in the photo puts an end to."""
    status = session.jobs.status
    return status is not None and status.title == _(UNASKED) and not status.cancelling


def build_found(session: EditorSession, boxes: Sequence[LabelledBox]) -> None:
    """Build the scene of the open project's photo with what was found in it beside what is marked.

    Args:
        session: where.
        boxes: boxes of which nobody looked at one.

    Raises:
        EditRefused: the project is read-only.
    """
    inputs = session.inputs
    if inputs is not None:
        # Views of a 360 degree photo show more than the photo itself: what they show is found by the build.
        given = inputs if inputs.photo.equirectangular else replace(inputs, boxes=(*inputs.boxes, *boxes))
        start_build(session, given, _(UNASKED), _("build the scene"))


def is_awaited(project: Project) -> bool:
    """Whether the project's photo is to be built as soon as its objects are found; says so only once."""
    awaited = bool(project.info().get(AWAITED))
    if awaited:
        project.update_info(**{AWAITED: None})
    return awaited


def stop_unasked(session: EditorSession) -> None:
    """End the build that nobody asked for, and begin none: a person says more of the photo than was found in it."""
    if session.project is not None:
        is_awaited(session.project)
    if builds_unasked(session):
        session.jobs.cancel(in_favour=True)


def build(session: EditorSession) -> None:
    """Build the scene of the open project's photo, as one undo step.

    Raises:
        EditRefused: the project is read-only.
        InputError: there is no photo, or nothing is marked in it.
    """
    inputs = session.inputs
    if inputs is None or not ready_to_build(inputs):
        raise InputError(
            "there is no photo yet; upload one first"
            if inputs is None
            else "nothing is marked in the photo yet; draw a box around each piece of furniture first"
        )
    start_build(session, inputs, _("Building the scene"), _("build the scene"))


def start_build(session: EditorSession, inputs: Inputs, title: str, label: str, message: str = "") -> None:
    """Build the open project's scene from these inputs, in the background.

    Args:
        session: where.
        inputs: the photo with everything that is said of it.
        title: what the job is called.
        label: what the undo step is called.
        message: what is said at the end instead of the number of objects.
    """
    if inputs.photo.equirectangular:
        build_whole_room(session, inputs, title)
        return
    project = session.need_project()
    before, others, inputs_before = session.scene.camera, session.further_photos, session.inputs

    def work(progress: Progress) -> None:
        from diorama_core.project.build import build_project, with_found_boxes

        session.autosave.flush()
        joined = [p for p in others if p.camera is not None]
        alone = 1.0 / (1 + len(joined))
        with _note(project):
            warnings = project.info().get("warnings", ())
            part = progress.part(0.0, alone)
            built = build_project(project, inputs, session.offer, warnings=warnings, progress=part, save_scene=False)
            again = None
            if joined:
                again = _with_others(project, built, before, others, session.offer, progress.part(alone, 1.0))
        made = NewScene.of(built, with_found_boxes(inputs, built), warnings, again)
        session.autosave.save_soon(project, made.scene)  # whatever is open by then
        session.ui_thread.post(
            lambda: show_built(session, project, made, label=label, inputs_before=inputs_before, message=message)
        )

    session.interrupted = False
    session.jobs.start("build", title, work)


def build_whole_room(session: EditorSession, sphere: Inputs, title: str = "") -> None:
    """Build the room of the open project from one of its photos, a 360 degree photo, as one undo step.

    Args:
        session: where.
        sphere: the photo with its boxes; without any, what is found in its views is used.
        title: what the job is called; empty for that it builds the whole room.

    Raises:
        EditRefused: the project is read-only.
    """
    project, before, library = session.need_project(), session.scene, session.offer

    def work(progress: Progress) -> None:
        from diorama_core.layout.recipes import recipe
        from diorama_core.multiview.sphere_scene import build_sphere
        from diorama_core.pipeline.presets import stages_for
        from diorama_core.project.further_photos import note_placed

        session.autosave.flush()
        layout = recipe("feasible", library, depth_measured=True)
        with _note(project):
            built = build_sphere(
                sphere.photo, sphere.boxes, library, lambda given: stages_for("auto", given, library), layout, progress
            )
            note_placed(project, built.room.scene)
        session.ui_thread.post(lambda: _show_whole_room(session, project, before, sphere, built))

    for client in session.clients.values():
        client.view.canvas.close()
    session.jobs.start("build", title or _("Building the whole room of a 360 degree photo"), work)


def _show_whole_room(
    session: EditorSession, project: Project, before: Scene, sphere: Inputs, built: SphereScene
) -> None:
    if session.project != project:
        return  # another project was opened here meanwhile
    if session.scene is not before:
        session.notice_all(_("The scene was changed while the room was built, so it stays as it is. Build it again."))
        return
    session.add_textures(dict(built.room.textures))
    session.notes = limit_notes(built.room.notes)
    main, further = built.views[0], built.further_photos(sphere)
    known = {Path(n).stem for n in built.names} | {p.name for p in further}
    others = [replace(p, camera=None, seen=()) for p in session.further_photos if p.name not in known]
    for client in session.clients.values():
        client.view.canvas.close()  # it would show the photo that the scene opens with
        client.open_tab("Scene")
    session.commit(
        _("build the whole room"),
        built.room.scene,
        selection=(),
        inputs=replace(main.inputs, intrinsics=main.camera.intrinsics),
        further=(*further, *others),
    )
    session.view.show_whole_room()
    session.notice_all(summary(built.room.scene), "good")


def _with_others(
    project: Project,
    built: Built,
    before: Camera | None,
    others: Sequence[FurtherPhoto],
    library: ShapeLibrary,
    progress: Progress,
) -> Rebuilt:
    """The other photos join the scene that was built anew; their pictures are saved."""
    from diorama_core.layout.recipes import recipe
    from diorama_core.multiview.rebuilding import with_photos_again
    from diorama_core.pipeline.presets import stages_for
    from diorama_core.project.further_photos import note_placed

    joined = with_photos_again(
        built.scene,
        built.inputs,
        before,
        others,
        library,
        lambda given: stages_for("auto", given, library),
        lambda free: recipe("feasible", library, free, depth_measured=True),
        progress,
    )
    project.save_textures(joined.textures)
    note_placed(project, joined.scene)
    return joined


@contextlib.contextmanager
def _note(project: Project) -> Iterator[None]:
    """While it lasts, the project's file says that its scene is built."""
    project.update_info(**{BUILDING: time.strftime("%Y-%m-%dT%H:%M:%S")})
    try:
        yield
    finally:
        forget_build(project)


def forget_build(project: Project) -> None:
    """No build of this project is under way."""
    with contextlib.suppress(DioramaError):  # the build itself has said what is wrong with the folder
        project.update_info(**{BUILDING: None})


def summary(scene: Scene) -> str:
    """Message about a scene that was built: its number of objects."""
    return plural(*BUILT, len(scene.objects))


def show_built(
    session: EditorSession,
    project: Project,
    made: NewScene,
    *,
    label: str,
    inputs_before: Inputs | None,
    message: str = "",
) -> None:
    """Show the built scene of the open project to all clients, as one undo step.

    Args:
        session: where.
        project: the project that was built.
        made: what was built, which is saved or being saved.
        label: what the undo step is called.
        inputs_before: what the document said of the photo when the build began; what a person has changed since stays.
        message: what is said instead of the number of objects.
    """
    if project != session.project:
        return  # somebody opened another project here meanwhile
    for client in session.clients.values():
        if client.view.canvas.is_open or not session.scene.objects:
            client.open_tab("Scene")  # who corrects the camera of a scene goes on correcting it
        client.view.canvas.close()
    session.textures = {**session.textures, **made.textures}  # undo shows what earlier ones name
    session.notes, session.reasons = made.notes, made.reasons
    # Photos that were added or taken out meanwhile are as the person left them.
    known = {} if made.again is None else {p.name: p for p in made.again.photos}
    further = tuple(known.get(p.name, p) for p in session.further_photos)
    inputs = made.inputs if session.inputs is inputs_before else None
    session.saving.inputs_are_saved(inputs)
    session.commit(label, made.scene, inputs=inputs, further=further if made.again is not None else None)
    session.view.show_whole_room()
    message = message or summary(made.scene)
    if made.again is not None and made.again.left_out:
        names = ", ".join(made.again.left_out)
        message += " " + _("Not in the new scene, to be added again: {names}.").format(names=names)
    session.notice_all(message, "good")
