"""Makes `duoduoclip/visual.onnx` from your own copy of a DuoduoCLIP checkpoint (Lee et al. 2025).

    python scripts/convert_duoduoclip.py Four_1to6F_bs1600_LT6.ckpt -o converted
    diorama models pull --from converted

The shape tower is rebuilt from the checkpoint's own weights: a vision transformer whose later layers attend over the
patches of all views together, and whose class tokens are averaged over the views. The text tower is OpenCLIP B-32's.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import torch
from torch.nn import functional

from diorama_core.models.onnx_export import CheckpointPart, checkpoint_arguments, read_checkpoint, write_graph

HEAD = 64
"""Channels of an attention head in every CLIP transformer."""
SIDE = 224
PREFIXES = ("duoduoclip.visual.", "visual.")
SETTINGS = ("model", "network", "layers_threshold")


class ShapeTower(CheckpointPart):
    """Normalised views [1, V, 3, 224, 224] of one shape to its vector [1, 512]."""

    def __init__(self, weights: Mapping[str, torch.Tensor], alone: int) -> None:
        """`weights` by their names below `visual.`; the first `alone` layers see each view by itself."""
        super().__init__(weights)
        self.layers = 1 + max(int(n.split(".")[2]) for n in weights if n.startswith("transformer.resblocks."))
        self.alone = alone

    def _attended(self, x: torch.Tensor, layer: str) -> torch.Tensor:
        """Self-attention among the tokens [batch, tokens, width] of each row of the batch."""
        width = x.shape[-1]
        mixed = functional.linear(x, self._w(f"{layer}.attn.in_proj_weight"), self._w(f"{layer}.attn.in_proj_bias"))
        q, k, v = (part.unflatten(-1, (width // HEAD, HEAD)).transpose(1, 2) for part in mixed.chunk(3, dim=-1))
        share = torch.softmax(q @ k.transpose(-1, -2) * HEAD**-0.5, dim=-1)
        joined = (share @ v).transpose(1, 2).flatten(-2)
        return self._linear(joined, f"{layer}.attn.out_proj")

    def _widened(self, x: torch.Tensor, layer: str) -> torch.Tensor:
        return self._linear(functional.gelu(self._linear(x, f"{layer}.mlp.c_fc")), f"{layer}.mlp.c_proj")

    def forward(self, views: torch.Tensor) -> torch.Tensor:
        kernel = self._w("conv1.weight")
        patches = functional.conv2d(views[0], kernel, stride=kernel.shape[-1]).flatten(2).transpose(1, 2)
        token = self._w("class_embedding").expand(patches.shape[0], 1, -1)
        x = self._norm(torch.cat([token, patches], dim=1) + self._w("positional_embedding"), "ln_pre")
        tokens, width = self._w("positional_embedding").shape
        for index in range(self.layers):
            layer = f"transformer.resblocks.{index}"
            # Every token of every view in one row, or one row per view.
            x = x.reshape(-1, tokens, width) if index < self.alone else x.reshape(1, -1, width)
            x = x + self._attended(self._norm(x, f"{layer}.ln_1"), layer)
            x = x + self._widened(self._norm(x, f"{layer}.ln_2"), layer)
        seen = self._norm(x.reshape(-1, tokens, width)[:, 0], "ln_post")
        return seen.mean(dim=0, keepdim=True) @ self._w("proj")


def shape_tower(saved: Mapping[str, Any]) -> ShapeTower:
    """The tower of a checkpoint that Lightning wrote, or of a plain dictionary of weights."""
    state = saved.get("state_dict", saved)
    prefix = next((p for p in PREFIXES if f"{p}conv1.weight" in state), None)
    if prefix is None:
        sys.exit("this is no DuoduoCLIP checkpoint: it holds no duoduoclip.visual.conv1.weight")
    weights = {name.removeprefix(prefix): value for name, value in state.items() if name.startswith(prefix)}
    settings: Any = saved.get("hyper_parameters", {})
    for key in SETTINGS:
        settings = settings.get(key, {}) if isinstance(settings, Mapping) else {}
    return ShapeTower(weights, settings if isinstance(settings, int) else 0).eval()


def write_tower(tower: ShapeTower, target: Path) -> None:
    example = (torch.zeros(1, 3, 3, SIDE, SIDE),)
    write_graph(tower, example, target, inputs=["views"], outputs=["embedding"], dynamic={"views": {1: "v"}})


def main(arguments: list[str] | None = None) -> None:
    a = checkpoint_arguments(__doc__, arguments)
    target = a.output / "duoduoclip" / "visual.onnx"
    write_tower(shape_tower(read_checkpoint(a.checkpoint, a.trust)), target)
    print(target)


if __name__ == "__main__":
    main()
