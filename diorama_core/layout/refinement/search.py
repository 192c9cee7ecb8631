"""The search for poses that agree better with the masks: one object after another, in steps that become smaller."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.projection import box_iou
from diorama_core.geometry.silhouette import PoseBatch
from diorama_core.layout.problem.problem import Problem
from diorama_core.layout.refinement.freedom import Freedom, PosePrior, RoomLeft, freedom
from diorama_core.layout.refinement.posed_picture import PosedPicture, TriedPoses
from diorama_core.layout.settings import REFINEMENT, RefinementSettings
from diorama_core.progress import Progress


@dataclass(frozen=True, eq=False)
class Search:
    """From a settled layout to one that agrees better with the masks and is as sound."""

    problem: Problem
    """The settled layout."""
    picture: PosedPicture
    """What is seen of it; follows the search."""
    priors: Sequence[PosePrior]
    boxes_px: Float[np.ndarray, "n 4"]
    """Where each object was found in the photo: x1, y1, x2, y2."""
    trust: Float[np.ndarray, " n"]
    """What each object's mask counts, 0 to 1; its box counts the rest."""
    sized: Sequence[bool]
    """Whether each object keeps its size."""
    settings: RefinementSettings = REFINEMENT

    def poses(self, progress: Progress) -> PoseBatch:
        """The poses that were found, one for each object."""
        problem, room = self.problem, RoomLeft.of(self.problem)
        poses = PoseBatch(problem.R.copy(), problem.p.copy(), problem.scale.copy())
        seen = self.picture.mask_pixels >= self.settings.min_pixels
        movable = [int(i) for i in np.flatnonzero(seen & problem.free) if problem.surface[i] is not None]
        for number, share in enumerate(self.settings.shares):
            moving = movable
            for part in range(self.settings.rounds):
                begun = (number + part / self.settings.rounds) / len(self.settings.shares)
                progress.report(begun, "fitting objects to their masks")
                moving = [i for i in moving if self._moves(room, poses, i, share, seen, progress)]
        return poses

    def _moves(
        self, room: RoomLeft, poses: PoseBatch, i: int, share: float, seen: np.ndarray, progress: Progress
    ) -> bool:
        """Make a few steps of one object; whether there was one to make."""
        progress.check()
        steps = 0
        while steps < self.settings.steps and self._step(room, poses, i, share, seen):
            steps += 1
        return steps > 0

    def _step(self, room: RoomLeft, poses: PoseBatch, i: int, share: float, seen: np.ndarray) -> bool:
        """Make an object's best step for which there is room, in `poses` and the picture; whether there is one."""
        before = poses[np.array([i])]
        for tried in self._better(poses, i, share, seen):
            _set(poses, i, tried.poses, tried.number)
            if room.allows(i, self.problem.with_poses(poses.R, poses.position, poses.scale)):
                self.picture.replace(tried.look, tried.number)
                return True
        _set(poses, i, before, 0)
        return False

    def _better(self, poses: PoseBatch, i: int, share: float, seen: np.ndarray) -> list[_Try]:
        """Poses of one object that are better than its own, the best first: single changes, and several together."""
        free = self._freedom(poses, i)
        prior, place = self.priors[i], poses.position[i]
        distance = float(np.linalg.norm(place - prior.eye))
        changes = free.steps(self.settings.move * share * min(distance, self.settings.farthest_m), share)
        if prior.was_pushed_away(place):
            changes = np.concatenate([changes, free.steps_toward(place, prior.observed.position)])
        single = self._tries(poses, i, free, changes, seen)
        if not single:
            return []
        together = _together([changes[tried.number] for tried in single])
        return _best_first([*single, *self._tries(poses, i, free, together, seen)])

    def _tries(
        self, poses: PoseBatch, i: int, free: Freedom, changes: Float[np.ndarray, "k f"], seen: np.ndarray
    ) -> list[_Try]:
        """The changes of one object's pose that gain anything over the first, which is none; the best first."""
        size = self.problem.shape_size[i]
        near = free.poses(poses.R[i], poses.position[i], poses.scale[i], size, changes)
        look = self.picture.look(i, near)
        if look is None:
            return []
        boxes = np.nan_to_num(box_iou(look.bounds_px, self.boxes_px[i]))
        value = look.agreement @ (self.trust * seen) + (1.0 - self.trust[i]) * boxes - self.priors[i].cost(near)
        gain = value - value[0]
        grown = np.abs(np.log(near.scale / self.problem.scale[i]))
        gain[(grown > np.log(self.settings.max_growth)).any(axis=1)] = -np.inf
        better = np.flatnonzero(gain > self.settings.min_gain)
        return _best_first([_Try(float(gain[k]), near, int(k), look) for k in better])

    def _freedom(self, poses: PoseBatch, i: int) -> Freedom:
        surface = self.problem.surface[i]
        assert surface is not None, "what nothing holds does not move"
        surface = self.problem.with_poses(poses.R, poses.position, poses.scale).to_world(i, surface)
        is_round = self.picture.casters[i].round_from_above
        return freedom(self.problem, i, surface, sized=self.sized[i], is_round=is_round, settings=self.settings)


@dataclass(frozen=True, eq=False)
class _Try:
    gain: float
    poses: PoseBatch
    number: int
    """Which of the poses."""
    look: TriedPoses


def _best_first(tries: Sequence[_Try]) -> list[_Try]:
    return sorted(tries, key=lambda tried: -tried.gain)


def _set(poses: PoseBatch, i: int, source: PoseBatch, number: int) -> None:
    poses.R[i], poses.position[i], poses.scale[i] = source.R[number], source.position[number], source.scale[number]


def _together(better: Sequence[Float[np.ndarray, " f"]]) -> Float[np.ndarray, "m f"]:
    """No change, and what may gain more than single changes do: the best twice, the best two, and all that gain.

    Of changes of the same freedom only the better one counts; they come the best first.
    """
    apart: list[np.ndarray] = []
    for change in better:
        if not any((change * other).any() for other in apart):
            apart.append(change)
    several = [np.sum(apart[:count], axis=0) for count in sorted({2, len(apart)}) if 1 < count <= len(apart)]
    return np.array([0.0 * better[0], 2.0 * better[0], *several])
