"""Blender files, opened by Blender again."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from diorama_core.errors import Cancelled, UnavailableError
from diorama_core.export import FORMATS, blender, export_scene
from diorama_core.export.blend import EVEN_SHARE
from diorama_core.export.blender import PYTHON_VARIABLE, blender_python, missing_blender, run_in_blender
from diorama_core.progress import CancelToken, Progress
from tests.export.scenes import scene_of

needs_blender = pytest.mark.skipif(bool(missing_blender()), reason=missing_blender())


@needs_blender
@pytest.mark.slow
def test_blender_finds_every_object_where_it_was(tmp_path: Path) -> None:
    scene, library = scene_of("fittings")
    photo = np.full((90, 120, 3), 120, np.uint8)
    gathered = export_scene(scene, library, tmp_path / "room.blend", "blend", photo=photo)
    command = [blender_python(), str(Path(__file__).with_name("blend_reader.py")), str(tmp_path / "room.blend")]
    output = subprocess.run(command, capture_output=True, text=True, check=True, timeout=300).stdout
    found = json.loads(next(line for line in output.splitlines() if line.startswith("FOUND "))[6:])
    assert {v["id"] for v in found["objects"].values()} == {o.id for o in gathered.objects}
    assert set(found["objects"]) == {o.name for o in gathered.objects}
    for item in gathered.objects:
        points = np.array(found["objects"][item.name]["corners"])
        expected = item.item.corners_world
        np.testing.assert_allclose(points.min(axis=0), expected.min(axis=0), atol=1e-3)
        np.testing.assert_allclose(points.max(axis=0), expected.max(axis=0), atol=1e-3)
    assert found["materials"] == sorted(m.name for m in gathered.materials)
    assert len(found["planes"]) == len(gathered.planes)
    assert gathered.even_light is not None
    assert found["lights"] == len(gathered.lights) + (gathered.main_light is not None)
    assert found["around"] == pytest.approx(EVEN_SHARE * gathered.even_light.lux / np.pi)
    assert set(found["collections"]) == {"Architecture", "Objects", "Lights", "Camera"}
    assert found["photo"]
    assert found["unpacked"] == []
    assert scene.camera is not None
    np.testing.assert_allclose(np.array(found["camera"])[:3, 3], scene.camera.position, atol=1e-5)
    assert list(tmp_path.iterdir()) == [tmp_path / "room.blend"]


def test_what_is_missing_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(PYTHON_VARIABLE, "/nowhere/python")
    assert "/nowhere/python" in FORMATS["blend"].missing
    monkeypatch.delenv(PYTHON_VARIABLE)
    monkeypatch.setattr(blender, "find_spec", lambda name: None)
    assert PYTHON_VARIABLE in FORMATS["blend"].missing
    with pytest.raises(UnavailableError, match=PYTHON_VARIABLE):
        FORMATS["blend"].writer()


@pytest.fixture
def python(monkeypatch: pytest.MonkeyPatch) -> None:
    """Workers run in this Python: they need no Blender here."""
    monkeypatch.setenv(PYTHON_VARIABLE, sys.executable)


@pytest.mark.usefixtures("python")
def test_workers_report_fail_and_are_stopped(tmp_path: Path) -> None:
    worker = tmp_path / "worker.py"
    worker.write_text("import json, sys; print('diorama 0.5', json.load(open(sys.argv[1]))['word'], flush=True)")
    events = []
    run_in_blender(worker, {"word": "half"}, name="Blender", progress=Progress(events.append))
    assert [(e.fraction, e.message) for e in events] == [(0.5, "half")]

    worker.write_text("raise ValueError('no such room')")
    with pytest.raises(UnavailableError, match=r"Blender failed: .*no such room"):
        run_in_blender(worker, {}, name="Blender")

    worker.write_text("import time; print('diorama 0.1 begun', flush=True); time.sleep(60)")
    token = CancelToken()
    with pytest.raises(Cancelled):
        run_in_blender(worker, {}, name="Blender", progress=Progress(lambda event: token.cancel(), token))
    with pytest.raises(UnavailableError, match="took more than"):
        run_in_blender(worker, {}, name="Blender", timeout_s=0.5)
