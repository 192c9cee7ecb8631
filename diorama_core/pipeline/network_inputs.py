"""Network predictions added to the inputs: boxes and depth, where none were given.

Everything the user gave stays as it is; later stages cannot tell a network's contribution from a user's, except that
the inputs say whose depth it is.
"""

from __future__ import annotations

from dataclasses import replace

from diorama_core.artefacts import DepthPrediction, Inputs, LabelledBox
from diorama_core.perception.foundation.depth_prediction import with_depth


def with_network_inputs(
    given: Inputs, detected: tuple[LabelledBox, ...] | None, predicted: DepthPrediction | None
) -> Inputs:
    """The inputs with detected boxes and predicted depth; None adds nothing."""
    inputs = given if detected is None else replace(given, boxes=detected)
    return inputs if predicted is None else with_depth(inputs, predicted)
