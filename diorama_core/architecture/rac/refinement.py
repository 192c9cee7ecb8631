"""Walls that end at walls which nothing shows (Stekovic et al. 2020, the iterative refinement of the layout).

The rendered layout is compared with the measured depth. Where the picture looks deeper than a wall of the layout, that
wall was drawn past its end, because the wall behind its edge is turned away and nothing proposes it. The line along
which the depth leaves the wall, fitted robustly, and the camera's centre span the plane that ends it; in the picture
that plane is the line itself. The search runs again with such lines, as long as the layout gets nearer to the depth.

The publication looks for walls that are drawn too far. Of two walls that cannot both be drawn without such a line the
search may as well have left the nearer one out: walls that are measured before the layout are ended, too.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float

from diorama_core.architecture.rac.arrangement import PlaneLine
from diorama_core.architecture.rac.proposals import Proposals
from diorama_core.architecture.rac.search import RoomLayout, best_layout
from diorama_core.architecture.walls.surface import MeasuredSurface
from diorama_core.scene.types import Camera


@dataclass(frozen=True)
class LayoutRefinementSettings:
    """When the layout is refined by a hidden wall."""

    max_rounds: int = 3
    min_error_m: float = 0.01
    """The mean over the picture below which nothing is refined."""
    wrong_m: float = 0.1
    """What is measured this far from a wall does not belong to it."""
    min_share: float = 2000 / (640 * 480)
    """Share of the picture that is wrong about a wall before its end is looked for. These four are as in the authors'
    program."""
    line_samples: float = 1.0
    """Distance from a line, in samples of the depth grid, up to which a change of depth agrees with it."""
    min_agreeing: int = 10
    line_trials: int = 256


SETTINGS = LayoutRefinementSettings()


def refine_layout(layout: RoomLayout, surface: MeasuredSurface, proposals: Proposals, camera: Camera) -> RoomLayout:
    """The layout with walls ended where the picture looks past them, as far as that explains the depth better.

    Args:
        layout: the cheapest layout of the proposed planes.
        surface: measured points in the world, and which of them belong to objects.
        proposals: the proposed planes.
        camera: of the photo, in the world.
    """
    pixels = camera.project(surface.points)
    ends: tuple[PlaneLine, ...] = ()
    for _ in range(SETTINGS.max_rounds):
        error = depth_error_m(layout, surface, pixels)
        new = find_hidden_ends(layout, surface, proposals, camera) if error > SETTINGS.min_error_m else ()
        tried = best_layout(surface, proposals, camera, (*ends, *new)) if new else None
        if tried is None or depth_error_m(tried, surface, pixels) >= error:
            break
        layout, ends = tried, (*ends, *new)
    return layout


def depth_error_m(layout: RoomLayout, surface: MeasuredSurface, pixels: Float[np.ndarray, "n 2"]) -> float:
    """Mean distance of the rendered from the measured depth in metres; behind objects the layout may be anywhere."""
    rendered = layout.depth_at(pixels)
    known = np.isfinite(rendered)
    before = np.where(known, surface.depth_m - np.where(known, rendered, 0.0), 0.0)
    return float(np.where(surface.is_object, np.maximum(before, 0.0), np.abs(before)).mean()) if len(before) else 0.0


def find_hidden_ends(
    layout: RoomLayout, surface: MeasuredSurface, proposals: Proposals, camera: Camera
) -> tuple[PlaneLine, ...]:
    """For every wall about which the layout is wrong, the line along which the depth leaves it.

    Args:
        layout: the layout that may be wrong.
        surface: measured points in the world, and which of them belong to objects.
        proposals: the proposed planes.
        camera: of the photo, in the world.
    """
    pixels = camera.project(surface.points)
    shown, rendered = layout.planes_at(pixels), layout.depth_at(pixels)
    size = surface.grid_rows, surface.grid_columns
    scale = np.array([size[1] / camera.intrinsics.width, size[0] / camera.intrinsics.height])
    lines = []
    for wall in range(len(proposals.normals)):
        if proposals.role(wall) != "wall":
            continue
        inverse = layout.cells.inverse_at(wall, pixels)
        behind = np.where(inverse > 0, surface.depth_m - 1.0 / np.maximum(inverse, 1e-9), -np.inf)
        drawn_too_far = (shown == wall) & (behind > SETTINGS.wrong_m)
        left_out = (proposals.segment == wall) & (rendered - surface.depth_m > SETTINGS.wrong_m)
        if (drawn_too_far | left_out).sum() < SETTINGS.min_share * size[0] * size[1]:
            continue
        # Where two walls meet the depth does not jump, and their own line is there already.
        form = _line(
            _changes(pixels * scale, np.abs(behind) <= SETTINGS.wrong_m, behind > 2.0 * SETTINGS.wrong_m, size)
        )
        if form is not None:
            lines.append(PlaneLine(form * [*scale, 1.0], frozenset((wall,))))
    return tuple(lines)


def _changes(
    places: Float[np.ndarray, "n 2"],
    on_wall: Bool[np.ndarray, "n"],
    deeper: Bool[np.ndarray, "n"],
    size: tuple[int, int],
) -> Float[np.ndarray, "m 2"]:
    """Samples on either side of the change from a wall to what is seen past it; x and y on the depth grid."""
    column, row = np.clip(places.astype(int), 0, [size[1] - 1, size[0] - 1]).T
    near = []
    for these, others in ((deeper, on_wall), (on_wall, deeper)):
        grid = np.zeros(size, np.uint8)
        grid[row[others], column[others]] = 1
        beside = cv2.dilate(grid, np.ones((3, 3), np.uint8))
        near.append(places[these & (beside[row, column] > 0)])
    return np.concatenate(near)


def _line(places: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, "3"] | None:
    """The line that most places agree with, as a form whose normal has unit length; None where few do."""
    if len(places) < SETTINGS.min_agreeing:
        return None
    rng = np.random.default_rng(0)
    first, second = places[rng.integers(len(places), size=(2, SETTINGS.line_trials))]
    along = second - first
    length = np.linalg.norm(along, axis=1)
    normals = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.maximum(length, 1e-9)[:, None]
    off = np.abs(normals @ places.T - (normals * first).sum(axis=1)[:, None])
    agreeing = (off <= SETTINGS.line_samples) & (length > 1e-9)[:, None]
    best = agreeing[np.argmax(agreeing.sum(axis=1))]
    if best.sum() < SETTINGS.min_agreeing:
        return None
    centre = places[best].mean(axis=0)
    _, axes = np.linalg.eigh(np.cov((places[best] - centre).T))
    return np.array([*axes[:, 0], -axes[:, 0] @ centre])
