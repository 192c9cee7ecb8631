"""A scene from words: a picture of what they describe, and the same build as for a photo."""

from __future__ import annotations

from diorama_app.projects.begin import fresh_folder
from diorama_app.session.client import Client
from diorama_core.errors import DioramaError, InputError
from diorama_core.progress import Progress
from diorama_core.project.storage import Project

COMPOSED = "No image endpoint is set up: the room is composed from the library, rendered and reconstructed."


def how_pictures_come() -> str:
    """One sentence on how the picture of a described room is made."""
    from diorama_core.text.pictures import ImageSettings  # the room grammar; opening a project does without it

    try:
        endpoint = ImageSettings.from_environment()
    except DioramaError as error:
        return str(error)
    return COMPOSED if endpoint is None else f"{endpoint.model} draws the picture."


def describe_room(client: Client, words: str) -> None:
    """Create a project from a description, in the background, and open it."""
    from diorama_core.text.pictures import ImageSettings, picture_of

    session = client.session
    said = " ".join(words.split())
    if not said:
        raise InputError("describe the room, for example: a reading corner with two armchairs")
    endpoint = ImageSettings.from_environment()

    def work(progress: Progress) -> None:
        from diorama_core.project.build import build_project
        from diorama_core.text.unmet import unmet

        made = picture_of(said, session.library, endpoint=endpoint, progress=progress.part(0.0, 0.2))
        name = said[:1].upper() + said[1:60]
        project = Project.create(fresh_folder(session.projects_dir, said.replace(".", " ")), name=name)
        session.autosave.flush()
        built = build_project(
            project, made.inputs, session.library, warnings=made.notes, progress=progress.part(0.2, 1.0)
        )
        how = (
            "its picture was composed from the library, not drawn" if endpoint is None else f"drawn by {endpoint.model}"
        )
        count = len(built.scene.objects)
        what = f"The scene has {count} objects" if count else "No furniture was found; draw boxes"
        lacking = unmet(said, built.scene)
        if lacking:
            missing = f"of the description is missing: {', '.join(lacking)}"
            project.update_info(notes=[missing, *project.info().get("notes", ())])
            what += f"; {missing}"
        client.post(lambda: session.visit(client, project, f"{what}; {how}."))

    session.jobs.start("text", "Creating the room you described", work)
