"""Finding shapes by a picture of the thing: its outline, inner edges and colours against views of the shapes.

The paper's order (section 3.2): words first, which keep the search within a kind, then the picture among what they
found, both counting the same. Features are made of the shapes that are compared, once, and kept by content.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
import trimesh
from jaxtyping import Float, Float32

from diorama_core.geometry.looks import SHARED_LOOKS, Look
from diorama_core.geometry.palettes import palette_of_crop, palette_of_look
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.search import Found, find
from diorama_core.library.store import BUILT_IN, StoredLibrary, open_library
from diorama_core.library.store.features import FeatureMatrix
from diorama_core.progress import Progress
from diorama_core.render.crops import Crop
from diorama_core.render.templates import TemplateGrid, render_templates
from diorama_core.render.view_features import WIDTH, colour_feature, view_feature
from diorama_core.workers import Workers

SEARCH_GRID = TemplateGrid(
    elevations_deg=(-12.0, 8.0, 28.0), azimuths=12, size_px=72, longest_side=0.85, distance=2.2, fov_deg=32.0
)
"""Views as photos of rooms have them: rarely from high above, sometimes from below (lamps), little perspective."""
_VERSION = "1"
_BATCH = 32
_WORDS_FIRST = 50
"""Shapes that the words choose and the picture orders (the paper's 50)."""


@dataclass(frozen=True)
class ImageSearch:
    """Searches one library by pictures.

    Args:
        library: Whose shapes.
        folder: Where features are kept; None for the library's own place.
    """

    library: ShapeLibrary
    folder: Path | None = None

    def find(self, crop: Crop, text: str = "", k: int = 10, progress: Progress | None = None) -> Found:
        """The `k` shapes most like a picture, best first.

        Args:
            crop: The picture.
            text: What it shows, which keeps the search within that kind; where it names nothing that the library has,
                all shapes are compared.
            k: How many.
            progress: Reports and cancellation while features are made.
        """
        worded = find(self.library, text, _WORDS_FIRST)
        by_words = dict(zip(worded.shapes, worded.scores, strict=True)) if text.strip() else {}
        shapes = tuple(by_words) or self.library.shapes()
        matrix = self.prepared(shapes, progress)
        query = crop_feature(crop)
        if query is None or not len(matrix):
            return Found((), (), worded.wish, worded.note)
        alike = matrix.scores(query)
        best_words = max(by_words.values(), default=0.0)
        ranked = []
        for order, shape in enumerate(shapes):
            place = matrix.position(_key(shape))
            if place is None:
                continue
            score = float(alike[place])
            if best_words > 0:
                score = 0.5 * (score + by_words[shape] / best_words)
            ranked.append((-score, order))
        ranked = sorted(ranked)[:k]
        return Found(
            tuple(shapes[i] for _, i in ranked), tuple(-s for s, _ in ranked), worded.wish, worded.note if text else ""
        )

    def prepared(
        self,
        shapes: Sequence[Shape],
        progress: Progress | None = None,
        workers: Workers | None = None,
        name: str = BUILT_IN,
    ) -> FeatureMatrix:
        """The matrix with features of all these shapes; those that are missing are made and kept.

        Args:
            shapes: Of the library.
            progress: Reports and cancellation; what was made stays.
            workers: Where to make them; None for this process.
            name: What the workers open the library by.
        """
        progress = progress or Progress()
        matrix = FeatureMatrix(self._folder(), WIDTH, len(SEARCH_GRID))
        by_key = {_key(s): s.id for s in shapes}
        missing = [(key, by_key[key]) for key in matrix.missing(by_key)]
        batches = [missing[i : i + _BATCH] for i in range(0, len(missing), _BATCH)]
        if workers is None:
            made = (_features(partial(_look, self.library), batch) for batch in batches)
        else:
            task = partial(_features_of_named, name)
            made = (done.unwrap() for done in workers.map(task, batches))
        progress.check()
        for count, (keys, values) in enumerate(made, start=1):
            if keys:
                matrix.append(keys, values)
            progress.report(count / len(batches), f"looking at shapes: {min(count * _BATCH, len(missing))}")
        return matrix

    def _folder(self) -> Path:
        if self.folder is not None:
            return self.folder
        own = self.library.folder if isinstance(self.library, StoredLibrary) else default_cache_dir()
        return own / "features" / f"views-{_VERSION}"


def crop_feature(crop: Crop) -> Float32[np.ndarray, "width"] | None:
    """The feature of a picture; None when it shows nothing."""
    colour = colour_feature(palette_of_crop(crop.rgb, crop.mask))
    return view_feature(crop.gray, crop.mask, colour)


def shape_features(look: Look) -> Float32[np.ndarray, "views width"]:
    """Features of all views of a shape; zeros for a view in which nothing is seen."""
    mesh = trimesh.Trimesh(look.vertices, look.faces, process=False)
    templates = render_templates(mesh, SEARCH_GRID)
    colour = colour_feature(palette_of_look(look))
    gray, mask = templates.gray, templates.mask
    rows = [view_feature(gray[i], mask[i], colour) for i in range(len(SEARCH_GRID))]
    return np.stack([np.zeros(WIDTH, np.float32) if row is None else row for row in rows])


def _key(shape: Shape) -> str:
    return shape.content_hash or shape.id


def _look(library: ShapeLibrary, key: str, shape_id: str) -> Look:
    return SHARED_LOOKS.get(key, default_cache_dir() / "looks", lambda: library.parts(shape_id))


def _features_of_named(
    name: str, batch: Sequence[tuple[str, str]]
) -> tuple[list[str], Float[np.ndarray, "n views width"]]:
    """In another process: features of shapes of a library that is opened there."""
    return _features(partial(_look, open_library(name)), batch)


def _features(look_of: partial[Look], batch: Sequence[tuple[str, str]]) -> tuple[list[str], np.ndarray]:
    """Keys and features of shapes given as (key, id); shapes without a surface are left out."""
    keys, rows = [], []
    for key, shape_id in batch:
        look = look_of(key, shape_id)
        if len(look.faces) and np.ptp(look.vertices, axis=0).max() > 0:
            keys.append(key)
            rows.append(shape_features(look))
    return keys, np.array(rows).reshape(len(keys), len(SEARCH_GRID), WIDTH)
