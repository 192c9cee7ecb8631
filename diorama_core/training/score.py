"""How good exported networks are on photos that a person annotated."""

from __future__ import annotations

from pathlib import Path

from diorama_core.evaluation.benchmarks.recognition import BEST, RecognitionBench, run
from diorama_core.models.recogniser import Recogniser
from diorama_core.perception.foundation.proposals import OwnDetection, names_of


def score(annotations: Path, photos: Path, recogniser: Recogniser) -> RecognitionBench:
    """Boxes and names on every annotated photo."""
    routes = {"own": OwnDetection(recogniser, threshold=0.01, most=BEST)}
    return run(annotations, photos, routes, {"own": lambda photo, boxes: names_of(recogniser, photo, boxes)}, {})
