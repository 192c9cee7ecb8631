"""What a photo says about one object, at the resolution at which rendered shapes are compared with it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.geometry.projection import NEAR_M
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster, ShapeHits
from diorama_core.geometry.window import Window, soft_iou
from diorama_core.scene.types import Camera

Box = tuple[float, float, float, float]


@runtime_checkable
class Outlined(Protocol):
    """Anything with a box and a mask in the photo (`artefacts.DetectedObject`)."""

    @property
    def box(self) -> Box:
        """x1, y1, x2, y2 in photo pixels."""
        ...

    @property
    def mask(self) -> Bool[np.ndarray, "h w"]:
        """Visible pixels."""
        ...

    @property
    def mask_confidence(self) -> float:
        """0 to 1."""
        ...


_BORDER_PX = 2.5
_FULLY_TRUSTED_AREA_PX = 600.0
MIN_OWN_SHARE = 0.2
"""Share of a mask that must be left without what lies on the object."""
_OF_OPENINGS = 0.25
"""Weight of a mask that was not drawn where a shape is open below."""


@dataclass(frozen=True, eq=False)
class Observed:
    """One object's mask and box in a window of the photo, with the reliability of each."""

    window: Window
    box: Box
    covered: Float[np.ndarray, "n"]
    """Share of each cell that the object's mask covers."""
    weight: Float[np.ndarray, "n"]
    """How much a cell says: 0 outside the photo and where nearer objects hide what is behind them."""
    origin_world: Float[np.ndarray, "3"]
    directions_world: Float[np.ndarray, "n 3"]
    """One ray per cell, of unit depth."""
    mask_trust: float
    """0 (no usable mask) to 1 (a mask given by the user, large enough to have a shape)."""
    border_share: float
    """Share of the box's outline that lies on the photo's border, where the object is cut."""
    hidden_share: float
    """Share of the box that nearer objects' masks cover."""

    def silhouettes(self, caster: ShapeCaster, poses: PoseBatch) -> Bool[np.ndarray, "p n"]:
        """The cells whose centres the posed shape covers."""
        part = self._part_around(caster, poses)
        covered = np.zeros((len(poses), *self._grid.shape[:2]), dtype=bool)
        rays = self._grid[part].reshape(-1, 3)
        covered[:, *part] = caster.covers(self.origin_world, rays, poses).reshape(covered[:, *part].shape)
        return covered.reshape(len(poses), -1)

    def hits(self, caster: ShapeCaster, poses: PoseBatch) -> ShapeHits:
        """What the rays through the cells' centres meet of a shape under every pose."""
        part = self._part_around(caster, poses)
        met = caster.cast(self.origin_world, self._grid[part].reshape(-1, 3), poses)

        def whole(values: np.ndarray, nothing: object) -> np.ndarray:
            filled = np.full((len(poses), *self._grid.shape[:2], *values.shape[2:]), nothing, values.dtype)
            filled[:, *part] = values.reshape(filled[:, *part].shape)
            return filled.reshape(len(poses), -1, *values.shape[2:])

        depth, normals, triangles = whole(met.depth_m, np.inf), whole(met.normals_object, 0), whole(met.triangles, 0)
        return ShapeHits(depth, normals, triangles, self.directions_world, poses)

    @property
    def _grid(self) -> Float[np.ndarray, "c c 3"]:
        """The rays by row and column."""
        return self.directions_world.reshape(self.window.cells, self.window.cells, 3)

    @cached_property
    def _to_cells(self) -> Float[np.ndarray, "3 3"]:
        """Turns a direction into (column, row, 1) times its depth: rays go on evenly along rows and columns."""
        grid, last = self._grid, self.window.cells - 1
        across, down = (grid[0, last] - grid[0, 0]) / last, (grid[last, 0] - grid[0, 0]) / last
        return np.linalg.inv(np.stack([across, down, grid[0, 0]], axis=1))

    def _part_around(self, caster: ShapeCaster, poses: PoseBatch) -> tuple[slice, slice]:
        """Rows and columns of all cells that the shape's box may cover in any pose: rays beside it meet nothing."""
        cells = self.window.cells
        corners = poses.apply_by_coordinate(caster.corners).reshape(3, -1) - self.origin_world[:, None]
        column, row, depth = self._to_cells @ corners
        if depth.min() <= NEAR_M:
            return slice(0, cells), slice(0, cells)
        return _cell_range(row / depth, cells), _cell_range(column / depth, cells)

    def agreement(self, silhouettes: Bool[np.ndarray, "p n"]) -> Float[np.ndarray, "p"]:
        """Intersection over union with the mask where there is evidence, 0 to 1.

        A mask that nobody drew fills the space between legs: whether there is any, it can hardly tell.
        """
        weight = self.weight
        if self.mask_trust < 1.0:
            weight = np.where(open_below(silhouettes, self.window.cells), _OF_OPENINGS * weight, weight)
        return soft_iou(self.covered, silhouettes.astype(np.float64), weight)


def _cell_range(places: Float[np.ndarray, "n"], cells: int) -> slice:
    """Cells between the least and the greatest place, and one more on either side for what rounding hides."""
    first, last = np.clip([np.floor(places.min()) - 1, np.ceil(places.max()) + 2], 0, cells).astype(int)
    return slice(int(first), int(max(first, last)))


