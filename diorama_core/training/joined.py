"""Several namers as one graph that tells the mean of their probabilities: what they get wrong differs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import onnx
from onnx import NodeProto, TensorProto, compose, helper, numpy_helper

from diorama_core.io.atomic import write_atomically
from diorama_core.library.form import MEASURED, VALUES

_INPUTS, _OUTPUTS = ("crops", "geometry"), ("kinds", "forms")
_TINY = 1e-7
"""Added to every probability before its logarithm."""


def join_namers(paths: Sequence[Path], output: Path) -> None:
    """Write one graph with the inputs and outputs of a namer (`training.naming`), made of several.

    Its logits are the logarithms of the mean probabilities of kinds and of the values of every attribute of form.

    Args:
        paths: graphs written by `export_namer`, of the same categories.
        output: where the joined graph goes.
    """
    graphs = [onnx.load(path) for path in paths]
    nodes: list[NodeProto] = []
    values = [_array(np.array([len(VALUES[name]) for name in MEASURED], np.int64), "sizes")]
    values += [_array(np.array(1 / len(graphs), np.float32), "share"), _array(np.array(_TINY, np.float32), "tiny")]
    for k, graph in enumerate(graphs):
        own = compose.add_prefix(graph, f"{k}_").graph
        for node in own.node:
            node.input[:] = [name.removeprefix(f"{k}_") if name in _prefixed(k) else name for name in node.input]
        nodes += [*own.node, *_probabilities(k)]
        values += own.initializer
    for name in _OUTPUTS:
        nodes += [
            helper.make_node("Sum", [f"{k}_{name}_probability" for k in range(len(graphs))], [f"{name}_sum"]),
            helper.make_node("Mul", [f"{name}_sum", "share"], [f"{name}_mean"]),
            helper.make_node("Add", [f"{name}_mean", "tiny"], [f"{name}_positive"]),
            helper.make_node("Log", [f"{name}_positive"], [name]),
        ]
    first = graphs[0]
    whole = helper.make_graph(nodes, "namers", list(first.graph.input), list(first.graph.output), values)
    model = helper.make_model(whole, opset_imports=first.opset_import, ir_version=first.ir_version)
    onnx.checker.check_model(model)
    write_atomically(output, model.SerializeToString())


def _prefixed(k: int) -> tuple[str, ...]:
    return tuple(f"{k}_{name}" for name in _INPUTS)


def _probabilities(k: int) -> list[NodeProto]:
    """From the logits of one namer: all kinds together, each attribute of form for itself."""
    parts = [f"{k}_{name}" for name in MEASURED]
    return [
        helper.make_node("Softmax", [f"{k}_kinds"], [f"{k}_kinds_probability"], axis=1),
        helper.make_node("Split", [f"{k}_forms", "sizes"], parts, axis=1),
        *(helper.make_node("Softmax", [part], [f"{part}_probability"], axis=1) for part in parts),
        helper.make_node("Concat", [f"{part}_probability" for part in parts], [f"{k}_forms_probability"], axis=1),
    ]


def _array(value: np.ndarray, name: str) -> TensorProto:
    return numpy_helper.from_array(value, name)
