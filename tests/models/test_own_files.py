"""Detectors and depth networks that a person brings as files, on small graphs that answer as each family does."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diorama_core.artefacts import Photo
from diorama_core.errors import InputError
from diorama_core.models.own_files import FileDepth, FileDetector
from diorama_core.models.runtime import NetworkError
from diorama_core.perception.foundation.detection import FileDetection
from diorama_core.progress import Progress
from tests.models import small_graphs

RGB = np.full((320, 640, 3), 90, np.uint8)
LABELS = ("person", "sofa", "table")
BOX = (100.0, 80.0, 300.0, 240.0)
"""In the photo, which fills the upper half of the square."""


def detector(folder: Path, outputs: dict[str, np.ndarray], labels: tuple[str, ...] = LABELS) -> FileDetector:
    path = folder / "mine.onnx"
    path.with_suffix(".txt").write_text("\n".join(labels) + "\n")
    values = {name: value.astype(np.float32) for name, value in outputs.items()}
    return FileDetector.of(small_graphs.constants(path, {"images": ("f", 4)}, values))


def v5() -> dict[str, np.ndarray]:
    rows = np.zeros((1, 12, 8))
    rows[0, 3] = [200, 160, 200, 160, 0.9, 0.0, 1.0, 0.1]
    return {"output": rows}


def v8() -> dict[str, np.ndarray]:
    columns = np.zeros((1, 7, 20))
    columns[0, :, 5] = [200, 160, 200, 160, 0.0, 0.9, 0.1]
    return {"output0": columns}


def detr() -> dict[str, np.ndarray]:
    logits, boxes = np.full((1, 6, 4), -4.0), np.full((1, 6, 4), 0.1)
    logits[..., 3] = 6.0  # nothing
    logits[0, 2] = [-4.0, 8.0, -4.0, 0.0]
    boxes[0, 2] = [200 / 640, 160 / 320, 200 / 640, 160 / 320]
    return {"logits": logits, "pred_boxes": boxes}


@pytest.mark.parametrize("answers", [v5(), v8(), detr()], ids=["YOLOv5", "YOLOv8", "DETR"])
def test_outputs_of_each_family_are_recognised_by_their_shapes(tmp_path: Path, answers: dict[str, np.ndarray]) -> None:
    found = detector(tmp_path, answers).detect(RGB, 0.5)
    assert len(found) == 1
    assert found.boxes[0] == pytest.approx(BOX, abs=0.5)
    assert LABELS[found.labels[0]] == "sofa"


def test_labels_that_name_no_kind_are_left_out(tmp_path: Path) -> None:
    answers = v5()
    answers["output"][0, 7] = [500, 160, 80, 160, 0.9, 1.0, 0.0, 0.0]
    boxes = FileDetection(detector(tmp_path, answers)).detect(Photo(RGB, "0" * 64, (640, 320)), (), Progress())
    assert [b.category for b in boxes] == ["sofa"]


def test_another_number_of_labels_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(NetworkError, match=r"12 x 8, which is no YOLO or DETR detector of 2 labels; put its labels"):
        detector(tmp_path, v5(), ("sofa", "table")).detect(RGB, 0.5)
    with pytest.raises(InputError, match="there is no such file"):
        FileDetector.of(tmp_path / "absent.onnx")


def test_the_published_yolox_is_recognised(shared: Path) -> None:
    from diorama_app.projects.example import example_inputs
    from diorama_core.models.yolox import Yolox

    path, rgb = shared / "models" / "yolox_nano.onnx", example_inputs().inputs.photo.rgb
    ours, known = FileDetector.of(path).detect(rgb, 0.3), Yolox(path).detect(rgb, 0.3)
    assert len(ours) == len(known) > 0
    assert ours.boxes == pytest.approx(known.boxes)


def test_depth_in_metres_is_brought_to_the_photo(tmp_path: Path) -> None:
    ramp = np.broadcast_to(np.linspace(1.0, 3.0, 32, dtype=np.float32), (1, 1, 24, 32)).copy()
    network = FileDepth.of(small_graphs.constants(tmp_path / "d.onnx", {"x": ("f", 4)}, {"depth": ramp}))
    seen = network.predict(RGB, None)
    assert seen.depth_m.shape == (320, 640)
    assert seen.depth_m[:, 320].mean() == pytest.approx(2.0, abs=0.05)
    assert (seen.normals_camera[..., 2].mean()) < 0  # toward the camera
    nothing = FileDepth.of(small_graphs.constants(tmp_path / "n.onnx", {"x": ("f", 4)}, {"depth": 0 * ramp}))
    with pytest.raises(NetworkError, match="answers no depth in metres"):
        nothing.predict(RGB, None)
