"""Seats stand at tables: where a picture leaves open how far away a chair is, the table that it belongs to tells."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from diorama_core.library.taxonomy import with_kin
from diorama_core.perception.metrology.box_observations import BoxObservations
from diorama_core.perception.metrology.problem import Cuboids, Problems
from diorama_core.perception.metrology.settings import SETTINGS, PlacementSettings

SEATS = with_kin("chair", "office chair", "stool")
TABLES = with_kin("table", "desk", "kitchen island")


def tables_of_seats(boxes: Mapping[int, Cuboids], observations: BoxObservations) -> dict[int, int]:
    """For every seat that may be at a table the table that is nearest.

    Args:
        boxes: where everything on the floor stands so far, by index; batches of one.
        observations: of all objects.
    """
    tables = [i for i in boxes if observations.categories[i].name in TABLES]
    seats = [i for i in boxes if observations.categories[i].name in SEATS]
    return {i: min(tables, key=lambda j: (_gap_m(boxes[i], boxes[j]), j)) for i in seats} if tables else {}


def at_table(rows: Problems, table: Cuboids, settings: PlacementSettings = SETTINGS.placement) -> Problems:
    """The rows of a seat with its base at a table: over its top or around it, by about a seat's depth."""
    beside = np.exp(rows.log_size[:, :1]) + settings.stands_off_m
    half = table.size_m[:, :2] / 2 + np.repeat(beside, 2, axis=1)
    place = np.tile([*table.centre[0, :2], float(table.yaw_rad[0])], (len(rows), 1))
    return rows.changed(footprint=np.column_stack([place, half]), footprint_sigma_m=settings.stands_off_sigma_m)


def _gap_m(seat: Cuboids, table: Cuboids) -> float:
    """How far the seat's centre is from the table's footprint."""
    offset: Float[np.ndarray, "2"] = seat.centre[0, :2] - table.centre[0, :2]
    c, s = np.cos(table.yaw_rad[0]), np.sin(table.yaw_rad[0])
    local = np.array([c * offset[0] + s * offset[1], -s * offset[0] + c * offset[1]])
    return float(np.linalg.norm(np.maximum(np.abs(local) - table.size_m[0, :2] / 2, 0.0)))
