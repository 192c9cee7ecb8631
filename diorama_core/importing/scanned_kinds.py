"""What scanned things are: by how large they are, what they look like in the photos of the scan, which shapes their
points lie on, and what else is in the room.

Each says how likely every kind is; a thing is of the kind for which all together speak most (naive Bayes). Shapes of
likely kinds are stretched into the thing's box and compared with its points, so that a table is no cabinet.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from jaxtyping import Float
from scipy.spatial import cKDTree

from diorama_core.artefacts import DetectedObject, Photo
from diorama_core.errors import InputError
from diorama_core.geometry.shape_appearance import SHARED_APPEARANCES
from diorama_core.importing.depth_frames import read_depth
from diorama_core.importing.measured_room import likeliest_kind, possible_kinds
from diorama_core.importing.measured_types import MeasuredBox, MeasuredRoom
from diorama_core.importing.point_cloud import ScanPhoto
from diorama_core.io.bounded import read_picture
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.library.labels import meanings
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.taxonomy import UNKNOWN, category
from diorama_core.perception.foundation.proposals import OwnNaming, own_naming
from diorama_core.progress import Progress
from diorama_core.retrieval.kinds_together import kinds_together
from diorama_core.retrieval.pools import size_cost
from diorama_core.retrieval.seen_kinds import as_it_looks
from diorama_core.scene.types import yaw_rotation

LOOKS = 4
"""Photos in which a thing is looked at."""
AGREES_M = 0.08
"""So near to the depth in a photo a point is seen there."""
MIN_SEEN, MIN_SEEN_PX = 0.25, 16
"""Share of a thing's points that a photo must show, and the least side of their box."""
LOOKED_AT = 400
"""Points of a thing that are projected."""
LIKELY, MAX_KINDS = 1e-3, 12
"""Kinds whose shapes are compared: not less likely than so many times the likeliest, and not more."""
MISFIT_SIGMA_M = 0.02
"""A kind whose best shape is so much farther off the points is less likely by e."""
POINTS = 500
SHAPES_OF_KIND = 4
"""Those nearest in size are compared."""
SHAPES_COMPARED = 24
"""Shapes of the object's own kind that are compared at most."""
FIT_SIGMA_M = 0.02
TURN_COST_M = 0.006
"""Metres that another front must be nearer."""
FAR_M = 0.15
"""What is farther apart counts no more."""
UNSEEN_WEIGHT = 0.5
"""Weight of a shape's surface without points nearby: part of it faced a wall or was never scanned."""


def with_scanned_kinds(room: MeasuredRoom, library: ShapeLibrary, *, look: bool = True) -> MeasuredRoom:
    """The room, the kinds of its scanned boxes as likely as its photos (where `look` says so) and all else say.

    Raises:
        InputError: a photo cannot be read.
    """
    scanned = [k for k, box in enumerate(room.boxes) if box.points is not None]
    boxes = [room.boxes[k] for k in scanned]
    naming = own_naming() if look and room.photos else None
    seen = _looks(boxes, room.photos, naming) if naming is not None else [()] * len(boxes)
    alone = [_alone(box, of_box) for box, of_box in zip(boxes, seen, strict=True)]
    alone = [_with_shapes(box, kinds, library) for box, kinds in zip(boxes, alone, strict=True)]
    together = kinds_together(alone, [_carrier(box, boxes) for box in boxes])
    known = dict(zip(scanned, together, strict=True))
    return replace(
        room,
        boxes=tuple(_fit(box, known[k], library) if k in known else box for k, box in enumerate(room.boxes)),
    )


def _fit(box: MeasuredBox, kinds: Mapping[str, float], library: ShapeLibrary) -> MeasuredBox:
    """A box with its kinds, and its front and shapes as its points say."""
    kind = max(kinds, key=lambda k: (kinds[k], k))
    fits, quarters = ScannedSurface.of(box).fits(kind, library)
    size = box.size_m if quarters % 2 == 0 else box.size_m[[1, 0, 2]]
    R = box.R_world_box @ yaw_rotation(quarters * np.pi / 2)
    return replace(box, kinds=kinds, kinds_know_size=True, fits=fits, R_world_box=R, size_m=size)


def _alone(box: MeasuredBox, seen: Sequence[tuple[str, float]]) -> dict[str, float]:
    """How likely each kind is by how frequent it is, the thing's size, and its looks."""
    frequent = meanings(UNKNOWN.name, UNKNOWN.name)
    possible = possible_kinds(box.kinds, box.size_m) or {UNKNOWN.name: 1.0}
    usual = {kind: share * frequent.get(kind, 1.0) for kind, share in possible.items()}
    return as_it_looks(likeliest_kind(usual, box.size_m), seen, named=False)


