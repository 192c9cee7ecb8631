"""What objects look like to the namer that comes with Diorama, which learnt from rendered rooms."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diorama_core.artefacts import DetectedObject, Photo, SeenKinds
from diorama_core.models.own_weights import has_own_recogniser
from diorama_core.models.recogniser import Recogniser, own_recogniser
from diorama_core.progress import Progress


@dataclass(frozen=True)
class OwnNaming:
    """Asks the shipped namer about every box."""

    recogniser: Recogniser

    def name(self, photo: Photo, objects: tuple[DetectedObject, ...], progress: Progress) -> tuple[SeenKinds, ...]:
        """Probabilities of all categories, as if all were equally frequent, and of all forms, for every object.

        Args:
            photo, objects, progress: as documented in `protocols.NamingStage`.
        """
        progress.report(0.0, f"Looking at {len(objects)} objects")
        boxes = np.array([item.box for item in objects], dtype=float).reshape(-1, 4)
        looks, names = self.recogniser.look(photo.rgb, boxes), self.recogniser.categories
        return tuple(
            SeenKinds(item.id, names, kinds, tuple(map(float, form)))
            for item, kinds, form in zip(objects, looks.kinds, looks.forms, strict=True)
        )


def own_naming() -> OwnNaming | None:
    """The namer that comes with Diorama; None where its weights were left out."""
    return OwnNaming(own_recogniser()) if has_own_recogniser() else None
