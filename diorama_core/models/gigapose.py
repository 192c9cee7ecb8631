"""GigaPose's second network: how much larger and how far turned one patch is beside another (Nguyen et al. 2024)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Float32, Int, UInt8

from diorama_core.models.images import CLIP_MEAN, CLIP_STD, normalise, resize
from diorama_core.models.runtime import SHARED_SESSIONS, SessionPool

SIDE = 224


@dataclass(frozen=True, eq=False)
class PatchTurns:
    """For every pair of patches, the similarity that carries the template onto the photo, up to translation."""

    scale: Float[np.ndarray, "n"]
    """Size in the photo over size in the template."""
    angle_rad: Float[np.ndarray, "n"]
    """In-plane turn, from the picture's x axis toward its y axis."""


@runtime_checkable
class ScaleNetwork(Protocol):
    """Input: feature maps of two crops and pairs of patches that match. Output: how the pairs are scaled and turned."""

    def maps(self, crops: Sequence[UInt8[np.ndarray, "_ _ 3"]]) -> Float32[np.ndarray, "b c n n"]:
        """Feature maps of crops."""
        ...

    def turns(
        self,
        template: Float32[np.ndarray, "c n n"],
        photo: Float32[np.ndarray, "c n n"],
        template_cells: Int[np.ndarray, "k 2"],
        photo_cells: Int[np.ndarray, "k 2"],
    ) -> PatchTurns:
        """Scale and angle of every pair of cells (column, row).

        Args:
            template: features of the view.
            photo: features of the crop.
            template_cells: columns and rows.
            photo_cells: likewise.
        """
        ...


@dataclass(frozen=True)
class GigaPoseScale:
    """Input: feature maps of two 224 x 224 crops and pairs of patches (column, row) that match.

    Output: relative scale and in-plane angle of each pair.
    """

    features: Path = field(repr=False)
    regressor: Path = field(repr=False)
    weights: str = "gigapose-scale"
    pool: SessionPool = field(default=SHARED_SESSIONS, repr=False, compare=False)

    def maps(self, crops: Sequence[UInt8[np.ndarray, "_ _ 3"]]) -> Float32[np.ndarray, "b c n n"]:
        """Feature maps of crops, each stretched to 224 x 224; normalised as in its training (CLIP's statistics)."""
        session = self.pool.get(self.features)
        pixels = [normalise(resize(c, (SIDE, SIDE)), CLIP_MEAN, CLIP_STD) for c in crops]
        return np.concatenate([session.answer({session.picture_input: p}, (1, None, None, None)) for p in pixels])

    def turns(
        self,
        template: Float32[np.ndarray, "c n n"],
        photo: Float32[np.ndarray, "c n n"],
        template_cells: Int[np.ndarray, "k 2"],
        photo_cells: Int[np.ndarray, "k 2"],
    ) -> PatchTurns:
        """Scale and angle of every pair of cells (column, row).

        Args:
            template: features of the view.
            photo: features of the crop.
            template_cells: columns and rows.
            photo_cells: likewise.
        """
        if not len(template_cells):
            return PatchTurns(np.zeros(0), np.zeros(0))
        pairs = np.concatenate(
            [
                photo[:, photo_cells[:, 1], photo_cells[:, 0]].T,
                template[:, template_cells[:, 1], template_cells[:, 0]].T,
            ],
            axis=1,
        )
        session = self.pool.get(self.regressor)
        count = len(pairs)
        out = session.run({session.first_input: pairs}, {"scale": (count, 1), "inplane": (count, 2)})
        cos_sin = out["inplane"].astype(np.float64)
        return PatchTurns(out["scale"].reshape(-1).astype(np.float64), np.arctan2(cos_sin[:, 1], cos_sin[:, 0]))
