"""The real process, driven by a client that is made of its OpenAPI document."""

from __future__ import annotations

import importlib
import io
import json
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType

import pytest
import trimesh
from PIL import Image

from diorama_app.cli import main
from diorama_app.http_api.access import MAX_BODY_BYTES
from diorama_app.projects.formats import EXPORT_FORMATS
from tests.app.http_api.openapi_client import Client, send
from tests.cli.room_photo import write_room
from tests.cli.running import refused
from tests.few_shapes import stored_seats
from tests.io.test_bombs import png
from tests.waiting import until

pytestmark = pytest.mark.posix

pytest.importorskip("fastapi", reason="needs FastAPI (pip install 'diorama[api]')")
pytest.importorskip("uvicorn", reason="needs uvicorn (pip install 'diorama[api]')")
ROOT = Path(__file__).resolve().parents[3]
TOKEN = "s3cret"
PROGRAM = """
import sys, tests.small_planes
from diorama_app import serve
from diorama_app.cli import main
serve.warm_up = lambda stopped: None
sys.exit(main())
"""


@contextmanager
def running(projects: Path) -> Iterator[tuple[Client, subprocess.Popen]]:
    """A server, and a client of it that has its token; nothing is preloaded."""
    command = [sys.executable, "-c", PROGRAM, "api", "--port", "0", "--projects", str(projects), "--token", TOKEN]
    command += ["--library", stored_seats()]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT)
    assert process.stdout is not None
    try:
        line = process.stdout.readline()
        assert "http://" in line, line
        yield Client(line.split(" at ")[1].split()[0], TOKEN), process
    finally:
        process.send_signal(signal.SIGINT)
        try:
            process.wait(60)
        finally:
            process.kill()
            process.wait()
            process.stdout.close()


@pytest.fixture(scope="module")
def photo(tmp_path_factory: pytest.TempPathFactory) -> dict:
    """Arguments of `create_job`."""
    image, boxes = write_room(tmp_path_factory.mktemp("photo"), marked=1)
    return {"photo": ("my room.png", image.read_bytes()), "boxes": boxes.read_text(), "profile": "embedded"}


@pytest.fixture(scope="module")
def projects(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("projects")


@pytest.fixture(scope="module")
def served(projects: Path) -> Iterator[tuple[Client, subprocess.Popen]]:
    with running(projects) as made:
        yield made


@pytest.fixture(scope="module")
def client(served: tuple[Client, subprocess.Popen]) -> Client:
    return served[0]


@pytest.fixture(scope="module")
def finished(client: Client, photo: dict) -> str:
    """A job that is done."""
    created = client.create_job(**photo, fov_deg=62)
    assert created.status == 202
    assert created.body["state"] in ("queued", "running")
    for _ in range(5):  # a busy machine takes some minutes
        done = client.get_job(job_id=created.body["id"], wait_s=60)
        if done.body["state"] not in ("queued", "running"):
            break
    assert (done.body["state"], done.body["progress"], done.body["error"]) == ("done", 1.0, None)
    assert done.body["objects"] >= 1
    return created.body["id"]


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="reads memory from /proc")
def test_a_token_opens_the_door_and_pictures_are_decoded_outside_the_server(served) -> None:
    """63 megapixels that end too early: decoded here they would take 190 MB and more. A later test's builds take more,
    so this one is the first."""
    client, process = served
    assert send("GET", f"{client.url}/openapi.json").status == 401
    assert send("GET", f"{client.url}/openapi.json", headers={"Authorization": "Bearer wrong"}).status == 401
    assert client.create_job(photo=("small.png", b"no picture")).status == 422  # what is loaded on first use
    before = most_memory_mb(process.pid)
    reply = client.create_job(photo=("large.png", png(9_000, 7_000, 8, 2, 3)[:-2_000]))
    assert (reply.status, "large.png" in reply.body["error"]) == (422, True), reply
    assert most_memory_mb(process.pid) < before + 60
    assert client.list_jobs().body == {"jobs": []}


def most_memory_mb(pid: int) -> float:
    """The most that a process has held until now."""
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    return float(next(line for line in lines if line.startswith("VmHWM")).split()[1]) / 1000


def test_a_photo_becomes_a_scene_a_picture_and_files(client: Client, finished: str) -> None:
    scene = client.get_scene(job_id=finished).body
    assert scene["objects"]
    picture = client.get_picture(job_id=finished, view="top", width=200, height=100)
    assert Image.open(io.BytesIO(picture.body)).size == (200, 100)
    file = client.export_scene(job_id=finished, format_name="glb", ceiling="false", texture_size=64)
    assert len(trimesh.load_scene(io.BytesIO(file.body), file_type="glb").geometry) >= len(scene["objects"])
    names = {f["name"] for f in client.list_formats().body}
    assert names == set(EXPORT_FORMATS)
    assert finished in [job["id"] for job in client.list_jobs().body["jobs"]]


