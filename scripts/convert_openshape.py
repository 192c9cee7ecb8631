"""Makes `openshape/points.onnx` from your own copy of OpenShape's `pointbert-vitg14-rgb` (Liu et al. 2023).

    python scripts/convert_openshape.py openshape-pointbert-vitg14-rgb/model.pt -o converted
    diorama models pull --from converted

The point encoder is rebuilt from the checkpoint's own weights: a small PointNet reads each patch of points, a
transformer mixes the patches, and a linear layer leads into OpenCLIP bigG-14's space. Patches are made outside.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

import torch
from torch.nn import functional

from diorama_core.models.onnx_export import CheckpointPart, checkpoint_arguments, read_checkpoint, write_graph
from diorama_core.models.openshape import NEIGHBOURS, PATCHES

HEAD = 64
"""Channels of an attention head."""
PREFIXES = ("module.", "pc_encoder.", "")
FIRST = "ppat.cls_token"


class PointTower(CheckpointPart):
    """Middles [1, p, 3] and patches [1, p, k, 9] of one shape to its vector [1, 1280]."""

    def __init__(self, weights: Mapping[str, torch.Tensor]) -> None:
        super().__init__(weights)
        self.convolutions = sum(n.startswith("ppat.sa.mlp_convs.") and n.endswith(".weight") for n in weights)
        self.layers = 1 + max(int(n.split(".")[3]) for n in weights if n.startswith("ppat.transformer.layers."))

    def _read(self, patches: torch.Tensor) -> torch.Tensor:
        """Each patch [1, p, k, 9] as one vector: the largest value of each channel among its points."""
        x = patches
        for k in range(self.convolutions):
            name = f"ppat.sa.mlp_bns.{k}"
            spread = torch.sqrt(self._w(f"{name}.running_var") + 1e-5)
            x = self._linear(x, f"ppat.sa.mlp_convs.{k}") - self._w(f"{name}.running_mean")
            x = torch.relu(x / spread * self._w(f"{name}.weight") + self._w(f"{name}.bias"))
        return x.amax(dim=2)

    def _attended(self, x: torch.Tensor, name: str) -> torch.Tensor:
        q, k, v = functional.linear(x, self._w(f"{name}.to_qkv.weight")).chunk(3, dim=-1)
        q, k, v = (part.unflatten(-1, (-1, HEAD)).transpose(1, 2) for part in (q, k, v))
        share = torch.softmax(q @ k.transpose(-1, -2) * HEAD**-0.5, dim=-1)
        return self._linear((share @ v).transpose(1, 2).flatten(-2), f"{name}.to_out.0")

    def forward(self, centres: torch.Tensor, patches: torch.Tensor) -> torch.Tensor:
        x = self._linear(torch.cat([centres, self._read(patches)], dim=-1), "ppat.lift.0")
        x = torch.cat([self._w(FIRST).reshape(1, 1, -1), self._norm(x, "ppat.lift.2")], dim=1)
        for layer in range(self.layers):
            first, second = (f"ppat.transformer.layers.{layer}.{half}" for half in (0, 1))
            x = x + self._attended(self._norm(x, f"{first}.norm"), f"{first}.fn")
            inner = functional.gelu(self._linear(self._norm(x, f"{second}.norm"), f"{second}.fn.net.0"))
            x = x + self._linear(inner, f"{second}.fn.net.3")
        return self._linear(x[:, 0], "proj")


def point_tower(saved: Mapping[str, Any]) -> PointTower:
    """The tower of a checkpoint as its authors publish it."""
    state = saved.get("state_dict", saved)
    prefix = next((p for p in PREFIXES if f"{p}{FIRST}" in state), None)
    if prefix is None or f"{prefix}proj.weight" not in state:
        sys.exit(
            f"this is no checkpoint of OpenShape's PointBERT for CLIP bigG-14: it holds no {FIRST} and proj.weight"
        )
    weights = {
        n.removeprefix(prefix): v for n, v in state.items() if n.startswith((f"{prefix}ppat.", f"{prefix}proj."))
    }
    return PointTower({n: v for n, v in weights.items() if not n.endswith("num_batches_tracked")}).eval()


def main(arguments: list[str] | None = None) -> None:
    a = checkpoint_arguments(__doc__, arguments)
    target = a.output / "openshape" / "points.onnx"
    example = (torch.zeros(1, PATCHES, 3), torch.zeros(1, PATCHES, NEIGHBOURS, 9))
    tower = point_tower(read_checkpoint(a.checkpoint, a.trust))
    write_graph(tower, example, target, inputs=["centres", "patches"], outputs=["embedding"])
    print(target)


if __name__ == "__main__":
    main()
