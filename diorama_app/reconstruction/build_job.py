"""The longest job: building a scene from a photo, beside everything else."""

from __future__ import annotations

import contextlib
import re
from pathlib import Path

from diorama_app.session.client import Client
from diorama_app.session.draft import Draft
from diorama_app.session.session import EditorSession
from diorama_core.errors import InputError
from diorama_core.progress import Progress
from diorama_core.project.lock import ProjectLock
from diorama_core.project.storage import Project
from diorama_core.scene.types import Scene


def build(client: Client) -> None:
    """Build the draft's scene: in the open project when it came from there, else in a new one."""
    session = client.session
    draft = session.draft
    if not draft.ready:
        raise InputError(
            "there is no photo yet; upload one first"
            if draft.photo is None
            else "nothing is marked in the photo yet; draw a box around each piece of furniture first"
        )
    inputs = draft.to_build()
    own = draft.from_project and session.project is not None
    if own:
        session.need_writable()

    def work(progress: Progress) -> None:
        from diorama_core.project.build import build_project

        project = (
            session.project
            if own
            else Project.create(fresh_folder(session.projects_dir, draft.name), name=Path(draft.name).stem)
        )
        assert project is not None
        session.autosave.flush()
        with contextlib.nullcontext() if own else ProjectLock(project.folder, "the editor"):
            built = build_project(project, inputs, session.library, warnings=draft.warnings, progress=progress)
        client.post(lambda: show_built(session, draft, project, built.scene, own=own))

    session.jobs.start("build", "Building the scene", work)


def show_built(
    session: EditorSession,
    draft: Draft,
    project: Project,
    scene: Scene,
    *,
    own: bool,
    message: str = "",
    label: str = "build the scene",
) -> None:
    """Show the built scene to all clients.

    Args:
        session: the session whose clients see it.
        draft: what was handed in when the build began; a newer one stays.
        project: the project that contains the scene.
        scene: what was built.
        own: whether it was built in the open project, as one undo step there.
        message: what to say instead of the number of objects.
        label: what the undo step is called.
    """
    newer = session.draft if session.draft is not draft else None
    if newer is None:
        for client in session.clients.values():
            client.view.canvas.close()
    if own and project == session.project:
        inputs = project.load_inputs()
        session.textures = project.textures(scene)
        session.read_notes()
        session.draft = Draft(inputs, inputs.boxes if inputs else (), from_project=True, name=project.name)
        session.commit(label, scene, inputs=inputs)
        session.show_whole_room()
    else:
        session.open_project(project)
    if newer is not None:
        session.draft = newer  # what somebody handed in meanwhile is not lost
        session.refresh_panels()
    session.notice_all(message or f"The scene has {len(scene.objects)} objects. Click one to change it.", "good")


def fresh_folder(projects_dir: Path, name: str, *, resume: bool = True) -> Path:
    """A folder for a new project, named after its photo or file; with `resume`, one without a scene yet is taken up."""
    stem = re.sub(r"[^A-Za-z0-9._-]+", "-", Path(name).stem).strip("-.")[:60] or "room"
    for number in range(1, 10_000):
        folder = projects_dir / (stem if number == 1 else f"{stem}-{number}")
        begun = (folder / "project.json").exists() and not (folder / "scene.json").exists()
        if (begun and resume) or not folder.exists():
            return folder
    raise InputError(f"{projects_dir} holds too many projects called {stem}; rename the file")
