"""FastDepth's eight-bit file as a graph of real numbers, against the network converted by others; small networks."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import flatbuffers
import numpy as np
import pytest
import tflite

from diorama_core.errors import UnavailableError
from diorama_core.models.fast_depth import SIDE_PX, USUAL_FOCAL, FastDepth
from diorama_core.models.runtime import SessionPool
from diorama_core.models.tflite_graph import onnx_graph
from diorama_core.scene.types import Intrinsics
from tests.conftest import PhotoEntry


@pytest.fixture(scope="module")
def published(shared: Path) -> Path:
    path = shared / "models" / "fast_depth_224_int8.tflite"
    if not path.exists():
        pytest.skip("needs the real network models/fast_depth_224_int8.tflite in the shared folder")
    return path


def small_network(operator: int) -> bytes:
    """A network of one operator on two eight-bit tensors."""
    b = flatbuffers.Builder()

    def vector(start: Callable[..., Any], values: list[int], put: Callable[[int], None]) -> int:
        start(b, len(values))
        for value in reversed(values):
            put(value)
        return int(b.EndVector())

    tensors = []
    for _ in range(2):
        shape = vector(tflite.TensorStartShapeVector, [1, 4, 4, 1], b.PrependInt32)
        tflite.TensorStart(b)
        tflite.TensorAddShape(b, shape)
        tflite.TensorAddType(b, tflite.TensorType.INT8)
        tensors.append(tflite.TensorEnd(b))
    ends = [vector(tflite.OperatorStartInputsVector, [k], b.PrependInt32) for k in (0, 1)]
    tflite.OperatorStart(b)
    tflite.OperatorAddInputs(b, ends[0])
    tflite.OperatorAddOutputs(b, ends[1])
    operators = vector(tflite.SubGraphStartOperatorsVector, [tflite.OperatorEnd(b)], b.PrependUOffsetTRelative)
    listed = vector(tflite.SubGraphStartTensorsVector, tensors, b.PrependUOffsetTRelative)
    tflite.SubGraphStart(b)
    for add, value in zip(
        (tflite.SubGraphAddTensors, tflite.SubGraphAddInputs, tflite.SubGraphAddOutputs, tflite.SubGraphAddOperators),
        (listed, *ends, operators),
        strict=True,
    ):
        add(b, value)
    graphs = vector(tflite.ModelStartSubgraphsVector, [tflite.SubGraphEnd(b)], b.PrependUOffsetTRelative)
    tflite.OperatorCodeStart(b)
    tflite.OperatorCodeAddDeprecatedBuiltinCode(b, operator)
    codes = vector(tflite.ModelStartOperatorCodesVector, [tflite.OperatorCodeEnd(b)], b.PrependUOffsetTRelative)
    tflite.ModelStart(b)
    tflite.ModelAddOperatorCodes(b, codes)
    tflite.ModelAddSubgraphs(b, graphs)
    b.Finish(tflite.ModelEnd(b))
    return bytes(b.Output())


def test_what_changes_no_real_number_is_an_identity(tmp_path: Path) -> None:
    path = tmp_path / "same.onnx"
    path.write_bytes(onnx_graph(small_network(tflite.BuiltinOperator.QUANTIZE)))
    picture = np.random.default_rng(0).random((1, 1, 4, 4)).astype(np.float32)
    np.testing.assert_array_equal(
        SessionPool().get(path).run({"input": picture}, {"output": (1, 1, 4, 4)})["output"], picture
    )


def test_other_operators_are_refused_in_one_line() -> None:
    with pytest.raises(UnavailableError, match=r"operator \(number 25\) that is not supported"):
        onnx_graph(small_network(tflite.BuiltinOperator.SOFTMAX))


def test_the_graph_is_the_published_network(published: Path, shared: Path, tmp_path: Path) -> None:
    ours = tmp_path / "ours.onnx"
    ours.write_bytes(onnx_graph(published.read_bytes()))
    y, x = np.mgrid[:SIDE_PX, :SIDE_PX].astype(np.float32) / SIDE_PX
    picture = np.stack([x, y, 0.5 + 0.5 * np.sin(20 * x * y)])[None].astype(np.float32)
    shape = (1, 1, SIDE_PX, SIDE_PX)
    seen = SessionPool().get(ours).run({"input": picture}, {"output": shape})["output"]
    other = SessionPool().get(shared / "models" / "fastdepth_224.onnx").run({"picture": picture}, {}, gaps=True)
    expected = next(iter(other.values()))
    assert np.median(np.abs(seen / expected - 1)) < 0.01, "others left out the saturation of eight bits"


def test_depth_is_metric_and_goes_with_the_focal_length(published: Path, photos: list[PhotoEntry]) -> None:
    photo = next(p for p in photos if p.id == "nyu_00000")
    network, rgb = FastDepth(published, pool=SessionPool()), photo.inputs.photo.rgb
    usual = network.predict(rgb, None)
    height, width = rgb.shape[:2]
    assert usual.intrinsics.fx == pytest.approx(USUAL_FOCAL * width)
    longer = Intrinsics(width, height, 2 * USUAL_FOCAL * width, 2 * USUAL_FOCAL * width, width / 2, height / 2)
    np.testing.assert_allclose(network.predict(rgb, longer).depth_m, 2 * usual.depth_m, rtol=1e-4)
    true = photo.inputs.depth_m
    assert true is not None
    known = true > 0
    ratio = usual.depth_m[known] / true[known]
    assert 0.7 < np.median(ratio) < 1.4
    assert np.abs(ratio / np.median(ratio) - 1).mean() < 0.2
    assert usual.log_sigma is not None
    assert usual.scale_log_sigma > 0