def test_a_finished_job_is_edited_as_a_project(client: Client, finished: str) -> None:
    project = client.get_project(name=finished).body
    assert project["objects"]
    hide = {"do": "set", "objects": [project["objects"][0]["id"]], "state": "hidden"}
    done = client.edit_project(name=finished, version=project["version"], edits=[hide])
    assert done.status == 200
    assert client.undo_project(name=finished, author="API").status == 200


def test_errors_are_one_line_with_the_status_that_fits(client: Client, photo: dict, finished: str) -> None:
    cases = [
        (client.create_job(photo=("a.jpg", b"no picture")), 422, "a.jpg"),
        (client.create_job(**{**photo, "boxes": '[{"bbox": [1]}]'}), 422, "box"),
        (client.create_job(**{**photo, "intrinsics": "1,2"}), 422, "four numbers"),
        (client.create_job(boxes="[]"), 422, "photo"),
        (client.create_job(**{**photo, "profile": "best"}), 422, "profile"),
        (client.get_job(job_id="nobody"), 404, "nobody"),
        (client.get_job(job_id="../etc"), 404, ""),
        (client.get_job(job_id=finished, wait_s=1e9), 422, "wait_s"),
        (client.export_scene(job_id=finished, format_name="dwg"), 404, "dwg"),
        (client.get_picture(job_id=finished, view="sideways"), 422, "sideways"),
        (client.get_picture(job_id=finished, width=10**6), 422, "width"),
        (client.cancel_job(job_id=finished), 409, "over already"),
    ]
    for reply, status, words in cases:
        assert (reply.status, words in reply.body["error"]) == (status, True), reply
        assert "\n" not in reply.body["error"]
    assert send("GET", f"{client.url}/nothing", headers=client.headers).body == {"error": "Not Found"}


def test_other_origins_and_names_are_refused(client: Client) -> None:
    port = client.url.rpartition(":")[2]
    for headers in ({"Origin": "http://evil.example"}, {"Host": f"evil.example:{port}"}):
        reply = send("GET", f"{client.url}/v1/jobs", headers={**client.headers, **headers})
        assert reply.status == 403
        assert reply.body["error"]
    assert send("GET", f"{client.url}/v1/jobs", headers={**client.headers, "Origin": client.url}).status == 200


def test_large_requests_are_refused_before_they_are_read(client: Client) -> None:
    host, port = client.url.removeprefix("http://").split(":")
    head = f"POST /v1/jobs?token={TOKEN} HTTP/1.1\r\nHost: {host}:{port}\r\n"
    head += "Content-Type: multipart/form-data; boundary=x\r\n"
    for line in (f"Content-Length: {MAX_BODY_BYTES + 1}", "Content-Length: many"):
        with socket.create_connection((host, int(port)), timeout=60) as connection:
            connection.sendall(f"{head}{line}\r\n\r\n".encode())
            status = int(connection.recv(1000).split()[1])
        assert status in (400, 413)


def test_a_generated_client_drives_it(
    client: Client, finished: str, photo: dict, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another project's generator makes it of the OpenAPI document."""
    pytest.importorskip("openapi_python_client", reason="needs a generator (extra 'dev')")
    pytest.importorskip("httpx", reason="needs what generated clients need (extra 'dev')")
    generate_client(client.document, tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))

    def module(name: str) -> ModuleType:
        return importlib.import_module(f"room_client.{name}")

    made = module("client").AuthenticatedClient(base_url=client.url, token=TOKEN, timeout=120.0)
    models, types = module("models"), module("types")
    picture = types.File(payload=io.BytesIO(photo["photo"][1]), file_name="my room.png", mime_type="image/png")
    profile = models.BodyCreateJobProfile.EMBEDDED
    body = models.BodyCreateJob(photo=picture, boxes=photo["boxes"], fov_deg=62.0, profile=profile)
    begun = module("api.default.create_job").sync(client=made, body=body)
    assert isinstance(begun, models.JobAnswer), begun
    module("api.default.cancel_job").sync(begun.id, client=made)
    job = module("api.default.get_job").sync(finished, client=made, wait_s=60.0)
    assert (job.state, job.error) == (models.JobAnswerState.DONE, None)
    scene = module("api.default.get_scene").sync(job.id, client=made)
    assert len(scene["objects"]) == job.objects
    file = module("api.default.export_scene").sync(job.id, "glb", client=made)
    assert len(trimesh.load_scene(file.payload, file_type="glb").geometry) >= job.objects
    drawn = module("api.default.get_picture").sync_detailed(job.id, client=made, view="top", width=200, height=100)
    assert Image.open(io.BytesIO(drawn.content)).size == (200, 100)
    project = module("api.default.get_project").sync(job.id, client=made)
    first = project.objects[0].id
    hide = models.SetState(objects=[first], state=models.SetStateState.HIDDEN)
    body = models.EditRequest(version=project.version, edits=[hide], author="Client")
    edited = module("api.default.edit_project").sync(job.id, client=made, body=body)
    assert edited.changed == [first]
    stale = module("api.default.edit_project").sync(job.id, client=made, body=body)
    assert isinstance(stale, models.ErrorAnswer)
    undone = module("api.default.undo_project").sync(job.id, client=made, body=models.StepRequest(author="Client"))
    assert undone.version != edited.version
    missing = module("api.default.get_job").sync("nobody", client=made)
    assert isinstance(missing, models.ErrorAnswer)
    assert "nobody" in missing.error


