"""The numbers of retrieval, as fields of its stage."""

from __future__ import annotations

from dataclasses import dataclass

from diorama_core.retrieval import measured_sizes, pools, usual_forms
from diorama_core.retrieval.measured_sizes import MeasuredSizeSettings
from diorama_core.retrieval.pools import PoolSettings
from diorama_core.retrieval.usual_forms import UsualFormSettings


@dataclass(frozen=True)
class RankingSettings:
    """How shapes of a pool are ranked, and which objects share a shape."""

    similar_log_size: float = 0.45
    similar_log_size_of_seats: float = 0.8
    """Seats in one room are usually of a set, so that different sizes are rather errors of measurement."""
    unnamed_outline: float = 3.0
    """Increased weight of the outline of an object without a name."""
    unnamed_size: float = 0.5
    """Reduced weight of its guessed size."""
    own_evidence: float = 0.4
    """What an object's own scores count against those of its group."""
    min_similarity: float = 0.25
    """Share of the weight of likeness that an object keeps of which nothing is seen well."""
    guessed_size: float = 0.5
    """Reduced weight of a size that was not observed but taken from the category's prior."""
    min_voice: float = 0.1
    """What an object that is hardly seen says in its group."""
    other_mount: float = 0.1
    """How likely a thing is of a kind that is held otherwise than it is."""
    other_mount_of_unnamed: float = 0.5
    """Likewise of one without a name: what holds it is guessed too."""
    kinds: int = 3
    """How many kinds are among the candidates of a thing, where it may be of so many."""
    kinds_of_unnamed: int = 7
    of_see_through: float = 2.0
    """Power of the agreement with where one looks past an object."""
    roughly: float = 0.1
    """What a shape that is not yet in place may be off there."""


@dataclass(frozen=True)
class RetrievalSettings:
    """All numbers of `HierarchicalRetrieval` that are not the weights of its scores."""

    ranking: RankingSettings = RankingSettings()
    pools: PoolSettings = pools.SETTINGS
    sizes: MeasuredSizeSettings = measured_sizes.SETTINGS
    forms: UsualFormSettings = usual_forms.SETTINGS


SETTINGS = RetrievalSettings()
