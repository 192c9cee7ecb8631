"""Inputs in which few of the things are marked, where a test does not ask how many a build finds."""

from __future__ import annotations

from collections.abc import Container
from dataclasses import replace

import numpy as np

from diorama_core.artefacts import Box, Inputs


def few_marked(inputs: Inputs, boxes: Container[Box]) -> Inputs:
    """The inputs with nothing marked but what these boxes are drawn about."""
    kept = tuple((number, b) for number, b in inputs.instance_boxes if b.box in boxes)
    instances = inputs.instances
    if instances is not None:
        instances = np.where(np.isin(instances, [number for number, _ in kept]), instances, 0).astype(instances.dtype)
    marked = tuple(b for b in inputs.boxes if b.box in boxes)
    return replace(inputs, boxes=marked, instances=instances, instance_boxes=kept)
