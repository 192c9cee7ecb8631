"""The numbers of layout and refinement, as fields of their stages, and how much each cost of a recipe counts, as a
person may set it.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Literal

import numpy as np

from diorama_core.errors import InputError

RecipeName = Literal["feasible", "paper", "all-in-one"]


@dataclass(frozen=True)
class LayoutSettings:
    """How the default recipe reads a scene, keeps to its photo and takes collisions away."""

    firm_share: float = 0.55
    """Rigid share of a soft object's extent: pillows sink into one another."""
    behind_m: float = 0.02
    """Accuracy of the walls' places."""
    above_m: float = 0.01
    """Parts of a supporter that rise less above a place are below what rests there."""
    beside_m: float = 0.005
    """Overlap of a part with the edge of a place beside which it stands: parts contain their mesh."""
    long_side_px: int = 400
    """Size of the picture in which the layout is looked at: a cup at the far wall still has a dozen pixels."""
    max_points: int = 120
    """Points that track an object."""
    min_points: int = 8
    """With fewer the corners of the object's box are tracked in their place."""
    nearest_m: float = 0.1
    """What is nearer to the camera has no place in the picture."""
    same_place: float = 0.4
    """Intersection over union from which a posed shape is where its box in the photo is."""
    border_px: float = 2.0
    """Boxes that end nearer to the picture's border go on beyond it."""
    different: float = 0.08
    """Share of a box by which posed bounds may differ from it: shapes are not what they stand for."""
    covered: float = 0.3
    """Share of a box's side that a nearer object's box covers where that side is hidden."""
    upward: float = 0.98
    """Normals with a larger z are of places on which things are put down."""
    load_m: float = 0.12
    """What was observed farther from its place says nothing about that place."""
    moved_m: float = 2e-3
    """Objects that structure moved less already agree: a settled layout and what a person arranged stay."""
    fit_steps: int = 4
    tracked: float = 3.0
    """Weight of a metre by which tracked points leave their lines of sight, against one of the outline."""
    keep_place: float = 0.1
    """Weight of staying where structure put an object."""
    load: float = 1.5
    """Weight of a metre between a place and what was observed on it."""
    keep_size: float = 0.4
    """Weight of a relative change of size, and of one extent against the others."""
    max_stretch: float = 1.3
    """Sizes change by at most this factor either way."""
    max_growth: float = 1.7
    """An object's distance, with its size, is corrected by at most this factor; so is the height of what stands between
    two boards."""
    smallest_shrink: float = 0.8
    """What does not fit even so much smaller stays large and is named."""
    shrinks: tuple[float, ...] = (0.95, 0.9, 0.85)
    """Sizes of colliding objects that are tried, before the smallest."""
    shortest_before_wall: float = 0.5
    """An object that reaches through a wall ends before it if this share of its extent is left."""
    max_detour: float = 3.0
    """An object leaves its wall rather than move so many times as far along it onto its support."""
    parallel: float = 0.97
    """Cosine within which a side of an object is along a wall."""
    min_slant: float = 0.1
    """A surface seen more edge-on than this says nothing about distance."""
    min_beyond_m: float = 0.005
    """Loads that reach less beyond an edge are brought back; others lengthen their supporter."""
    inner_share: float = 0.15
    """An edge farther from the supporter's side, as a share of the extent, is a divider's."""
    ceiling_slope: float = 0.3
    """Normals with a smaller z are of walls."""
    max_cord_m: float = 1.5
    """A lamp that was seen farther below its ceiling does not hang from it."""
    hidden: float = 0.2
    """Weight of a hidden end of a height, against one that was seen."""
    min_extent_m: float = 0.02
    """Least apparent height."""
    usual: float = 0.05
    """Share of an apparent height up to which disagreements count by their square."""
    height_rounds: int = 4
    height_rounding_m: float = 1e-4
    """Smaller changes of a height or a place are rounding."""
    shrink: float = 0.9
    """Factor on a stuck object's footprint, each attempt."""
    min_certainty: float = 0.1
    """Weight of an object that is hardly seen."""
    riding: float = 0.05
    """Cost of moving on a supporter, against moving in the picture."""
    reaches_m: tuple[float, ...] = (0.15, 0.6, 2.0)
    """Distances looked through in turn for a free place: near ones need only near neighbours."""
    left_overlap: float = 2.0
    """Cost of a pair that is left overlapping, which is made smaller then: of a move by a metre across the picture."""
    max_pairs: int = 12
    """With more pairs in collision sizes are left alone: a crowd is parted by moves."""
    worth: float = 0.8
    """A smaller size is taken where it costs less than this share of the move that it saves."""
    apart_m: float = 5e-4
    """Separation asked for once two parts touched."""
    touching_m: float = 1e-4
    """Parts nearer than this (or overlapping) touch."""
    watched_m: float = 0.02
    """Pairs of parts nearer than this are watched."""
    relaxations: int = 3
    min_saving: float = 0.01
    """Relaxing goes on as long as it saves this share of the move."""
    max_axes: int = 64
    """Axes of a pair of parts that are looked at for a way out; fewer never part what overlaps."""
    sides: int = 8
    """Directions in which the axes that part them soonest are looked at besides."""
    named_move_m: float = 0.2
    """Objects that a layout moves farther are named."""
    named_outline: float = 0.6
    """Likewise those whose outline shares less with the observed one (intersection over union of bounds)."""


