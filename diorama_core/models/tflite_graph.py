"""Eight-bit convolutional networks of TensorFlow Lite as ONNX graphs of real numbers.

Weights are multiplied out, and every sum is clipped to what its eight bits hold, in which activations such as ReLU are
contained (Jacob et al., CVPR 2018). Tensors are `[n, c, h, w]` instead of `[n, h, w, c]`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import onnx
import tflite
from onnx import TensorProto, helper, numpy_helper

from diorama_core.errors import UnavailableError

_OPSET, _IR = 17, 8
_CHANNELS_FIRST = (0, 3, 1, 2)


def onnx_graph(network: bytes) -> bytes:
    """A network of one input and one output, both eight-bit, as an ONNX graph of `input` and `output`.

    Raises:
        UnavailableError: when it has operators other than convolutions, sums, padding and enlarging.
    """
    model = tflite.Model.GetRootAsModel(network, 0)
    graph = model.Subgraphs(0)
    converted = _Conversion(model, graph)
    for k in range(graph.OperatorsLength()):
        converted.add(graph.Operators(k))
    first, last = graph.Inputs(0), graph.Outputs(0)
    nodes = [
        helper.make_node("Identity", ["input"], [f"t{first}"]),
        *converted.nodes,
        helper.make_node("Identity", [f"t{last}"], ["output"]),
    ]
    ends = [
        helper.make_tensor_value_info(name, TensorProto.FLOAT, converted.shape(at))
        for name, at in (("input", first), ("output", last))
    ]
    whole = helper.make_graph(nodes, "tflite", ends[:1], ends[1:], converted.constants)
    made = helper.make_model(whole, opset_imports=[helper.make_opsetid("", _OPSET)], ir_version=_IR)
    onnx.checker.check_model(made)
    return made.SerializeToString()


class _Conversion:
    """Nodes and constants of the graph so far; tensor k of the network is `tk`."""

    def __init__(self, model: Any, graph: Any) -> None:
        self._model, self._graph = model, graph
        self.nodes: list[onnx.NodeProto] = []
        self.constants: list[onnx.TensorProto] = []
        self._writers = {
            tflite.BuiltinOperator.QUANTIZE: self._same,
            tflite.BuiltinOperator.PAD: self._pad,
            tflite.BuiltinOperator.CONV_2D: self._convolve,
            tflite.BuiltinOperator.DEPTHWISE_CONV_2D: self._convolve_by_channel,
            tflite.BuiltinOperator.RESIZE_NEAREST_NEIGHBOR: self._enlarge,
            tflite.BuiltinOperator.ADD: self._add,
        }

    def add(self, operator: Any) -> None:
        """Write one operator of the network."""
        code = self._model.OperatorCodes(operator.OpcodeIndex())
        kind = max(code.BuiltinCode(), code.DeprecatedBuiltinCode())
        if kind not in self._writers:
            raise UnavailableError(f"the network has an operator (number {kind}) that is not supported")
        self._writers[kind](operator, [int(t) for t in operator.InputsAsNumpy()], int(operator.Outputs(0)))

    def shape(self, at: int) -> list[int]:
        """The shape of a tensor, channels first."""
        return [int(self._graph.Tensors(at).Shape(axis)) for axis in _CHANNELS_FIRST]

    def _same(self, operator: Any, inputs: list[int], output: int) -> None:
        self._node("Identity", [f"t{inputs[0]}"], f"t{output}")

    def _pad(self, operator: Any, inputs: list[int], output: int) -> None:
        before, after = self._numbers(inputs[1]).reshape(4, 2)[list(_CHANNELS_FIRST)].T
        pads = self._constant(f"c{inputs[1]}_{output}", np.concatenate([before, after]).astype(np.int64))
        self._node("Pad", [f"t{inputs[0]}", pads], f"t{output}")

    def _convolve(self, operator: Any, inputs: list[int], output: int) -> None:
        options = _options(operator, tflite.Conv2DOptions())
        kernel = self._real(inputs[1], axis=0).transpose(0, 3, 1, 2)
        self._convolution(options, kernel, 1, inputs, output)

    def _convolve_by_channel(self, operator: Any, inputs: list[int], output: int) -> None:
        options = _options(operator, tflite.DepthwiseConv2DOptions())
        kernel = self._real(inputs[1], axis=3).transpose(3, 0, 1, 2)
        self._convolution(options, kernel, len(kernel), inputs, output)

    def _convolution(self, options: Any, kernel: np.ndarray, groups: int, inputs: list[int], output: int) -> None:
        """Convolve with real weights (outputs, inputs, height, width) in groups of channels, add the bias and clip."""
        weights = self._constant(f"c{inputs[1]}", kernel.astype(np.float32))
        bias = self._constant(f"c{inputs[2]}", self._real(inputs[2], axis=0).astype(np.float32))
        same = options.Padding() == tflite.Padding.SAME
        how = {"auto_pad": "SAME_UPPER" if same else "VALID", "strides": [options.StrideH(), options.StrideW()]}
        self._node("Conv", [f"t{inputs[0]}", weights, bias], f"s{output}", group=groups, **how)
        self._clip(output)

    def _enlarge(self, operator: Any, inputs: list[int], output: int) -> None:
        sizes = self._constant(f"c{output}_size", np.array(self.shape(output), np.int64))
        how = {"mode": "nearest", "coordinate_transformation_mode": "asymmetric", "nearest_mode": "floor"}
        self._node("Resize", [f"t{inputs[0]}", "", "", sizes], f"t{output}", **how)

    def _add(self, operator: Any, inputs: list[int], output: int) -> None:
        self._node("Add", [f"t{i}" for i in inputs], f"s{output}")
        self._clip(output)

    def _clip(self, output: int) -> None:
        """Clip a sum to what eight bits hold."""
        scale, zero = self._scale(output)
        ends = [self._constant(f"c{output}_{end}", np.float32(scale[0] * (end - zero[0]))) for end in (-128, 127)]
        self._node("Clip", [f"s{output}", *ends], f"t{output}")

    def _node(self, kind: str, inputs: list[str], output: str, **attributes: Any) -> None:
        self.nodes.append(helper.make_node(kind, inputs, [output], **attributes))

    def _constant(self, name: str, value: np.ndarray | np.generic) -> str:
        self.constants.append(numpy_helper.from_array(np.asarray(value), name))
        return name

    def _numbers(self, at: int) -> np.ndarray:
        """The whole numbers that are stored of a tensor."""
        tensor = self._graph.Tensors(at)
        kinds = {tflite.TensorType.INT8: np.int8, tflite.TensorType.INT32: np.int32}
        stored = self._model.Buffers(tensor.Buffer()).DataAsNumpy()
        if tensor.Type() not in kinds or not isinstance(stored, np.ndarray):
            raise UnavailableError("the network's weights are not of eight bits")
        return stored.view(kinds[tensor.Type()]).reshape(tensor.ShapeAsNumpy()).astype(np.int64)

    def _scale(self, at: int) -> tuple[np.ndarray, np.ndarray]:
        """Scales and zeros of a tensor, one or one a channel."""
        quantised = self._graph.Tensors(at).Quantization()
        return np.asarray(quantised.ScaleAsNumpy(), float), np.asarray(quantised.ZeroPointAsNumpy(), float)

    def _real(self, at: int, axis: int) -> np.ndarray:
        """The real numbers that a tensor stands for, scaled along an axis."""
        numbers = self._numbers(at)
        scale, zero = self._scale(at)
        return np.moveaxis((np.moveaxis(numbers, axis, -1) - zero) * scale, -1, axis)


def _options(operator: Any, options: Any) -> Any:
    table = operator.BuiltinOptions()
    options.Init(table.Bytes, table.Pos)
    return options
