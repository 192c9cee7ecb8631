from __future__ import annotations

from pathlib import Path

import numpy as np
import onnxruntime
import torch

from diorama_core.models.onnx_export import write_graph


def test_a_graph_answers_as_its_network_for_any_number_of_rows(tmp_path: Path) -> None:
    network = torch.nn.Sequential(torch.nn.Linear(3, 4), torch.nn.Dropout(0.5))
    axes = {"rows": {0: "n"}, "scores": {0: "n"}}
    path = write_graph(
        network, (torch.zeros(1, 3),), tmp_path / "a" / "b.onnx", inputs=["rows"], outputs=["scores"], dynamic=axes
    )
    assert not network.training
    rows = np.random.default_rng(0).standard_normal((5, 3), dtype=np.float32)
    (scores,) = onnxruntime.InferenceSession(str(path)).run(None, {"rows": rows})
    with torch.no_grad():
        np.testing.assert_allclose(scores, network(torch.tensor(rows)).numpy(), atol=1e-6)


def test_half_weights_halve_the_file_and_hardly_change_the_answers(tmp_path: Path) -> None:
    torch.manual_seed(1)
    network = torch.nn.Sequential(torch.nn.Linear(64, 256), torch.nn.SiLU(), torch.nn.Linear(256, 5))
    rows = np.random.default_rng(0).standard_normal((7, 64), dtype=np.float32)
    sizes, answers = [], []
    for half in (False, True):
        path = tmp_path / f"{half}.onnx"
        write_graph(network, (torch.zeros(7, 64),), path, inputs=["rows"], outputs=["scores"], half_weights=half)
        sizes.append(path.stat().st_size)
        answers.append(onnxruntime.InferenceSession(str(path)).run(None, {"rows": rows})[0])
    assert sizes[1] < 0.56 * sizes[0]
    np.testing.assert_allclose(answers[1], answers[0], atol=5e-3)
    assert answers[1].dtype == np.float32
