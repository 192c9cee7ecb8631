"""Coffee machines and coffee pots."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *

CREAM_ENAMEL = m.paint("cream enamel", "#e2d8c3", 0.25)


RED_ENAMEL = m.paint("brick red enamel", "#99594d", 0.25)


COFFEE = m.glass("brewed coffee", "#35241b", 0.94)


def drip_machine(size: Size, body: Material, trim: Material) -> Parts:
    """A filter coffee machine with its glass pot, open toward +X."""
    d, w, h = size
    foot = box((d, w, 0.05), 0.016, 3)
    tower = box((d * 0.36, w, h - 0.01), 0.02, 3).moved(-d * 0.32)
    head = box((d * 0.96, w, h * 0.3), 0.024, 3).moved(-d * 0.02, 0, h * 0.7)
    cone = lathe([(0.028, 0.56 * h), (0.3 * w, 0.71 * h)], 28).moved(d * 0.14)
    plate = cylinder(0.34 * w, 0.006, 0.002, 32).moved(d * 0.14, 0, 0.048)
    r, z, tall = 0.31 * w, 0.055, 0.44 * h
    pot = hollow(((0.85, 0), (0.95, 0.04), (1.0, 0.4), (0.8, 0.85), (0.82, 1.0)), r, tall, 0.003, 0.004, 32)
    drink = lathe(
        [(0.8 * r, 0.008), (0.88 * r, 0.1 * tall), (0.88 * r, 0.5 * tall), (0.003, 0.5 * tall)], 28, np.deg2rad(60)
    )
    ear = tube(
        bend(
            [
                (0, r * 0.8, tall * 0.92),
                (0, r * 1.3, tall * 0.9),
                (0, r * 1.35, tall * 0.45),
                (0, r * 0.98, tall * 0.3),
            ],
            5,
        ),
        0.008,
        8,
    ).turned("z", -55)
    lid = cylinder(0.82 * r, 0.016, 0.005, 28).moved(z=tall)
    screen = box((0.004, 0.07, 0.03), 0.001).moved(d * 0.462, 0.05 * w, h * 0.86)
    knob = cylinder(0.016, 0.012, 0.003, 18).turned("y", 90).moved(d * 0.46, -0.28 * w, h * 0.875)
    jug = shifted(of(m.GLASS, pot) + of(COFFEE, drink) + of(m.BLACK, ear, lid), d * 0.14, 0, z)
    return of(body, foot, tower, head) + of(trim, cone, plate, knob) + of(m.SCREEN, screen) + jug


def espresso_machine(size: Size, body: Material, trim: Material) -> Parts:
    """A pump machine: group, portafilter, steam wand, drip tray."""
    d, w, h = size
    case = box((d * 0.52, w, h - 0.03), 0.014, 3).moved(-d * 0.24, 0, 0.015)
    head = box((d * 0.8, w, h * 0.28), 0.018, 3).moved(-d * 0.08, 0, h * 0.7)
    tray = box((d * 0.72, w * 0.96, 0.055), 0.012, 2).moved(d * 0.13, 0, 0.012)
    grid = [box((d * 0.3, 0.006, 0.006), 0.002).moved(d * 0.26, y, 0.064) for y in np.linspace(-0.4, 0.4, 13) * w]
    x = d * 0.2
    group = [
        cylinder(0.034, 0.05, 0.005, 28).moved(x, 0, h * 0.66),
        cylinder(0.038, 0.028, 0.005, 28).moved(x, 0, h * 0.6),
        cylinder(0.01, 0.035, 0.003, 14).moved(x, 0, h * 0.55),
    ]
    lever = rod((x + 0.03, 0, h * 0.625), (d / 2 - 0.01, 0, h * 0.6), 0.011, 0.014, 12)
    wand = tube(
        bend([(x - 0.02, -w * 0.38, h * 0.7), (x + 0.03, -w * 0.4, h * 0.62), (x + 0.05, -w * 0.41, h * 0.3)], 5),
        0.005,
        8,
    )
    dial = cylinder(0.028, 0.014, 0.004, 24).turned("y", 90).moved(d * 0.315, 0.0, h * 0.83)
    buttons = [
        cylinder(0.014, 0.01, 0.003, 18).turned("y", 90).moved(d * 0.315, y * w, h * 0.83) for y in (0.34, 0.22, -0.3)
    ]
    rails = [
        tube(ring_path(rounded_rectangle(d * 0.62, w * 0.92, 0.03, 4), h - 0.002), 0.004, 6, closed=True).moved(
            -d * 0.1
        )
    ]
    feet = four(cylinder(0.014, 0.02, 0.002, 12).moved(d * 0.36, w * 0.4))
    return (
        of(body, case, head, tray)
        + of(trim, *grid, *group, wand, *rails, *buttons)
        + of(m.BLACK, lever, *feet)
        + of(m.PORCELAIN, dial)
    )


def moka_pot(size: Size, body: Material) -> Parts:
    """An eight-sided stove-top pot."""
    d, w, h = size
    x = d / 2 - w / 2
    r = w / 2 * 0.92
    lower = lathe([(0.96 * r, 0), (r, 0.004), (0.84 * r, 0.44 * h), (0.7 * r, 0.46 * h)], 8, 0.1)
    upper = lathe(
        [(0.68 * r, 0.46 * h), (0.66 * r, 0.5 * h), (0.92 * r, 0.86 * h), (0.5 * r, 0.93 * h), (0.12 * r, 0.96 * h)],
        8,
        0.1,
    )
    ring = lathe([(0.72 * r, 0.44 * h), (0.8 * r, 0.45 * h), (0.8 * r, 0.48 * h), (0.7 * r, 0.49 * h)], 32)
    beak = loft(
        np.array(
            [
                ring_path(superellipse(0.03 * s, 0.03 * s, 2, 10)) + np.array([x + r * o, 0, h * z])
                for s, o, z in ((0.1, 0.66, 0.62), (0.8, 0.78, 0.78), (1.0, 0.98, 0.86))
            ]
        )
    )
    handle = [
        rod((x - 0.8 * r, 0, 0.82 * h), (x - 1.45 * r, 0, 0.84 * h), 0.006),
        rod((x - 1.45 * r, 0, 0.86 * h), (-d / 2 + 0.014, 0, 0.5 * h), 0.008, 0.012),
    ]
    return of(body, lower.moved(x), upper.moved(x), ring.moved(x), beak) + of(
        m.BLACK, *handle, cylinder(0.12 * r, 0.05 * h, 0.003, 12).moved(x, 0, 0.95 * h)
    )


def capsule_machine(size: Size, body: Material, trim: Material) -> Parts:
    """A small capsule machine with a tank behind it."""
    d, w, h = size
    column = prism(superellipse(d * 0.42, w * 0.92, 3, 36), h * 0.94, 0.02).moved(-d * 0.08)
    nose = prism(superellipse(d * 0.62, w * 0.72, 2.6, 36), h * 0.3, 0.02).moved(d * 0.08, 0, h * 0.62)
    tank = prism(superellipse(d * 0.3, w * 0.86, 3, 32), h * 0.82, 0.01).moved(-d * 0.34, 0, 0.02)
    tray = prism(superellipse(d * 0.5, w * 0.74, 2.6, 36), 0.03, 0.008).moved(d * 0.24)
    lever = tube(
        bend(
            [
                (d * 0.0, w * 0.3, h * 0.93),
                (d * 0.24, w * 0.27, h * 0.985),
                (d * 0.34, 0, h * 0.985),
                (d * 0.24, -w * 0.27, h * 0.985),
                (d * 0.0, -w * 0.3, h * 0.93),
            ],
            4,
        ),
        0.007,
        8,
    )
    tip = cylinder(0.014, 0.04, 0.004, 16).moved(d * 0.24, 0, h * 0.585)
    return (
        of(body, column, nose)
        + of(m.GLASS, tank)
        + of(trim, tray, lever, tip, cylinder(0.3 * w, 0.004, 0.001, 28).moved(d * 0.26, 0, 0.03))
    )


def french_press(size: Size, metal: Material) -> Parts:
    """A glass press pot in a metal frame."""
    d, w, h = size
    x = d / 2 - w / 2
    r, tall = w / 2 * 0.9, h * 0.76
    beaker = hollow(((0.96, 0), (1.0, 0.02), (1.0, 0.96), (1.03, 1.0)), r * 0.95, tall, 0.0025, 0.004, 32).moved(
        x, 0, 0.01
    )
    drink = cylinder(r * 0.87, tall * 0.6, 0.003, 28).moved(x, 0, 0.014)
    bands = [
        lathe([(r * 0.955, z), (r, z), (r, z + 0.012), (r * 0.955, z + 0.012), (r * 0.955, z)], 36).moved(x)
        for z in (0.016, tall * 0.62)
    ]
    stays = [
        rod(
            (x + r * 0.985 * np.cos(a), r * 0.985 * np.sin(a), 0.0),
            (x + r * 0.985 * np.cos(a), r * 0.985 * np.sin(a), tall * 0.72),
            0.003,
            segments=6,
        )
        for a in np.deg2rad((45, 135, 225, 315))
    ]
    lid = lathe(
        [
            (r * 1.0, tall + 0.006),
            (r * 1.02, tall + 0.014),
            (r * 0.8, tall + 0.028),
            (0.3 * r, tall + 0.036),
            (0.003, tall + 0.037),
        ],
        36,
        np.deg2rad(50),
    ).moved(x)
    plunger = [
        cylinder(0.003, h - tall - 0.05, 0.0008, 8).moved(x, 0, tall + 0.034),
        ball(0.026, 6).moved(x, 0, h - 0.026),
        cylinder(r * 0.86, 0.008, 0.002, 28).moved(x, 0, tall * 0.62),
    ]
    ear = tube(
        bend(
            [
                (x - r, 0, tall * 0.64),
                (x - 1.5 * r, 0, tall * 0.72),
                (x - 1.6 * r, 0, tall * 0.3),
                (x - r, 0, tall * 0.06),
            ],
            5,
        ),
        0.007,
        8,
    )
    return (
        of(m.GLASS, beaker)
        + of(COFFEE, drink)
        + of(metal, *bands, *stays, lid, *plunger)
        + of(m.BLACK, ear.scaled(y=1.4))
    )


DESIGNS: tuple[Design, ...] = (
    design("coffee machine", "drip", "black filter coffee machine", (0.27, 0.20, 0.34), "modern", drip_machine, body=m.BLACK, trim=m.STEEL),
    design("coffee machine", "drip-cream", "cream filter coffee machine", (0.26, 0.19, 0.33), "classic", drip_machine, body=CREAM_ENAMEL, trim=m.CHROME),
    design("coffee machine", "espresso", "steel espresso machine", (0.36, 0.30, 0.36), "industrial", espresso_machine, body=m.STAINLESS, trim=m.CHROME),
    design("coffee machine", "capsule", "white capsule coffee machine", (0.33, 0.14, 0.27), "minimal", capsule_machine, body=m.WHITE, trim=m.STEEL),
    design("coffee machine", "capsule-red", "red capsule coffee machine", (0.32, 0.13, 0.25), "modern", capsule_machine, body=RED_ENAMEL, trim=m.CHROME),
    design("coffee machine", "moka", "aluminium stove-top coffee pot", (0.16, 0.10, 0.19), "classic", moka_pot, body=m.STEEL),
    design("coffee machine", "press", "glass coffee press", (0.17, 0.11, 0.24), "rustic", french_press, metal=m.COPPER),
)  # fmt: skip
