"""Trained networks as ONNX graphs with the names of their outputs; scores on annotated photos."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import onnx
import torch
from onnx import ModelProto, NodeProto, compose, helper, numpy_helper
from torch import nn

from diorama_core.errors import InputError
from diorama_core.evaluation.benchmarks.recognition import BEST, RecognitionBench, run
from diorama_core.io.atomic import write_atomically
from diorama_core.library.form import MEASURED, VALUES
from diorama_core.models.efficientnet import MAP_CHANNELS
from diorama_core.models.images import CROP_SIDE
from diorama_core.models.onnx_export import write_graph
from diorama_core.models.outliner import SIDE
from diorama_core.models.recogniser import Recogniser
from diorama_core.perception.foundation.proposals import OwnDetection, names_of

_INPUTS, _OUTPUTS = ("crops", "geometry"), ("kinds", "forms")
_TINY = 1e-7
"""Added to every probability before its logarithm."""


def export_detector(network: nn.Module, path: Path) -> None:
    """Write the detector; pictures of any size that 32 divides."""
    dynamic = {"pictures": {0: "b", 2: "h", 3: "w"}, "rows": {0: "b", 1: "n"}}
    example = (torch.zeros(1, 3, 256, 320),)
    write_graph(network, example, path, inputs=["pictures"], outputs=["rows"], dynamic=dynamic, half_weights=True)


def export_namer(network: nn.Module, path: Path) -> None:
    """Write the namer; any number of crops."""
    dynamic = {name: {0: "b"} for name in (*_INPUTS, *_OUTPUTS)}
    example = (torch.zeros(2, 3, CROP_SIDE, CROP_SIDE), torch.zeros(2, 6))
    write_graph(network, example, path, inputs=[*_INPUTS], outputs=[*_OUTPUTS], dynamic=dynamic, half_weights=True)


def export_outliner(network: nn.Module, path: Path) -> None:
    """Write the outliner; any number of windows."""
    dynamic = {"windows": {0: "b"}, "logits": {0: "b"}}
    example = (torch.zeros(2, 4, SIDE, SIDE),)
    write_graph(network, example, path, inputs=["windows"], outputs=["logits"], dynamic=dynamic, half_weights=True)


def export_surfaces(network: nn.Module, path: Path) -> None:
    """Write the head that tells a room's surfaces; pictures of any size that 32 divides."""
    maps = {f"stride_{4 * 2**k}": torch.zeros(1, c, 96 >> k, 128 >> k) for k, c in enumerate(MAP_CHANNELS.values())}
    example = (*maps.values(), torch.zeros(1, 96, 128))
    names = [*maps, "rise"]
    dynamic = {name: {2: f"h_{name}", 3: f"w_{name}"} for name in maps}
    dynamic |= {"rise": {1: "h", 2: "w"}, "surfaces": {2: "h", 3: "w"}}
    write_graph(network, example, path, inputs=names, outputs=["surfaces"], dynamic=dynamic, half_weights=True)


def write_card(path: Path, categories: Sequence[str], **more: object) -> None:
    """The names of the outputs, and how the weights were made."""
    forms = {name: list(VALUES[name]) for name in MEASURED}
    write_atomically(path, json.dumps({"categories": list(categories), "forms": forms, **more}, indent=1).encode())


def score(annotations: Path, photos: Path, recogniser: Recogniser) -> RecognitionBench:
    """Boxes and names on every annotated photo."""
    routes = {"own": OwnDetection(recogniser, threshold=0.01, most=BEST)}
    return run(annotations, photos, routes, {"own": lambda photo, boxes: names_of(recogniser, photo, boxes)}, {})


def join_namers(paths: Sequence[Path], output: Path) -> None:
    """Write one graph with the inputs and outputs of a namer (`training.networks`), made of several.

    Its logits are the logarithms of the mean probabilities of kinds and of the values of every attribute of form.
    Namers that learnt before an attribute was there say nothing of it: they tell the first of `library.form.MEASURED`.

    Args:
        paths: graphs written by `export_namer`, of the same categories; the first tells all attributes.
        output: where the joined graph goes.

    Raises:
        InputError: for a graph whose numbers are not those of attributes of form.
    """
    graphs = [onnx.load(path) for path in paths]
    attributes = [_attributes(graph, path) for graph, path in zip(graphs, paths, strict=True)]
    if attributes[0] != MEASURED:
        raise InputError(
            f"{paths[0]}: tells {', '.join(attributes[0])} only; begin with a namer that tells every attribute"
        )
    nodes: list[NodeProto] = []
    values = [numpy_helper.from_array(np.array(_TINY, np.float32), "tiny")]
    for k, graph in enumerate(graphs):
        prefixed = compose.add_prefix(graph, f"{k}_").graph
        shared = {f"{k}_{name}": name for name in _INPUTS}
        for node in prefixed.node:
            node.input[:] = [shared.get(name, name) for name in node.input]
        nodes += [*prefixed.node, *_probabilities(k, attributes[k])]
        sizes = np.array([len(VALUES[name]) for name in attributes[k]], np.int64)
        values += [*prefixed.initializer, numpy_helper.from_array(sizes, f"{k}_sizes")]
    for name in ("kinds", *MEASURED):
        parts = [f"{k}_{name}_probability" for k in range(len(graphs)) if name == "kinds" or name in attributes[k]]
        nodes.append(helper.make_node("Mean", parts, [f"{name}_mean"]))
    nodes.append(helper.make_node("Concat", [f"{name}_mean" for name in MEASURED], ["forms_mean"], axis=1))
    for name in _OUTPUTS:
        nodes += [
            helper.make_node("Add", [f"{name}_mean", "tiny"], [f"{name}_positive"]),
            helper.make_node("Log", [f"{name}_positive"], [name]),
        ]
    first = graphs[0]
    whole = helper.make_graph(nodes, "namers", list(first.graph.input), list(first.graph.output), values)
    model = helper.make_model(whole, opset_imports=first.opset_import, ir_version=first.ir_version)
    onnx.checker.check_model(model)
    write_atomically(output, model.SerializeToString())


def _attributes(graph: ModelProto, path: Path) -> tuple[str, ...]:
    """Which attributes of form a namer tells, by how many numbers it gives."""
    forms = next(output for output in graph.graph.output if output.name == "forms")
    width = forms.type.tensor_type.shape.dim[1].dim_value
    ends = np.cumsum([len(VALUES[name]) for name in MEASURED]).tolist()
    if width not in ends:
        raise InputError(f"{path}: {width} numbers of form are those of no attributes; join namers made by `export`")
    return MEASURED[: ends.index(width) + 1]


def _probabilities(k: int, attributes: Sequence[str]) -> list[NodeProto]:
    """From the logits of one namer: all kinds together, each attribute of form for itself."""
    parts = [f"{k}_{name}" for name in attributes]
    return [
        helper.make_node("Softmax", [f"{k}_kinds"], [f"{k}_kinds_probability"], axis=1),
        helper.make_node("Split", [f"{k}_forms", f"{k}_sizes"], parts, axis=1),
        *(helper.make_node("Softmax", [part], [f"{part}_probability"], axis=1) for part in parts),
    ]
