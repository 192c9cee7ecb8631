"""Where one looks through or past an object: cells of its box that look like its surroundings.

The outline that a box gives without networks fills rings, the space between legs and the air between slats, and
closed shapes fit it best. The picture tells more: what is seen through an object has the colours that are seen beside
it. Every cell of the box belongs either to the object or to what is behind it; the colours of both are told from each
other by kernel densities, those behind from cells around the place in question, those of the object from cells of its
mask that do not look like them. Shapes are compared with the result after both are blurred: how much of a place is
filled counts, and not whether two thin rods meet.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, Int, UInt8

from diorama_core.geometry.observed import Observed
from diorama_core.geometry.window import Window, soft_iou


@dataclass(frozen=True)
class SeeThroughSettings:
    """How it is told where one looks past an object."""

    colour_sigma: float = 5.0
    """Spread of colours of one thing side by side (CIE Lab), where lightness weighs less: shade changes it."""
    lightness: float = 0.5
    reach: float = 0.3
    """How far around a cell its background is looked for: sigma, as a share of the box's longer side."""
    of_mask: float = 0.55
    of_rest: float = 0.15
    """Probability that a cell shows the object where its mask says so, and where it does not."""
    unlike: float = 0.02
    """Density of colours that are met nowhere else."""
    rounds: int = 2
    blur: float = 0.04
    """Share of the window's side: as far as parts may lie off."""
    min_telling: float = 0.1
    """Weight of cells that may show the one as well as the other."""
    of_sure_mask: float = 0.5
    clearly: float = 0.6
    """What colours that tell the object clearly from its surroundings say beside a mask with which they agree; and the
    mean weight of cells from which on they do."""
    max_samples: int = 900
    """Cells, evenly spread, that stand for all of the background or of the object."""
    min_cells: int = 30
    min_side_px: float = 24.0
    """Objects of which less is seen have too few pixels."""


SETTINGS = SeeThroughSettings()
_NOTHING = 1e-9


@dataclass(frozen=True, eq=False)
class SeeThrough:
    """What the colours within one object's box say about where the object is."""

    window: Window
    shown: Float[np.ndarray, "n"]
    """Probability that a cell shows the object and not what is behind it; 0 outside its box."""
    weight: Float[np.ndarray, "n"]
    """How much a cell tells, 0 to 1; 0 outside the box and where nearer things are seen."""
    share: float
    """What the colours say beside the mask, 0 to 1: more the clearer they tell and the less it agrees with them."""
    settings: SeeThroughSettings = SETTINGS

    @classmethod
    def of(
        cls, rgb: UInt8[np.ndarray, "h w 3"], seen: Observed, settings: SeeThroughSettings = SETTINGS
    ) -> SeeThrough | None:
        """Look at one object; None where its mask is sure already, or too little of it or around it is seen.

        Args:
            rgb: the photo, sRGB, eight bits.
            seen: the object's cells, its mask's share in each, and what is in front.
            settings: when enough is seen.
        """
        x1, y1, x2, y2 = seen.box
        x, y = seen.window.centres_px.T
        boxed = (x >= x1) & (x < x2) & (y >= y1) & (y < y2)
        known = seen.weight > 0.5
        inside, behind = np.flatnonzero(boxed & known), np.flatnonzero(known & (seen.covered < 0.1))
        if seen.mask_trust >= 1.0 or min(x2 - x1, y2 - y1) < settings.min_side_px:
            return None
        if len(inside) < settings.min_cells or (~boxed[behind]).sum() < settings.min_cells:
            return None
        lab = _lab(seen.window.means(rgb), settings)
        reach_px = settings.reach * max(x2 - x1, y2 - y1)
        of_background = _density_around(inside, _spread(behind, settings), lab, seen.window.centres_px / reach_px)
        shown = np.zeros(len(x))
        shown[inside] = _posterior(lab[inside], seen.covered[inside], of_background, settings)
        telling = settings.min_telling + (1 - settings.min_telling) * np.abs(2 * shown - 1)
        see_through = cls(seen.window, shown, np.where(boxed, seen.weight * telling, 0.0), 0.0, settings)
        of_mask = float(see_through.agreement((seen.covered > 0.5)[None])[0])
        clear = min(float(see_through.weight[see_through.weight > 0].mean()) / settings.clearly, 1.0)
        return replace(see_through, share=clear * (1.0 - (1.0 - settings.of_sure_mask) * of_mask**2))

    def agreement(self, silhouettes: Bool[np.ndarray, "p n"]) -> Float[np.ndarray, "p"]:
        """How well shapes fill the same places, 0 to 1; cells as in the window."""
        return soft_iou(
            self._target,
            self._blur(np.where(silhouettes, self.weight.astype(np.float32), np.float32(0))),
            np.ones(len(self._target)),
        )

    @cached_property
    def _target(self) -> Float[np.ndarray, "n"]:
        """What shapes should fill."""
        return self._blur((self.shown * self.weight)[None])[0]

    def _blur(self, filled: Float[np.ndarray, "p n"] | Float32[np.ndarray, "p n"]) -> Float[np.ndarray, "p n"]:
        cells = self.window.cells
        sigma = self.settings.blur * cells
        grids = filled.reshape(-1, cells, cells).astype(np.float32, copy=False)
        blurred = [cv2.GaussianBlur(g, (0, 0), sigma, borderType=cv2.BORDER_CONSTANT) for g in grids]
        return np.asarray(blurred, dtype=np.float64).reshape(filled.shape)