def _with_shapes(box: MeasuredBox, kinds: Mapping[str, float], library: ShapeLibrary) -> dict[str, float]:
    """How likely each kind is once its shapes were compared with the points; others fit as badly as the worst."""
    if box.points is None:
        return dict(kinds)
    surface = ScannedSurface.of(box)
    order = sorted(kinds, key=lambda kind: (-kinds[kind], kind))
    compared = [kind for kind in order[:MAX_KINDS] if kinds[kind] >= LIKELY * kinds[order[0]]]
    misfit = {kind: misfit_m for kind in compared if (misfit_m := surface.misfit_of_kind(kind, library)) is not None}
    if not misfit:
        return dict(kinds)
    worst = max(misfit.values())
    likely = {k: share * float(np.exp(-misfit.get(k, worst) / MISFIT_SIGMA_M)) for k, share in kinds.items()}
    whole = sum(likely.values())
    return {kind: value / whole for kind, value in likely.items()}


def _carrier(box: MeasuredBox, boxes: Sequence[MeasuredBox]) -> int | None:
    """The larger box that a box stands on."""
    larger = (k for k, b in enumerate(boxes) if np.prod(b.size_m) > np.prod(box.size_m) and b.is_under(box))
    return next(larger, None)


@dataclass(frozen=True, eq=False)
class _View:
    """A box of the photo around what it shows of a thing, and how well it shows it."""

    number: int
    box_px: tuple[float, float, float, float]
    worth: float


def _looks(
    boxes: Sequence[MeasuredBox], photos: Sequence[ScanPhoto], naming: OwnNaming
) -> list[tuple[tuple[str, float], ...]]:
    """For every thing the kinds that it looks like, by all photos that show it best together."""
    views: list[list[_View]] = [[] for _ in boxes]
    for number, photo in enumerate(photos):
        depth = read_depth(photo.depth, photo.unit_m)
        for of_box, box in zip(views, boxes, strict=True):
            view = _view(number, photo, depth, box)
            if view is not None:
                of_box.append(view)
    best = [sorted(of_box, key=lambda v: (-v.worth, v.number))[:LOOKS] for of_box in views]
    logs: list[dict[str, float]] = [{} for _ in boxes]
    weights = [0.0] * len(boxes)
    for number, photo in enumerate(photos):
        shown = [(k, v) for k, of_box in enumerate(best) for v in of_box if v.number == number]
        if not shown:
            continue
        rgb = read_picture(photo.picture, InputError)
        named = naming.name(
            Photo(rgb, photo.picture.name, (rgb.shape[1], rgb.shape[0])), _marks(shown, rgb), Progress()
        )
        for (k, view), kinds in zip(shown, named, strict=True):
            weights[k] += view.worth
            for kind, p in zip(kinds.kinds, kinds.probabilities, strict=True):
                logs[k][kind] = logs[k].get(kind, 0.0) + view.worth * float(np.log(max(float(p), 1e-6)))
    return [_mean(of_box, weight) for of_box, weight in zip(logs, weights, strict=True)]


def _mean(logs: Mapping[str, float], weight: float) -> tuple[tuple[str, float], ...]:
    """Probabilities whose logarithms are the weighted mean; nothing where nobody looked."""
    if not logs:
        return ()
    kinds = tuple(sorted(kind for kind in logs if category(kind) is not UNKNOWN))
    values = np.exp([logs[kind] / weight for kind in kinds])
    return tuple(zip(kinds, (float(v) for v in values / values.sum()), strict=True))


def _marks(shown: Sequence[tuple[int, _View]], rgb: np.ndarray) -> tuple[DetectedObject, ...]:
    nothing = np.zeros(rgb.shape[:2], bool)
    return tuple(
        DetectedObject(f"thing-{k}", UNKNOWN.name, UNKNOWN.name, v.box_px, nothing, n + 1, 0.0)
        for n, (k, v) in enumerate(shown)
    )


