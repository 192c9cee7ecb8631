"""The addresses of open projects: other programs look, ask, edit and undo beside the browser."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Form, Query, Request, Response
from fastapi.sse import EventSourceResponse, ServerSentEvent
from starlette.concurrency import run_in_threadpool

from diorama_app.commands import review
from diorama_app.commands.optimise import optimise
from diorama_app.http_api import project_answers as answers
from diorama_app.http_api.answers import FILE, PICTURE, VIEWS, error_docs, file_answer, format_of, png
from diorama_app.http_api.forms import (
    AUTHOR,
    DescribeRequest,
    EditAnswer,
    EditRequest,
    EventData,
    OptimiseRequest,
    PhotoForm,
    ProjectList,
    ReviewRequest,
    StepAnswer,
    StepRequest,
)
from diorama_app.http_api.open_projects import OpenProjects, UnknownProjectError, edit, need_version, room_of
from diorama_app.projects.manage import address_of, name_of
from diorama_app.reconstruction.build_job import build
from diorama_app.session.session import EditorSession
from diorama_core.export.gathering import ExportOptions
from diorama_core.io.bounded import shorten
from diorama_core.review.questions import questions
from diorama_core.scene.schema import scene_to_json

MAX_WAIT_S = 60.0
POLL_S = 0.1
"""How often a job that is waited for is looked at."""
project_router = APIRouter(prefix="/v1/projects", responses=error_docs(404, 500))


def _open_projects(request: Request) -> OpenProjects:
    return request.app.state.opened


Opened = Annotated[OpenProjects, Depends(_open_projects)]


def _session(opened: Opened, name: str) -> EditorSession:
    return opened.session(name)


Session = Annotated[EditorSession, Depends(_session)]
"""Session of the project in the address."""


@project_router.get("", operation_id="list_projects")
def list_projects(opened: Opened) -> ProjectList:
    """All projects."""
    here = {e.session.project.folder for e in opened.running.workspace.editors if e.session.project is not None}
    rows = [
        answers.ProjectAnswer(project=address_of(f), title=name_of(f), open=f in here, folder=str(f.resolve()))
        for f in opened.folders()
    ]
    return ProjectList(projects=rows)


@project_router.post("", status_code=202, operation_id="begin_project", responses=error_docs(400, 408, 413, 422, 503))
def begin_project(
    opened: Opened, form: PhotoForm, author: Annotated[str, Form(max_length=40)] = AUTHOR
) -> answers.SceneAnswer:
    """Send a photo: it becomes a project whose scene is built, in the editor; `job` says how far it is."""
    return _scene_answer(opened, opened.begin(form, author))


@project_router.post("/described", status_code=201, operation_id="describe_project", responses=error_docs(422, 501))
def describe_project(opened: Opened, body: DescribeRequest) -> answers.SceneAnswer:
    """Describe a room in words: it becomes a project with a scene, at the end of the request."""
    return _scene_answer(opened, opened.describe(body.text, body.author))


@project_router.get("/{name}", operation_id="get_project")
def get_project(opened: Opened, session: Session) -> answers.SceneAnswer:
    """The open scene: objects, room, version, what is wrong and what is doubtful."""
    return _scene_answer(opened, session)


def _scene_answer(opened: OpenProjects, session: EditorSession) -> answers.SceneAnswer:
    def answer() -> answers.SceneAnswer:
        scene, document = session.scene, session.document
        undo = document.next_undo()
        return answers.SceneAnswer(
            project="" if session.project is None else address_of(session.project.folder),
            title="" if session.project is None else session.project.name,
            page=opened.page(session),
            version=document.version,
            read_only=session.read_only,
            undo=None if undo is None else undo.label,
            job=answers.job_answer(session),
            objects=[answers.object_answer(scene, o, session.badges, session.reasons) for o in scene.objects],
            room=[answers.plane_answer(p) for p in scene.architecture.planes],
            notes=list(session.notes),
        )

    return session.ui_thread.ask(answer)


@project_router.post("/{name}/edits", operation_id="edit_project", responses=error_docs(409, 422, 501))
def edit_project(session: Session, body: EditRequest) -> EditAnswer:
    """Make edits as one undo step that every browser sees. 409: somebody has changed the scene; look again."""
    done = edit(session, body.version, body.edits or body.words.strip(), body.author)
    made = done.proposed
    return EditAnswer(version=done.version, lines=[*made.lines], notes=[*made.notes], changed=[*made.changed])


@project_router.get("/{name}/questions", operation_id="get_questions")
def get_questions(session: Session) -> answers.QuestionsAnswer:
    """What a person could tell of the scene, the answer that makes most objects right first."""
    scene, version = session.ui_thread.ask(lambda: (session.scene, session.document.version))
    return answers.QuestionsAnswer.model_validate(
        {"version": version, "questions": [q.to_json() for q in questions(scene)]}
    )


@project_router.post("/{name}/answers", operation_id="answer_question", responses=error_docs(409, 422))
def answer_question(session: Session, body: ReviewRequest) -> StepAnswer:
    """Answer a question, as one undo step. 409: somebody has changed the scene; ask for the questions again."""

    def answer() -> StepAnswer:
        session.need_writable()
        need_version(session, body.version)
        review.answer(session, body.question, body.answer, author=body.author)
        return StepAnswer(version=session.document.version, label=session.document.history.current.label)

    return session.ui_thread.ask(answer)


@project_router.post("/{name}/undo", operation_id="undo_project", responses=error_docs(422))
def undo_project(session: Session, body: StepRequest) -> StepAnswer:
    """Take back the author's own last change, as long as nobody else has changed the same things since."""
    entry = session.ui_thread.ask(lambda: session.undo(body.author))
    return StepAnswer(version=session.document.version, label=entry.label)


