from __future__ import annotations

import io
import json
import time
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given

from diorama_core.artefacts import DetectedObject, Inputs, LabelledBox, Photo
from diorama_core.errors import ProjectError
from diorama_core.geometry.rotations import CameraAttitude
from diorama_core.io.text import clean_text
from diorama_core.pipeline import codec
from diorama_core.provenance import DepthSource
from diorama_core.scene.types import Scene
from tests.scene.strategies import scenes


def example_inputs(seed: int = 0) -> Inputs:
    rng = np.random.default_rng(seed)
    photo = Photo(rng.integers(0, 255, (20, 30, 3), dtype=np.uint8), "room.jpg", (30, 20), 25.5)
    depth = rng.random((20, 30), dtype=np.float32)
    return Inputs(photo, (LabelledBox((1, 2, 3.5, 4), "chair", "chairs"),), depth_m=depth)


@given(scenes(max_objects=3))
def test_artefacts_survive_the_file_exactly(scene: Scene) -> None:
    assume(all(clean_text(o.shape_id) == o.shape_id and clean_text(o.label) == o.label for o in scene.objects))
    value = (scene, example_inputs(), ())
    assert codec.load(codec.dump(value)) == value


def test_the_same_artefact_gives_the_same_bytes_at_any_time(monkeypatch: pytest.MonkeyPatch) -> None:
    first = codec.dump(example_inputs())
    monkeypatch.setattr(time, "time", lambda: 2_000_000_000.0)
    assert codec.dump(example_inputs()) == first


def test_masks_keep_their_type() -> None:
    mask = np.zeros((4, 5), dtype=bool)
    mask[1, 2] = True
    item = DetectedObject("chair_1", "chair", "chair", (0, 0, 3, 3), mask, 1, 0.5)
    again = codec.load(codec.dump((item,)))[0]
    assert again == item
    assert again.mask.dtype == bool
    assert not again.mask.flags.writeable


def test_fingerprints_tell_contents_apart() -> None:
    assert codec.fingerprint(example_inputs(0)) == codec.fingerprint(example_inputs(0))
    assert codec.fingerprint(example_inputs(0)) != codec.fingerprint(example_inputs(1))


@pytest.mark.parametrize(
    "data", [b"", b"not a zip", codec.dump(example_inputs())[:100]], ids=["empty", "not a zip", "truncated"]
)
def test_damaged_bytes_are_refused(data: bytes) -> None:
    with pytest.raises(ProjectError, match="damaged"):
        codec.load(data)


def zipped(tree: dict, *arrays: bytes) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr("tree.json", json.dumps(tree))
        for k, array in enumerate(arrays):
            archive.writestr(f"{k}.npy", array)
    return buffer.getvalue()


def test_only_known_classes_are_constructed() -> None:
    with pytest.raises(ProjectError, match="damaged"):
        codec.load(zipped({"class": "Popen", "fields": {"args": "true"}}))


def test_pickled_arrays_are_refused() -> None:
    raw = io.BytesIO()
    np.save(raw, np.array([{"a": 1}], dtype=object), allow_pickle=True)
    with pytest.raises(ProjectError, match="damaged"):
        codec.load(zipped({"array": 0}, raw.getvalue()))


def test_inputs_saved_under_former_names_are_read() -> None:
    """The file was written by the version that called a camera's attitude `Held` and its pitch `tilt_rad`."""
    saved = (Path(__file__).parent / "saved" / "inputs_with_held.zip").read_bytes()
    assert b"Held" in saved
    inputs = codec.load(saved, Inputs)
    assert inputs.camera_attitude == CameraAttitude(pitch_rad=0.25, roll_rad=-0.125)
    assert inputs.camera_height_m == 1.5
    assert inputs.depth_source is DepthSource.NETWORK
    assert inputs.boxes == (LabelledBox((1, 1, 4, 3), "chair", "seat", 0.5),)
    np.testing.assert_array_equal(inputs.photo.rgb.ravel(), np.arange(72))
    assert b"Held" not in codec.dump(inputs)
    assert codec.load(codec.dump(inputs), Inputs) == inputs


def test_a_source_that_no_enum_names_is_refused() -> None:
    tree = {"class": "CameraSource", "fields": {"focal": "hearsay", "attitude": "floor", "heading": "walls"}}
    with pytest.raises(ProjectError, match="damaged"):
        codec.load(zipped(tree))
