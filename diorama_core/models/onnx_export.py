"""Networks of PyTorch as ONNX graphs: with one set of operators, in evaluation mode, checked; and checkpoints read."""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import onnx
import torch
from torch import nn
from torch.nn import functional

OPSET = 17
_LARGE = 64
"""Numbers in a weight that is worth storing in half precision."""


def read_checkpoint(path: Path, trusted: bool) -> dict[str, Any]:
    """A checkpoint of a user's own, without running code that it may carry unless it is trusted.

    Raises:
        SystemExit: it cannot be read; one line that says why.
    """
    try:
        return torch.load(path, map_location="cpu", weights_only=not trusted)
    except Exception as error:  # unpickling raises almost anything
        words = " ".join(str(error).split())[:120]
        advice = "is it the right file?" if trusted else "add --trust if you know where it comes from (it may run code)"
        raise SystemExit(f"{path}: cannot be read ({words}); {advice}") from error


def checkpoint_arguments(about: str | None, given: list[str] | None) -> argparse.Namespace:
    """What a script that converts a checkpoint is told: `checkpoint`, `output` and `trust`.

    Args:
        about: The script's own description.
        given: Its arguments; those of the process where None.
    """
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("checkpoint", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--trust", action="store_true", help="read a checkpoint that may run code")
    return parser.parse_args(given)


class CheckpointPart(nn.Module):
    """A network that is rebuilt from the weights of a checkpoint, and the layers that use them by name."""

    def __init__(self, weights: Mapping[str, torch.Tensor]) -> None:
        super().__init__()
        for name, value in weights.items():
            self.register_buffer(name.replace(".", "__"), value.float())

    def _w(self, name: str) -> torch.Tensor:
        return self.get_buffer(name.replace(".", "__"))

    def _linear(self, x: torch.Tensor, name: str) -> torch.Tensor:
        """Linear layers, and convolutions of size 1, which are the same."""
        weight = self._w(f"{name}.weight")
        return functional.linear(x, weight.reshape(weight.shape[:2]), self._w(f"{name}.bias"))

    def _norm(self, x: torch.Tensor, name: str) -> torch.Tensor:
        weight = self._w(f"{name}.weight")
        return functional.layer_norm(x, (weight.numel(),), weight, self._w(f"{name}.bias"))


def write_graph(
    network: nn.Module,
    arguments: tuple[torch.Tensor, ...],
    path: Path,
    inputs: Sequence[str],
    outputs: Sequence[str],
    dynamic: Mapping[str, Mapping[int, str]] | None = None,
    *,
    half_weights: bool = False,
    data_beside: bool = False,
) -> Path:
    """Trace a network and write its graph.

    Args:
        network: put into evaluation mode.
        arguments: an example of what it is called with.
        path: where to; folders are made.
        inputs: names of the arguments.
        outputs: names of the results.
        dynamic: axes that may have any length, by name of an input or output: number and name.
        half_weights: store weights in half precision, which halves the file; the graph still calculates in single.
        data_beside: store weights in one file beside the graph, `NAME_data`; a graph of over 2 GB cannot hold them.

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
    if half_weights or data_beside:
        _store_again(path, half_weights, data_beside)
    onnx.checker.check_model(str(path))
    return path


def _store_again(path: Path, half_weights: bool, data_beside: bool) -> None:
    """Write a graph anew, its weights in half precision or in one file beside it."""
    # The tracer itself leaves weights of large networks beside the graph, each in a file of its own.
    weights = onnx.load(str(path), load_external_data=False).graph.initializer
    parts = {entry.value for weight in weights for entry in weight.external_data if entry.key == "location"}
    model = onnx.load(str(path))
    for part in parts:
        (path.parent / part).unlink()
    model = with_half_weights(model) if half_weights else model
    data = path.with_name(f"{path.name}_data")
    data.unlink(missing_ok=True)  # it would be appended to
    onnx.save_model(model, str(path), save_as_external_data=data_beside, location=data.name if data_beside else None)


def with_half_weights(model: onnx.ModelProto) -> onnx.ModelProto:
    """The model with its large weights in half precision, each cast to single where the graph begins."""
    half = onnx.ModelProto()
    half.CopyFrom(model)
    casts = []
    for weight in half.graph.initializer:
        values = onnx.numpy_helper.to_array(weight)
        if values.dtype == np.float32 and values.size >= _LARGE:
            name = f"{weight.name}.half"
            casts.append(onnx.helper.make_node("Cast", [name], [weight.name], to=onnx.TensorProto.FLOAT))
            weight.CopyFrom(onnx.numpy_helper.from_array(values.astype(np.float16), name))
    nodes = [*casts, *half.graph.node]
    del half.graph.node[:]
    half.graph.node.extend(nodes)
    return half
