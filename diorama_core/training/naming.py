"""The naming network: what stands in a box, from its pixels, a margin around it, and where in the picture it is.

Beside the kind it tells the form: which top and base, whether with arms, how many doors and drawers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import torch
from jaxtyping import Float, Int
from torch import Tensor, nn
from torch.nn import functional

from diorama_core.library.form import MEASURED, VALUES
from diorama_core.training.layers import Residual, convolution

FORM_WEIGHT = 0.15
"""Weight of one attribute of form beside the kind."""


class Namer(nn.Module):
    """Input: `box_crop`s `[b, 3, 96, 96]`, 0 to 1, and `box_geometry` `[b, 6]`. Output: logits of kinds and of forms.

    Args:
        kinds: number of categories.
        width: channels of the first stage.
    """

    def __init__(self, kinds: int, width: int = 64) -> None:
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
        self.joined = nn.Sequential(nn.Dropout(0.2), nn.Linear(6 * w + 64, 256), nn.SiLU())
        self.kind = nn.Linear(256, kinds)
        self.form = nn.Linear(256, sum(len(VALUES[name]) for name in MEASURED))

    def forward(
        self, crops: Float[Tensor, "b 3 s s"], geometry: Float[Tensor, "b 6"]
    ) -> tuple[Float[Tensor, "b k"], Float[Tensor, "b f"]]:
        """Logits of the kinds, and of all values of all attributes of form, those of `MEASURED` one after another."""
        features = torch.cat([self.features(crops - 0.5), self.geometry(geometry)], dim=1)
        joined = self.joined(features)
        return self.kind(joined), self.form(joined)


@dataclass(frozen=True, eq=False)
class NamingLoss:
    """How wrong a batch was named."""

    total: Tensor
    kind: float
    """Share of kinds that are right."""
    form: float
    """Share of attributes that are right, of those that things have."""


def naming_loss(
    logits: tuple[Float[Tensor, "b k"], Float[Tensor, "b f"]],
    kinds: Int[Tensor, "b"],
    forms: Int[Tensor, "b 7"],
    form_weights: Sequence[Float[Tensor, "_"]],
) -> NamingLoss:
    """Cross entropy of the kind and of every attribute of form.

    Args:
        logits: of the network.
        kinds: what is right.
        forms: what is right; -1 where an attribute is not asked.
        form_weights: of the values of each attribute.
    """
    of_kind, of_forms = (
        logits[0].float(),
        torch.split(logits[1].float(), [len(VALUES[name]) for name in MEASURED], dim=1),
    )
    total = functional.cross_entropy(of_kind, kinds, label_smoothing=0.05)
    right, asked = 0.0, 0
    for k, values in enumerate(of_forms):
        has = forms[:, k] >= 0
        if has.any():
            total = total + FORM_WEIGHT * functional.cross_entropy(
                values[has], forms[has, k], form_weights[k], label_smoothing=0.05
            )
            right, asked = right + float((values[has].argmax(dim=1) == forms[has, k]).sum()), asked + int(has.sum())
    return NamingLoss(total, float((of_kind.argmax(dim=1) == kinds).float().mean()), right / max(asked, 1))
