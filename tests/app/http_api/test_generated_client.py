"""A client that another project's generator makes of the OpenAPI document drives the real server."""

from __future__ import annotations

import importlib
import io
import json
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest
import trimesh
from PIL import Image

pytest.importorskip("fastapi", reason="needs FastAPI (pip install 'diorama[api]')")
pytest.importorskip("uvicorn", reason="needs uvicorn (pip install 'diorama[api]')")
pytest.importorskip("openapi_python_client", reason="needs a generator (extra 'dev')")
pytest.importorskip("httpx", reason="needs what generated clients need (extra 'dev')")

from tests.app.http_api.openapi_client import send  # after the check for its libraries
from tests.app.http_api.test_server import running
from tests.cli.room_photo import write_room

pytestmark = pytest.mark.posix


def generated(url: str, folder: Path) -> Path:
    """The package of a client for the server."""
    (folder / "openapi.json").write_text(json.dumps(send("GET", f"{url}openapi.json").body))
    (folder / "config.yml").write_text("post_hooks: []\n")
    package = folder / "room_client"
    command = [sys.executable, "-m", "openapi_python_client", "generate", "--path", str(folder / "openapi.json")]
    command += ["--output-path", str(package), "--meta", "none", "--config", str(folder / "config.yml")]
    subprocess.run(command, check=True, capture_output=True, timeout=120)
    return package


@pytest.mark.slow
def test_a_photo_becomes_a_scene_and_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    image, boxes = write_room(tmp_path, marked=1)
    with running(tmp_path / "projects") as (url, _):
        generated(url, tmp_path)
        monkeypatch.syspath_prepend(str(tmp_path))

        def module(name: str) -> ModuleType:
            return importlib.import_module(f"room_client.{name}")

        client = module("client").Client(base_url=url, timeout=120.0)
        models, types = module("models"), module("types")
        photo = types.File(payload=io.BytesIO(image.read_bytes()), file_name="my room.png", mime_type="image/png")
        body = models.BodyCreateJob(
            photo=photo, boxes=boxes.read_text(), fov_deg=62.0, profile=models.BodyCreateJobProfile.EMBEDDED
        )
        job = module("api.default.create_job").sync(client=client, body=body)
        assert isinstance(job, models.JobAnswer), job
        for _ in range(5):  # a busy machine takes some minutes
            job = module("api.default.get_job").sync(job.id, client=client, wait_s=60.0)
            if job.state not in (models.JobAnswerState.QUEUED, models.JobAnswerState.RUNNING):
                break
        assert (job.state, job.error) == (models.JobAnswerState.DONE, None)
        scene = module("api.default.get_scene").sync(job.id, client=client)
        assert len(scene["objects"]) == job.objects
        file = module("api.default.export_scene").sync(job.id, "glb", client=client)
        assert len(trimesh.load_scene(file.payload, file_type="glb").geometry) >= job.objects
        picture = module("api.default.get_picture").sync_detailed(
            job.id, client=client, view="top", width=200, height=100
        )
        assert Image.open(io.BytesIO(picture.content)).size == (200, 100)
        project = module("api.default.get_project").sync(job.id, client=client)
        first = project.objects[0].id
        hide = models.SetState(objects=[first], state=models.SetStateState.HIDDEN)
        body = models.EditRequest(version=project.version, edits=[hide], author="Client")
        edited = module("api.default.edit_project").sync(job.id, client=client, body=body)
        assert edited.changed == [first]
        stale = module("api.default.edit_project").sync(job.id, client=client, body=body)
        assert isinstance(stale, models.ErrorAnswer)
        undone = module("api.default.undo_project").sync(
            job.id, client=client, body=models.StepRequest(author="Client")
        )
        assert undone.version != edited.version
        missing = module("api.default.get_job").sync("nobody", client=client)
        assert isinstance(missing, models.ErrorAnswer)
        assert "nobody" in missing.error
