"""Blocks that both networks are made of."""

from __future__ import annotations

from jaxtyping import Float
from torch import Tensor, nn


def convolution(inputs: int, outputs: int, kernel: int = 3, stride: int = 1) -> nn.Sequential:
    """A convolution, batch normalisation and SiLU; the size stays, or shrinks by the stride.

    Args:
        inputs: channels.
        outputs: channels.
        kernel: its side.
        stride: of the kernel.
    """
    return nn.Sequential(
        nn.Conv2d(inputs, outputs, kernel, stride, kernel // 2, bias=False), nn.BatchNorm2d(outputs), nn.SiLU()
    )


class Residual(nn.Module):
    """Two convolutions through half the channels, added to the input."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.inner = nn.Sequential(convolution(channels, channels // 2, 1), convolution(channels // 2, channels))

    def forward(self, x: Float[Tensor, "b c h w"]) -> Float[Tensor, "b c h w"]:
        """The sum."""
        out: Tensor = x + self.inner(x)
        return out
