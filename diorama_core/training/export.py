"""Trained networks as ONNX graphs, with the names of their outputs beside them."""

from __future__ import annotations

import json
import warnings
from collections.abc import Sequence
from pathlib import Path

import onnx
import torch
from torch import nn

from diorama_core.io.atomic import write_atomically
from diorama_core.models.recogniser import CROP_SIDE

OPSET = 17


def export_detector(network: nn.Module, path: Path) -> None:
    """Write the detector; pictures of any size that 32 divides."""
    dynamic = {"pictures": {0: "b", 2: "h", 3: "w"}, "rows": {0: "b", 1: "n"}}
    _export(network, (torch.zeros(1, 3, 256, 320),), path, ("pictures",), ("rows",), dynamic)


def export_namer(network: nn.Module, path: Path) -> None:
    """Write the namer; any number of crops."""
    dynamic = {"crops": {0: "b"}, "geometry": {0: "b"}, "logits": {0: "b"}}
    arguments = (torch.zeros(2, 3, CROP_SIDE, CROP_SIDE), torch.zeros(2, 6))
    _export(network, arguments, path, ("crops", "geometry"), ("logits",), dynamic)


def write_card(path: Path, categories: Sequence[str], **more: object) -> None:
    """The names of the outputs, and how the weights were made."""
    write_atomically(path, json.dumps({"categories": list(categories), **more}, indent=1).encode())


def _export(
    network: nn.Module,
    arguments: tuple[torch.Tensor, ...],
    path: Path,
    inputs: Sequence[str],
    outputs: Sequence[str],
    dynamic: dict[str, dict[int, str]],
) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with warnings.catch_warnings(), torch.no_grad():
        warnings.simplefilter("ignore")
        torch.onnx.export(
            network.eval(),
            arguments,
            str(path),
            input_names=list(inputs),
            output_names=list(outputs),
            dynamic_axes=dynamic,
            opset_version=OPSET,
            dynamo=False,
        )
    onnx.checker.check_model(str(path))
