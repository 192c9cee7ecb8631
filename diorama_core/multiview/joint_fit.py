"""One upright cuboid for the boxes of an object in several photos with known cameras.

What speaks against a cuboid is what `perception.metrology` says photo by photo (`problem.values`): how far its
outline is from the box at each edge, leniently where something hides the edge. Its size is judged once. Unlike in one
photo, distance is not read from the size: rays from several places meet.

The unknowns are x and y of the centre, the logarithms of depth, width and height, the height of the base, and the
heading. Things that stand on the floor have their base there; things that stand along the room's axes turn only by
quarters, unless many photos say otherwise.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from diorama_core.library.taxonomy import Category
from diorama_core.multiview.settings import SETTINGS
from diorama_core.perception.metrology.box_observations import BoxObservations
from diorama_core.perception.metrology.priors import SizeMode, size_modes
from diorama_core.perception.metrology.problem import UNTOLD, Problems, View, concatenate_problems, values
from diorama_core.perception.metrology.rows import row
from diorama_core.scene.types import Camera

NEAREST_M = 0.15
"""What is nearer is not before a camera."""
STEP = 1e-4
LONGEST = np.array([0.5, 0.5, 0.4, 0.4, 0.4, 0.3, 0.3])
"""Length of one step of each unknown, at most."""
UNKNOWNS = len(LONGEST)
ODD_STARTS = np.radians((0.0, 30.0, 60.0, 90.0, 120.0, 150.0))


@dataclass(frozen=True, eq=False)
class PosedBoxes:
    """What one photo says of its objects, and where it was taken."""

    camera: Camera
    """In a world with +Z up, the floor at 0 and the room's axes along x and y."""
    observations: BoxObservations
    hidden_px: Float[np.ndarray, "n 4"]
    """How far beyond each edge an object may go on, hidden by something nearer: they bound its size from below."""


@dataclass(frozen=True, eq=False)
class JointCuboid:
    """The cuboid that fits an object's boxes best."""

    centre: Float[np.ndarray, "3"]
    yaw_rad: float
    """Modulo half a turn: boxes do not tell the front from the back."""
    size_m: Float[np.ndarray, "3"]
    cost: float
    """Everything that speaks against it, in squared sigmas."""
    log_size_sigma: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """How far off the logarithms of its extents may be: depths of thin things hardly show in boxes."""
    place_sigma_m: tuple[float, float] = (0.0, 0.0)
    """How far off x and y of its centre may be: rays from places close together hardly cross."""


def fit_jointly(
    sightings: Sequence[tuple[PosedBoxes, int]],
    kind: Category,
    starts: Sequence[Float[np.ndarray, "3"]],
    *,
    on_floor: bool,
    upright_m: float | None = None,
) -> JointCuboid:
    """Fit one cuboid.

    Args:
        sightings: photos with the number of the object's box in each; at least one.
        kind: what the object is; gives its size's prior and whether it stands at odd angles.
        starts: middles to start from, the first of which is what the photos say each by itself.
        on_floor: whether its base is the floor's height.
        upright_m: expected height of the base, where it is not on the floor; that of the first start by default.
    """
    modes = size_modes(kind.name)
    odd = kind.quarter_turns_free or len(sightings) >= SETTINGS.min_photos_of_odd
    odd_cost = SETTINGS.odd_angle_cost if kind.quarter_turns_free else SETTINGS.odd_square_cost
    rows = [(mode, yaw, free) for mode in modes for yaw, free in _headings(mode, odd=odd)]
    batch = [(mode, yaw, free, start) for mode, yaw, free in rows for start in starts]
    unknowns = np.array([[*s[:2], *mode.log_size, 0.0 if on_floor else s[2], yaw] for mode, yaw, _, s in batch])
    if not on_floor:
        unknowns[:, 5] -= np.exp(unknowns[:, 4]) / 2
    fixed = np.array([[False] * 5 + [on_floor, not free] for _, _, free, _ in batch])
    base_m = float(np.median([s[2] for s in starts])) if upright_m is None else upright_m
    problem = _Joint(sightings, [b[0] for b in batch], starts[0][:2], None if on_floor else base_m)
    extra = np.array([mode.cost + (odd_cost if free else 0.0) for mode, _, free, _ in batch])
    unknowns, costs = _minimise(problem, unknowns, fixed, SETTINGS.first_iterations)
    last = np.argsort(costs + extra, kind="stable")[: SETTINGS.finalists]
    unknowns, costs = _minimise(problem.rows(last), unknowns[last], fixed[last], SETTINGS.iterations)
    costs = costs + extra[last]
    best = int(np.argmin(costs))
    x, y, *log_size, base, yaw = unknowns[best]
    size = np.exp(np.array(log_size))
    row = np.array([best])
    sigmas = _sigmas(problem.rows(last).rows(row), unknowns[row], fixed[last][row])
    centre, log_size = np.array([x, y, base + size[2] / 2]), (sigmas[2], sigmas[3], sigmas[4])
    return JointCuboid(centre, float(yaw), size, float(costs[best]), log_size, (sigmas[0], sigmas[1]))


