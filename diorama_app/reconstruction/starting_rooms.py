"""Rooms to begin with that no photo shows: an empty one of given lengths, and furnished examples."""

from __future__ import annotations

from diorama_app.projects.begin import begin_with_scene
from diorama_app.projects.example import example_project
from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_core.errors import InputError, ProjectError
from diorama_core.progress import Progress

LIVING_ROOM = "living"
"""The bundled example, which was made from its rendering."""


def start_empty_room(client: Client, width_m: float, depth_m: float, height_m: float) -> None:
    """Create a project with an empty room and open it.

    Args:
        client: the browser that asked.
        width_m: along x.
        depth_m: along y.
        height_m: of the walls.

    Raises:
        EditRefused: a length is no room's.
        ProjectError: the folder cannot be written.
    """
    from diorama_core.appearance.surface_finish import with_finish_pictures  # OpenCV; opening does without it
    from diorama_core.editing.plan_edits import empty_room

    session = client.session
    scene, made = with_finish_pictures(empty_room(width_m, depth_m, height_m), {})
    session.autosave.flush()
    project = begin_with_scene(
        session.projects_dir, _("Empty room"), scene, made, ("started as an empty room",), session.library
    )
    message = _("Insert furniture from the Library tab; click a wall or the floor to paint or cover it.")
    session.visit(client, project, message)


def open_example(client: Client, kind: str) -> None:
    """Open an example room; all but the bundled one are furnished now, in the background.

    Raises:
        InputError: there is no such example.
        ProjectError: the folder cannot be written.
    """
    session = client.session
    session.autosave.flush()
    if kind == LIVING_ROOM:
        project = example_project(session.projects_dir)
        if project is None:
            raise ProjectError("the bundled example is missing; start with a photo or an empty room")
        session.visit(client, project, "")
        return
    from diorama_core.synthesis.example_rooms import EXAMPLE_ROOMS, example_room

    room = next((r for r in EXAMPLE_ROOMS if r.kind == kind), None)
    if room is None:
        raise InputError("there is no such example; choose one that is shown")

    def work(progress: Progress) -> None:
        from diorama_core.appearance.surface_finish import with_finish_pictures

        progress.report(0.1, "choosing and placing furniture")
        scene, made = with_finish_pictures(example_room(room, session.offer), {})
        progress.report(0.8, "saving the project")
        notes = ("an example, furnished by rules",)
        project = begin_with_scene(session.projects_dir, _(room.name), scene, made, notes, session.library)
        client.post(lambda: session.visit(client, project, ""))

    session.jobs.start("example", _("Furnishing: {room}").format(room=_(room.name).lower()), work)
