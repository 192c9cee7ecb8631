"""Air conditioners on walls, in windows and on wheels."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def split_unit(size: Size, body: Material, trim: Material) -> Parts:
    """The indoor part of an air conditioner, hung high on a wall."""
    d, w, h = size
    profile = [
        (-d / 2, 0.02),
        (-d / 2, h),
        (d * 0.28, h),
        (d * 0.46, h * 0.9),
        (d / 2, h * 0.5),
        (d * 0.44, h * 0.24),
        (d * 0.2, 0.0),
        (-d * 0.3, 0.0),
    ]
    ring = np.array(profile)
    ends = [np.column_stack([ring[:, 0], np.full(len(ring), y), ring[:, 1]]) for y in (w / 2, -w / 2)]
    case = loft(np.array(ends)[:, ::-1], crease_rad=np.deg2rad(46))
    flap = box((0.09, w * 0.86, 0.006), 0.002).turned("y", -38).moved(d * 0.3, 0, h * 0.075)
    line = box((0.004, w * 0.985, 0.004), 0.001).moved(d * 0.468, 0, h * 0.36)
    light = box((0.004, 0.03, 0.012), 0.001).moved(d * 0.485, -w * 0.4, h * 0.46)
    return of(body, case) + of(trim, flap, line) + of(m.SCREEN, light)


def portable_ac(size: Size, body: Material) -> Parts:
    """An air conditioner on wheels."""
    d, w, h = size
    case = prism(rounded_rectangle(d, w, 0.06, 6), h - 0.05, 0.03).moved(z=0.045)
    outlet = [
        box((0.012, w * 0.72, 0.012), 0.004).turned("y", -20).moved(d / 2 - 0.002, 0, z)
        for z in np.linspace(0.8, 0.9, 5) * h
    ]
    intake = [box((0.008, w * 0.72, 0.005), 0.002).moved(d / 2 - 0.001, 0, z) for z in np.linspace(0.14, 0.42, 14) * h]
    seam = box((0.004, w * 0.92, 0.004), 0.001).moved(d / 2, 0, h * 0.5)
    wheels = four(cylinder(0.026, 0.02, 0.006, 14).turned("x", 90).moved(d * 0.34, w * 0.4, 0.026))
    screen = box((0.06, w * 0.34, 0.004), 0.002).moved(d * 0.2, 0, h - 0.005)
    return of(body, case) + of(m.GREY, *outlet, *intake, seam) + of(m.BLACK, *wheels, screen)


def window_unit(size: Size, body: Material) -> Parts:
    """A box air conditioner as it sits in a window or a wall."""
    d, w, h = size
    case = box((d * 0.9, w, h), 0.01, 2).moved(-d * 0.05)
    front = box((d * 0.12, w, h), 0.02, 3).moved(d * 0.44)
    slats = [
        box((0.01, w * 0.6, 0.009), 0.003).moved(d / 2 - 0.002, w * 0.14, z) for z in np.linspace(0.14, 0.86, 13) * h
    ]
    panel = box((0.008, w * 0.2, h * 0.76), 0.004).moved(d / 2 - 0.002, -w * 0.34, h * 0.12)
    dials = [cylinder(0.02, 0.016, 0.004, 18).turned("y", 90).moved(d / 2, -w * 0.34, h * f) for f in (0.68, 0.4)]
    return of(body, case, front) + of(m.GREY, *slats, panel) + of(m.CHARCOAL, *dials)


DESIGNS: tuple[Design, ...] = (
    design("air conditioner", "split", "white wall air conditioner", (0.22, 0.85, 0.29), "modern", split_unit, body=m.WHITE, trim=m.LIGHT_GREY),
    design("air conditioner", "split-dark", "graphite wall air conditioner", (0.21, 0.80, 0.28), "minimal", split_unit, body=m.CHARCOAL, trim=m.BLACK),
    design("air conditioner", "window", "window air conditioner", (0.52, 0.60, 0.40), "classic", window_unit, body=m.CREAM),
    design("air conditioner", "portable", "air conditioner on wheels", (0.36, 0.44, 0.76), "minimal", portable_ac, body=m.WHITE),
)  # fmt: skip