def _sigmas(problem: _Joint, unknowns: Float[np.ndarray, "1 7"], fixed: Bool[np.ndarray, "1 7"]) -> list[float]:
    """Deviations of the place (x, y) and of the logarithms of depth, width and height, from the cost's curvature."""
    jacobian = _linearise(problem, unknowns, fixed)[1][0]
    normal = jacobian.T @ jacobian + np.diag(np.where(fixed[0], 1.0, 1e-6))
    return [float(v) for v in np.sqrt(np.diag(np.linalg.inv(normal))[:5])]


def _linearise(
    problem: _Joint, unknowns: Float[np.ndarray, "n 7"], fixed: Bool[np.ndarray, "n 7"]
) -> tuple[Float[np.ndarray, "n r"], Float[np.ndarray, "n r 7"]]:
    """Residuals of the batch, and how they change with the unknowns that are not fixed (forward differences)."""
    moves = STEP * np.concatenate([np.zeros((1, UNKNOWNS)), np.eye(UNKNOWNS)])
    probes = (unknowns[None] + moves[:, None]).reshape(-1, UNKNOWNS)
    values = problem(probes, UNKNOWNS + 1).reshape(UNKNOWNS + 1, len(unknowns), -1)
    return values[0], ((values[1:] - values[0]) / STEP).transpose(1, 2, 0) * ~fixed[:, None, :]


def _headings(mode: SizeMode, *, odd: bool) -> list[tuple[float, bool]]:
    """Headings to start from, and whether each may turn."""
    axes = [(0.0, False)] if mode.square else [(0.0, False), (np.pi / 2, False)]
    return axes + [(float(a), True) for a in ODD_STARTS] if odd else axes


class _Joint:
    """Residuals of a batch of cuboids of one object in all its photos."""

    def __init__(
        self,
        sightings: Sequence[tuple[PosedBoxes, int]],
        modes: Sequence[SizeMode],
        place: Float[np.ndarray, "2"],
        base_m: float | None,
    ) -> None:
        self._place, self._base_m = place, base_m
        self._views: list[tuple[Camera, View, Problems]] = []
        for photo, index in sightings:
            view = View(photo.camera.intrinsics, photo.camera.T_world_camera[:3, :3])
            rows = [
                row(
                    photo.observations,
                    index,
                    mode,
                    camera_height_m=float(photo.camera.position[2]),
                    yaw_rad=0.0,
                    base_sigma_m=1.0,
                    cut_sigma=UNTOLD,
                    hidden_px=photo.hidden_px[index],
                    hidden_odds=np.where(photo.hidden_px[index] > 0, SETTINGS.hidden_odds, 0.0),
                )
                for mode in modes
            ]
            self._views.append((photo.camera, view, concatenate_problems(rows)))
        self._log_size = np.array([m.log_size for m in modes])
        self._sigma = np.array([m.sigma for m in modes])
        self._whitening = np.array([m.whitening for m in modes])

    def rows(self, chosen: Int[np.ndarray, "k"]) -> _Joint:
        """Some cuboids of the batch."""
        views = [(camera, view, problems.rows(chosen)) for camera, view, problems in self._views]
        part = copy(self)
        part._views = views
        part._log_size, part._sigma = self._log_size[chosen], self._sigma[chosen]
        part._whitening = self._whitening[chosen]
        return part

    def clip_sizes(self, unknowns: Float[np.ndarray, "n 7"]) -> Float[np.ndarray, "n 7"]:
        """The nearest unknowns with plausible sizes."""
        most = SETTINGS.max_sigmas * self._sigma
        off = np.clip(unknowns[:, 2:5] - self._log_size, -most, most)
        return np.column_stack([unknowns[:, :2], self._log_size + off, unknowns[:, 5:]])

    def __call__(self, unknowns: Float[np.ndarray, "n 7"], repeats: int = 1) -> Float[np.ndarray, "n r"]:
        """Residuals of `repeats` copies of the batch, one after another."""
        chosen = np.tile(np.arange(len(self._log_size)), repeats)
        parts = []
        for camera, view, problems in self._views:
            rows = problems.rows(chosen).with_columns(yaw_rad=unknowns[:, 6])
            edges = values(_as_seen(unknowns, camera, view), rows, view).residuals[:, :4]
            behind = (rows.hidden_px > 0) & (edges > 0)
            parts.append(np.where(behind, _limit_residuals(edges, SETTINGS.max_hidden), edges))
        size = np.einsum("nij,nj->ni", self._whitening[chosen], unknowns[:, 2:5] - self._log_size[chosen])
        parts += [size, (unknowns[:, :2] - self._place) / SETTINGS.place_sigma_m]
        if self._base_m is not None:
            middle = unknowns[:, 5:6] + np.exp(unknowns[:, 4:5]) / 2
            parts += [(middle - self._base_m) / SETTINGS.base_sigma_m, np.minimum(unknowns[:, 5:6], 0.0) / 0.05]
        return np.concatenate(parts, axis=1)


