"""How like shapes are to a thing in the photo, whatever their size and pose.

The paper's second query (section 3.2 and supplement, "Multimodal 3D shape retrieval"): the masked crop orders what the
words found. Which features compare is the provider's affair: the embedded one is here, the learned one in `joint`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Protocol

import cv2
import numpy as np
import trimesh
from jaxtyping import Bool, Float, Float32, UInt8

from diorama_core.geometry.looks import SHARED_LOOKS, Look
from diorama_core.geometry.palettes import NOTHING_KNOWN, palette_agreement, palette_of_crop, palette_of_look
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.render.templates import TemplateGrid, render_templates
from diorama_core.render.view_features import WIDTH, Weights, colour_feature, view_feature
from diorama_core.retrieval.kept import kept_features
from diorama_core.retrieval.outlines import filled, open_share
from diorama_core.scene.values import ArrayValue

NEUTRAL = 235
"""Gray level of what a crop does not show, and of the ground of a shape's pictures."""
SIDE_PX = 224
_MARGIN = 0.06
_GRID = TemplateGrid(elevations_deg=(8.0, 28.0), azimuths=12, size_px=72, longest_side=0.85, distance=2.2, fov_deg=32.0)
"""Views as photos of rooms have them, with little perspective."""
_KIND = f"views-2-{_GRID.key}"
_SHAPE_ONLY = Weights(outline=0.5, edges=0.5, colour=0.0)
_NO_COLOUR = colour_feature(NOTHING_KNOWN)
_COLOUR_WEIGHTS = (0.3, 0.6)
"""Beside the views of a thing that is seen whole, and of one of which little is seen."""


@dataclass(frozen=True, eq=False)
class Glimpse(ArrayValue):
    """One thing in the photo."""

    rgb: UInt8[np.ndarray, "h w 3"]
    """The photo."""
    mask: Bool[np.ndarray, "h w"]
    """The thing's visible pixels; may be empty."""
    label: str
    """What it is called."""
    visible: float = 1.0
    """How much of it the mask shows, 0 to 1: less where it is cut, hidden or badly outlined."""
    mask_trust: float = 1.0
    """0 to 1: whether the mask's inner gaps can be believed."""

    @property
    def crop(self) -> UInt8[np.ndarray, "s s 3"]:
        """The thing alone on a neutral ground, square; all ground for an empty mask."""
        rows, columns = np.flatnonzero(self.mask.any(axis=1)), np.flatnonzero(self.mask.any(axis=0))
        if not len(rows):
            return np.full((SIDE_PX, SIDE_PX, 3), NEUTRAL, np.uint8)
        window = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
        shown = np.where(self.mask[window][..., None], self.rgb[window], NEUTRAL).astype(np.uint8)
        height, width = shown.shape[:2]
        side = round((1 + 2 * _MARGIN) * max(height, width)) + 1
        square = np.full((side, side, 3), NEUTRAL, np.uint8)
        top, left = (side - height) // 2, (side - width) // 2
        square[top : top + height, left : left + width] = shown
        return square


class Likeness(Protocol):
    """Compares things with shapes."""

    def of(self, thing: Glimpse, shapes: Sequence[Shape]) -> Float[np.ndarray, " n"]:
        """0 (unlike) to 1, comparable among these shapes."""
        ...


@dataclass(frozen=True)
class EmbeddedLikeness:
    """By main colours, and by outline and inner edges against rendered views; needs no weights."""

    library: ShapeLibrary = field(repr=False)
    folder: Path | None = field(default=None, repr=False)
    """Where features of views are kept; `features` in the cache folder by default."""

    def of(self, thing: Glimpse, shapes: Sequence[Shape]) -> Float[np.ndarray, " n"]:
        """The better seen the thing, the more the views say beside the colours."""
        looks = [self._look(s) for s in shapes]
        seen = palette_of_crop(thing.rgb, thing.mask)
        colours = np.array([palette_agreement(seen, palette_of_look(look)) for look in looks])
        query = _open_and_filled(cv2.cvtColor(thing.rgb, cv2.COLOR_RGB2GRAY), thing.mask)
        if query is None or thing.visible <= 0:
            return colours
        share = open_share(thing.mask_trust)
        query = query * np.array([[share], [1 - share]], np.float32)
        alike = [float((self._views(s, look) @ query.ravel()).max()) for s, look in zip(shapes, looks, strict=True)]
        of_colours = float(np.interp(1.0 - thing.visible, (0.0, 1.0), _COLOUR_WEIGHTS))
        return (of_colours * colours + thing.visible * np.clip(alike, 0.0, 1.0)) / (of_colours + thing.visible)

    def _look(self, shape: Shape) -> Look:
        parts = partial(self.library.parts, shape.id)
        return SHARED_LOOKS.get(shape.content_hash, default_cache_dir() / "looks", parts)

    def _views(self, shape: Shape, look: Look) -> Float32[np.ndarray, "v width"]:
        return kept_features(_KIND, shape, lambda: _features_of_views(look), self.folder).astype(np.float32)


def _features_of_views(look: Look) -> Float32[np.ndarray, "v width"]:
    """Of every view; zeros where nothing is seen, and for shapes without a surface."""
    rows = np.zeros((len(_GRID), 2 * WIDTH), np.float32)
    if not len(look.faces) or np.ptp(look.vertices, axis=0).max() <= 0:
        return rows
    templates = render_templates(trimesh.Trimesh(look.vertices, look.faces, process=False), _GRID)
    for k, (gray, mask) in enumerate(zip(templates.gray, templates.mask, strict=True)):
        found = _open_and_filled(gray, mask)
        if found is not None:
            rows[k] = found.ravel()
    return rows


def _open_and_filled(
    gray: UInt8[np.ndarray, "h w"], mask: Bool[np.ndarray, "h w"]
) -> Float32[np.ndarray, "2 width"] | None:
    """Features of a picture as it is outlined, and with the outline's gaps filled: what shows through is an edge."""
    rows = [view_feature(gray, m, _NO_COLOUR, _SHAPE_ONLY) for m in (mask, filled(mask))]
    return None if rows[0] is None or rows[1] is None else np.stack([rows[0], rows[1]])
