"""A scene from words: composed from the library, or built from the picture that an image endpoint draws."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from diorama_app.projects.begin import new_project
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_app.strings import N_, _, plural
from diorama_core.errors import DioramaError, InputError
from diorama_core.io.text import sentences
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import Progress
from diorama_core.project.storage import Project

if TYPE_CHECKING:
    from diorama_core.perception.language.client import LmmSettings
    from diorama_core.text.pictures import ImageSettings

COMPOSED = (
    "The scene has {count} object, composed from the library.",
    "The scene has {count} objects, composed from the library.",
)
NO_ENDPOINT = N_("No image endpoint is set up: the room is composed from the library.")


def how_pictures_come() -> str:
    """One sentence on how the picture of a described room is made."""
    from diorama_core.text.pictures import ImageSettings  # the room grammar; opening a project does without it

    try:
        endpoint = ImageSettings.from_environment()
    except DioramaError as error:
        return str(error)
    return NO_ENDPOINT if endpoint is None else _("{model} generates the picture.").format(model=endpoint.model)


def describe_room(client: Client, words: str) -> None:
    """Create a project from a description, in the background, and open it."""
    session, create = client.session, creation(client.session, words)

    def work(progress: Progress) -> None:
        session.autosave.flush()
        project, what = create(progress)
        client.post(lambda: session.visit(client, project, what))

    session.jobs.start("text", _("Creating the room you described"), work)


def creation(session: EditorSession, words: str) -> Callable[[Progress], tuple[Project, str]]:
    """What creates a project from a description, beside a session's, and says what it is like.

    Raises:
        InputError: nothing is described, or an endpoint is set up wrongly.
    """
    from diorama_core.perception.language.client import LmmSettings
    from diorama_core.text.pictures import ImageSettings

    prompt = " ".join(words.split())
    if not prompt:
        raise InputError("describe the room, for example: a reading corner with two armchairs")
    endpoint, model = ImageSettings.from_environment(), LmmSettings.from_environment()

    def create(progress: Progress) -> tuple[Project, str]:
        name = prompt[:1].upper() + prompt[1:60]
        make = (
            partial(_compose, prompt, model=model) if endpoint is None else partial(_draw_and_build, prompt, endpoint)
        )
        with new_project(session.projects_dir, prompt.replace(".", " "), name=name, library=session.library) as project:
            what = make(project, session.offer, progress=progress)
        return project, what

    return create


def _compose(
    prompt: str, project: Project, library: ShapeLibrary, model: LmmSettings | None, progress: Progress
) -> str:
    """Compose the room in a new project; what to tell the user."""
    from diorama_core.text.scene_from_text import scene_from_text

    made = scene_from_text(prompt, library, language_model=model, progress=progress)
    project.save_textures(made.textures)
    project.save_scene(made.scene)
    project.update_info(notes=list(made.notes))
    unmet = [note for note in made.notes[1:] if not note.startswith(("added", "mended"))]
    message = plural(*COMPOSED, len(made.scene.objects))
    return (
        f"{message} {sentences(map(_, unmet))}" if unmet else f"{message} {_('It has everything that you asked for.')}"
    )


def _draw_and_build(
    asked: str, endpoint: ImageSettings, project: Project, library: ShapeLibrary, progress: Progress
) -> str:
    """Build the endpoint's picture in a new project; what to tell the user."""
    from diorama_core.project.build import build_project
    from diorama_core.text.pictures import picture_of
    from diorama_core.text.scene_from_text import unmet

    made = picture_of(asked, endpoint, progress.part(0.0, 0.2))
    built = build_project(project, made.inputs, library, warnings=made.notes, progress=progress.part(0.2, 1.0))
    count = len(built.scene.objects)
    message = plural("The scene has {count} object.", "The scene has {count} objects.", count)
    message = message if count else _("No furniture was found; draw boxes.")
    lacking = unmet(asked, built.scene)
    if lacking:
        names = ", ".join(lacking)
        project.update_info(notes=[f"missing from the scene: {names}", *project.info().get("notes", ())])
        message += " " + _("Missing from the scene: {names}.").format(names=names)
    return f"{message} {_('The picture is by {model}.').format(model=endpoint.model)}"