def _limit_residuals(edges: Float[np.ndarray, "n 4"], most: float) -> Float[np.ndarray, "n 4"]:
    """Residuals that reach a limit: how much more something hides does not matter, however many photos say it."""
    return np.asarray(edges / np.sqrt(1.0 + (edges / most) ** 2))


def _as_seen(unknowns: Float[np.ndarray, "n 7"], camera: Camera, view: View) -> Float[np.ndarray, "n 6"]:
    """The cuboids as unknowns of a photo's own problem (`metrology.problem`)."""
    ahead = view.heading
    right = np.array([ahead[1], -ahead[0]])
    plan = unknowns[:, :2] - camera.position[:2]
    forward = plan @ ahead
    safe = np.maximum(forward, NEAREST_M)
    return np.column_stack([plan @ right / safe, np.log(safe), unknowns[:, 2:5], unknowns[:, 5]])


def _minimise(
    problem: _Joint, unknowns: Float[np.ndarray, "n 7"], fixed: Bool[np.ndarray, "n 7"], iterations: int
) -> tuple[Float[np.ndarray, "n 7"], Float[np.ndarray, "n"]]:
    """Levenberg-Marquardt over the batch, each row with its own damping."""
    damping = np.full(len(unknowns), 1e-2)
    unknowns = problem.clip_sizes(unknowns)
    cost = (problem(unknowns) ** 2).sum(axis=1)
    for _ in range(iterations):
        residuals, jacobian = _linearise(problem, unknowns, fixed)
        normal = np.einsum("nri,nrj->nij", jacobian, jacobian)
        gradient = np.einsum("nri,nr->ni", jacobian, residuals)
        diagonal = np.einsum("nii->ni", normal)
        normal = normal + np.eye(UNKNOWNS) * (damping[:, None] * (diagonal + 1e-2) + fixed)[:, None]
        step = -np.linalg.solve(normal, gradient[..., None])[..., 0]
        step *= np.minimum(1.0, 1.0 / np.maximum(np.abs(step / LONGEST).max(axis=1, keepdims=True), 1e-12))
        trial = problem.clip_sizes(unknowns + step)
        reached = (problem(trial) ** 2).sum(axis=1)
        better = reached < cost
        settled = (np.abs(cost - reached) < 1e-3).all()
        unknowns = np.where(better[:, None], trial, unknowns)
        cost = np.where(better, reached, cost)
        damping = np.clip(np.where(better, damping * 0.3, damping * 5.0), 1e-6, 1e6)
        if settled:
            break
    return unknowns, cost


def meeting_point(sightings: Sequence[tuple[PosedBoxes, int]]) -> Float[np.ndarray, "3"]:
    """The point nearest to the rays through the middles of an object's boxes (least squares)."""
    A, b = np.zeros((3, 3)), np.zeros(3)
    for photo, index in sightings:
        x1, y1, x2, y2 = photo.observations.box_px[index]
        ray = photo.camera.rays(np.array([(x1 + x2) / 2, (y1 + y2) / 2]))
        ray = ray / np.linalg.norm(ray)
        across = np.eye(3) - np.outer(ray, ray)
        A += across
        b += across @ photo.camera.position
    return np.linalg.solve(A + 1e-9 * np.eye(3), b)
