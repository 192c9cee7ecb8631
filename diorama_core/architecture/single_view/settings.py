"""The numbers of the room that is read from one photo, as fields of its stage."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class RoomCueSettings:
    """What the picture tells of walls, floor and ceiling, and what each cue counts."""

    map_side_px: int = 400
    """Longest side of the edge maps."""
    edge_sigma: float = 0.006
    """Width of the edges' response, as a share of the picture's diagonal."""
    slant_share: float = 0.025
    slant_diagonals: float = 0.12
    """Minimum share of all segments, and length in image diagonals, of an accepted slanted direction."""
    min_level: float = 0.25
    """Segments near the horizon do not determine a direction."""
    crowd_share: float = 0.12
    crowd_free: float = 0.12
    crowd_loss: float = 3.0
    crowd_min: float = 0.25
    """Dense parallel edges (bricks, boards) are down-weighted beyond this share of a window."""
    unseen_foot: float = 0.3
    """What an object says about the walls whose distance only its size tells, against one that is seen to stand
    there."""
    edge_weight: float = 1.0
    object_weight: float = 0.5
    prior_weight: float = 0.1


@dataclass(frozen=True)
class RoomSearchSettings:
    """How the room is searched as a chain of walls."""

    first_ceilings_m: tuple[float, ...] = (2.2, 2.9, 3.8, 5.0)
    """Below which chains are begun, from low to the highest in steps of a third."""
    above_camera_m: float = 0.4
    """Least height of these above the camera."""
    region_weight: float = 6.0
    line_weight: float = 2.5
    skirtings_m: tuple[float, ...] = (0.06, 0.08, 0.1, 0.12)
    """Usual heights of skirting boards, whose upper edge is a line above a wall's foot as clear as the foot itself."""
    upright_weight: float = 1.5
    protrusion_m: float = 0.25
    back_weight: float = 0.1
    back_log_sigma: float = 0.12
    back_cap: float = 2.0
    """Weight of a sure object's back against all that the picture shows of the room; how well its place is known; and
    the squared sigmas beyond which it says no more: it may stand elsewhere."""
    unsure_share: float = 0.2
    """Share of its distance by which an object may be nearer than its cuboid."""
    corner_cost: float = 0.05
    protruding_cost: float = 0.2
    jump_cost: float = 0.3
    """Costs of a corner that the room folds in at, of one that stands into it, and of a wall that ends in the open."""
    min_share: float = 0.3
    """Minimum share of the corner cost at a clear vertical edge, since photos have many vertical edges."""
    nearest_m: float = 0.5
    farthest_m: float = 12.0
    distances: int = 32
    corner_bins: float = 1.5
    enough_edge: float = 0.25
    edge_trust: float = 0.7
    """Edges free to be seen over so many picture diagonals can be relied on; and how much they count for confidence."""
    enough_colour: float = 0.004
    colour_trust: float = 0.45
    """Visible share of floor and wall at which their colours are distinguishable, and its weight."""
    grazing: float = 0.06
    """Walls are not looked for where they are seen more aslant than this, nor beyond"""
    reach_m: float = 15.0
    far_m: float = 7.0
    far_log_sigma: float = 0.25
    """What is seen of a wall is rarely farther away than this: another wall comes first."""
    floor_confidence: float = 0.6
    lines: int = 14
    """Number of longest lines per axis that are tried as feet of walls."""
    max_push_m: float = 2.0
    """Walls give way to objects by at most this: what is farther out is a mistake."""
    push_weight: float = 3.0
    enough_out_m: float = 0.5
    """How much a sure wall's place counts beside a sure object's; and the protrusion beyond which more says no more."""
    clearance_m: float = 0.02
    measured: float = 0.95
    """A wall candidate's confidence is this less what is seen through it."""
    min_visible_share: float = 0.004
    """A ceiling seen in less of the picture than this is left out."""
    ceiling_step: int = 8
    """Pixel stride of the ceiling visibility test."""


@dataclass(frozen=True)
class PhotoRoomSettings:
    """All numbers of `PhotoRoom`."""

    cues: RoomCueSettings = RoomCueSettings()
    search: RoomSearchSettings = RoomSearchSettings()


SETTINGS = PhotoRoomSettings()
