"""Makes `duoduoclip/visual.onnx` from your own copy of DuoduoCLIP: its code and a checkpoint.

    python scripts/convert_duoduoclip.py --source DuoduoCLIP --checkpoint Four_1to6F.ckpt -o converted
    diorama models pull --from converted

Needs the packages that their code needs (lightning, hydra, omegaconf, torchvision). The text tower is OpenCLIP B-32's.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import torch


class ShapeTower(torch.nn.Module):
    """Normalised views [1, V, 3, 224, 224] of one shape to its vector [1, 512]."""

    def __init__(self, network: torch.nn.Module, views: int) -> None:
        super().__init__()
        self.clip = network.duoduoclip
        layers, threshold = self.clip.visual.transformer.layers, network.layers_threshold
        self.frames = [1] * threshold + [views] * (layers - threshold) + [views]

    def forward(self, views: torch.Tensor) -> torch.Tensor:
        return self.clip.encode_image(views[0], num_frames=self.frames)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--source", type=Path, required=True, help="clone of their repository")
    parser.add_argument("--checkpoint", type=Path, required=True)
    parser.add_argument("--views", type=int, default=12, help="views of a shape (fewer given ones are repeated)")
    parser.add_argument("-o", "--output", type=Path, required=True)
    a = parser.parse_args()
    sys.path.insert(0, str(a.source.resolve()))
    from src.model.duoduoclip import DuoduoCLIP

    network = DuoduoCLIP.load_from_checkpoint(str(a.checkpoint), map_location="cpu").eval().float()
    target = a.output / "duoduoclip" / "visual.onnx"
    target.parent.mkdir(parents=True, exist_ok=True)
    views = torch.zeros(1, a.views, 3, 224, 224)
    with torch.no_grad():
        torch.onnx.export(
            ShapeTower(network, a.views).eval(),
            (views,),
            str(target),
            input_names=["views"],
            output_names=["embedding"],
            opset_version=17,
            dynamo=False,
        )
    print(target)


if __name__ == "__main__":
    main()
