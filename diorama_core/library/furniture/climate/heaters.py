"""Electric heaters."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *

GRILLE = Material("steel grille", "mesh", "#9b9d9e", 0.5, 0.3, 0.06)


def oil_heater(size: Size, body: Material) -> Parts:
    """A finned oil radiator on wheels, its long side along x."""
    d, w, h = size
    count = max(int((d - 0.14) / 0.055), 5)
    fins = [
        prism(rounded_rectangle(h - 0.1, w * 0.8, 0.05, 3), 0.03, 0.009)
        .turned("y", 90)
        .moved(-d / 2 + 0.06 + 0.055 * k, 0, h / 2 + 0.03)
        for k in range(count)
    ]
    pipes = [rod((-d / 2 + 0.05, 0, z), (d / 2 - 0.09, 0, z), 0.02) for z in (0.14, h - 0.08)]
    panel = box((0.1, w * 0.8, h - 0.12), 0.02, 3).moved(d / 2 - 0.05, 0, 0.08)
    dial = cylinder(0.03, 0.016, 0.004, 20).turned("y", 90).moved(d / 2 - 0.002, 0, h * 0.7)
    feet = [box((0.05, w, 0.018), 0.006).moved(s * d * 0.33, 0, 0.05) for s in (1, -1)]
    wheels = [
        cylinder(0.03, 0.02, 0.006, 16).turned("x", 90).moved(sx * d * 0.33, sy * (w / 2 - 0.012) + 0.01, 0.03)
        for sx in (1, -1)
        for sy in (1, -1)
    ]
    return of(body, *fins, *pipes, panel) + of(m.BLACK, dial, *feet, *wheels)


def fan_heater(size: Size, body: Material) -> Parts:
    """A small box heater with a grille."""
    d, w, h = size
    case = box((d, w, h - 0.015), 0.03, 3).moved(z=0.015)
    slats = [box((0.008, w * 0.72, 0.007), 0.002).moved(d / 2 - 0.001, 0, z) for z in np.linspace(0.2, 0.62, 9) * h]
    dials = [
        cylinder(0.017, 0.014, 0.003, 18).turned("y", 90).moved(d / 2 - 0.002, s * w * 0.2, h * 0.82) for s in (1, -1)
    ]
    feet = four(cylinder(0.012, 0.018, 0.002, 10).moved(d * 0.35, w * 0.36))
    return of(body, case) + of(m.CHARCOAL, *slats, *dials, *feet)


def panel_heater(size: Size, face: Material) -> Parts:
    """A slim convector on two feet."""
    d, w, h = size
    panel = box((0.05, w, h - 0.08), 0.014, 3).moved(z=0.08)
    slots = [box((0.006, w * 0.8, 0.006), 0.002).moved(0.024, 0, z) for z in (0.14, 0.165, 0.19, h - 0.075, h - 0.05)]
    feet = both_sides(
        box((d, 0.05, 0.02), 0.008, 2).moved(0, w * 0.34), box((0.03, 0.03, 0.09), 0.004).moved(0, w * 0.34)
    )
    return (
        of(face, panel)
        + of(m.GREY, *slots)
        + of(m.BLACK, *feet, box((0.01, 0.07, 0.05), 0.004).moved(0.024, w * 0.38, h - 0.17))
    )


def tower_heater(size: Size, body: Material, face: Material) -> Parts:
    """A slim upright heater on a round foot."""
    d, w, h = size
    column = prism(superellipse(d * 0.72, w * 0.72, 3.2, 32), h - 0.04, 0.02).moved(z=0.035)
    grille = box((0.02, w * 0.44, h * 0.62), 0.008, 2).moved(d * 0.335, 0, h * 0.2)
    slats = [box((0.008, w * 0.4, 0.006), 0.002).moved(d * 0.36, 0, z) for z in np.linspace(0.22, 0.8, 24) * h]
    return (
        of(body, column, lathe([(w * 0.48, 0), (w * 0.5, 0.006), (w * 0.47, 0.025), (w * 0.3, 0.036)], 36))
        + of(face, grille)
        + of(m.GREY, *slats)
    )


DESIGNS: tuple[Design, ...] = (
    design("heater", "oil-white", "white oil-filled radiator on wheels", (0.48, 0.26, 0.62), "modern", oil_heater, body=m.WHITE),
    design("heater", "oil-black", "black oil-filled radiator on wheels", (0.56, 0.26, 0.64), "industrial", oil_heater, body=m.CHARCOAL),
    design("heater", "fan", "small fan heater", (0.15, 0.25, 0.28), "minimal", fan_heater, body=m.WHITE),
    design("heater", "panel", "slim panel heater on feet", (0.22, 0.70, 0.46), "minimal", panel_heater, face=m.WHITE),
    design("heater", "panel-charcoal", "long charcoal panel heater", (0.20, 0.90, 0.42), "modern", panel_heater, face=m.CHARCOAL),
    design("heater", "tower", "upright ceramic heater", (0.22, 0.22, 0.62), "modern", tower_heater, body=m.CHARCOAL, face=GRILLE),
)  # fmt: skip
