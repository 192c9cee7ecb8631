"""Which of an object's candidates comes first, once they were fitted to the picture as well as they can be.

Shapes are ranked in the poses in which they were compared as wholes. A design whose profile or size is another is a bad
match there and the right one afterwards: what round things look like is known only when their profile was measured. So
where the first candidate does not fit well at its best, others are fitted too: the likeliest bodies of revolution, of
which a few are enough, since all get the same profile; shapes with a left and a right, which may be the mirror image of
the thing; and the next ones, where the first fits badly in a photo alone.
Measured depth has told them from one another already, with what is seen within the outline (`details`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import islice

import numpy as np

from diorama_core.artefacts import PosedCandidates
from diorama_core.geometry.silhouette import ShapeCaster
from diorama_core.library.furniture.measures import can_be_turned
from diorama_core.library.hands import other_hand
from diorama_core.library.record import ShapeLibrary
from diorama_core.pose.outline_fit import fitted_pose
from diorama_core.pose.seen_objects import SeenObject
from diorama_core.pose.settings import SETTINGS, PoseSettings, ShapeFitSettings
from diorama_core.pose.turned_profile import turned
from diorama_core.scene.types import Candidate


@dataclass(frozen=True)
class FittedChoice:
    """Compares the candidates of single objects; those of sets are the set's."""

    library: ShapeLibrary = field(repr=False)
    settings: PoseSettings = SETTINGS

    def best_first(self, one: PosedCandidates, seen: SeenObject) -> PosedCandidates:
        """The candidates with the best first, all of them as they were.

        Args:
            one: Candidates, best first so far; at least one.
            seen: The object.
        """
        outlined = seen.is_surely_outlined
        first, first_score = self._fitted(one.candidates[0], seen)
        if first < self.settings.shapes.good_fit:
            return one
        by_rank = seen.evidence.surface is None and first >= self.settings.shapes.poor_fit
        others = {
            *_compared(one.candidates, by_rank, outlined, self.settings.shapes),
            *(self._uneven(one.candidates) if outlined else ()),
        }
        scores = {0: first_score, **{k: self._fitted(one.candidates[k], seen)[1] for k in others}}
        best = max(scores, key=lambda k: (scores[k], -k))
        rest = (*one.candidates[:best], *one.candidates[best + 1 :])
        return replace(one, candidates=(one.candidates[best], *rest))

    def _uneven(self, candidates: Sequence[Candidate]) -> list[int]:
        """The next candidates whose mirror image is another shape: none of them was compared as that."""
        places = (k for k, c in enumerate(candidates) if k and other_hand(self.library, c.shape_id) is not None)
        return list(islice(places, self.settings.shapes.uneven))

    def _fitted(self, candidate: Candidate, seen: SeenObject) -> tuple[float, float]:
        """Disagreement with the picture, 0 to 1, in the fitted pose and with the profile that is seen; and the score.

        Of what has a left and a right, the hand that fits better counts. The score is a logarithm, higher is better.
        """
        evidence, size = seen.evidence, np.asarray(candidate.shape_size_m)
        hands = [i for i in (candidate.shape_id, other_hand(self.library, candidate.shape_id)) if i is not None]
        casters = [ShapeCaster(self.library.mesh(hand)) for hand in hands]
        poses = [
            fitted_pose(evidence, c, candidate.pose, size, resize=True, settings=self.settings.shapes) for c in casters
        ]
        errors = [evidence.error(c, p) for c, p in zip(casters, poses, strict=True)]
        best = int(np.argmin(errors))
        error, caster, pose = errors[best], casters[best], poses[best]
        fits = (
            turned(self.library, candidate.shape_id, [evidence], [pose], error, self.settings)
            if seen.is_surely_outlined
            else None
        )
        if fits is not None:
            error = fits.error
        edges = (1.0 - evidence.seen.hidden_share) * seen.edges_in(caster, pose)
        weights = self.settings.shapes
        of_rank = weights.of_rank * float(np.log(max(candidate.score, weights.no_score)))
        of_fit = weights.of_fit * float(np.log(error + self.settings.evidence.noise_floor))
        return error, of_rank - of_fit + weights.of_edges * edges


def _compared(candidates: Sequence[Candidate], by_rank: bool, outlined: bool, settings: ShapeFitSettings) -> list[int]:
    """Which candidates are fitted beside the first: the next ones, and bodies of revolution."""
    next_ones = range(1, min(settings.compared, len(candidates))) if by_rank else ()
    round_ones = (
        [k for k, c in enumerate(candidates) if can_be_turned(c.shape_id)][: settings.turned] if outlined else []
    )
    return sorted({*next_ones, *round_ones} - {0})
