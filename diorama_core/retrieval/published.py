"""Retrieval as publications have it: shapes near to the label's words, ordered by the crop, and shapes as ACDC finds
them (Dai et al. 2024, "digital cousins"): kinds by the label, then shapes by their looks. No size, outline in place or
neighbour has a say.

The paper (section 3.2 and supplement) does not say how many shapes the words leave; shapes that carry others are not
told apart here. ACDC compares the label with the library's categories by CLIP and the masked crop with pictures of
shapes by DINOv2, and lets a language model choose among the nearest. Here the taxonomy names the kinds, and looks are
compared as the stage is told: in a joint embedding where networks are at hand, else by the embedded views.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np
from jaxtyping import Float32

from diorama_core.artefacts import DetectedObject, Inputs, ObjectGeometry, RankedShapes
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.progress import Progress
from diorama_core.retrieval.appearance_similarity import AppearanceSimilarity, EmbeddedSimilarity, ObjectCrop
from diorama_core.retrieval.joint import PROMPT, JointEmbedding, shape_vectors
from diorama_core.retrieval.pools import near_kinds

By = Literal["words", "picture", "words and picture"]


@dataclass(frozen=True)
class TextThenPicture:
    """The shapes of a whole library nearest to what is asked, in one joint embedding."""

    library: ShapeLibrary
    embedding: JointEmbedding
    by: By = "words and picture"
    folder: Path | None = field(default=None, repr=False)
    """Cache folder of embeddings; `features` in Diorama's cache folder by default."""
    left_by_words: int = 50
    shapes: int = 8

    def retrieve(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> tuple[RankedShapes, ...]:
        """At most `shapes` of every object that was placed.

        Args:
            inputs, objects, geometry, progress: as documented in `protocols.RetrievalStage`.
        """
        shapes = self.library.shapes()
        placed = {c.object_id for c in geometry.cuboids}
        if not shapes or not placed:
            return ()
        known = shape_vectors(self.library, self.embedding, shapes, self.folder)
        rankings = []
        for index, item in enumerate(objects):
            if item.id in placed:
                progress.report(index / len(objects), f"Looking for shapes: {item.label}")
                rankings.append(RankedShapes(item.id, self._rank(inputs, item, shapes, known)))
        return tuple(rankings)

    def _rank(
        self, inputs: Inputs, item: DetectedObject, shapes: tuple[Shape, ...], known: Float32[np.ndarray, "n d"]
    ) -> tuple[tuple[str, float], ...]:
        """Shapes with their cosines, best first; what cannot be seen is found by its words."""
        left = np.arange(len(shapes))
        cosine = known @ self.embedding.text(PROMPT.format(item.label))
        if self.by != "words" and item.mask.any():
            if self.by == "words and picture":
                left = np.argsort(-cosine, kind="stable")[: self.left_by_words]
            cosine = known @ self.embedding.picture(ObjectCrop(inputs.photo.rgb, item.mask, item.label).crop)
        order = sorted(left.tolist(), key=lambda k: (-float(cosine[k]), shapes[k].id))[: self.shapes]
        return tuple((shapes[k].id, float(cosine[k])) for k in order)


@dataclass(frozen=True)
class MatchedByLooks:
    """The shapes of an object's nearest kinds that look most like its crop."""

    library: ShapeLibrary
    similarity: AppearanceSimilarity | None = None
    """Compares looks; by rendered views where None."""
    kinds: int = 3
    shapes: int = 6
    """As in the publication's default configuration."""

    def retrieve(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> tuple[RankedShapes, ...]:
        """At most `shapes` of every object that was placed; nothing for kinds of which the library has none.

        Args:
            inputs, objects, geometry, progress: as documented in `protocols.RetrievalStage`.
        """
        similarity = self.similarity or EmbeddedSimilarity(self.library)
        placed = {c.object_id for c in geometry.cuboids}
        rankings = []
        for index, item in enumerate(objects):
            if item.id not in placed:
                continue
            progress.report(index / len(objects), f"Looking for shapes: {item.label}")
            shapes = list(self.library.in_category(item.category))
            related = near_kinds(item.category)[: self.kinds] if not shapes else ()
            shapes += [s for kind in related for s in self.library.in_category(kind)]
            crop = ObjectCrop(inputs.photo.rgb, item.mask, item.label, 1.0, 1.0)
            alike = similarity.similarities(crop, shapes)
            order = sorted(range(len(shapes)), key=lambda k: (-alike[k], shapes[k].id))[: self.shapes]
            rankings.append(RankedShapes(item.id, tuple((shapes[k].id, float(alike[k])) for k in order)))
        return tuple(rankings)
