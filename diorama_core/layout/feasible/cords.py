"""Lamps whose upper end is above the picture's border hang from the ceiling: they go on up to it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.layout.feasible.photo_observations import PhotoObservations
from diorama_core.layout.problem.problem import Problem


def reaching_ceilings(problem: Problem, observations: PhotoObservations) -> Problem:
    """The problem with lamps whose upper end was not seen going on up to the ceiling that they hang from.

    The lower end stays.
    """
    scale, p, slope = problem.scale.copy(), problem.p.copy(), problem.settings.ceiling_slope
    for i in map(int, np.flatnonzero(problem.free & observations.hidden[:, 1])):
        ceiling = problem.surface[i]
        if problem.on_plane[i] is None or ceiling is None or ceiling.normal[2] > -slope or problem.contact[i][2] < 0.5:
            continue
        up = problem.R[i][:, 2]
        height = float(problem.shape_size[i, 2] * scale[i, 2])
        gap = (float(ceiling.normal @ p[i]) - ceiling.level) / max(-float(ceiling.normal @ up), slope) - height / 2
        if 0.0 < gap <= problem.settings.max_cord_m:
            scale[i, 2] *= 1.0 + gap / height
            p[i] = p[i] + 0.5 * gap * up
    return replace(problem, scale=scale, p=p)
