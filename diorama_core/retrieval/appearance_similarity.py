"""Appearance similarity of shapes and an object in the photo, independent of size and pose.

The paper's second query (section 3.2 and supplement, "Multimodal 3D shape retrieval"): the masked crop orders what the
words found. The provider decides on the features: affair: the embedded one is here, the learned one in `joint`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Protocol, runtime_checkable

import cv2
import numpy as np
import trimesh
from jaxtyping import Bool, Float, UInt8

from diorama_core.geometry.palettes import palette_agreement, palette_of_appearance, palette_of_crop
from diorama_core.geometry.shape_appearance import SHARED_APPEARANCES, ShapeAppearance
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.render.templates import TemplateGrid, templates_with_faces
from diorama_core.render.view_features import (
    EDGES_WIDTH,
    LAYOUT_WIDTH,
    OUTLINE_WIDTH,
    colour_layout,
    layout_agreement,
    outline_and_edges,
    paint_views,
)
from diorama_core.retrieval.feature_cache import cached_features, has_features
from diorama_core.retrieval.outlines import close_gaps, open_share
from diorama_core.retrieval.settings import SETTINGS, SimilaritySettings
from diorama_core.scene.values import ArrayValue

NEUTRAL = 235
"""Gray level of what a crop does not show, and of the ground of a shape's pictures."""
SIDE_PX = 224
_GRID = TemplateGrid(elevations_deg=(8.0, 28.0), azimuths=12, size_px=72, longest_side=0.85, distance=2.2, fov_deg=32.0)
"""Views as photos of rooms have them, with little perspective."""
EMBEDDED_FEATURES = f"views-3-{_GRID.key}"
"""Cache key of the shapes' features; changes with the kind of features."""
_FORM_WIDTH = 2 * (OUTLINE_WIDTH + EDGES_WIDTH)


@dataclass(frozen=True, eq=False)
class ObjectCrop(ArrayValue):
    """One thing in the photo."""

    rgb: UInt8[np.ndarray, "h w 3"]
    """The photo."""
    mask: Bool[np.ndarray, "h w"]
    """The object's visible pixels; may be empty."""
    label: str
    """What it is called."""
    visible: float = 1.0
    """How much of it the mask shows, 0 to 1: less where it is cut, hidden or badly outlined."""
    mask_trust: float = 1.0
    """0 to 1: reliability of the gaps in the mask."""

    @property
    def crop(self) -> UInt8[np.ndarray, "s s 3"]:
        """The masked object on a neutral background, square; only background for an empty mask."""
        rows, columns = np.flatnonzero(self.mask.any(axis=1)), np.flatnonzero(self.mask.any(axis=0))
        if not len(rows):
            return np.full((SIDE_PX, SIDE_PX, 3), NEUTRAL, np.uint8)
        window = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
        shown = np.where(self.mask[window][..., None], self.rgb[window], NEUTRAL).astype(np.uint8)
        height, width = shown.shape[:2]
        side = round((1 + 2 * 0.06) * max(height, width)) + 1  # a margin on each side
        square = np.full((side, side, 3), NEUTRAL, np.uint8)
        top, left = (side - height) // 2, (side - width) // 2
        square[top : top + height, left : left + width] = shown
        return square


@runtime_checkable
class AppearanceSimilarity(Protocol):
    """Compares objects with shapes."""

    def similarities(self, item: ObjectCrop, shapes: Sequence[Shape]) -> Float[np.ndarray, " n"]:
        """Similarities, 0 (unlike) to 1, comparable among these shapes."""
        ...


