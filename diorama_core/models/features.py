"""Patch features: DINOv2 (Oquab et al. 2023), from its last or any inner block."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float32, UInt8

from diorama_core.errors import UnavailableError
from diorama_core.io.atomic import open_atomically
from diorama_core.io.bounded import shorten
from diorama_core.models.images import IMAGENET_MEAN, IMAGENET_STD, normalise, resize
from diorama_core.models.runtime import GraphNetwork, NetworkError

PATCH = 14


@dataclass(frozen=True)
class Dinov2(GraphNetwork):
    """Input: an RGB picture, eight bits. Output: one vector per patch of 14 x 14 pixels.

    GigaPose reads block 17 of the large network (blocks count from 0), after the final LayerNorm.
    """

    weights: str = "dinov2"
    block: int | None = None
    """Inner block to read; None reads the last."""

    def patches(self, rgb: UInt8[np.ndarray, "h w 3"], side: int = 224) -> Float32[np.ndarray, "n n d"]:
        """Features of the picture stretched to a square of `side` pixels, a multiple of 14."""
        return self.batch([rgb], side)[0]

    def batch(self, pictures: list[UInt8[np.ndarray, "_ _ 3"]], side: int = 224) -> Float32[np.ndarray, "b n n d"]:
        """Patches of several pictures at once."""
        if side % PATCH:
            raise ValueError(f"the side {side} must be a multiple of {PATCH}")
        graph = self.graph if self.block is None else inner_graph(self.graph, self.block)
        pixels = np.concatenate([normalise(resize(p, (side, side)), IMAGENET_MEAN, IMAGENET_STD) for p in pictures])
        n, name = side // PATCH, "last_hidden_state"
        out = self.pool.get(graph).run({"pixel_values": pixels}, {name: (len(pictures), 1 + n * n, None)})[name]
        return out[:, 1:].reshape(len(pictures), n, n, -1)


def inner_graph(graph: Path, block: int) -> Path:
    """The graph that ends after an inner block: what enters the final LayerNorm is that block's residual output.

    Made once, beside the original.

    Raises:
        UnavailableError: when `onnx` is missing.
        NetworkError: when the graph is damaged, or has no such block.
    """
    target = graph.with_name(f"{graph.stem}.block{block}{graph.suffix}")
    if target.exists() and target.stat().st_mtime >= graph.stat().st_mtime:
        return target
    try:
        import onnx
    except ImportError as error:
        raise UnavailableError("reading an inner block needs the package onnx; run: pip install onnx") from error
    try:
        model = onnx.load(str(graph))
    except Exception as error:  # protobuf's own, or whatever damaged data leads to
        reason = shorten(str(error)) or type(error).__name__
        raise NetworkError(graph, f"cannot be loaded ({reason}); run: diorama models verify") from error
    sums = _block_outputs([(n.op_type, n.name, list(n.output)) for n in model.graph.node])
    if block not in sums:
        raise NetworkError(graph, f"there is no block {block} (it has {len(sums)}); run: diorama models verify")
    last, wanted = sums[max(sums)], sums[block]
    after = False
    for node in model.graph.node:
        if after:
            for i, name in enumerate(node.input):
                if name == last:
                    node.input[i] = wanted
        after = after or last in node.output
    with open_atomically(target, error=UnavailableError) as stream:
        onnx.save(model, stream)
    return target


def _block_outputs(nodes: list[tuple[str, str, list[str]]]) -> dict[int, str]:
    """For every block, the name of its last residual sum."""
    output_names: dict[int, str] = {}
    for kind, name, outputs in nodes:
        match = re.search(r"layer\.(\d+)/Add(_\d+)?$", name)
        if kind == "Add" and match:
            output_names[int(match[1])] = outputs[0]
    return output_names
