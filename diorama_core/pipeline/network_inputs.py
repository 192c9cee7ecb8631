"""Network predictions added to the inputs: boxes and depth, where none were given.

Everything the user gave stays as it is; later stages cannot tell a network's contribution from a user's, except that
the inputs say whose depth it is.
"""

from __future__ import annotations

from dataclasses import replace

from diorama_core.artefacts import DepthPrediction, Inputs, LabelledBox
from diorama_core.library.taxonomy import UNKNOWN
from diorama_core.perception.foundation.depth_prediction import with_depth


def with_network_inputs(
    given: Inputs, detected: tuple[LabelledBox, ...] | None, predicted: DepthPrediction | None
) -> Inputs:
    """The inputs with detected boxes and predicted depth; None adds nothing.

    A guessed word is left out: what a box looks like is asked again of its outline, and with it everything else.
    """
    boxes = () if detected is None else tuple(_nameless(box) if box.guessed else box for box in detected)
    inputs = given if detected is None else replace(given, boxes=boxes)
    return inputs if predicted is None else with_depth(inputs, predicted)


def _nameless(box: LabelledBox) -> LabelledBox:
    return replace(box, category=UNKNOWN.name, label=UNKNOWN.name)