def generate_client(document: dict, folder: Path) -> None:
    """Put the package `room_client` into a folder."""
    (folder / "openapi.json").write_text(json.dumps(document))
    (folder / "config.yml").write_text("post_hooks: []\n")
    command = [sys.executable, "-m", "openapi_python_client", "generate", "--path", str(folder / "openapi.json")]
    command += ["--output-path", str(folder / "room_client"), "--meta", "none", "--config", str(folder / "config.yml")]
    subprocess.run(command, check=True, capture_output=True, timeout=120)


@pytest.mark.slow
def test_a_running_job_can_be_cancelled(client: Client, photo: dict) -> None:
    job = client.create_job(**{**photo, "recipe": "paper"}).body["id"]
    until(lambda: client.get_job(job_id=job).body["state"] == "running", "it begins", seconds=60)
    assert client.cancel_job(job_id=job).status == 200
    assert client.get_job(job_id=job, wait_s=60).body["state"] == "cancelled"
    assert client.get_scene(job_id=job).status == 404


def test_a_taken_port_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert f"port {port}" in refused(capsys, ["api", "--port", str(port), "--projects", str(tmp_path)])


def test_the_document_says_what_the_api_is(client: Client) -> None:
    assert set(client.operations) == {
        *("create_job", "list_jobs", "get_job", "cancel_job", "delete_job"),
        *("get_scene", "get_picture", "export_scene", "list_formats"),
        *("list_projects", "begin_project", "get_project", "get_object", "get_free_floor", "check_project"),
        *("get_questions", "answer_question"),
        *("edit_project", "undo_project", "redo_project", "optimise_project", "build_project"),
        *("get_project_job", "cancel_project_job", "watch_project", "describe_project"),
        *("get_project_scene", "get_project_picture", "export_project"),
    }
    form = client.document["components"]["schemas"]["Body_create_job"]["properties"]
    files = {
        name
        for name, field in form.items()
        if any(k.get("format") == "binary" for k in (field, *field.get("anyOf", ())))
    }
    assert files == {"photo", "masks", "depth"}, "generators of clients take other strings for text"
    assert json.dumps(client.document).count('"#/components/schemas/ErrorAnswer"') > 20


@pytest.mark.slow
def test_jobs_survive_a_server_that_was_killed(served, projects: Path, tmp_path: Path, photo: dict) -> None:
    """The last one: it ends the server of the others."""
    client, process = served
    if find_spec("pxr") and Path("/proc/self/maps").exists():
        loaded = Path(f"/proc/{process.pid}/maps").read_text()
        assert "/pxr/" in loaded, "an export must not load it beside a build: see `load_quickly`"
    earlier = set(projects.iterdir())
    first, second = (client.create_job(**photo).body["id"] for _ in range(2))
    until(lambda: client.get_job(job_id=first).body["state"] == "running", "the first build begins")
    dropped = client.create_job(**photo).body["id"]
    assert client.cancel_job(job_id=dropped).body["state"] == "cancelled"
    assert client.delete_job(job_id=second).status == 409, "it waits"
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    with running(projects) as (client, _):
        assert client.get_job(job_id=first, wait_s=60).body["state"] == "done"
        cancelled = client.cancel_job(job_id=second).status == 200  # otherwise it is built by now
        assert client.get_job(job_id=second, wait_s=60).body["state"] == ("cancelled" if cancelled else "done")
        assert client.get_job(job_id=dropped).body["state"] == "cancelled"
        assert client.delete_job(job_id=second).status == 204
        assert client.get_job(job_id=second).status == 404
    assert {p.name for p in set(projects.iterdir()) - earlier} == {first, dropped}
    assert main(["export", str(projects / first), "--format", "glb", "-o", str(tmp_path / "room.glb")]) == 0
