"""Makes `gigapose-scale/*.onnx` from your own copy of GigaPose: its code and a checkpoint.

    python scripts/convert_gigapose.py --source gigapose --checkpoint gigaPose_v1.ckpt -o converted
    diorama models pull --from converted

Only the second network (scale and in-plane angle of matching patches) is taken; the features of the first are DINOv2's.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import torch

DESCRIPTOR, HIDDEN = 256, 256
BACKBONE = {
    "n_heads": 0,
    "input_dim": 3,
    "input_size": 256,
    "initial_dim": 128,
    "block_dims": [128, 192, 256, 512],
    "descriptor_size": DESCRIPTOR,
}
"""As in their configs/model/ist_net/resnet.yaml."""


class Regressor(torch.nn.Module):
    """Features [n, 512] of matching patches (photo's first) to scale [n, 1] and unit (cos, sin) [n, 2]."""

    def __init__(self, network: torch.nn.Module) -> None:
        super().__init__()
        self.scale, self.inplane = network.scale_predictor, network.inplane_predictor

    def forward(self, pairs: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        return self.scale(pairs), torch.nn.functional.normalize(self.inplane(pairs), dim=1)


def _part(state: dict[str, torch.Tensor], name: str) -> dict[str, torch.Tensor]:
    """The weights below `ist_net.<name>.`, wherever the checkpoint keeps them."""
    mark = f"ist_net.{name}."
    return {key.split(mark, 1)[1]: value for key, value in state.items() if mark in key}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--source", type=Path, required=True, help="clone of their repository")
    parser.add_argument("--checkpoint", type=Path, required=True)
    parser.add_argument("-o", "--output", type=Path, required=True)
    a = parser.parse_args()
    sys.path.insert(0, str(a.source.resolve()))
    from src.models.network.ist_net import Regressor as TheirRegressor
    from src.models.network.resnet import ResNet

    saved = torch.load(a.checkpoint, map_location="cpu", weights_only=False)
    state = saved.get("state_dict", saved)
    backbone = ResNet(BACKBONE).eval()
    backbone.load_state_dict(_part(state, "backbone"))
    regressor = TheirRegressor(DESCRIPTOR, HIDDEN, use_tanh_act=True, normalize_output=True).eval()
    regressor.load_state_dict(_part(state, "regressor"))
    folder = a.output / "gigapose-scale"
    folder.mkdir(parents=True, exist_ok=True)
    with torch.no_grad():
        torch.onnx.export(
            backbone,
            (torch.zeros(1, 3, 224, 224),),
            str(folder / "features.onnx"),
            input_names=["image"],
            output_names=["features"],
            opset_version=17,
            dynamo=False,
        )
        torch.onnx.export(
            Regressor(regressor).eval(),
            (torch.zeros(4, 2 * DESCRIPTOR),),
            str(folder / "regressor.onnx"),
            input_names=["pairs"],
            output_names=["scale", "inplane"],
            dynamic_axes={"pairs": {0: "n"}, "scale": {0: "n"}, "inplane": {0: "n"}},
            opset_version=17,
            dynamo=False,
        )
    print(folder)


if __name__ == "__main__":
    main()
