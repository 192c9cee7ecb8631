"""The outlining network: which pixels in and around a box are the object's."""

from __future__ import annotations

import torch
from jaxtyping import Float
from torch import Tensor, nn
from torch.nn import functional

from diorama_core.training.layers import Residual, convolution


class OutlineNetwork(nn.Module):
    """Input: windows `[b, 4, s, s]` of `models.outliner`. Output: logits of the object's pixels `[b, s, s]`.

    An encoder of four levels and a decoder that joins them again, each twice as fine (Ronneberger et al. 2015).

    Args:
        width: channels of the finest level; `s` is a multiple of 16.
    """

    def __init__(self, width: int = 32) -> None:
        super().__init__()
        w = width
        self.fine = nn.Sequential(convolution(4, w, 5, 2), Residual(w))
        self.middle = nn.Sequential(convolution(w, 2 * w, 3, 2), Residual(2 * w), Residual(2 * w))
        self.coarse = nn.Sequential(convolution(2 * w, 3 * w, 3, 2), Residual(3 * w), Residual(3 * w))
        self.whole = nn.Sequential(convolution(3 * w, 4 * w, 3, 2), *(Residual(4 * w) for _ in range(3)))
        self.to_coarse = nn.Sequential(convolution(7 * w, 3 * w, 1), Residual(3 * w))
        self.to_middle = nn.Sequential(convolution(5 * w, 2 * w, 1), Residual(2 * w))
        self.to_fine = nn.Sequential(convolution(3 * w, w, 1), Residual(w), Residual(w))
        self.out = nn.Sequential(nn.Conv2d(w, 4, 3, padding=1), nn.PixelShuffle(2))

    def forward(self, windows: Float[Tensor, "b 4 s s"]) -> Float[Tensor, "b s s"]:
        """Logits."""
        fine = self.fine(windows - 0.5)
        middle = self.middle(fine)
        coarse = self.coarse(middle)
        features = self.whole(coarse)
        for skip, join in ((coarse, self.to_coarse), (middle, self.to_middle), (fine, self.to_fine)):
            enlarged = functional.interpolate(features, scale_factor=2.0, mode="nearest")
            features = join(torch.cat([enlarged, skip], dim=1))
        logits: Tensor = self.out(features)[:, 0]
        return logits


def outline_loss(logits: Float[Tensor, "b s s"], target: Float[Tensor, "b s s"]) -> Tensor:
    """Cross-entropy of the pixels, and one minus the soft Dice score of every object."""
    share = torch.sigmoid(logits)
    both = (share * target).sum(dim=(1, 2))
    dice = (2 * both + 1) / (share.sum(dim=(1, 2)) + target.sum(dim=(1, 2)) + 1)
    return functional.binary_cross_entropy_with_logits(logits, target) + (1 - dice).mean()
