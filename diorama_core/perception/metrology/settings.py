"""The numbers of single-view metrology, as fields of its stage."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class BoxObservationSettings:
    """What boxes, masks and drawn edges say of an object."""

    share_sigma: float = 0.03
    pixel_sigma: float = 3.0
    """By picture 640 pixels wide, added to the share."""
    min_box_px: float = 2.0
    border_share: float = 0.006
    """An edge so near to the border of the photo, as a share of its longer side, is cut there."""
    covered: float = 0.65
    """Share of an edge that something in front must cover to hide it."""
    strip: float = 0.15
    lower_end: float = 0.25
    """Width of the strips beside a box, and the part of its height along which they lie, as shares of the box."""
    odds_boxed: float = 2.0
    odds_outlined: float = 8.0
    """By how much a nearer thing's box across the edge, and others' masks all along its outer side, raise them."""
    outside_px: float = 2.5
    """Beside the box, in a picture 640 pixels wide."""
    along: int = 64
    clearly_lower: float = 0.03
    """How much lower, as a share of the picture, a thing's box must end to be in front."""
    beyond_sigma: float = 0.05
    beyond_sigma_guessed: float = 0.12
    """For masks that are not the user's own."""
    empty_sigma_solid: float = 0.13
    empty_sigma: float = 0.35
    max_outline_cost: float = 10.0
    guessed_trust: float = 0.5
    """Trust in a mask that is not the user's own, at full agreement of its starts."""
    samples: int = 9
    middle: float = 0.6
    lower: float = 0.1
    """Shares of a box: of its width along which its lower end is looked at, and of its height above its lower edge."""
    floor_share: float = 0.9
    """Share of the unmarked surfaces below the camera that a depth network sees above the floor or on it: a few are
    seen too low."""
    least_free: float = 0.02
    """Least share of the picture that is unmarked and below the camera, so that it tells where the floor is."""


@dataclass(frozen=True)
class CuboidFitSettings:
    """How a cuboid is fitted to what is observed of an object."""

    robust_beyond: float = 2.0
    """Residuals beyond this many sigmas count linearly."""
    hidden_density: float = 0.25
    """Density of where a hidden edge is, even over its reach, against the highest of a measured edge's: below 1, since
    a range of places shares it; not the ratio of widths, since the reading with more room is likelier."""
    hidden_reach: float = 1.0
    """How far an object may go on unseen, in extents of its box, where no other box tells how far."""
    invisible_penalty: float = 12.0
    """Sigmas per edge for a cuboid that is not in the picture at all."""
    wall_nearer_log_sigma: float = 0.06
    cut_near_m: float = 0.2
    far_m: float = 6.0
    far_log_sigma: float = 0.15
    min_room_m: float = 0.02
    min_back_m: float = 0.05
    """Bases have so much room on their supporters, and backs are so far from the camera, at least."""
    longest_step: float = 0.7
    """Largest change of any unknown in one iteration."""
    min_gain: float = 1e-3
    """A row whose cost falls by less than this in an accepted step has settled."""
    max_sigmas: float = 2.0
    cut_log_sigma: float = 1.5
    min_rise_m: float = 0.1
    """Tops nearer to the camera's height do not tell how far they are."""
    maybe_hidden: float = 0.3
    """Odds from which on a lower end may be hidden."""
    seen_before_centre: float = 0.25
    """What is seen of a cuboid is so far before its centre, in depths and widths: half of what its front is."""
    nearest_m: float = 0.4
    farthest_m: float = 12.0


