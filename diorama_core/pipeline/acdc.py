"""ACDC (Dai et al. 2024) as a whole, to compare with: the stages of a build replaced by its own.

Perception, depth and support graph stay those of the run, as the paper gives both systems the same inputs.
"""

from __future__ import annotations

from dataclasses import replace

from diorama_core.architecture.acdc import AcdcRoom
from diorama_core.layout.settled import Settled
from diorama_core.library.record import ShapeLibrary
from diorama_core.pipeline.stages import Stages
from diorama_core.pose.correspondence.solvers import HALF_GRID, CorrespondencePose
from diorama_core.pose.discrete_turns import DiscreteTurns
from diorama_core.retrieval.hierarchical import HierarchicalRetrieval
from diorama_core.retrieval.matched import MatchedByLooks


def acdc_stages(base: Stages, has_depth: bool, library: ShapeLibrary) -> Stages:
    """`base` with ACDC's architecture, retrieval, poses and layout.

    Looks are compared as `base` compares them: in a joint embedding where its networks are on this machine. Without
    depth, measured or predicted, the room of `base` stays.

    Args:
        base: the stages of a profile.
        has_depth: whether depth is measured or a network of `base` predicts it.
        library: where shapes come from.
    """
    similarity = base.retrieval.similarity if isinstance(base.retrieval, HierarchicalRetrieval) else None
    views = base.pose if isinstance(base.pose, CorrespondencePose) else CorrespondencePose(library, grid=HALF_GRID)
    return replace(
        base,
        architecture=AcdcRoom() if has_depth else base.architecture,
        retrieval=MatchedByLooks(library, similarity),
        pose=DiscreteTurns(views),
        layout=Settled(),
        refinement=None,
    )