@dataclass(frozen=True)
class EmbeddedSimilarity:
    """By main colours, and by outline, inner edges and places of colours in rendered views; needs no weights."""

    library: ShapeLibrary = field(repr=False)
    folder: Path | None = field(default=None, repr=False)
    """Cache folder of view features; `features` in Diorama's cache folder by default."""
    settings: SimilaritySettings = SETTINGS.similarity

    def similarities(self, item: ObjectCrop, shapes: Sequence[Shape]) -> Float[np.ndarray, " n"]:
        """The weight of the views relative to the main colours grows with visibility."""
        appearances = [self._appearance(s) for s in shapes]
        seen = palette_of_crop(item.rgb, item.mask)
        colours = np.array([palette_agreement(seen, palette_of_appearance(appearance)) for appearance in appearances])
        query = _feature(item.rgb, item.mask)
        if query is None or item.visible <= 0 or not len(shapes):
            return colours
        views = np.stack([self._views(s, appearance) for s, appearance in zip(shapes, appearances, strict=True)])
        weights = _form_weights(item.mask_trust, self.settings)
        form = np.clip(views[..., :_FORM_WIDTH] @ (query[:_FORM_WIDTH] * weights), 0.0, 1.0)
        layout = layout_agreement(query[_FORM_WIDTH:], views[..., _FORM_WIDTH:])
        alike = (form + self.settings.layout * layout).max(axis=1)
        of_colours = float(
            np.interp(1.0 - item.visible, (0.0, 1.0), (self.settings.colours, self.settings.colours_of_hidden))
        )
        of_views = item.visible * (1 + self.settings.layout)
        return (of_colours * colours + item.visible * alike) / (of_colours + of_views)

    def prepare(self, shape: Shape) -> None:
        """Make and keep what is compared of a shape, where that has not been done yet."""
        self._views(shape, self._appearance(shape))

    def is_prepared(self, shape: Shape) -> bool:
        """Whether what `prepare` keeps is on disk."""
        return has_features(EMBEDDED_FEATURES, shape, self.folder)

    def form_agreement(self, a: Shape, b: Shape) -> float:
        """How alike two shapes are from all sides, whatever their size and colours: 1 for the same, 0 or less for none.

        0 for a shape without a surface.
        """
        rows = [self._views(s, self._appearance(s))[:, :_FORM_WIDTH] for s in (a, b)]
        lengths = [np.sqrt(np.square(r).sum()) for r in rows]
        return float((rows[0] * rows[1]).sum() / max(lengths[0] * lengths[1], 1e-9))

    def _appearance(self, shape: Shape) -> ShapeAppearance:
        parts = partial(self.library.parts, shape.id)
        return SHARED_APPEARANCES.get(shape.content_hash, default_cache_dir() / "appearances", parts)

    def _views(self, shape: Shape, appearance: ShapeAppearance) -> Float[np.ndarray, "v width"]:
        # In double precision sums do not depend on the machine's order of adding by more than is rounded away.
        return cached_features(EMBEDDED_FEATURES, shape, lambda: _features_of_views(appearance), self.folder).astype(
            np.float64
        )


def _features_of_views(appearance: ShapeAppearance) -> Float[np.ndarray, "v width"]:
    """Features of every view; zeros where nothing is seen, and for shapes without a surface."""
    rows = np.zeros((len(_GRID), _FORM_WIDTH + LAYOUT_WIDTH))
    if not len(appearance.faces) or np.ptp(appearance.vertices, axis=0).max() <= 0:
        return rows
    templates, face_ids = templates_with_faces(
        trimesh.Trimesh(appearance.vertices, appearance.faces, process=False), _GRID
    )
    for k, rgb in enumerate(paint_views(templates, face_ids, appearance)):
        feature = _feature(rgb, templates.mask[k])
        if feature is not None:
            rows[k] = feature
    return rows


def _feature(rgb: UInt8[np.ndarray, "h w 3"], mask: Bool[np.ndarray, "h w"]) -> Float[np.ndarray, "width"] | None:
    """Outline and inner edges of a picture as it is outlined, and with the outline's gaps filled (what shows through
    is an edge), each of unit length; then where its colours are. None for an empty mask."""
    gray = cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY)
    form = [outline_and_edges(gray, m) for m in (mask, close_gaps(mask))]
    if form[0] is None or form[1] is None:
        return None
    return np.concatenate([*form[0], *form[1], colour_layout(rgb, mask)]).astype(np.float64)


def _form_weights(mask_trust: float, settings: SimilaritySettings) -> Float[np.ndarray, "width"]:
    """How much each number says about form: outlines and gaps of doubtful masks little; the sum's parts add up to 1."""
    open_ = open_share(mask_trust, settings)
    edges = settings.edges + settings.edges_of_doubtful * (1.0 - mask_trust)
    outline = np.repeat([1.0 - edges, edges], [OUTLINE_WIDTH, EDGES_WIDTH])
    return np.concatenate([open_ * outline, (1.0 - open_) * outline])
