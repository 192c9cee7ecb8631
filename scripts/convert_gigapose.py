"""Makes `gigapose-scale/*.onnx` from your own copy of a GigaPose checkpoint (Nguyen et al. 2024).

    python scripts/convert_gigapose.py gigaPose_v1.ckpt -o converted
    diorama models pull --from converted

Only the second network (relative scale and in-plane angle of matching patches) is taken; it is rebuilt from the
checkpoint's own weights. The features of the first one are DINOv2's.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import torch
from torch.nn import functional

from diorama_core.models.onnx_export import CheckpointPart, checkpoint_arguments, read_checkpoint, write_graph

SIDE, INNER_SIDE = 224, 256
"""Of the crops, and of what the backbone enlarges them to."""
STAGES = (1, 2, 2, 2)
"""Strides of the residual stages, two blocks each, after a first convolution of stride 2."""


class Backbone(CheckpointPart):
    """Crops [b, 3, 224, 224], CLIP's statistics, to features [b, 256, 16, 16]."""

    def _normed(self, x: torch.Tensor, name: str) -> torch.Tensor:
        mean, variance = self._w(f"{name}.running_mean"), self._w(f"{name}.running_var")
        return functional.batch_norm(x, mean, variance, self._w(f"{name}.weight"), self._w(f"{name}.bias"))

    def _block(self, x: torch.Tensor, name: str, stride: int) -> torch.Tensor:
        y = functional.relu(
            self._normed(functional.conv2d(x, self._w(f"{name}.conv1.weight"), stride=stride, padding=1), f"{name}.bn1")
        )
        y = self._normed(functional.conv2d(y, self._w(f"{name}.conv2.weight"), padding=1), f"{name}.bn2")
        if hasattr(self, f"{name}.downsample.0.weight".replace(".", "__")):
            x = functional.conv2d(x, self._w(f"{name}.downsample.0.weight"), stride=stride)
            x = self._normed(x, f"{name}.downsample.1")
        return functional.relu(x + y)

    def forward(self, image: torch.Tensor) -> torch.Tensor:
        x = functional.interpolate(image, (INNER_SIDE, INNER_SIDE), mode="bilinear", align_corners=True)
        x = functional.relu(self._normed(functional.conv2d(x, self._w("conv1.weight"), stride=2, padding=3), "bn1"))
        for stage, stride in enumerate(STAGES, start=1):
            x = self._block(x, f"layer{stage}.0", stride)
            x = self._block(x, f"layer{stage}.1", 1)
        return functional.conv2d(x, self._w("layer4_outconv.weight"))


class Regressor(CheckpointPart):
    """Features [n, 512] of matching patches (photo's first) to scale [n, 1] and unit (cos, sin) [n, 2]."""

    def _mlp(self, x: torch.Tensor, name: str) -> torch.Tensor:
        for layer in (0, 2, 4):
            x = self._linear(x, f"{name}.{layer}")
            x = functional.relu(x) if layer < 4 else x
        return x

    def forward(self, pairs: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        turned = torch.tanh(self._mlp(pairs, "inplane_predictor"))
        return self._mlp(pairs, "scale_predictor"), functional.normalize(turned, dim=1)


def part(saved: Mapping[str, Any], name: str) -> dict[str, torch.Tensor]:
    """The weights below `ist_net.<name>.` or, as in the published checkpoint, below `<name>.`."""
    state = saved.get("state_dict", saved)
    marked = {key: key.split(f"ist_net.{name}.", 1)[1] for key in state if f"ist_net.{name}." in key}
    plain = {key: key.removeprefix(f"{name}.") for key in state if key.startswith(f"{name}.")}
    found = {short: state[key] for key, short in (marked or plain).items()}
    if not found:
        sys.exit(f"this is no GigaPose checkpoint: it holds nothing below ist_net.{name}. or {name}.")
    return {key: value for key, value in found.items() if not key.endswith("num_batches_tracked")}


def write_networks(saved: Mapping[str, Any], folder: Path) -> None:
    backbone, regressor = Backbone(part(saved, "backbone")).eval(), Regressor(part(saved, "regressor")).eval()
    channels = regressor.get_buffer("scale_predictor__0__weight").shape[1]
    image, pairs = (torch.zeros(1, 3, SIDE, SIDE),), (torch.zeros(4, channels),)
    any_number = {"image": {0: "b"}, "features": {0: "b"}}
    write_graph(backbone, image, folder / "features.onnx", inputs=["image"], outputs=["features"], dynamic=any_number)
    any_number = {name: {0: "n"} for name in ("pairs", "scale", "inplane")}
    outputs = ["scale", "inplane"]
    write_graph(regressor, pairs, folder / "regressor.onnx", inputs=["pairs"], outputs=outputs, dynamic=any_number)


def main(arguments: list[str] | None = None) -> None:
    a = checkpoint_arguments(__doc__, arguments)
    folder = a.output / "gigapose-scale"
    write_networks(read_checkpoint(a.checkpoint, a.trust), folder)
    print(folder)


if __name__ == "__main__":
    main()
