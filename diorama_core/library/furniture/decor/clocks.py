"""Clocks on walls, mantels and floors."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def wall_clock(size: Size, rim: Material, face: Material, square: bool = False) -> Parts:
    """A clock with hands."""
    d, w, h = size
    if square:
        parts = of(rim, *frame(d, w, h, 0.02), box((d * 0.6, w - 0.01, h - 0.01), 0.003).moved(-d * 0.2, 0, 0.005))
        return parts + of(face, box((0.004, w - 0.036, h - 0.036), 0.001).pictured().moved(0.2 * d, 0, 0.018))
    r = w / 2
    ring = (
        lathe(
            [(r * 0.9, 0), (r, 0.004), (r, d * 0.8), (r * 0.97, d), (r * 0.9, d * 0.92), (r * 0.88, d * 0.5)],
            48,
            np.deg2rad(45),
        )
        .turned("y", 90)
        .moved(-d / 2, 0, h / 2)
    )
    dial = stand_up(superellipse(2 * r * 0.9, 2 * r * 0.9, 2, 48), d * 0.55).pictured().moved(-d / 2, 0, h / 2)
    return of(rim, ring) + of(face, dial)


def alarm_clock(size: Size, body: Material, face: Material) -> Parts:
    """A twin-bell alarm clock."""
    d, w, h = size
    r = w * 0.46
    can = cylinder(r, d * 0.8, 0.006, 36).turned("y", 90).moved(-d * 0.4, 0, r + 0.012)
    dial = stand_up(superellipse(r * 1.8, r * 1.8, 2, 40), 0.006).pictured().moved(d * 0.4 - 0.002, 0, r + 0.012)
    bells = [
        lathe([(0.02, 0), (r * 0.42, 0.002), (r * 0.38, 0.018), (r * 0.2, 0.028), (0.004, 0.03)], 20, np.pi)
        .turned("x", s * 28)
        .moved(0, -s * r * 0.5, h - 0.045)
        for s in (1, -1)
    ]
    legs = [rod((0, s * r * 0.72, 0.0), (0, s * r * 0.5, r * 0.4), 0.006) for s in (1, -1)]
    return (
        of(body, can, *bells, *legs)
        + of(face, dial)
        + of(m.STEEL, tube(np.array([(0, -0.02, h - 0.02), (0, 0, h - 0.005), (0, 0.02, h - 0.02)]), 0.003, 6))
    )


def mantel_clock(size: Size, wood: Material, face: Material, arched: bool = True) -> Parts:
    """A clock for a shelf: arched, or a tambour between low shoulders."""
    d, w, h = size
    base = box((d, w, 0.03), 0.008, 2)
    if arched:
        t = np.linspace(0, np.pi, 21)
        r = w * 0.4
        o = np.concatenate(
            [np.column_stack([r * np.cos(t), h - 0.03 - r + r * np.sin(t)]), [(-r, 0.0), (r, 0.0)]]
        ) - np.array([0, (h - 0.03) / 2])
        body = stand_up(o, d * 0.8).moved(-d * 0.4, 0, 0.03 + (h - 0.03) / 2)
        radius, z = 0.8 * r, h - r
    else:
        u = np.linspace(-1, 1, 41)
        top = 0.32 + 0.68 * np.exp(-((u / 0.46) ** 4))
        o = np.concatenate(
            [np.column_stack([-u * w * 0.47, top * (h - 0.03)]), [(-w * 0.47, 0.0), (w * 0.47, 0.0)]]
        ) - np.array([0, 0.2 * h])
        body = stand_up(o, d * 0.8).moved(-d * 0.4, 0, 0.03 + 0.2 * h)
        radius, z = 0.36 * h, 0.03 + 0.54 * (h - 0.03)
    rim = (
        lathe([(radius, 0), (radius * 1.08, 0.004), (radius * 1.05, 0.012), (radius * 0.97, 0.012), (radius, 0)], 40)
        .turned("y", 90)
        .moved(d * 0.39, 0, z)
    )
    dial = stand_up(superellipse(2 * radius, 2 * radius, 2, 44), 0.006).pictured().moved(d * 0.396, 0, z)
    return of(wood, base, body) + of(m.BRASS, rim) + of(face, dial)


def grandfather(size: Size, wood: Material, face: Material, plain: bool = False) -> Parts:
    """A longcase clock with its pendulum behind glass."""
    d, w, h = size
    waist = 0.72 * w
    foot, head = 0.24 * h, 0.26 * h
    body_h = h - foot - head
    parts = of(wood, box((d, w, foot), 0.01, 2), box((d * 1.0, w, 0.04), 0.01, 2).moved(z=foot - 0.02))
    t = 0.05
    parts += of(
        wood,
        *both_sides(box((d * 0.82, t, body_h), 0.006).moved(0, (waist - t) / 2, foot)),
        box((0.02, waist, body_h), 0.003).moved(-d * 0.4, 0, foot),
    )
    parts += of(wood, *(box((0.03, waist, 0.06), 0.006).moved(d * 0.395, 0, z) for z in (foot, foot + body_h - 0.06)))
    parts += of(m.GLASS, box((0.004, waist - 2 * t + 0.01, body_h - 0.1), 0.001).moved(d * 0.395, 0, foot + 0.05))
    bob = foot + 0.28 * body_h
    disc = (
        lathe([(0.003, -0.01), (0.055, -0.006), (0.062, 0), (0.055, 0.006), (0.003, 0.01)], 28, np.pi)
        .turned("y", 90)
        .moved(0.05, 0, bob)
    )
    weights = [
        cylinder(0.022, 0.16, 0.006, 20).moved(-0.02, s * 0.08, foot + (0.5 if s > 0 else 0.4) * body_h)
        for s in (1, -1)
    ]
    lines = [rod((0.05, 0, bob), (0.05, 0, foot + body_h), 0.004, segments=6)] + [
        rod((-0.02, s * 0.08, foot + 0.5 * body_h), (-0.02, s * 0.08, foot + body_h), 0.0025, segments=5)
        for s in (1, -1)
    ]
    parts += of(m.BRASS, disc, *weights, *lines)
    z = foot + body_h
    crown = 0.0 if plain else 0.09
    parts += of(
        wood,
        box((d * 0.98, w * 0.96, head - crown), 0.008, 2).moved(0, 0, z),
        box((d, w, 0.035), 0.01, 2).moved(0, 0, z),
    )
    parts += of(wood, box((d, w, 0.03), 0.01, 2).moved(0, 0, z + head - crown - 0.03))
    side = min(w * 0.74, head - crown - 0.09)
    dial = box((0.006, side, side), 0.001).pictured().moved(d * 0.49, 0, z + 0.045)
    trim = [box((0.012, side + 0.03, 0.016), 0.003).moved(d * 0.49, 0, zz) for zz in (z + 0.032, z + 0.045 + side)]
    parts += of(face, dial) + of(m.BRASS, *trim)
    if not plain:
        horns = both_sides(
            prism([(0.0, 0.0), (w * 0.46, 0.0), (w * 0.44, 0.03), (w * 0.2, 0.05), (0.05, crown)], d * 0.2, 0.006)
            .turned("x", 90)
            .turned("z", 90)
            .moved(d * 0.3, 0.0, z + head - crown)
        )
        finial = [
            ball(0.045, 6).moved(d * 0.4, 0, h - 0.06),
            cylinder(0.012, 0.04, 0.003, 12).moved(d * 0.4, 0, h - 0.09),
        ]
        parts += of(wood, *horns) + of(m.BRASS, *finial)
    return parts


def cuckoo(size: Size, wood: Material, face: Material) -> Parts:
    """A little house on the wall with a dial, a door and two weights."""
    d, w, h = size
    low = 0.42 * h
    body = box((d * 0.7, w * 0.7, 0.36 * h), 0.004).moved(-d * 0.15, 0, low)
    eaves = [box((d, w * 0.58, 0.02), 0.005).turned("x", s * 40).moved(0, -s * w * 0.2, h - 0.22 * h) for s in (1, -1)]
    gable = loft(
        np.array(
            [
                [(x, -w * 0.34, low + 0.35 * h), (x, w * 0.34, low + 0.35 * h), (x, 0.0, h - 0.05 * h)]
                for x in (-d * 0.5, d * 0.19)
            ]
        )
    )
    x = d * 0.2
    dial = stand_up(superellipse(0.42 * w, 0.42 * w, 2, 36), 0.008).pictured().moved(x, 0, low + 0.14 * h)
    door = box((0.012, 0.14 * w, 0.1 * h), 0.004).moved(x, 0, low + 0.3 * h)
    leaves = [
        cushion((0.02, 0.2 * w, 0.05 * h), 2, 2, 5).turned("x", a).moved(x, y * w, low + z * h)
        for a, y, z in ((35, -0.3, 0.02), (-35, 0.3, 0.02), (-20, -0.3, 0.3), (20, 0.3, 0.3))
    ]
    chains = [rod((0, s * 0.12 * w, 0.08 * h), (0, s * 0.12 * w, low), 0.003, segments=5) for s in (1, -1)]
    cones = [
        lathe([(0.003, 0), (0.014, 0.012), (0.018, 0.04), (0.012, 0.075), (0.003, 0.085)], 14).moved(
            0, s * 0.12 * w, 0.0 if s > 0 else 0.06 * h
        )
        for s in (1, -1)
    ]
    return (
        of(wood, body, *eaves, gable) + of(face, dial) + of(m.DARK_WALNUT, door, *leaves) + of(m.IRON, *chains, *cones)
    )


def digital(size: Size, body: Material, face: Material) -> Parts:
    """A bedside clock that shows figures."""
    d, w, h = size
    return of(body, box(size, 0.012, 3)) + of(
        face, box((0.004, w - 0.024, h - 0.024), 0.001).pictured().moved(d / 2 - 0.001, 0, 0.012)
    )


def spokes_clock(size: Size, metal: Material, wood: Material) -> Parts:
    """A clock of twelve rods with balls at their ends, no rim."""
    d, w, h = size
    r = w / 2
    rods = [rod((0, 0.2 * r, 0), (0, 0.9 * r, 0), 0.0035, segments=8).turned("x", 30 * k) for k in range(12)]
    balls = [ball(0.14 * r, 6).moved(0, 0.93 * r, -0.07 * r).turned("x", 30 * k) for k in range(12)]
    hub = cylinder(0.22 * r, d * 0.8, 0.006, 36).turned("y", 90).moved(-d / 2)
    hands = [
        box((0.003, 0.02, 0.5 * r), 0.001).moved(d * 0.36, 0, -0.04).turned("x", 60),
        box((0.003, 0.014, 0.72 * r), 0.001).moved(d * 0.44, 0, -0.05).turned("x", -60),
    ]
    return [p.moved(0, 0, h / 2) for p in of(metal, *rods) + of(wood, *balls, hub) + of(m.BLACK, *hands)]


DIAL = m.art("clock dial", "dial", "#f0ece2")


DARK_DIAL = m.art("dark clock dial", "dial", "#2f3235")


ROMAN = m.art("roman dial", "roman dial", "#efe8d8")
DARK_ROMAN = m.art("dark roman dial", "roman dial", "#3a3c3f")
DIGITS = m.Material("clock display", "digits", "#c9d6cf", 0.3, 0.0, 1.0, glow=0.08)


DESIGNS: tuple[Design, ...] = (
    design("clock", "round-black", "round black wall clock", (0.045, 0.32, 0.32), "modern", wall_clock, rim=m.BLACK_STEEL, face=DIAL),
    design("clock", "round-oak", "oak wall clock", (0.05, 0.36, 0.36), "rustic", wall_clock, rim=m.OAK, face=DIAL),
    design("clock", "square-dark", "square clock with a dark dial", (0.04, 0.30, 0.30), "minimal", wall_clock, rim=m.STEEL, face=DARK_DIAL, square=True),
    design("clock", "alarm", "twin-bell alarm clock", (0.06, 0.12, 0.16), "classic", alarm_clock, body=m.SAGE, face=DIAL),
    design("clock", "station", "large station clock", (0.06, 0.60, 0.60), "industrial", wall_clock, rim=m.BLACK_STEEL, face=ROMAN),
    design("clock", "roman-dark", "dark clock with roman figures", (0.05, 0.45, 0.45), "industrial", wall_clock, rim=m.IRON, face=DARK_ROMAN),
    design("clock", "brass", "brass wall clock with roman figures", (0.05, 0.38, 0.38), "classic", wall_clock, rim=m.BRASS, face=ROMAN),
    design("clock", "white", "plain white wall clock", (0.04, 0.28, 0.28), "minimal", wall_clock, rim=m.WHITE, face=DIAL),
    design("clock", "spokes", "clock of rods and oak balls", (0.06, 0.55, 0.55), "modern", spokes_clock, metal=m.BRASS, wood=m.OAK),
    design("clock", "cuckoo", "cuckoo clock", (0.16, 0.30, 0.50), "rustic", cuckoo, wood=m.WALNUT, face=DIAL),
    design("clock", "alarm-brass", "brass alarm clock", (0.06, 0.11, 0.15), "classic", alarm_clock, body=m.BRASS, face=ROMAN),
    design("mantel clock", "arched", "arched walnut mantel clock", (0.13, 0.22, 0.30), "classic", mantel_clock, wood=m.WALNUT, face=ROMAN),
    design("mantel clock", "tambour", "tambour mantel clock", (0.13, 0.46, 0.22), "classic", mantel_clock, wood=m.MAHOGANY, face=DIAL, arched=False),
    design("mantel clock", "oak", "plain oak table clock", (0.10, 0.20, 0.24), "minimal", mantel_clock, wood=m.LIGHT_OAK, face=DIAL),
    design("mantel clock", "digital", "digital bedside clock", (0.07, 0.17, 0.075), "modern", digital, body=m.BLACK, face=DIGITS),
    design("mantel clock", "digital-wood", "wooden digital clock", (0.06, 0.20, 0.08), "minimal", digital, body=m.BIRCH, face=DIGITS),
    design("grandfather clock", "mahogany", "mahogany longcase clock", (0.28, 0.52, 2.05), "classic", grandfather, wood=m.MAHOGANY, face=ROMAN),
    design("grandfather clock", "oak", "oak longcase clock", (0.26, 0.46, 1.90), "rustic", grandfather, wood=m.OAK, face=ROMAN),
    design("grandfather clock", "black", "plain black longcase clock", (0.24, 0.40, 1.80), "minimal", grandfather, wood=m.BLACK_WOOD, face=DARK_DIAL, plain=True),
)  # fmt: skip
