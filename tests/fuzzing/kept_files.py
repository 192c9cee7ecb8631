"""What a project of several photos keeps beside its scene: further photos, and where the program put everything."""

from __future__ import annotations

import json
import tempfile
from functools import cache
from pathlib import Path

from diorama_core.artefacts import FurtherPhoto, Inputs
from diorama_core.errors import ProjectError
from diorama_core.pipeline import codec
from diorama_core.project.further_photos import load_photos, note_placed, save_photos, still_made, still_placed
from diorama_core.project.plan_picture import load_plan_picture
from diorama_core.project.storage import Project
from tests.app.small_room import make_project, photo_camera, plain_photo

PLACES = ("placed.json", "looks.json")


@cache
def _project() -> Project:
    project = make_project(Path(tempfile.mkdtemp(prefix="fuzz-")) / "demo")
    project.update_info(photos=["other"])
    note_placed(project, project.load_scene())
    return project


def further_samples() -> tuple[bytes, ...]:
    seen = (("table_1", (1.0, 2.0, 30.0, 40.0)),)
    return (codec.dump(FurtherPhoto("other", Inputs(plain_photo(48, 36)), photo_camera(), seen)),)


def read_further(data: bytes) -> object:
    """What is read is kept again where it was, and nothing elsewhere."""
    project = _project()
    (project.folder / "photos").mkdir(exist_ok=True)
    (project.folder / "photos" / "other.zip").write_bytes(data)
    found, damage = load_photos(project)
    if damage:
        raise ProjectError(damage[0])  # the line that a person reads
    save_photos(project, found)
    assert project.info()["photos"] == ["other"], "a photo with the name of another file"
    return found


def placed_samples() -> tuple[bytes, ...]:
    project = _project()
    rows = {name: json.loads((project.stages_folder / name).read_text()) for name in PLACES}
    picture = {"size": [800, 600], "at": [1.0, 2.0], "metres": 0.01}
    return (json.dumps({**rows, "info": {"plan_picture": picture, "photos": ["other"]}}).encode(),)


def read_placed(data: bytes) -> object:
    """Whatever these files hold, a build can note anew where it put everything."""
    project = _project()
    rows = _json_in(data)
    rows = rows if isinstance(rows, dict) else {}
    for name in PLACES:
        (project.stages_folder / name).write_bytes(json.dumps(rows.get(name)).encode() if rows else data)
    (project.folder / "plan.jpg").write_bytes(b"a picture")
    info = project.folder / "project.json"
    good = info.read_bytes()
    try:
        info.write_text(json.dumps({**json.loads(good), **_table(rows.get("info"))}))
        below, further = load_plan_picture(project), load_photos(project)
    finally:
        info.write_bytes(good)
    scene = project.load_scene()
    placed = still_placed(project, scene), still_made(project, scene)
    note_placed(project, scene)
    assert still_placed(project, scene) >= {o.id for o in scene.objects}, "what was noted is not found"
    return placed, below, further


def _json_in(data: bytes) -> object:
    try:
        return json.loads(data)
    except (ValueError, RecursionError):
        return None


def _table(value: object) -> dict:
    return value if isinstance(value, dict) else {}