def _lab(rgb: Float[np.ndarray, "n 3"], settings: SeeThroughSettings) -> Float[np.ndarray, "n 3"]:
    """CIE Lab, lightness weighted down, in units of `COLOUR_SIGMA`."""
    lab = cv2.cvtColor((rgb / 255.0).astype(np.float32)[None], cv2.COLOR_RGB2LAB)[0].astype(np.float64)
    return lab * np.sqrt([settings.lightness, 1.0, 1.0]) / settings.colour_sigma


def _kernel(a: Float[np.ndarray, "n d"], b: Float[np.ndarray, "m d"]) -> Float32[np.ndarray, "n m"]:
    """Gaussian kernel of points in units of its sigma; single precision, whose exponentials are ten times as fast."""
    middle = b.mean(axis=0)  # distances are differences of squares: small numbers keep their digits
    a, b = a - middle, b - middle
    ones, of_a, of_b = np.ones, -0.5 * (a**2).sum(axis=1), -0.5 * (b**2).sum(axis=1)
    left = np.column_stack([a, of_a, ones(len(a))]).astype(np.float32)
    right = np.column_stack([b, ones(len(b)), of_b]).astype(np.float32)
    exponent = left @ right.T
    return np.exp(np.minimum(exponent, 0.0, out=exponent), out=exponent)


def _spread(cells: Int[np.ndarray, "n"], settings: SeeThroughSettings) -> Int[np.ndarray, "m"]:
    """At most `MAX_SAMPLES` of the cells, evenly spread."""
    return cells[:: -(-len(cells) // settings.max_samples) or 1]


def _density_around(
    inside: Int[np.ndarray, "k"],
    behind: Int[np.ndarray, "m"],
    lab: Float[np.ndarray, "n 3"],
    place: Float[np.ndarray, "n 2"],
) -> Float[np.ndarray, "k"]:
    """How likely the colours inside are among those that are seen around them beside the object."""
    near = _kernel(place[inside], place[behind])
    _, rows, columns = np.intersect1d(inside, behind, assume_unique=True, return_indices=True)
    near[rows, columns] = 0.0
    whole = np.maximum(near.sum(axis=1, dtype=np.float64), _NOTHING)
    return np.einsum("nm,nm->n", near, _kernel(lab[inside], lab[behind])).astype(np.float64) / whole


def _posterior(
    lab: Float[np.ndarray, "k 3"],
    covered: Float[np.ndarray, "k"],
    of_background: Float[np.ndarray, "k"],
    settings: SeeThroughSettings,
) -> Float[np.ndarray, "k"]:
    """Probability that each cell shows the object: its colours are those of its mask that are not seen behind it."""
    samples = _spread(np.arange(len(lab)), settings)
    alike = _kernel(lab, lab[samples])
    alike[samples, np.arange(len(samples))] = 0.0
    usual = max(float(np.quantile(of_background, 0.9)), _NOTHING)
    likelihood = covered * (1 - np.minimum(of_background / usual, 1.0)) ** 2
    prior = settings.of_rest + (settings.of_mask - settings.of_rest) * covered
    shown = prior
    for _ in range(settings.rounds):
        of_object = (alike @ likelihood[samples].astype(np.float32)) / max(float(likelihood[samples].sum()), _NOTHING)
        theirs = (1 - prior) * (of_background + settings.unlike / 2)
        shown = 1 - theirs / (theirs + prior * (of_object + settings.unlike))
        likelihood = shown * covered
    return shown
