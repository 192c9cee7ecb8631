"""What lamps have in common: shades, bulbs and the wires between them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.library.furniture.kit import *


def shade(bottom: float, top: float, height: float, pleats: int = 0) -> Solid:
    """A lampshade open above and below, on z = 0; radii of its rims."""
    t = 0.004
    solid = lathe([(bottom - t, 0.004), (bottom, 0), (top, height), (top - t, height), (bottom - t, 0.004)], 40)
    if not pleats:
        return solid
    angle = np.arctan2(solid.vertices[:, 1], solid.vertices[:, 0])
    factor = 1 + 0.02 * np.cos(pleats * angle)
    return replace(solid, vertices=solid.vertices * np.column_stack([factor, factor, np.ones(len(factor))]))


def bulb(z: float, radius: float = 0.03) -> Parts:
    """A lit globe with its middle at z."""
    return of(m.LAMP_GLOW, ball(2 * radius).moved(z=z - radius))


def spider(radius: float, z: float) -> list[Solid]:
    """The three wires that hold a shade."""
    return [
        rod((0, 0, z), (radius * np.cos(a), radius * np.sin(a), z), 0.002, segments=5)
        for a in np.deg2rad((0, 120, 240))
    ]


def rose(h: float, metal: Material, radius: float = 0.05) -> Parts:
    """The cup on the ceiling, its top at `h`."""
    return of(metal, lathe([(0.9 * radius, h - 0.025), (radius, h - 0.02), (radius, h), (0.01, h)], 24))


def flex(low: float, high: float, metal: Material = m.BLACK) -> Solid:
    """A lamp's cord between two heights."""
    return cylinder(0.003, high - low, 0.001, 8).moved(z=low)


def filament_bulb(z: float, glow: Material = m.LAMP_GLOW, scale: float = 1.0) -> Parts:
    """A clear pear-shaped bulb hanging from its socket at z, with a glowing thread in it."""
    k = scale
    pear = lathe(
        [
            (0.002, -0.125 * k),
            (0.018 * k, -0.12 * k),
            (0.032 * k, -0.09 * k),
            (0.028 * k, -0.06 * k),
            (0.014 * k, -0.02 * k),
            (0.013 * k, 0),
        ],
        20,
        np.pi,
    )
    thread = cylinder(0.0035 * k, 0.06 * k, 0.001, 6).moved(z=-0.095 * k)
    return (
        of(m.GLASS, pear.moved(z=z))
        + of(glow, thread.moved(z=z))
        + of(m.BRASS, cylinder(0.015 * k, 0.035 * k, 0.002, 14).moved(z=z - 0.008 * k))
    )
