"""The public interface, used as a script uses it: `import diorama_core as diorama`."""

from __future__ import annotations

import inspect
import json
import subprocess
import sys
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

import diorama_core as diorama
from diorama_core.artefacts import CameraEstimate, Inputs
from diorama_core.errors import ExportError, InputError, ProjectError
from diorama_core.library.catalogue import built_in_library
from diorama_core.perception.camera.estimate import EmbeddedCamera
from diorama_core.progress import Progress, ProgressEvent
from diorama_core.scene import edits
from tests.cli.room_photo import BOXES, room_picture, write_room

HEAVY = ("numpy", "scipy", "trimesh", "PIL", "pydantic", "torch", "open3d", "onnxruntime", "cv2", "sklearn", "openai")


@pytest.fixture(scope="module")
def room() -> diorama.Reconstruction:
    """A room built in memory from arrays."""
    return diorama.build(room_picture(), boxes=BOXES, profile="embedded")


def test_importing_the_package_loads_nothing_heavy() -> None:
    code = f"import sys, diorama_core; print(*[m for m in {HEAVY!r} if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split() == []


def test_there_are_under_a_dozen_public_names_and_each_is_documented() -> None:
    assert len(diorama.__all__) < 12
    assert set(diorama.__all__) <= set(dir(diorama))
    for name in diorama.__all__:
        assert inspect.getdoc(getattr(diorama, name)), name


@pytest.mark.parametrize("function", [diorama.build, diorama.optimise, diorama.export, diorama.render, diorama.load])
def test_every_argument_is_documented(function: object) -> None:
    assert callable(function)
    documented = inspect.getdoc(function) or ""
    for argument in inspect.signature(function).parameters:
        assert f"\n    {argument}: " in documented, argument


@pytest.mark.parametrize("module", ["diorama_core.export.gltf", "diorama_core.render.picture"])
def test_modules_do_not_replace_the_functions_that_share_their_package_s_name(module: str) -> None:
    name = module.split(".")[1]
    code = f"import {module}, diorama_core as d; from {module} import __doc__; print(callable(d.{name}))"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "True\n"


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'reconstruct'"):
        diorama.reconstruct  # noqa: B018


def test_arrays_and_files_give_the_same_scene(room: diorama.Reconstruction, tmp_path: Path) -> None:
    photo, boxes = write_room(tmp_path)
    built = diorama.build(str(photo), boxes=boxes, profile="embedded", output=tmp_path / "room")
    assert built.scene == room.scene
    assert diorama.load(tmp_path / "room").scene == built.scene


def test_saving_and_loading_give_the_same_room(room: diorama.Reconstruction, tmp_path: Path) -> None:
    room.save(tmp_path / "room")
    again = diorama.load(tmp_path / "room")
    assert again.scene == room.scene
    assert again.textures.keys() == room.textures.keys()
    assert again.library_name == "built-in"
    assert again.inputs is not None
    assert room.inputs is not None
    assert np.array_equal(again.inputs.photo.rgb, room.inputs.photo.rgb)
    stages = json.loads((tmp_path / "room" / "project.json").read_text())["stages"]
    assert {s["stage"] for s in stages} >= {"camera", "pose", "layout"}


def test_a_loaded_room_is_saved_where_it_came_from_and_elsewhere(room: diorama.Reconstruction, tmp_path: Path) -> None:
    room.save(tmp_path / "first")
    loaded = diorama.load(tmp_path / "first")
    emptier = replace(loaded, scene=edits.remove(loaded.scene, [loaded.scene.objects[0].id]))
    textures = {p.name: p.read_bytes() for p in (tmp_path / "first" / "textures").iterdir()}
    emptier.save(tmp_path / "first")
    emptier.save(tmp_path / "second")
    assert diorama.load(tmp_path / "first").scene == emptier.scene
    assert {p.name: p.read_bytes() for p in (tmp_path / "first" / "textures").iterdir()} == textures
    second = diorama.load(tmp_path / "second")
    assert second.scene == emptier.scene
    assert second.inputs is not None
    assert second.textures.keys() == loaded.textures.keys()


def test_saving_over_other_files_is_refused(room: diorama.Reconstruction, tmp_path: Path) -> None:
    (tmp_path / "letter.txt").write_text("dear")
    with pytest.raises(ProjectError, match="holds other files"):
        room.save(tmp_path)


def test_one_stage_can_be_replaced(room: diorama.Reconstruction) -> None:
    @dataclass(frozen=True)
    class Wider:
        """The embedded camera with a shorter focal length."""

        def estimate(self, inputs: Inputs, progress: Progress) -> CameraEstimate:
            found = EmbeddedCamera().estimate(inputs, progress)
            k = found.best.intrinsics
            best = replace(found.best, intrinsics=replace(k, fx=0.8 * k.fx, fy=0.8 * k.fy))
            return replace(found, hypotheses=(best,))

    wider = diorama.build(
        room_picture(), boxes=BOXES, profile="embedded", stages=lambda stages: replace(stages, camera=Wider())
    )
    assert wider.scene.camera is not None
    assert room.scene.camera is not None
    assert wider.scene.camera.intrinsics.fx == pytest.approx(0.8 * room.scene.camera.intrinsics.fx)


def test_optimising_reports_costs_and_leaves_the_original(room: diorama.Reconstruction) -> None:
    before = room.scene
    optimised = diorama.optimise(room, recipe="feasible")
    assert optimised.layout is not None
    assert optimised.layout.after["overlapping_pairs"] == 0
    assert dict(optimised.scene.metrics) == pytest.approx(optimised.layout.after)
    assert room.scene is before
    with pytest.raises(InputError, match="feasible, paper, all-in-one"):
        diorama.optimise(room, recipe="magic")


def test_export_takes_the_format_from_the_name(room: diorama.Reconstruction, tmp_path: Path) -> None:
    diorama.export(room, tmp_path / "room.GLB")
    diorama.export(room, tmp_path / "room.xml")
    assert "<mujoco" in (tmp_path / "room.xml").read_text()
    assert len(trimesh.load_scene(tmp_path / "room.GLB", file_type="glb").geometry) >= len(room.scene.objects)
    with pytest.raises(ExportError, match=r"files end in \.stl"):
        diorama.export(room, tmp_path / "room.glb", format="stl")
    with pytest.raises(ExportError, match="choose one of: glb"):
        diorama.export(room, tmp_path / "room.doc")


@pytest.mark.parametrize("view", ["photo", "planes", "top"])
def test_render_draws_a_picture_of_the_asked_size(room: diorama.Reconstruction, view: str) -> None:
    picture = diorama.render(room, view=view, size=(160, 120))
    assert picture.shape == (120, 160, 3)
    assert picture.dtype == np.uint8
    assert picture.std() > 5


def test_planes_need_a_photo(room: diorama.Reconstruction) -> None:
    with pytest.raises(InputError, match="no photo"):
        diorama.render(replace(room, given=None), view="planes")


def test_remarks_reach_the_caller_and_are_recorded() -> None:
    said: list[str] = []
    odd = [*BOXES, {"bbox": [250, 20, 400, 140], "class": "floor lamp"}]
    built = diorama.build(room_picture(), boxes=odd, profile="embedded", warn=said.append)
    assert said
    assert tuple(said) == built.warnings


def test_progress_is_reported_and_a_library_can_be_given() -> None:
    events: list[ProgressEvent] = []
    built = diorama.build(room_picture(), library=built_in_library(), progress=Progress(events.append))
    assert events[-1].fraction == pytest.approx(1.0)
    assert [e.fraction for e in events] == sorted(e.fraction for e in events)
    assert built.library_name is None