def open_below(silhouettes: Bool[np.ndarray, "p n"], cells: int) -> Bool[np.ndarray, "p n"]:
    """Cells below something that a shape covers that it leaves open: between legs, beside a pedestal, between slats."""
    grid = silhouettes.reshape(-1, cells, cells)
    below = np.maximum.accumulate(grid, axis=1)
    above_foot = np.maximum.accumulate(np.asarray(grid.any(axis=2))[:, ::-1], axis=1)[:, ::-1]
    return np.asarray((below & ~grid & above_foot[..., None]).reshape(silhouettes.shape))


def observe(
    camera: Camera,
    box: Box,
    mask: Bool[np.ndarray, "h w"],
    mask_confidence: float,
    nearer_masks: Sequence[Bool[np.ndarray, "h w"]],
    cells: int,
    margin: float = 0.2,
) -> Observed:
    """Observe one object.

    Args:
        camera: The photo's camera.
        box: The object's box in photo pixels.
        mask: The object's visible pixels; may be empty.
        mask_confidence: 0 to 1.
        nearer_masks: Masks of objects in front of this one: their pixels say nothing about it.
        cells: Resolution of the window, both ways.
        margin: How far the window reaches beyond the box, as a share of the box.
    """
    window = Window.from_box(box, margin, cells)
    height, width = mask.shape
    covered = window.coverage(mask)
    hidden = np.zeros_like(covered)
    for nearer in nearer_masks:
        hidden = np.maximum(hidden, window.coverage(nearer))
    hidden = hidden * (1.0 - covered)
    x, y = window.centres_px.T
    in_box = (x >= box[0]) & (x < box[2]) & (y >= box[1]) & (y < box[3])
    area = float(mask.sum())
    return Observed(
        window=window,
        box=box,
        covered=covered if area > 0 else in_box.astype(np.float64),
        weight=window.is_in_photo(width, height) * (1.0 - hidden),
        origin_world=np.asarray(camera.position),
        directions_world=camera.rays(window.centres_px),
        mask_trust=float(np.clip(mask_confidence, 0.0, 1.0)) * min(area / _FULLY_TRUSTED_AREA_PX, 1.0),
        border_share=_border_share(box, width, height),
        hidden_share=float(hidden[in_box].mean()) if in_box.any() else 0.0,
    )


def observe_among(
    camera: Camera,
    items: Sequence[Outlined],
    centres_world: Float[np.ndarray, "m 3"],
    parents: Sequence[int | None],
    index: int,
    cells: int,
    *,
    loads_apart: bool = False,
) -> Observed:
    """Observe object `index`, given which of the others may occlude it.

    Args:
        camera: The photo's camera.
        items: All objects in the photo.
        centres_world: Where each is.
        parents: For each, which of the others it lies on, if any.
        index: The object to observe.
        cells: Resolution of the window, both ways.
        loads_apart: Whether what lies on it is no part of its outline where its mask takes it for one.
    """
    depths = camera.to_camera(centres_world)[:, 2]
    masks = [items[i].mask for i in indices_in_front(depths, parents, index)]
    item = items[index]
    mask = without_loads(item.mask, [items[i].mask for i in loads_of(parents, index)] if loads_apart else [])
    return observe(camera, item.box, mask, item.mask_confidence, masks, cells)


def without_loads(mask: Bool[np.ndarray, "h w"], loads: Sequence[Bool[np.ndarray, "h w"]]) -> Bool[np.ndarray, "h w"]:
    """A mask without what lies on the object: an outline that was not drawn often takes it for a part of it.

    Where next to nothing would be left, the masks of what lies on it are too large, and it stays as it is.
    """
    unloaded = mask & ~np.logical_or.reduce([np.zeros_like(mask), *loads])
    return unloaded if unloaded.sum() >= MIN_OWN_SHARE * mask.sum() else mask


def loads_of(parents: Sequence[int | None], index: int) -> tuple[int, ...]:
    """Which objects lie on object `index`, or on something that does."""
    loads: list[int] = []
    level = {index}
    while level:
        level = {i for i, parent in enumerate(parents) if parent in level and i not in loads and i != index}
        loads += sorted(level)
    return tuple(loads)


def cut_sides(box: Box, width: int, height: int) -> Bool[np.ndarray, "4"]:
    """Which of the box's sides x1, y1, x2, y2 lie on the photo's border."""
    x1, y1, x2, y2 = box
    return np.array([x1 <= _BORDER_PX, y1 <= _BORDER_PX, x2 >= width - _BORDER_PX, y2 >= height - _BORDER_PX])


def _border_share(box: Box, width: int, height: int) -> float:
    lengths = np.array([box[3] - box[1], box[2] - box[0], box[3] - box[1], box[2] - box[0]], dtype=np.float64)
    return float(lengths[cut_sides(box, width, height)].sum() / max(lengths.sum(), 1e-9))


def indices_in_front(depths_m: Float[np.ndarray, "m"], parents: Sequence[int | None], index: int) -> tuple[int, ...]:
    """Which objects may hide object `index`: those nearer to the camera and those that lie on it.

    What it lies on itself is never in front: its surface is seen beside the object, not before it.
    """
    nearer = []
    for other, depth in enumerate(depths_m):
        lies_on_it = parents[other] == index
        if other != index and parents[index] != other and (lies_on_it or depth < depths_m[index]):
            nearer.append(other)
    return tuple(nearer)
