"""Legs: one profile a style."""

from __future__ import annotations

from typing import Literal

import numpy as np

from diorama_core.library.furniture.model import joined
from diorama_core.library.furniture.solids import Solid, bend, box, lathe, rod, taper, tube

Leg = Literal["splay", "taper", "turned", "cabriole", "square", "slim", "steel", "bun"]
"""How a leg is shaped; "bun" is a low turned foot."""

_TURNED = (
    *((0.45, 0.0), (0.62, 0.015), (0.5, 0.05), (0.72, 0.09), (0.55, 0.12), (0.68, 0.2), (0.98, 0.52), (0.8, 0.68)),
    *((1.0, 0.72), (0.7, 0.75), (1.0, 0.8)),
)
"""(share of the radius, share of the height) of a turned leg below its square head."""


def leg(kind: Leg, x: float, y: float, h: float, thick: float, lean: float = 0.06) -> Solid:
    """One leg under the point (x, y, h), its outward direction away from the origin.

    Args:
        kind: Its profile.
        x: Where its head is.
        y: Where its head is.
        h: Its height, metres.
        thick: Its width at the head, metres.
        lean: How far a splayed leg's foot stands out, as a share of its height.
    """
    out_x, out_y = np.sign(x) or 1.0, np.sign(y) or 1.0
    if kind == "splay":
        foot = (x + out_x * lean * h, y + out_y * lean * h, 0)
        return rod(foot, (x - out_x * lean * h * 0.4, y - out_y * lean * h * 0.4, h), thick * 0.28, thick * 0.46, 12)
    if kind == "turned":
        r = thick / 2
        turned = lathe([(r * a, h * b) for a, b in _TURNED], 16)
        return joined([turned, box((thick, thick, h * 0.22), 0.004).moved(z=h * 0.78)]).moved(x, y)
    if kind == "cabriole":
        dx, dy = out_x * 0.7, out_y * 0.7
        path = bend(
            [
                (x + 0.02 * dx, y + 0.02 * dy, h),
                (x + 0.045 * dx, y + 0.045 * dy, 0.80 * h),
                (x + 0.012 * dx, y + 0.012 * dy, 0.35 * h),
                (x + 0.012 * dx, y + 0.012 * dy, 0.08 * h),
                (x + 0.05 * dx, y + 0.05 * dy, 0.012),
            ],
            4,
        )
        return tube(path, thick * np.interp(np.linspace(0, 1, len(path)), [0, 0.2, 0.6, 0.85, 1], _CABRIOLE), 10)
    if kind == "bun":
        r = thick * 0.6
        return lathe([(r * 0.5, 0), (r, 0.3 * h), (r, 0.6 * h), (r * 0.55, 0.85 * h), (r * 0.8, h)], 16).moved(x, y)
    if kind == "taper":
        return taper((x, y, 0), (x, y, h), thick * 0.55, thick, 0.004)
    width = {"square": 1.25, "slim": 0.62, "steel": 0.6}[kind] * thick
    return box((width, width, h), 0.008 if kind == "square" else 0.003).moved(x, y)


def trumpet(h: float, foot_r: float, stem_r: float) -> Solid:
    """A round foot that runs up into a stem, as under tulip chairs.

    Args:
        h: Its height, metres.
        foot_r: Radius on the floor, metres.
        stem_r: Radius under the seat, metres.
    """
    bell = [(foot_r, 0.0), (foot_r, 0.008), (0.8 * foot_r, 0.02), (0.4 * foot_r, 0.055), (1.15 * stem_r, 0.15)]
    return lathe([*bell, (stem_r, 0.5 * h), (1.25 * stem_r, h)], 28)


_CABRIOLE = [0.48, 0.52, 0.27, 0.24, 0.34]
"""Radii along a cabriole leg, as shares of its width at the head."""