@project_router.post("/{name}/redo", operation_id="redo_project", responses=error_docs(422))
def redo_project(session: Session, body: StepRequest) -> StepAnswer:
    """Do again what the author took back last."""
    entry = session.ui_thread.ask(lambda: session.redo(body.author))
    return StepAnswer(version=session.document.version, label=entry.label)


@project_router.post(
    "/{name}/optimise", status_code=202, operation_id="optimise_project", responses=error_docs(409, 422)
)
def optimise_project(session: Session, body: OptimiseRequest) -> answers.JobStatusAnswer:
    """Tidy up: objects rest on their supports and do not overlap. One undo step at its end."""

    def start() -> answers.JobStatusAnswer:
        session.need_writable()
        need_version(session, body.version)
        missing = next((i for i in body.only if not session.scene.has_object(i)), None)
        if missing is not None:
            raise UnknownProjectError(f"there is no object {shorten(missing)!r} in this scene")
        optimise(session, body.recipe, tuple(body.only), author=body.author, by_hand_too=body.by_hand_too)
        return answers.job_answer(session)

    return session.ui_thread.ask(start)


@project_router.post("/{name}/build", status_code=202, operation_id="build_project", responses=error_docs(422))
def build_project(session: Session) -> answers.JobStatusAnswer:
    """Build the scene of the project's photo anew. One undo step at its end."""

    def start() -> answers.JobStatusAnswer:
        build(session)
        return answers.job_answer(session)

    return session.ui_thread.ask(start)


@project_router.get("/{name}/job", operation_id="get_project_job")
async def get_project_job(
    session: Session,
    wait_s: Annotated[float, Query(ge=0, le=MAX_WAIT_S, description="Wait so long for its end.")] = 0.0,
) -> answers.JobStatusAnswer:
    """How far the project's long work is, or how the last one ended."""
    until = asyncio.get_running_loop().time() + wait_s
    while session.jobs.status is not None and asyncio.get_running_loop().time() < until:
        await asyncio.sleep(POLL_S)

    def answer() -> answers.JobStatusAnswer:
        if session.jobs.status is None:
            session.jobs.wait(MAX_WAIT_S)  # its thread tells how it ended just before it ends
        return session.ui_thread.ask(lambda: answers.job_answer(session))

    return await run_in_threadpool(answer)


@project_router.post("/{name}/job/cancel", operation_id="cancel_project_job")
def cancel_project_job(session: Session) -> answers.JobStatusAnswer:
    """Stop the project's long work; nothing is changed by it then."""
    session.jobs.cancel()
    return answers.job_answer(session)


