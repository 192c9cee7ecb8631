"""Low stools, and the stool seats that bar stools share."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def round_stool(size: Size, wood: Material, seat: Material, foot_ring: Material | None = None) -> Parts:
    """A round seat on splayed turned legs."""
    d, _, h = size
    r = d / 2
    legs = []
    for k in range(4):
        a = np.deg2rad(45 + 90 * k)
        c, s = np.cos(a), np.sin(a)
        legs.append(rod((c * r * 0.98, s * r * 0.98, 0), (c * r * 0.6, s * r * 0.6, h - 0.035), 0.012, 0.019))
    ring_z = 0.34 * h
    ring_r = r * (0.98 - 0.38 * 0.34)
    parts = of(wood, *legs)
    parts += of(foot_ring or wood, tube(ring_path(superellipse(2 * ring_r, 2 * ring_r), ring_z), 0.009, closed=True))
    return parts + of(
        seat,
        lathe(
            [
                (r * 0.84, h - 0.038),
                (r * 0.92, h - 0.03),
                (r * 0.92, h - 0.012),
                (r * 0.86, h - 0.002),
                (r * 0.5, h - 0.006),
                (0.02, h - 0.008),
            ],
            32,
        ),
    )


def pad_stool(size: Size, cloth: Material, frame: Material) -> Parts:
    """A bar stool: upholstered pad on a square steel frame."""
    d, w, h = size
    leg = taper((d / 2 - 0.012, w / 2 - 0.012, 0), (d / 2 - 0.03, w / 2 - 0.03, h - 0.07), 0.022, 0.022, 0.003)
    z = 0.32 * h
    rails = [beam((x, -w / 2 + 0.02, z), (x, w / 2 - 0.02, z), 0.018, 0.018) for x in (d / 2 - 0.018, -d / 2 + 0.018)]
    sides = both_sides(beam((-d / 2 + 0.02, w / 2 - 0.018, z), (d / 2 - 0.02, w / 2 - 0.018, z), 0.018, 0.018))
    top = box((d - 0.03, w - 0.03, 0.018), 0.004).moved(0, 0, h - 0.082)
    return of(frame, *four(leg), *rails, *sides, top) + of(cloth, cushion((d, w, 0.075), 7, 3.0).moved(0, 0, h - 0.075))


def swivel_stool(size: Size, seat: Material, steel: Material) -> Parts:
    """A round pad on a column over a disc foot."""
    d, _, h = size
    r = d / 2
    foot = lathe([(r * 0.98, 0), (r, 0.006), (r * 0.9, 0.014), (r * 0.2, 0.03), (0.032, 0.05)], 36)
    column = cylinder(0.025, h - 0.1).moved(z=0.03)
    ring_z = 0.36 * h
    ring = tube(ring_path(superellipse(d * 0.72, d * 0.72), ring_z), 0.009, closed=True)
    spoke = rod((-0.36 * d, 0, ring_z), (0.36 * d, 0, ring_z), 0.008)
    return of(steel, foot, column, ring, spoke) + of(
        seat, cushion((d * 0.95, d * 0.95, 0.085), 2, 3.4, 12).moved(z=h - 0.085)
    )


def step_stool(size: Size, wood: Material) -> Parts:
    """A farmhouse stool: plank top, slanted board ends."""
    d, w, h = size
    top = box((d, w, 0.03), 0.007).moved(z=h - 0.03)
    end = taper((0, 0, 0), (0, 0, h - 0.03), 0.024, 0.024)
    board = both_sides(end.scaled(x=d * 0.82 / 0.024).moved(y=w * 0.36))
    return of(wood, top, *board, beam((0, -w * 0.36, h * 0.35), (0, w * 0.36, h * 0.35), 0.022, 0.06))


DESIGNS: tuple[Design, ...] = (
    design("stool", "round-oak", "low round oak stool", (0.36, 0.36, 0.45), "minimal", round_stool, 4, wood=m.OAK, seat=m.OAK),
    design("stool", "farm-pine", "small pine farmhouse stool", (0.26, 0.40, 0.34), "rustic", step_stool, 2, wood=m.PINE),
)  # fmt: skip
