"""Networks of PyTorch as ONNX graphs: with one set of operators, in evaluation mode, checked."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path

import onnx
import torch
from torch import nn

OPSET = 17


def write_graph(
    network: nn.Module,
    arguments: tuple[torch.Tensor, ...],
    path: Path,
    inputs: Sequence[str],
    outputs: Sequence[str],
    dynamic: Mapping[str, Mapping[int, str]] | None = None,
) -> Path:
    """Trace a network and write its graph.

    Args:
        network: put into evaluation mode.
        arguments: an example of what it is called with.
        path: where to; folders are made.
        inputs: names of the arguments.
        outputs: names of the results.
        dynamic: axes that may have any length, by name of an input or output: number and name.

    Returns:
        The path.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with warnings.catch_warnings(), torch.no_grad():
        warnings.simplefilter("ignore")  # the tracer warns of every size that it takes for a constant
        torch.onnx.export(
            network.eval(),
            arguments,
            str(path),
            input_names=list(inputs),
            output_names=list(outputs),
            dynamic_axes={name: dict(axes) for name, axes in (dynamic or {}).items()},
            opset_version=OPSET,
            dynamo=False,
        )
    onnx.checker.check_model(str(path))
    return path