@project_router.get("/{name}/objects/{object_id}", operation_id="get_object")
def get_object(session: Session, object_id: str) -> answers.DetailAnswer:
    """One object: what is around it and how far, what it carries, its alternatives, why it is where it is."""
    scene, reasons = session.scene, session.reasons
    if not scene.has_object(object_id):
        known = ", ".join(o.id for o in scene.objects[:30]) or "none"
        raise UnknownProjectError(f"there is no object {shorten(object_id)!r} in this scene; there are: {known}")
    item = scene.object(object_id)
    about = answers.object_answer(scene, item, session.badges, reasons)
    return answers.detail_answer(scene, item, about, session.library, reasons)


@project_router.get("/{name}/free-floor", operation_id="get_free_floor")
def get_free_floor(
    session: Session,
    width_m: Annotated[float, Query(gt=0, le=50)] = 1.0,
    depth_m: Annotated[float, Query(gt=0, le=50)] = 1.0,
) -> answers.FreeFloorAnswer:
    """Where the floor is free for something so wide and so deep, in either heading."""
    return answers.free_floor_answer(session.scene, width_m, depth_m)


@project_router.get("/{name}/check", operation_id="check_project")
def check_project(session: Session) -> answers.CheckAnswer:
    """Collisions, what floats or is outside the room, walkways, and what people hardly get at."""
    return answers.check_answer(session.scene, session.library)


@project_router.get("/{name}/scene", operation_id="get_project_scene", response_model=dict[str, Any])
def get_project_scene(session: Session) -> Response:
    """The scene file as it would be saved now; docs/scene-file.md describes it. `ETag` is its version."""
    scene, version = session.ui_thread.ask(lambda: (session.scene, session.document.version))
    return Response(scene_to_json(scene), media_type="application/json", headers={"ETag": f'"{version}"'})


@project_router.get(
    "/{name}/picture",
    operation_id="get_project_picture",
    response_class=Response,
    responses={**PICTURE, **error_docs(422)},
)
async def get_project_picture(
    request: Request,
    session: Session,
    view: Annotated[str, Query(description=VIEWS, max_length=80)] = "photo",
    width: Annotated[int, Query(ge=16, le=2048)] = 640,
    height: Annotated[int, Query(ge=16, le=2048)] = 480,
    ids: Annotated[bool, Query(description="Whether objects are outlined and named by their ids.")] = False,
) -> Response:
    """A picture of the scene as it is now; one with ids has its longer side at 896 pixels or more."""
    async with request.app.state.few:
        content = await run_in_threadpool(lambda: png(room_of(session), view, (width, height), ids=ids))
    return Response(content, media_type="image/png")


@project_router.get(
    "/{name}/export/{format_name}",
    operation_id="export_project",
    response_class=Response,
    responses={**FILE, **error_docs(422, 501)},
)
async def export_project(
    request: Request,
    session: Session,
    name: str,
    format_name: str,
    ceiling: Annotated[bool, Query(description="Whether ceilings are in it.")] = True,
    texture_size: Annotated[int | None, Query(ge=16, le=8192, description="Longest side of pictures.")] = None,
) -> Response:
    """The scene as it is now as a file for other programs; `/v1/formats` lists them."""
    format_ = format_of(format_name)
    options = ExportOptions(ceiling=ceiling, max_texture_px=texture_size)
    async with request.app.state.few:
        return await run_in_threadpool(lambda: file_answer(room_of(session), name, format_, options))


@project_router.get("/{name}/events", operation_id="watch_project", response_class=EventSourceResponse)
async def watch_project(session: Session) -> AsyncIterator[ServerSentEvent]:
    """Server-sent events: `scene` for the state now and after every change by anybody, `job` while long work runs."""
    loop, changed = asyncio.get_running_loop(), asyncio.Event()

    def notify() -> None:
        if not loop.is_closed():
            loop.call_soon_threadsafe(changed.set)

    def data() -> EventData:
        entry = session.document.history.current
        return EventData(
            version=session.document.version, label=entry.label, author=entry.author, job=answers.job_answer(session)
        )

    await run_in_threadpool(session.ui_thread.ask, lambda: session.watchers.add(notify))
    try:
        version = None
        while True:
            now = await run_in_threadpool(session.ui_thread.ask, data)
            yield ServerSentEvent(event="job" if now.version == version else "scene", id=now.version, data=now)
            version = now.version
            await changed.wait()
            changed.clear()
    finally:
        session.ui_thread.post(lambda: session.watchers.discard(notify))
