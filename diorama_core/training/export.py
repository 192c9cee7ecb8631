"""Trained networks as ONNX graphs with the names of their outputs; scores on annotated photos."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import torch
from torch import nn

from diorama_core.evaluation.benchmarks.recognition import BEST, RecognitionBench, run
from diorama_core.io.atomic import write_atomically
from diorama_core.library.form import MEASURED, VALUES
from diorama_core.models.images import CROP_SIDE
from diorama_core.models.onnx_export import write_graph
from diorama_core.models.outliner import SIDE
from diorama_core.models.recogniser import Recogniser
from diorama_core.perception.foundation.proposals import OwnDetection, names_of


def export_detector(network: nn.Module, path: Path) -> None:
    """Write the detector; pictures of any size that 32 divides."""
    dynamic = {"pictures": {0: "b", 2: "h", 3: "w"}, "rows": {0: "b", 1: "n"}}
    example = (torch.zeros(1, 3, 256, 320),)
    write_graph(network, example, path, inputs=["pictures"], outputs=["rows"], dynamic=dynamic, half_weights=True)


def export_namer(network: nn.Module, path: Path) -> None:
    """Write the namer; any number of crops."""
    dynamic = {"crops": {0: "b"}, "geometry": {0: "b"}, "kinds": {0: "b"}, "forms": {0: "b"}}
    example = (torch.zeros(2, 3, CROP_SIDE, CROP_SIDE), torch.zeros(2, 6))
    write_graph(
        network,
        example,
        path,
        inputs=["crops", "geometry"],
        outputs=["kinds", "forms"],
        dynamic=dynamic,
        half_weights=True,
    )


def export_outliner(network: nn.Module, path: Path) -> None:
    """Write the outliner; any number of windows."""
    dynamic = {"windows": {0: "b"}, "logits": {0: "b"}}
    example = (torch.zeros(2, 4, SIDE, SIDE),)
    write_graph(network, example, path, inputs=["windows"], outputs=["logits"], dynamic=dynamic, half_weights=True)


def write_card(path: Path, categories: Sequence[str], **more: object) -> None:
    """The names of the outputs, and how the weights were made."""
    forms = {name: list(VALUES[name]) for name in MEASURED}
    write_atomically(path, json.dumps({"categories": list(categories), "forms": forms, **more}, indent=1).encode())


def score(annotations: Path, photos: Path, recogniser: Recogniser) -> RecognitionBench:
    """Boxes and names on every annotated photo."""
    routes = {"own": OwnDetection(recogniser, threshold=0.01, most=BEST)}
    return run(annotations, photos, routes, {"own": lambda photo, boxes: names_of(recogniser, photo, boxes)}, {})
