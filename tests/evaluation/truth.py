"""Parts of the true scene of a rendered room."""

from __future__ import annotations

from dataclasses import replace

from diorama_core.evaluation.metrics.scene import true_supports
from diorama_core.scene.types import Scene
from diorama_core.synthesis.truth import TruthView


def without_unasked(view: TruthView) -> Scene:
    """The true scene of the objects asked for only: what a perfect system would return."""
    retained = tuple(view.scene.objects[k] for k in view.indices)
    return replace(view.scene, objects=retained, supports=true_supports(view))