@dataclass(frozen=True)
class PlacementSettings:
    """What costs decide where objects are and what supports them; costs are squared sigmas."""

    hardly: float = 1e-4
    """How likely a thing without a name is held as no kind is that it may be of."""
    screen_on_wall_cost: float = 3.0
    beside_its_supporter_cost: float = 20.0
    """For a thing on the floor, or on a wall, that belongs on something its box rests in."""
    at_carrier_cost: float = 4.0
    """For a portable thing on the floor that ends on what often carries such things: it would do so by chance."""
    usual: float = 4.0
    company_trust: float = 0.5
    """How often a carrier's usual loads lie on it (`company.CARRIED`), and how much less is held against others."""
    stacked_cost: float = -3.0
    """For a thing on a small one that lies on others: what is behind that one would end right there by chance."""
    seen_under: float = 0.6
    """It lies there only where so much of what is seen just under it is the other."""
    before_cost: float = 10.0
    """For a thing on the floor that ends before another whose lower end is nearer: it would stand in its place."""
    through_top_cost: float = 10.0
    """For a thing on the floor that would be seen through a piece of furniture's top."""
    sure_cost: float = 12.0
    """Things on the floor that cost less than this tell how far the room reaches."""
    set_sigma: float = 0.05
    """Logarithmic: how well the extents of those of a set that are seen well are measured."""
    odd_one_cost: float = 3.0
    """For a size of its own beside others of its kind: one in five."""
    max_unseen: int = 1
    """Edges that may be hidden or cut of a member that tells the others' size."""
    averted_cost: float = 2.0
    ceiling_m: float = 2.6
    ceiling_sigma_m: float = 0.25
    top_sigma_m: float = 0.04
    seat_sigma_m: float = 0.08
    footprint_sigma_m: float = 0.06
    inner_level_cost: float = 1.5
    back_cost: float = 2.5
    odd_on_back_cost: float = 10.0
    """For a pillow or toy that lies on a backrest or headboard, and for anything else there."""
    above_parent: float = 0.5
    """Share of a thing's width that must lie within its supporter's box."""
    above_share: float = 0.15
    drawn_sigmas: float = 2.0
    seats_without_support_flag_cost: float = 2.0
    flat_m: float = 0.2
    """A door thinner than this along an axis is in the wall across that axis."""
    odd_on_seat_cost: float = 6.0
    """For what is neither pillow nor toy on a seat or a bed: one in twenty."""
    wall_top_m: float = 2.0
    wall_top_sigma_m: float = 0.5
    middle_m: float = 1.4
    middle_sigma_m: float = 0.4
    unnamed_anything_cost: float = 6.0
    min_share: float = 0.03
    max_meanings: int = 4
    """Meanings of a word that count for the size: how likely at least, and how many at most."""
    small_m: float = 0.55
    small_sigma_m: float = 0.12
    """Portable things lower than this are more often found on furniture than on the floor."""
    max_readings: int = 5
    dearest: float = 12.0
    """A reading that costs this much more than the cheapest is dropped."""
    same_place_m: float = 0.12
    same_size: float = 0.12
    overlap_cost: float = 14.0
    """For one footprint lying wholly in another."""
    tucked_cost: float = 4.0
    """Likewise for seats under tables."""
    on_footprint_flat_m: float = 0.05
    rounds: int = 6
    max_carried_cost: float = 12.0
    """No thing speaks more than this against one reading."""


@dataclass(frozen=True)
class HeightScanSettings:
    """How the camera's height and hypothesis are found, and how sure cuboids are."""

    height_prior_m: float = 1.4
    height_log_sigma: float = 0.18
    height_tails: float = 4.0
    """Degrees of freedom of Student's t: photos are also taken from the floor and from stairs."""
    max_vote: float = 25.0
    """No object counts more than this: it may be mislabelled."""
    max_doubtful_vote: float = 9.0
    """For things that need not stand on the floor."""
    odd_angle_cost: float = 1.5
    odd_angles_deg: tuple[float, ...] = (30.0, -30.0, 60.0, -60.0)
    scan_iterations: int = 10
    continued_iterations: int = 5
    farther: float = 1.6
    alike: float = 0.7
    """How far the sizes of two things of a kind in one room are the same surprise: sets have one vote, not one each."""
    square: float = 0.15
    """Difference of the logarithms of width and depth below which the prior cannot tell them apart."""
    cost_scale: float = 18.0
    may_be_hidden: float = 0.5
    """Odds from which on a lower end is not taken for seen."""
    hidden_factor: float = 0.85
    """Per edge that is hidden or cut by the picture's border."""
    cost_weight: float = 0.003
    """How much a squared sigma of the objects counts against a camera hypothesis's score."""


@dataclass(frozen=True)
class MetrologySettings:
    """All numbers of `SingleViewMetrology`."""

    observed: BoxObservationSettings = BoxObservationSettings()
    fit: CuboidFitSettings = CuboidFitSettings()
    placement: PlacementSettings = PlacementSettings()
    heights: HeightScanSettings = HeightScanSettings()


SETTINGS = MetrologySettings()