@dataclass(frozen=True)
class RefinementSettings:
    """How poses are searched that cover the masks better, and what keeps them near what was observed."""

    touching_m: float = 0.004
    """What is so near to a wall stays against it."""
    outlined: float = 0.4
    """Weight of a mask that was found in a box; the box, which a person drew or looked at, has the rest."""
    long_side_px: int = 320
    """Size of the grid of pixels, about."""
    shares: tuple[float, ...] = (0.08, 0.04, 0.02, 0.01)
    """Shares of its size by which a step changes an object, in turn."""
    rounds: int = 2
    """Turns of every object at each share; one without a step to make leaves the next out."""
    steps: int = 2
    """Most steps of an object in its turn."""
    move: float = 0.6
    """Length of a step over the object's distance, times the share."""
    turn_rad: float = 2.0
    """Turn of a step, times the share."""
    farthest_m: float = 4.0
    """Steps of what is farther away are no longer."""
    ways: tuple[float, ...] = (1.0, 0.5, 0.25)
    """Shares of the way to the observed place that are tried at once: what stands in between is no obstacle."""
    max_growth: float = 1.4
    """Most that an extent becomes longer or shorter: what its mask asks beyond is for another place or shape."""
    min_pixels: int = 8
    """An object whose mask is smaller says nothing."""
    min_gain: float = 1e-4
    """Least gain in agreement for which a step is made."""
    min_along: float = 0.3
    """Directions of which a wall leaves less are given up."""
    slanted: float = 3.0
    """Change of a slanted surface's depth over the move of its object, at most."""
    sigma: float = 0.005
    """Cost of one standard deviation, against the whole agreement of one mask."""
    max_sigmas: float = 5.0
    """More standard deviations of turn or size, to which the layout had to change an object, cost no more."""
    linear_sigmas: float = 2.0
    """Standard deviations beyond which distance costs by their number: what was pushed away comes back where it can."""
    turn_sigma_rad: float = 0.1
    """Standard deviation of an observed turn."""


LAYOUT = LayoutSettings()
REFINEMENT = RefinementSettings()


LARGEST = 10.0


@dataclass(frozen=True)
class Weights:
    """Factors on the costs of a recipe: 1 everywhere is the recipe as it is, 0 leaves a cost out.

    Support and the absence of overlap are no costs of the default recipe: it keeps to them exactly.

    Raises:
        InputError: a factor is negative, larger than `LARGEST` or no number.
    """

    align: float = 1.0
    """Contact faces parallel to what they rest on (published recipes)."""
    heading: float = 1.0
    """Fronts keep the direction seen in the photo (published recipes)."""
    place: float = 1.0
    """Contact faces touch what they rest on (published recipes)."""
    neighbours: float = 1.0
    """Objects near each other keep their arrangement (published recipes)."""
    volume: float = 1.0
    """Objects stay over and below what bounds their support (published recipes)."""
    collision: float = 1.0
    """Boxes apart (published recipes)."""
    outline: float = 1.0
    """Objects stay where they are seen in the photo (default recipe)."""
    distance: float = 1.0
    """Objects stay as far from the camera as observed (default recipe)."""

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not np.isfinite(value) or not 0.0 <= value <= LARGEST:
                raise InputError(f"the weight of {field.name} is {value:g}; give a factor from 0 to {LARGEST:g}")


AS_IT_IS = Weights()
PUBLISHED_COSTS = ("align", "heading", "place", "neighbours", "volume", "collision")
DEFAULT_COSTS = ("outline", "distance")


def cost_names(recipe: str) -> tuple[str, ...]:
    """The fields of `Weights` that make a difference to a recipe."""
    return DEFAULT_COSTS if recipe == "feasible" else PUBLISHED_COSTS
