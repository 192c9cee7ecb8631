"""Televisions and monitors."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def panel(w: float, h: float, t: float, bezel: float, body: Material, chin: float = 0.0) -> Parts:
    """A flat screen standing on z = 0, its glass on the plane x = 0, facing +X."""
    glass = box((0.004, w - 2 * bezel, h - 2 * bezel - chin), 0.001).pictured().moved(-0.0015, 0, bezel + chin)
    shell = box((t, w, h), 0.005, 2).moved(-t / 2 - 0.001)
    hump = box((t, w * 0.62, h * 0.5), 0.012, 2).moved(-1.3 * t, 0, h * 0.12)
    return of(body, shell, hump) + of(m.SCREEN, glass)


def television(size: Size, body: Material, stand: str) -> Parts:
    """`stand`: "feet", "plate", or "wall" (none)."""
    d, w, h = size
    if stand == "wall":
        return panel(w, h, d * 0.5, 0.01, body)
    lift = 0.07 if stand == "feet" else 0.09
    parts = [p.moved(0.02, 0, lift) for p in panel(w, h - lift, 0.035, 0.01, body, 0.01)]
    if stand == "feet":
        foot = [
            rod((d / 2 - 0.008, w * 0.37, 0.008), (0.0, w * 0.35, lift + 0.015), 0.008),
            rod((-d / 2 + 0.008, w * 0.37, 0.008), (-0.0, w * 0.35, lift + 0.015), 0.008),
        ]
        return parts + of(body, *both_sides(*foot))
    plate = prism(rounded_rectangle(d, w * 0.42, 0.03), 0.012, 0.004)
    return parts + of(body, plate, box((0.03, w * 0.1, lift + 0.1), 0.006).moved(-0.015, 0, 0.008))


def tube_television(size: Size, body: Material) -> Parts:
    """An old deep television with a bulging screen and knobs."""
    d, w, h = size
    case = taper((0, 0, 0), (0, 0, d - 0.05), 0.62, 1.0, 0.05).scaled(h, w, 1.0).turned("y", 90).moved(-d / 2, 0, h / 2)
    front = box((0.06, w, h), 0.02, 2).moved(d / 2 - 0.04)
    gw, gh, gy = w * 0.72, h * 0.8, w * 0.1
    v, u = np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 9), indexing="ij")
    bulge = np.stack([0.03 * (1 - (u**2 + v**2) / 2) + d / 2 - 0.018, -u * gw / 2 + gy, v * gh / 2 + h / 2], axis=-1)
    glass = slab(bulge, 0.012).pictured()
    knobs = [
        cylinder(0.022, 0.02, 0.004, 18).turned("y", 90).moved(d / 2 - 0.012, -w * 0.39, h * f) for f in (0.78, 0.62)
    ]
    grille = [
        box((0.008, w * 0.13, 0.006), 0.002).moved(d / 2 - 0.009, -w * 0.39, h * f) for f in np.linspace(0.14, 0.46, 9)
    ]
    return of(body, case, front) + of(m.SCREEN, glass) + of(m.BLACK, *knobs, *grille)


def monitor(size: Size, body: Material, stand: str = "arm", curved: bool = False) -> Parts:
    """`stand`: "arm" (a neck on a plate) or "ring"."""
    d, w, h = size
    z0 = 0.13
    parts = [p.moved(0.03, 0, z0) for p in panel(w, h - z0, 0.022, 0.009, body, 0.008 if curved else 0.016)]
    neck = box((0.022, 0.075, h * 0.55), 0.008, 2).turned("y", 5).moved(-0.055, 0, 0.006)
    if stand == "ring":
        return parts + of(
            m.STEEL,
            box((d * 0.9, 0.2, 0.009), 0.003, 2),
            box((0.012, 0.16, h * 0.6), 0.004).turned("y", 6).moved(-0.07, 0, 0.004),
        )
    foot = prism(rounded_rectangle(d * 0.96, min(0.26, w * 0.5), 0.04), 0.012, 0.004)
    return parts + of(body, neck, foot, box((0.04, 0.09, 0.09), 0.01).moved(-0.03, 0, h * 0.5))


def framed_television(size: Size, wood: Material, image: Material) -> Parts:
    """A television that hangs like a picture and shows one."""
    d, w, h = size
    bar = 0.018
    rails = [box((d, w, bar), 0.003).moved(0, 0, z) for z in (0.0, h - bar)]
    stiles = [box((d, bar, h), 0.003).moved(0, s * (w - bar) / 2) for s in (1, -1)]
    face = box((0.004, w - 2 * bar + 0.002, h - 2 * bar + 0.002), 0.001).pictured().moved(d * 0.24, 0, bar - 0.001)
    return (
        of(wood, *rails, *stiles)
        + of(image, face)
        + of(m.BLACK, box((d * 0.6, w - 0.02, h - 0.02), 0.004).moved(-d * 0.18, 0, 0.01))
    )


def easel_television(size: Size, wood: Material) -> Parts:
    """A television on a tripod of turned legs."""
    d, w, h = size
    low = h - 0.62 * w
    parts = [p.moved(d * 0.14, 0, low) for p in panel(w, h - low, 0.03, 0.012, m.CHARCOAL)]
    legs = [rod((d / 2 - 0.02, s * 0.3 * w, 0.0), (d * 0.06, s * 0.08 * w, low + 0.2), 0.014, 0.018) for s in (1, -1)]
    legs.append(rod((-d / 2 + 0.014, 0, 0.0), (d * 0.02, 0, low + 0.2), 0.014, 0.018))
    return parts + of(wood, *legs) + of(m.BRASS, box((0.02, 0.24 * w, 0.02), 0.004).moved(d * 0.07, 0, low + 0.02))


def portable_television(size: Size, body: Material) -> Parts:
    """A rounded portable with rabbit ears."""
    d, w, h = size
    top = h * 0.72
    case = cushion((d, w, top), 4.5, 4.5, 12)
    gw, gh = w * 0.5, top * 0.62
    v, u = np.meshgrid(np.linspace(-1, 1, 7), np.linspace(-1, 1, 7), indexing="ij")
    bulge = np.stack(
        [0.014 * (1 - (u**2 + v**2) / 2) + d / 2 - 0.004, -u * gw / 2 + 0.08 * w, v * gh / 2 + top / 2], axis=-1
    )
    knobs = [
        cylinder(0.02, 0.022, 0.004, 18).turned("y", 90).moved(d / 2 - 0.026, -0.34 * w, top * f) for f in (0.68, 0.46)
    ]
    ears = [rod((0, 0.02 * s, top - 0.01), (0, s * w * 0.42, h - 0.006), 0.0022, 0.0014, 6) for s in (1, -1)]
    return (
        of(body, case)
        + of(m.SCREEN, slab(bulge, 0.01).pictured())
        + of(m.STEEL, *ears, *knobs, cylinder(0.03, 0.016, 0.005, 20).moved(z=top - 0.008))
    )


def curved_monitor(size: Size, body: Material) -> Parts:
    """A wide curved screen on a foot of three legs."""
    d, w, h = size
    low, tall = 0.28 * h, 0.72 * h
    t = np.linspace(-1, 1, 15)
    radius = 1.4 * w
    back = (1 - np.cos(t * w / 2 / radius)) * radius
    rows = np.array(
        [np.stack([back + d * 0.05, radius * np.sin(t * w / 2 / radius), np.full_like(t, z)], axis=1) for z in (low, h)]
    )
    face = rows.copy()
    face[:, :, 0] += 0.014
    face[0, :, 2] += 0.012
    face[1, :, 2] -= 0.009
    face[:, :, 1] *= 0.985
    skin = slab(rows[:, ::-1], 0.022)
    hub, tips = (-0.01, 0, 0.01), [(d / 2 - 0.01, s * 0.26 * w, 0.007) for s in (1, -1)]
    legs = [lowered(rod(hub, tip, 0.01, 0.007)) for tip in (*tips, (-d / 2 + 0.03, 0, 0.007))]
    return of(body, skin, *legs, box((0.024, 0.06, low + 0.4 * tall), 0.008, 2).moved(-0.01, 0, 0.01)) + of(
        m.SCREEN, slab(face[:, ::-1], 0.002).pictured()
    )


ART_SCREEN = Material("lit art screen", "sun", "#6d7f83", 0.3, 0.0, 1.0, glow=0.05)


DESIGNS: tuple[Design, ...] = (
    design("television", "feet", "flat television on two feet", (0.24, 1.23, 0.77), "modern", television, body=m.BLACK, stand="feet"),
    design("television", "plate", "small flat television on a plate", (0.22, 0.74, 0.50), "minimal", television, body=m.BLACK, stand="plate"),
    design("television", "large", "large wall-mounted television", (0.06, 1.45, 0.83), "modern", television, body=m.BLACK, stand="wall"),
    design("television", "silver", "silver-framed television on a plate", (0.26, 0.96, 0.64), "minimal", television, body=m.STEEL, stand="plate"),
    design("television", "tube", "old television in a walnut case", (0.44, 0.62, 0.48), "classic", tube_television, body=m.WALNUT),
    design("monitor", "black", "black computer monitor", (0.20, 0.54, 0.45), "modern", monitor, body=m.BLACK),
    design("monitor", "white", "white all-in-one monitor", (0.19, 0.55, 0.46), "minimal", monitor, body=m.WHITE, stand="ring"),
    design("monitor", "wide", "wide computer monitor", (0.24, 0.81, 0.46), "modern", monitor, body=m.CHARCOAL, curved=True),
    design("monitor", "small", "small square monitor", (0.19, 0.38, 0.40), "classic", monitor, body=m.GREY),
    design("television", "framed", "television framed in oak showing a picture", (0.035, 1.24, 0.71), "minimal", framed_television, wood=m.OAK, image=ART_SCREEN),
    design("television", "easel", "television on a walnut easel", (0.62, 1.12, 1.35), "modern", easel_television, wood=m.WALNUT),
    design("television", "portable", "cream portable television with an aerial", (0.34, 0.44, 0.50), "rustic", portable_television, body=m.CREAM),
    design("television", "studio", "grey studio television with a steel stand", (0.24, 0.84, 0.56), "industrial", television, body=m.GREY, stand="plate"),
    design("monitor", "curved", "curved black monitor", (0.26, 0.80, 0.45), "industrial", curved_monitor, body=m.BLACK),
)  # fmt: skip
