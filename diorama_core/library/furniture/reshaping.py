"""Forms changed as a whole, whatever builds them: mirrored, and wider and narrower along their height.

What has a left and a right, a corner sofa or a desk with drawers at one side, has them the other way round in half of all
rooms. A design that looks the same from all around is known by its profile, and a picture tells the profile of such a
thing whichever side it shows: its girth changes as on a lathe, by factors at equally spaced heights with a smooth curve
through them, so that walls, lips and feet stay what they are.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from jaxtyping import Float
from scipy.interpolate import PchipInterpolator

from diorama_core.library.furniture.cutting import cut
from diorama_core.library.furniture.model import Part, Parts, Size
from diorama_core.library.furniture.solids import unit

GIRTH, MIRRORED = "girth", "mirrored"
"""Names of the parameters in ids."""
NAMES = frozenset({GIRTH, MIRRORED})
KNOTS = 13
"""Heights at which the girth is told, from the foot to the top."""
MIN_PERCENT, MAX_PERCENT = 15, 400
Whole = bool | tuple[int, ...]
"""What one of these parameters may be."""
AS_BUILT: Mapping[str, Whole] = {GIRTH: (100,) * KNOTS}
"""Values that change nothing."""


def read(name: str, text: str) -> Whole | None:
    """The value that an id states; None where it states none."""
    if name == MIRRORED:
        return True if text == "yes" else None
    words = text.split(",")
    return tuple(int(w) for w in words) if all(w.isdecimal() and len(w) <= 3 for w in words) else None


def reshaped(
    size: Size,
    *,
    builder: Callable[..., Parts],
    girth: Sequence[int] | None = None,
    mirrored: bool = False,
    **options: Any,
) -> Parts:
    """What another builder makes, mirrored, and wider and narrower along its height.

    Args:
        size: As for the other builder.
        builder: What makes the form; of a body of revolution where a girth is given.
        girth: Percent at `KNOTS` heights.
        mirrored: Whether its left is its right.
        options: As for the other builder.
    """
    parts = builder(size, **options)
    if mirrored:
        parts = [_mirrored(part) for part in parts]
    if girth is None:
        return parts
    points = np.concatenate([p.solid.vertices for p in parts])
    low, high = points.min(axis=0), points.max(axis=0)
    axis_xy, heights = (low + high)[:2] / 2, np.linspace(low[2], high[2], KNOTS)
    curve = PchipInterpolator(heights, np.asarray(girth, dtype=np.float64) / 100.0)
    return [_bent(part, curve, axis_xy, heights[1:-1]) for part in parts]


def _mirrored(part: Part) -> Part:
    """A part reflected in the plane y = 0; what moves opens as it did, to the other side."""
    joint = part.joint
    if joint is not None:
        (x, y, z), (along_x, along_y, along_z) = joint.origin, joint.axis
        # A turn is reflected by the axis' image turned about: right-handed angles keep their sign.
        sign = 1.0 if joint.kind == "slide" else -1.0
        joint = replace(joint, origin=(x, -y, z), axis=(sign * along_x, -sign * along_y, sign * along_z))
    return replace(part, solid=part.solid.mirrored(), joint=joint)


def _bent(
    part: Part, curve: PchipInterpolator, axis_xy: Float[np.ndarray, "2"], knots: Float[np.ndarray, " k"]
) -> Part:
    """A part with its distance from the axis multiplied by the curve; normals by the inverse transpose of that map.

    It is cut at the knots, so that there is something to bend between two corners of a profile.
    """
    solid = part.solid
    for height in knots:
        solid = cut(solid, float(height))
    z = solid.vertices[:, 2]
    factor, slope = curve(z), curve.derivative()(z)
    away = solid.vertices[:, :2] - axis_xy
    vertices = np.column_stack([axis_xy + away * factor[:, None], z])
    across = solid.normals[:, :2] / factor[:, None]
    normals = np.column_stack([across, solid.normals[:, 2] - slope * (away * across).sum(axis=1)])
    return replace(part, solid=replace(solid, vertices=vertices, normals=unit(normals)))
