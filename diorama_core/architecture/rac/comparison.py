"""Layouts compared with the picture: what each plane costs in each cell, and the layout that agrees best.

Costs are the publication's two: a layout's depth should be that which is measured where the room is seen and nowhere
in front of the objects, and its segments should be those of the picture.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from diorama_core.architecture.rac.arrangement import Arrangement, PlaneLine, arrangement, inverse_depths
from diorama_core.architecture.rac.proposals import Proposals
from diorama_core.architecture.rac.search import borders_of, labelled
from diorama_core.architecture.walls.surface import MeasuredSurface
from diorama_core.scene.types import Camera

FULL_DISAGREEMENT = 0.2
"""Relative difference of depth that counts in full."""
SEGMENT_WEIGHT = 0.5
"""Cost of a pixel in another plane's segment, beside one with the wrong depth."""


@dataclass(frozen=True, eq=False)
class RoomLayout:
    """A plane for every cell of the picture."""

    cells: Arrangement
    chosen: tuple[int, ...]
    """The plane of each cell."""

    def planes_at(self, pixels: Float[np.ndarray, "n 2"]) -> Int[np.ndarray, "n"]:
        """The plane that each pixel shows; -1 for one in a piece too small to be a cell."""
        cell = self.cells.holds(pixels)
        return np.where(cell >= 0, np.array(self.chosen, dtype=int)[cell], -1)

    def depth_at(self, pixels: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, "n"]:
        """Rendered depth in metres; infinite where no cell is."""
        plane = self.planes_at(pixels)
        rows = self.cells.inverse[np.maximum(plane, 0)]
        inverse = (rows[:, :2] * pixels).sum(axis=1) + rows[:, 2]
        return np.where((plane >= 0) & (inverse > 0), 1.0 / np.maximum(inverse, 1e-9), np.inf)


def best_layout(
    surface: MeasuredSurface, proposals: Proposals, camera: Camera, hidden_ends: Sequence[PlaneLine] = ()
) -> RoomLayout | None:
    """The cheapest feasible layout of the proposed planes, with lines at which some of them may end besides.

    None where the search finds no labelling that fills the picture.

    Args:
        surface: measured points in the world, and which of them belong to objects.
        proposals: the proposed planes.
        camera: of the photo, in the world.
        hidden_ends: further lines at which planes may end, in the picture.
    """
    k = camera.intrinsics
    inverse = inverse_depths(proposals.normals, proposals.offsets, camera)
    cells = arrangement(inverse, (k.width, k.height), hidden_ends)
    chosen = labelled(cell_costs(cells, surface, proposals, camera), borders_of(cells))
    return None if chosen is None else RoomLayout(cells, chosen)


def cell_costs(
    cells: Arrangement, surface: MeasuredSurface, proposals: Proposals, camera: Camera
) -> Float[np.ndarray, "c p"]:
    """Disagreement of each plane in each cell, in shares of the picture; infinite behind the camera.

    Args:
        cells: the c cells into which the planes' lines divide the picture.
        surface: measured points in the world, and which of them belong to objects.
        proposals: the p proposed planes.
        camera: of the photo, in the world.
    """
    pixels = camera.project(surface.points)
    cell = cells.holds(pixels)
    measured = 1.0 / np.maximum(surface.depth_m, 1e-6)
    costs = np.zeros((len(cells.cells), len(cells.inverse)))
    for p in range(len(cells.inverse)):
        q = cells.inverse_at(p, pixels)
        off = (q - measured) / measured
        # What hides the layout bounds it from one side only.
        wrong = np.where(surface.is_object, np.maximum(off, 0.0), np.abs(off))
        each = np.minimum(wrong / FULL_DISAGREEMENT, 1.0)
        each = each + SEGMENT_WEIGHT * ((proposals.segment >= 0) & (proposals.segment != p))
        inside = cell >= 0
        costs[:, p] = np.bincount(cell[inside], each[inside], minlength=len(cells.cells))
        behind = [float(cells.inverse_at(p, c.corners.mean(axis=0, keepdims=True))[0]) <= 0.0 for c in cells.cells]
        costs[np.array(behind, dtype=bool), p] = np.inf
    return costs / max(len(pixels), 1)
