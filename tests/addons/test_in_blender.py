"""The add-on in the real Blender, beside a real editor."""

from __future__ import annotations

import json
import os
import subprocess
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("fastapi", reason="needs FastAPI (pip install 'diorama[api]')")
pytest.importorskip("uvicorn", reason="needs uvicorn (pip install 'diorama[api]')")

from diorama_app.http_api import beside  # after the check for its libraries
from diorama_app.http_api.beside import api_beside
from diorama_app.serve import Running
from diorama_core.export.blender import blender_python, missing_blender
from diorama_core.scene.edits import set_hidden
from diorama_core.scene.types import Scene
from tests.app.people import join

ADDON = Path(__file__).parents[2] / "addons" / "blender"
TOKEN = "secret"
pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(missing_blender()), reason=missing_blender())]


@dataclass
class Blender:
    """A process that does what it is told."""

    process: subprocess.Popen[str]

    def do(self, code: str) -> Any:
        """Run code; gives its `answer`, or the error of an operator as its line."""
        assert self.process.stdin is not None
        self.process.stdin.write(json.dumps(code) + "\n")
        self.process.stdin.flush()
        return json.loads(self._until("ANSWER "))

    def ready(self) -> None:
        """Wait for its start."""
        self._until("READY")

    def _until(self, word: str) -> str:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            if line.startswith(word):
                return line.removeprefix(word)
        raise AssertionError("Blender has ended")


@pytest.fixture(scope="module")
def blender(running: Running, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Blender]:
    """Blender with the add-on installed from an archive, as a person does it, in a home of its own."""
    home = tmp_path_factory.mktemp("home")
    archive = home / "diorama.zip"
    with zipfile.ZipFile(archive, "w") as file:
        for path in [*ADDON.glob("*.py"), ADDON / "blender_manifest.toml"]:
            file.write(path, path.name)
    environment = {**os.environ, "BLENDER_USER_RESOURCES": str(home / "blender"), "XDG_STATE_HOME": str(home)}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(beside, "_folder", lambda: home / "diorama" / "servers")
        with api_beside(running, TOKEN):
            command = [blender_python(), "-P", str(Path(__file__).with_name("in_blender.py")), str(archive)]
            pipe = subprocess.PIPE
            process = subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True, env=environment)
            made = Blender(process)
            made.ready()
            yield made
            process.kill()
            process.communicate()


@pytest.fixture
def opened(running: Running, blender: Blender) -> Scene:
    """The room as it is when Blender has opened it."""
    assert blender.do("bpy.ops.diorama.list_rooms(); bpy.ops.diorama.open_room()") is None
    return running.session.scene


def test_objects_are_where_they_were_under_what_holds_them(blender: Blender, opened: Scene) -> None:
    ids = blender.do("answer = sorted(o['diorama_id'] for o in bpy.context.scene.objects if 'diorama_id' in o)")
    assert ids == sorted(o.id for o in opened.objects)
    for item in opened.objects:
        found = np.array(blender.do(f"answer = corners('{item.id}')"))
        np.testing.assert_allclose(found.min(axis=0), item.corners_world.min(axis=0), atol=1e-4)
        np.testing.assert_allclose(found.max(axis=0), item.corners_world.max(axis=0), atol=1e-4)
        matrix = blender.do(f"answer = [list(row) for row in item('{item.id}').matrix_world]")
        np.testing.assert_allclose(matrix, item.pose.matrix, atol=1e-5)
    parents = [blender.do(f"p = item('{i}').parent; answer = p and p['diorama_id']") for i in ids]
    assert parents == ["table_1" if i == "lamp_1" else None for i in ids]
    planes = "answer = sorted(o['diorama_plane'] for o in bpy.context.scene.objects if 'diorama_plane' in o)"
    assert blender.do(planes) == sorted(p.id for p in opened.architecture.planes)
    assert blender.do("answer = [o.name for o in bpy.data.objects if o.type == 'EMPTY']") == []
    camera = blender.do("answer = list(bpy.context.scene.camera.matrix_world.translation)")
    assert opened.camera is not None
    np.testing.assert_allclose(camera, opened.camera.position, atol=1e-5)
    k = opened.camera.intrinsics
    size = "r = bpy.context.scene.render; answer = [r.resolution_x, r.resolution_y]"
    assert blender.do(size) == [k.width, k.height]


def test_a_room_that_is_opened_again_leaves_nothing_behind(blender: Blender, opened: Scene) -> None:
    kinds = "('objects', 'meshes', 'materials', 'images', 'lights', 'cameras', 'collections')"
    count = f"answer = [len(getattr(bpy.data, k)) for k in {kinds}]"
    before = blender.do(count)
    assert blender.do("bpy.ops.diorama.open_room()") is None
    assert blender.do(count) == before
    filled = "answer = [c.name for c in bpy.data.collections if c.objects]"
    assert blender.do(filled) == ["Diorama demo"]


