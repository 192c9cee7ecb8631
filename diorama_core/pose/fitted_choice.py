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
from diorama_core.pose.mask_observations import NOISE_FLOOR
from diorama_core.pose.outline_fit import fitted_pose
from diorama_core.pose.seen_objects import SeenObject
from diorama_core.pose.turned_profile import turned
from diorama_core.scene.types import Candidate

GOOD_FIT = 0.08
"""Disagreement with the picture, 0 to 1, below which the first candidate stays."""
POOR_FIT = 0.3
"""Disagreement from which on the next ones are fitted from a photo alone."""
COMPARED, TURNED, UNEVEN = 3, 2, 2
"""Candidates that are fitted in that case; bodies of revolution, and shapes with a left and a right, that are fitted
whenever the outline is sure."""
OF_RANK, OF_FIT = 1.0, 2.0
"""What the ranks from before the fit and the fits themselves say of them, as factors of logarithms."""
OF_EDGES = 1.0
"""What the correlation of inner edges says beside them: books on a top and what a mask missed change its outline.
Less of a thing that is hidden."""
_NO_SCORE = 1e-3


@dataclass(frozen=True)
class FittedChoice:
    """Compares the candidates of single objects; those of sets are the set's."""

    library: ShapeLibrary = field(repr=False)

    def best_first(self, one: PosedCandidates, seen: SeenObject) -> PosedCandidates:
        """The candidates with the best first, all of them as they were.

        Args:
            one: Candidates, best first so far; at least one.
            seen: The object.
        """
        outlined = seen.is_surely_outlined
        first, first_score = self._fitted(one.candidates[0], seen)
        if first < GOOD_FIT:
            return one
        by_rank = seen.evidence.surface is None and first >= POOR_FIT
        others = {*_compared(one.candidates, by_rank, outlined), *(self._uneven(one.candidates) if outlined else ())}
        scores = {0: first_score, **{k: self._fitted(one.candidates[k], seen)[1] for k in others}}
        best = max(scores, key=lambda k: (scores[k], -k))
        rest = (*one.candidates[:best], *one.candidates[best + 1 :])
        return replace(one, candidates=(one.candidates[best], *rest))

    def _uneven(self, candidates: Sequence[Candidate]) -> list[int]:
        """The next candidates whose mirror image is another shape: none of them was compared as that."""
        found = (k for k, c in enumerate(candidates) if k and other_hand(self.library, c.shape_id) is not None)
        return list(islice(found, UNEVEN))

    def _fitted(self, candidate: Candidate, seen: SeenObject) -> tuple[float, float]:
        """Disagreement with the picture, 0 to 1, in the fitted pose and with the profile that is seen; and the score.

        Of what has a left and a right, the hand that fits better counts. The score is a logarithm, higher is better.
        """
        evidence, size = seen.evidence, np.asarray(candidate.shape_size_m)
        hands = [i for i in (candidate.shape_id, other_hand(self.library, candidate.shape_id)) if i is not None]
        casters = [ShapeCaster(self.library.mesh(hand)) for hand in hands]
        poses = [fitted_pose(evidence, c, candidate.pose, size, resize=True) for c in casters]
        errors = [evidence.error(c, p) for c, p in zip(casters, poses, strict=True)]
        best = int(np.argmin(errors))
        error, caster, pose = errors[best], casters[best], poses[best]
        found = turned(self.library, candidate.shape_id, [evidence], [pose], error) if seen.is_surely_outlined else None
        if found is not None:
            error = found.error
        edges = (1.0 - evidence.seen.hidden_share) * seen.edges_in(caster, pose)
        of_rank = OF_RANK * float(np.log(max(candidate.score, _NO_SCORE)))
        return error, of_rank - OF_FIT * float(np.log(error + NOISE_FLOOR)) + OF_EDGES * edges


def _compared(candidates: Sequence[Candidate], by_rank: bool, outlined: bool) -> list[int]:
    """Which candidates are fitted beside the first: the next ones, and bodies of revolution."""
    next_ones = range(1, min(COMPARED, len(candidates))) if by_rank else ()
    round_ones = [k for k, c in enumerate(candidates) if can_be_turned(c.shape_id)][:TURNED] if outlined else []
    return sorted({*next_ones, *round_ones} - {0})
