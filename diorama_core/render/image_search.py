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

from diorama_core.errors import InputError
from diorama_core.geometry.palettes import palette_of_appearance, palette_of_crop
from diorama_core.geometry.shape_appearance import SHARED_APPEARANCES, ShapeAppearance
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.library.naming import understand
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.search import FoundShapes, find
from diorama_core.library.store import BUILT_IN, StoredLibrary, open_library
from diorama_core.library.store.features import FeatureMatrix
from diorama_core.library.store.vectors import vector_index
from diorama_core.progress import SILENT, Progress
from diorama_core.render.crops import ShapeCrop
from diorama_core.render.templates import TemplateGrid, render_templates
from diorama_core.render.view_features import WIDTH, colour_feature, view_feature
from diorama_core.workers import Workers

SEARCH_GRID = TemplateGrid(
    elevations_deg=(-12.0, 8.0, 28.0), azimuths=12, size_px=72, longest_side=0.85, distance=2.2, fov_deg=32.0
)
"""Views as photos of rooms have them: rarely from high above, sometimes from below (lamps), little perspective."""
_VERSION = "2"
_BATCH = 32
_STALE = 4
"""Features are made anew when there are so many times more of them than shapes."""
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

    def find(self, crop: ShapeCrop, text: str = "", k: int = 10, progress: Progress = SILENT) -> FoundShapes:
        """The `k` shapes most like a picture, best first.

        Args:
            crop: The picture.
            text: What it shows, which keeps the search within that kind; where it names nothing that the library has,
                all shapes are compared.
            k: How many.
            progress: Reports and cancellation while features are made.

        Raises:
            InputError: when the picture's mask is empty.
        """
        if text.strip():
            worded = find(self.library, text, _WORDS_FIRST)
            if worded.shapes:
                return self._rerank(worded, crop, k, progress)
            matches = self._all(crop, k, progress)
            return FoundShapes(matches.shapes, matches.scores, worded.query, worded.note)
        return self._all(crop, k, progress)

    def _rerank(self, worded: FoundShapes, crop: ShapeCrop, k: int, progress: Progress) -> FoundShapes:
        """Order what words found by words and picture alike."""
        matrix = self.prepare(worded.shapes, progress)
        alike = matrix.scores(_query(crop))
        scores = []
        for shape, by_words in zip(worded.shapes, worded.scores, strict=True):
            place = matrix.position(_key(shape))
            by_picture = 0.0 if place is None else float(alike[place])
            scores.append(0.5 * (by_picture + by_words / worded.scores[0]))
        order = np.argsort(-np.array(scores), kind="stable")[:k]
        shapes = tuple(worded.shapes[i] for i in order)
        return FoundShapes(shapes, tuple(scores[i] for i in order), worded.query, worded.note)

    def _all(self, crop: ShapeCrop, k: int, progress: Progress) -> FoundShapes:
        """The whole library by the picture alone."""
        by_key: dict[str, list[Shape]] = {}
        for shape in self.library.shapes():
            by_key.setdefault(_key(shape), []).append(shape)
        matrix = self.prepare(self.library.shapes(), progress)
        stale = len(matrix.missing_from(by_key))
        near = vector_index(matrix).top(_query(crop), k + stale)
        matches = [(shape, n.score) for n in near for shape in by_key.get(n.key, ())][:k]
        return FoundShapes(tuple(shape for shape, _ in matches), tuple(score for _, score in matches), understand(""))

    def prepare(
        self,
        shapes: Sequence[Shape],
        progress: Progress = SILENT,
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
        matrix = FeatureMatrix(self._folder(), WIDTH, len(SEARCH_GRID))
        by_key = {_key(s): s.id for s in shapes}
        if len(matrix) > _STALE * max(len(self.library.shapes()), 100):
            matrix.clear()  # nearly all of shapes that are no more
        missing = [(key, by_key[key]) for key in matrix.missing(by_key)]
        batches = [missing[i : i + _BATCH] for i in range(0, len(missing), _BATCH)]
        if workers is None:
            made = (_features(partial(_appearance, self.library), batch) for batch in batches)
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
        folder = self.library.folder if isinstance(self.library, StoredLibrary) else default_cache_dir()
        return folder / "features" / f"views-{_VERSION}"


def _query(crop: ShapeCrop) -> Float32[np.ndarray, "width"]:
    colour = colour_feature(palette_of_crop(crop.rgb, crop.mask))
    feature = view_feature(crop.gray, crop.mask, colour)
    if feature is None:
        raise InputError("the picture shows nothing to look for; give one of an object")
    return feature


def shape_features(appearance: ShapeAppearance) -> Float32[np.ndarray, "views width"]:
    """Features of all views of a shape; zeros for a view in which nothing is seen."""
    mesh = trimesh.Trimesh(appearance.vertices, appearance.faces, process=False)
    templates = render_templates(mesh, SEARCH_GRID)
    colour = colour_feature(palette_of_appearance(appearance))
    gray, mask = templates.gray, templates.mask
    rows = [view_feature(gray[i], mask[i], colour) for i in range(len(SEARCH_GRID))]
    return np.stack([np.zeros(WIDTH, np.float32) if row is None else row for row in rows])


def _key(shape: Shape) -> str:
    return shape.content_hash or shape.id


def _appearance(library: ShapeLibrary, key: str, shape_id: str) -> ShapeAppearance:
    return SHARED_APPEARANCES.get(key, default_cache_dir() / "appearances", lambda: library.parts(shape_id))


def _features_of_named(
    name: str, batch: Sequence[tuple[str, str]]
) -> tuple[list[str], Float[np.ndarray, "n views width"]]:
    """In another process: features of shapes of a library that is opened there."""
    return _features(partial(_appearance, open_library(name)), batch)


def _features(
    appearance_of: partial[ShapeAppearance], batch: Sequence[tuple[str, str]]
) -> tuple[list[str], np.ndarray]:
    """Keys and features of shapes given as (key, id); shapes without a surface are left out."""
    keys, rows = [], []
    for key, shape_id in batch:
        appearance = appearance_of(key, shape_id)
        if len(appearance.faces) and np.ptp(appearance.vertices, axis=0).max() > 0:
            keys.append(key)
            rows.append(shape_features(appearance))
    return keys, np.array(rows).reshape(len(keys), len(SEARCH_GRID), WIDTH)
