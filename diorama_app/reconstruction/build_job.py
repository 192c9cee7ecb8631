"""The longest job: building a scene from a photo, beside everything else.

While it runs, the project's file says so: after a program that was killed, the next one offers to go on. Results of
stages are in the project already, so going on takes up where it ended.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator

from diorama_app.reconstruction.networks import can_find_furniture
from diorama_app.session.client import Client
from diorama_app.session.session import BUILDING, EditorSession
from diorama_core.artefacts import Inputs
from diorama_core.errors import DioramaError, EditRefused, InputError
from diorama_core.progress import Progress
from diorama_core.project.storage import Project
from diorama_core.scene.types import Scene


def ready_to_build(inputs: Inputs | None) -> bool:
    """Whether a scene with objects can be built."""
    return inputs is not None and (bool(inputs.boxes) or inputs.instances is not None or can_find_furniture())


def build(client: Client) -> None:
    """Build the scene of the open project's photo, as one undo step.

    Raises:
        EditRefused: the project is read-only.
        InputError: there is no photo, or nothing is marked in it.
    """
    session = client.session
    inputs = session.inputs
    if inputs is None or not ready_to_build(inputs):
        raise InputError(
            "there is no photo yet; upload one first"
            if inputs is None
            else "nothing is marked in the photo yet; draw a box around each piece of furniture first"
        )
    start_build(session, inputs, "Building the scene", "build the scene")


def start_build(session: EditorSession, inputs: Inputs, title: str, label: str, message: str = "") -> None:
    """Build the open project's scene from these inputs, in the background.

    Args:
        session: where.
        inputs: the photo with everything that is said of it.
        title: what the job is called.
        label: what the undo step is called.
        message: what is said at the end instead of the number of objects.
    """
    session.need_writable()
    project = session.project
    if project is None:
        raise EditRefused("no project is open")

    def work(progress: Progress) -> None:
        from diorama_core.project.build import build_project

        session.autosave.flush()
        with _noted(project):
            warnings = project.info().get("warnings", ())
            built = build_project(project, inputs, session.library, warnings=warnings, progress=progress)
        session.ui_thread.post(lambda: show_built(session, project, built.scene, label=label, message=message))

    session.interrupted = False
    session.jobs.start("build", title, work)


@contextlib.contextmanager
def _noted(project: Project) -> Iterator[None]:
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


def show_built(session: EditorSession, project: Project, scene: Scene, *, label: str, message: str = "") -> None:
    """Show the built scene of the open project to all clients, as one undo step."""
    if project != session.project:
        return  # it is on disk; somebody opened another project here meanwhile
    for client in session.clients.values():
        client.view.canvas.close()
    session.textures = {**session.textures, **project.textures(scene)}  # undo shows what earlier ones name
    session.read_notes()
    session.commit(label, scene, inputs=project.load_inputs())
    session.view.show_whole_room()
    message = message or f"The scene has {len(scene.objects)} objects. Click one to change it."
    if session.further_photos:
        message += " The other photos of the room are to be added again."
    session.notice_all(message, "good")
