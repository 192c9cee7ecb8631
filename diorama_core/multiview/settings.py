"""The numbers by which several photos of one room are joined."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class JoiningSettings:
    """How photos vote for the room's frame, and how boxes of different photos become objects."""

    vote_log_sigma: float = 0.12
    """Width of a vote for the scale."""
    miss: float = 0.08
    """Rays whose distance is more than this share of their length do not meet."""
    min_parallax_rad: float = 0.05
    strip: float = 0.06
    """Depth of the strip outside an edge in which something may hide the rest, as a share of the box across it."""
    min_strip_px: int = 4
    min_covered: float = 0.2
    """Share of the strip that nearer objects must cover."""
    nearer: float = 1.02
    """Distance of something over a nearer thing's, at least: what stands beside is taken for it, too."""
    unseen_edge: float = 0.5
    """Factor on a box's area for each hidden or cut edge: how well a photo shows an object."""
    min_overlap: float = 0.1
    """Intersection over union of a cuboid's outline with a box of its kind in another photo."""
    raised_cost: float = 6.0
    """Cost of a portable thing that stands on something which no photo says it stands on."""
    rounds: int = 2
    """Times that all boxes are claimed anew by cuboids that know the others."""
    left_out_cost: float = 12.0
    """Cost of a sighting that is left out: four independent edges at one sigma cost more once in sixty."""
    base_sigma_m: float = 0.3
    """Deviation of the height of what need not stand on the floor, about what one photo says."""
    place_sigma_m: float = 0.5
    """Deviation of the place that photos say each by itself: it decides where rays hardly cross."""
    max_sigmas: float = 2.5
    """Deviation of a size from its kind's, at most."""
    odd_angle_cost: float = 1.5
    """Cost of a heading off the room's axes."""
    odd_square_cost: float = 8.0
    """Cost of such a heading for a kind that hardly ever stands so."""
    min_photos_of_odd: int = 4
    """Fewer do not tell that what usually stands along the axes does not."""
    first_iterations: int = 6
    """Steps of all starts."""
    finalists: int = 6
    """Best starts, which go on."""
    iterations: int = 20
    """Steps of those."""
    hidden_odds: float = 10.0
    """Odds that an object goes on beyond an edge where several photos say that something hides it."""
    max_hidden: float = 1.0
    """Most sigmas that a cuboid which goes on behind something costs for each hidden edge."""
    proportion_sigma: float = 0.12
    """Deviation of the logarithms of a shape's proportions from those of what it stands for."""
    min_pairs: int = 3
    """Common objects from which the distance of a new photo is told by their sizes and places."""
    distance_log_sigma: float = 0.15
    """Deviation of that distance by the scene's surfaces."""
    max_cost: float = 40.0
    """Most that one object says against a distance: one that was joined wrongly does not decide."""
    same_box: float = 0.5
    """Intersection over union from which a read box is the one that an object was seen in."""
    clearly_better: float = 1.25
    """Area, less what is hidden or cut, of an object in another photo from which that one shows it better."""
    unseen_shape: float = 0.9
    """Score of a shape that a photo does not find, over the least that it gives."""


SETTINGS = JoiningSettings()