def _view(number: int, photo: ScanPhoto, depth_m: Float[np.ndarray, "h w"], box: MeasuredBox) -> _View | None:
    """What a photo shows of a thing; None where that is too little."""
    assert box.points is not None
    points = box.points[:: max(1, len(box.points) // LOOKED_AT)]
    local = photo.camera.to_camera(points)
    k, (height, width) = photo.camera.intrinsics, depth_m.shape
    z = np.maximum(local[:, 2], 1e-3)
    x, y = local[:, 0] / z * k.fx + k.cx, local[:, 1] / z * k.fy + k.cy
    inside = (local[:, 2] > 0.2) & (x >= 0) & (x < k.width) & (y >= 0) & (y < k.height)
    columns = np.clip((x / k.width * width).astype(int), 0, width - 1)
    rows = np.clip((y / k.height * height).astype(int), 0, height - 1)
    seen = inside & (np.abs(depth_m[rows, columns] - local[:, 2]) < AGREES_M)
    if seen.mean() < MIN_SEEN:
        return None
    x1, x2, y1, y2 = float(x[seen].min()), float(x[seen].max()), float(y[seen].min()), float(y[seen].max())
    if min(x2 - x1, y2 - y1) < MIN_SEEN_PX:
        return None
    return _View(number, (x1, y1, x2, y2), float(seen.mean()))


@dataclass(frozen=True, eq=False)
class ScannedSurface:
    """Points of a thing in its own box."""

    points: Float[np.ndarray, "n 3"]
    """Along the box's axes, from its middle."""
    size_m: Float[np.ndarray, "3"]
    tree: cKDTree

    @classmethod
    def of(cls, box: MeasuredBox) -> ScannedSurface:
        """Return the surface of a scanned box."""
        if box.points is None:
            raise ValueError("the box has no points")
        local = (box.points - box.centre) @ box.R_world_box
        chosen = local[np.linspace(0, len(local) - 1, min(len(local), POINTS)).astype(int)]
        return cls(chosen, box.size_m, cKDTree(chosen))

    def misfit_of_kind(self, kind: str, library: ShapeLibrary) -> float | None:
        """How far the points are from the best shape of a kind, in metres; None where the library has none."""
        shapes = sorted(library.in_category(kind), key=lambda s: (_unlike(s, self.size_m), s.id))[:SHAPES_OF_KIND]
        return min((min(self.misfits(s, library)) for s in shapes), default=None)

    def fits(self, kind: str, library: ShapeLibrary) -> tuple[dict[str, float], int]:
        """How well a kind's shapes agree with the points, by id, and how many quarters the best one is turned by.

        A front that was guessed stays where another one is hardly better.
        """
        shapes = sorted(library.in_category(kind), key=lambda s: (_unlike(s, self.size_m), s.id))[:SHAPES_COMPARED]
        costs_m = {s.id: np.asarray(self.misfits(s, library)) + TURN_COST_M * (np.arange(4) > 0) for s in shapes}
        if not costs_m:
            return {}, 0
        best = min(costs_m, key=lambda name: (float(costs_m[name].min()), name))
        fits = {name: float(np.exp(-misfits.min() / FIT_SIGMA_M)) for name, misfits in costs_m.items()}
        return fits, int(np.argmin(costs_m[best])) % 4

    def misfits(self, shape: Shape, library: ShapeLibrary) -> Sequence[float]:
        """For each quarter turn of a shape that is stretched into the box, the mean distance of the two surfaces.

        A turn that stretches the shape more than the other way round counts as farther off: thin things fit either way.
        """
        unit = unit_surface(shape, library)
        if not len(unit):
            return [FAR_M]
        cost = [size_cost(shape.size_m, self.size_m), size_cost(shape.size_m, self.size_m[[1, 0, 2]])]
        farther = [FIT_SIGMA_M * (c - min(cost)) for c in cost]
        return [self._misfit(_turn(unit, q) * self.size_m) + farther[q % 2] for q in range(4)]

    def _misfit(self, surface: Float[np.ndarray, "m 3"]) -> float:
        distance_m = np.minimum(cKDTree(surface).query(self.points)[0], FAR_M).mean()
        back = np.minimum(self.tree.query(surface)[0], FAR_M).mean()
        return float(distance_m + UNSEEN_WEIGHT * back)


def unit_surface(shape: Shape, library: ShapeLibrary) -> Float[np.ndarray, "m 3"]:
    """Points spread over a shape's surface, in a box of sides 1 around the origin."""
    parts = partial(library.parts, shape.id)
    appearance = SHARED_APPEARANCES.get(shape.content_hash, default_cache_dir() / "appearances", parts)
    points = appearance.spread_points(2 * POINTS)
    if not len(points):
        return points
    low, high = appearance.vertices.min(axis=0), appearance.vertices.max(axis=0)
    return np.asarray((points - (low + high) / 2) / np.maximum(high - low, 1e-6))


def _turn(points: Float[np.ndarray, "m 3"], quarters: int) -> Float[np.ndarray, "m 3"]:
    """Turned about up by quarters, counter-clockwise seen from above."""
    x, y, z = points.T
    for _ in range(quarters):
        x, y = -y, x
    return np.column_stack([x, y, z])


def _unlike(shape: Shape, size_m: Float[np.ndarray, "3"]) -> float:
    """In size, either way round."""
    return min(size_cost(shape.size_m, size_m), size_cost(shape.size_m, size_m[[1, 0, 2]]))
