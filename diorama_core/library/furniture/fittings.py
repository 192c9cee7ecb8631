"""Knobs, long handles and taps: what kitchens and bathrooms share."""

from __future__ import annotations

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Parts, of
from diorama_core.library.furniture.solids import bend, box, cylinder, rod, tube


def knob(radius: float = 0.018) -> Parts:
    """A turning knob on the plane x = 0."""
    return of(m.BLACK, cylinder(radius, 0.022, 0.004, 18).turned("y", 90)) + of(
        m.STEEL, box((0.004, 0.003, radius * 1.5), 0.001).moved(0.021, 0, 0)
    )


def at(parts: Parts, x: float, y: float, z: float) -> Parts:
    """Parts moved to a place."""
    return [p.moved(x, y, z) for p in parts]


def bar_handle(length: float, upright: bool, metal: Material = m.STEEL) -> Parts:
    """A long appliance handle on the plane x = 0, middle at the origin."""
    half = length / 2
    bits = [
        rod((0.04, -half, 0), (0.04, half, 0), 0.011),
        *(rod((0, s * half * 0.85, 0), (0.04, s * half * 0.85, 0), 0.008) for s in (1, -1)),
    ]
    return of(metal, *(b.turned("x", 90) for b in bits)) if upright else of(metal, *bits)


def tap(height: float, metal: Material = m.CHROME, reach: float = 0.18) -> Parts:
    """A swan-neck tap on z = 0, its spout toward +X."""
    path = bend(
        [
            (0, 0, 0),
            (0, 0, height * 0.7),
            (reach * 0.35, 0, height * 0.98),
            (reach * 0.85, 0, height * 0.9),
            (reach, 0, height * 0.66),
        ],
        6,
    )
    return of(
        metal, tube(path, 0.011, 10), cylinder(0.024, 0.02, 0.004, 18), rod((0, 0, 0.06), (0.0, 0.07, 0.085), 0.006)
    )