def test_what_was_done_is_one_step_that_the_editor_takes_back(
    running: Running, blender: Blender, opened: Scene
) -> None:
    session = running.session
    assert blender.do("item('table_1').location.x += 0.5; item('table_1').rotation_euler.z += 0.3") is None
    assert blender.do("item('chair_1').scale.z *= 1.2") is None
    assert blender.do("bpy.data.objects.remove(item('chair_2'))") is None
    expected = np.array(
        blender.do("answer = [list(row) for row in (corners('lamp_1'), item('lamp_1'))[1].matrix_world]")
    )
    assert blender.do("bpy.ops.diorama.send_changes()") is None
    after = session.scene
    assert {o.id for o in opened.objects} - {o.id for o in after.objects} == {"chair_2"}
    table = after.object("table_1").pose
    np.testing.assert_allclose(table.position - opened.object("table_1").pose.position, [0.5, 0, 0], atol=1e-5)
    assert table.yaw_rad - opened.object("table_1").pose.yaw_rad == pytest.approx(0.3, abs=1e-5)
    np.testing.assert_allclose(after.object("lamp_1").pose.matrix, expected, atol=1e-4)
    np.testing.assert_allclose(after.object("chair_1").size_m, opened.object("chair_1").size_m * [1, 1, 1.2], atol=1e-5)
    assert after.object("picture_1") == opened.object("picture_1")
    assert after.supports == tuple(s for s in opened.supports if s.child != "chair_2")
    person = session.ui_thread.ask(lambda: join(session))
    session.ui_thread.ask(lambda: session.undo(person))
    assert session.scene == opened
    session.ui_thread.ask(lambda: session.leave(person.viser_client))


def test_a_change_by_others_is_taken_over_and_one_s_own_stays(
    running: Running, blender: Blender, opened: Scene
) -> None:
    session = running.session
    blender.do("item('chair_1').location.x += 0.25; bpy.data.objects.remove(item('picture_1'))")
    session.ui_thread.ask(lambda: session.edit("hide", lambda s: set_hidden(s, "chair_2", True), author="Ann"))
    refused = blender.do("bpy.ops.diorama.send_changes()")["error"]
    assert refused.startswith("Error: press Reload (what you changed stays), look, and send again: ")
    assert "by Ann" in refused
    assert "\n" not in refused
    assert blender.do("bpy.ops.diorama.reload_room()") is None
    ids = blender.do("answer = sorted(o['diorama_id'] for o in bpy.context.scene.objects if 'diorama_id' in o)")
    assert ids == ["chair_1", "lamp_1", "table_1"], "names are not numbered, what is deleted or hidden is away"
    assert blender.do("bpy.ops.diorama.send_changes()") is None
    after = session.scene
    moved = after.object("chair_1").pose.position - opened.object("chair_1").pose.position
    np.testing.assert_allclose(moved, [0.25, 0, 0], atol=1e-5)
    assert after.has_object("chair_2"), "what is hidden was not deleted"
    assert not after.has_object("picture_1")


def test_what_cannot_be_sent_is_one_line(blender: Blender, opened: Scene) -> None:
    assert blender.do("bpy.ops.diorama.send_changes()") is None, "nothing has changed"
    blender.do("item('lamp_1').scale.x *= -1")
    assert "is mirrored" in blender.do("bpy.ops.diorama.send_changes()")["error"]
    blender.do("copy = item('lamp_1').copy(); bpy.context.scene.collection.objects.link(copy)")
    assert "are the same object" in blender.do("bpy.ops.diorama.send_changes()")["error"]
    blender.do("bpy.data.objects.remove(copy); bpy.context.window_manager.diorama_address = 'http://127.0.0.1:9'")
    assert "no editor answers at http://127.0.0.1:9" in blender.do("bpy.ops.diorama.open_room()")["error"]
    blender.do("bpy.context.window_manager.diorama_address = ''")


def test_blender_finds_no_fault_with_the_manifest() -> None:
    code = "import bpy; print(bpy.utils.system_resource('SCRIPTS'))"
    told = subprocess.run([blender_python(), "-c", code], capture_output=True, text=True, check=True).stdout
    tool = Path(told.strip().splitlines()[-1]) / "addons_core" / "bl_pkg" / "cli" / "blender_ext.py"
    checked = subprocess.run([blender_python(), str(tool), "validate", str(ADDON)], capture_output=True, text=True)
    assert checked.returncode == 0, checked.stdout + checked.stderr
