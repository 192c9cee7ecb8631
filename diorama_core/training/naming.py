"""The naming network: what stands in a box, from its pixels, a margin around it, and where in the picture it is."""

from __future__ import annotations

import torch
from jaxtyping import Float
from torch import Tensor, nn

from diorama_core.training.layers import Residual, convolution


class Namer(nn.Module):
    """Input: `box_crop`s `[b, 3, 80, 80]`, 0 to 1, and `box_geometry` `[b, 6]`. Output: logits of the categories.

    Args:
        kinds: number of categories.
        width: channels of the first stage.
    """

    def __init__(self, kinds: int, width: int = 32) -> None:
        super().__init__()
        w = width
        self.features = nn.Sequential(
            convolution(3, w, 3, 2),
            Residual(w),
            convolution(w, 2 * w, 3, 2),
            Residual(2 * w),
            Residual(2 * w),
            convolution(2 * w, 4 * w, 3, 2),
            Residual(4 * w),
            Residual(4 * w),
            convolution(4 * w, 6 * w, 3, 2),
            Residual(6 * w),
            nn.AdaptiveAvgPool2d(1),
            nn.Flatten(),
        )
        self.geometry = nn.Sequential(nn.Linear(6, 64), nn.SiLU(), nn.Linear(64, 64), nn.SiLU())
        self.kind = nn.Sequential(nn.Dropout(0.2), nn.Linear(6 * w + 64, 256), nn.SiLU(), nn.Linear(256, kinds))

    def forward(self, crops: Float[Tensor, "b 3 s s"], geometry: Float[Tensor, "b 6"]) -> Float[Tensor, "b k"]:
        """Logits."""
        joined = torch.cat([self.features(crops - 0.5), self.geometry(geometry)], dim=1)
        logits: Tensor = self.kind(joined)
        return logits
