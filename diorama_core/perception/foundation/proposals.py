"""Boxes and names from the recogniser that comes with Diorama, for a person to accept or correct."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import LabelledBox, Photo
from diorama_core.library.taxonomy import ARCHITECTURE_WORDS
from diorama_core.models.recogniser import Recogniser
from diorama_core.progress import Progress

CONFIDENT, LIKELY = 0.5, 0.25
"""Scores from which a build uses a box unseen, and from which a person is shown one."""
MOST = 12
MIN_SIDE_PX = 8.0
SUGGESTIONS = 5


@dataclass(frozen=True)
class OwnDetection:
    """Proposes boxes with the shipped detector and names them with the shipped namer."""

    recogniser: Recogniser
    threshold: float = CONFIDENT
    most: int = MOST

    def detect(self, photo: Photo, words: tuple[str, ...], progress: Progress) -> tuple[LabelledBox, ...]:
        """Boxes of likely objects, best first; `words` is ignored."""
        progress.report(0.0, "Looking for furniture")
        found = self.recogniser.propose(photo.rgb, self.threshold, self.most)
        large = np.flatnonzero((found.boxes[:, 2:] - found.boxes[:, :2]).min(axis=1, initial=np.inf) >= MIN_SIDE_PX)
        found = found.rows(large)
        progress.report(0.6, f"Naming {len(found)} boxes")
        names = names_of(self.recogniser, photo, found.boxes)
        boxes = []
        for box, score, ranked in zip(found.boxes, found.scores, names, strict=True):
            name = next((n for n in ranked if n not in ARCHITECTURE_WORDS), "object")
            x1, y1, x2, y2 = (float(v) for v in box)
            boxes.append(LabelledBox((x1, y1, x2, y2), name, name, float(score)))
        return tuple(boxes)


def names_of(recogniser: Recogniser, photo: Photo, boxes: Float[np.ndarray, "n 4"]) -> Sequence[tuple[str, ...]]:
    """For every box the likeliest categories, best first."""
    probabilities = recogniser.name(photo.rgb, boxes)
    order = np.argsort(-probabilities, axis=1, kind="stable")[:, :SUGGESTIONS]
    return [tuple(recogniser.categories[k] for k in row) for row in order]
