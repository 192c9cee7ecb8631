"""The numbers of retrieval, as fields of its stage."""

from __future__ import annotations

from dataclasses import dataclass


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
    near_m: float = 0.8
    """Things nearer to each other are neighbours."""
    neighbour_rounds: int = 3
    """After so many updates beliefs hardly change."""
    few: float = 0.3
    """Largest share of a kind's shapes that a noun names which tells them apart: balls are a few of the toys."""
    several: int = 3
    """A noun that is said of so many kinds says nothing of the things of one."""
    other_noun: float = 0.85
    """Penalty of a shape that the label's very noun rules out."""
    other_words: float = 0.12
    """Penalty of a shape that matches none of the label's describing words."""


@dataclass(frozen=True)
class SimilaritySettings:
    """What main colours, outline, inner edges and places of colours count in the likeness of crop and shape."""

    max_open: float = 0.5
    """Weight of an outline with its gaps beside the filled one, of a mask that can be trusted."""
    doubtful: float = 0.5
    """Mask confidence below which its gaps are ignored."""
    edges: float = 0.5
    """Weight of inner edges beside the outline."""
    edges_of_doubtful: float = 0.45
    """Increase of that weight where the outline is uncertain."""
    layout: float = 0.5
    """Weight of the places of colours beside the form."""
    colours: float = 0.1
    """Weight of main colours beside the views of an object that is seen whole."""
    colours_of_hidden: float = 0.4
    """Weight of main colours for an object of which little is seen."""


@dataclass(frozen=True)
class MeasuredSizeSettings:
    """Noise of measured sizes."""

    sigma: float = 0.3
    """Deviation of the logarithms of a size measured in a photo."""
    trust: float = 0.6
    """Power of the size's likelihood: the box, which it was measured from, has said some of it."""
    floor: float = 0.02
    """Added to the likelihoods, relative to the largest: sizes of what is hidden are guessed."""
    min_m: float = 0.01


@dataclass(frozen=True)
class PoolSettings:
    """How many shapes are looked at."""

    named_pool: int = 50
    """Shapes of one kind; the paper's text query keeps as many."""
    enough: int = 4
    related_factor: float = 0.6
    other_pool: int = 14
    """Shapes of every other kind that the word may mean."""
    unnamed_each: int = 5
    """Shapes of every kind that a thing without a name may be."""
    max_pool: int = 110
    """No more kinds are added to so many shapes."""
    min_sense: float = 0.04
    """Kinds less likely than this share of the likeliest are not looked at."""
    min_unnamed: int = 10
    """So many kinds are looked at whatever their share, where a thing has no name."""
    views_say: float = 10.0
    """How sharply views tell kinds apart: agreeing better by a factor f makes up for a kind less likely by f to
    this."""
    substitutes: int = 3
    min_m: float = 0.01


@dataclass(frozen=True)
class UsualFormSettings:
    """How much a usual form counts."""

    min_pane: float = 0.02
    """Share of the outline that a pane of a mirror has at least."""
    closed: float = 0.72
    """Share of the outline from the side that is filled, from which on a seat's sides are closed."""
    below_seat: float = 0.33
    foot: float = 0.08
    crossing: float = 0.5
    """Shares of a chair's height up to which legs are looked at, of a foot, and of its depth that crossing legs
    have."""
    drawn_px: int = 128
    leg_points: int = 6000
    rare: float = 0.02
    says: float = 0.08
    """Power of the share that multiplies a retrieval score: scores of shapes that fit well and badly differ little."""
    seen: float = 0.2
    """Likewise of the probability of a form that is seen."""
    seen_floor: float = 0.03
    """Added to every probability: the namer learnt from rendered pictures and is too sure of itself on photos."""


@dataclass(frozen=True)
class RetrievalSettings:
    """All numbers of `HierarchicalRetrieval` that are not the weights of its scores."""

    ranking: RankingSettings = RankingSettings()
    pools: PoolSettings = PoolSettings()
    sizes: MeasuredSizeSettings = MeasuredSizeSettings()
    similarity: SimilaritySettings = SimilaritySettings()
    forms: UsualFormSettings = UsualFormSettings()


SETTINGS = RetrievalSettings()
