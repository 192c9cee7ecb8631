"""Small ONNX graphs with any inputs and outputs, written node by node."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

TYPES = {"f": TensorProto.FLOAT, "i": TensorProto.INT64, "u": TensorProto.UINT8}
HQ_SAM = {
    "image_embeddings": ("f", 4),
    "interm_embeddings": ("f", 5),
    "point_coords": ("f", 3),
    "point_labels": ("f", 2),
    "mask_input": ("f", 4),
    "has_mask_input": ("f", 1),
    "orig_im_size": ("f", 1),
}
"""Inputs of HQ-SAM's decoder: kinds of number and numbers of dimensions."""
HUGE = 1 << 44
"""Elements that exceed any address space once they are multiplied by a picture's dimensions."""


def constants(path: Path, inputs: Mapping[str, tuple[str, int]], outputs: Mapping[str, np.ndarray]) -> Path:
    """Answers the same whatever it is given.

    Args:
        path: Of the file.
        inputs: Kind of number (`TYPES`) and number of dimensions, which may have any size.
        outputs: What it answers.
    """
    nodes = [
        helper.make_node("Constant", [], [name], value=numpy_helper.from_array(value))
        for name, value in outputs.items()
    ]
    return _written(path, inputs, list(outputs), nodes)


def failing(path: Path, inputs: Mapping[str, tuple[str, int]], output: str) -> Path:
    """Fails when it is run: a picture cannot be reshaped to seven numbers."""
    name = next(n for n, (kind, _) in inputs.items())
    nodes = [
        helper.make_node("Constant", [], ["seven"], value=numpy_helper.from_array(np.array([7], np.int64))),
        helper.make_node("Reshape", [name, "seven"], [output]),
    ]
    return _written(path, inputs, [output], nodes)


def greedy(path: Path, inputs: Mapping[str, tuple[str, int]], output: str) -> Path:
    """Asks for more memory than any machine has when it is run."""
    name = next(iter(inputs))
    nodes = [
        helper.make_node("Constant", [], ["huge"], value=numpy_helper.from_array(np.array([HUGE], np.int64))),
        helper.make_node("Shape", [name], ["dims"]),
        helper.make_node("ReduceSum", ["dims"], ["sum"], keepdims=0),
        helper.make_node("Mul", ["sum", "huge"], ["count"]),
        helper.make_node("ConstantOfShape", ["count"], [output]),
    ]
    return _written(path, inputs, [output], nodes)


def _written(path: Path, inputs: Mapping[str, tuple[str, int]], outputs: list[str], nodes: list) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    graph = helper.make_graph(
        nodes,
        "small",
        [helper.make_tensor_value_info(n, TYPES[k], [f"{n}_{i}" for i in range(d)]) for n, (k, d) in inputs.items()],
        [helper.make_tensor_value_info(n, TensorProto.FLOAT, None) for n in outputs],
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
    onnx.save(model, str(path))
    return path
