"""Telephones, routers, remote controls and game consoles."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *

BAKELITE = m.paint("black bakelite", "#232223", 0.22)
TEAL = m.paint("sea-green plastic", "#7c9a94", 0.4)


def handset(w: float, body: Material) -> Parts:
    """A receiver along y with its cups downward, resting on z = 0."""
    bar = tube(
        bend([(0, -w * 0.42, 0.03), (0, -w * 0.2, 0.052), (0, w * 0.2, 0.052), (0, w * 0.42, 0.03)], 6), 0.013, 10
    )
    cups = both_sides(cylinder(0.032, 0.034, 0.008, 24, top=0.022).moved(0, w * 0.43))
    return of(body, bar, *cups)


def rotary_telephone(size: Size, body: Material, metal: Material) -> Parts:
    """A dial telephone with its receiver on the cradle."""
    d, w, h = size
    top = h - 0.068
    rings = [
        ring_path(rounded_rectangle(d * a, w * 0.82 * b, 0.04, 5), z) + np.array([x, 0, 0])
        for a, b, z, x in (
            (1.0, 1.0, 0.008, 0),
            (1.0, 1.0, 0.02, 0),
            (0.72, 0.7, 0.6 * top, -0.1 * d),
            (0.5, 0.62, top, -0.18 * d),
        )
    ]
    shell = loft(np.array(rings), crease_rad=np.deg2rad(60))
    slope = float(np.rad2deg(np.arctan2(0.27 * d, 0.6 * top)))
    dial = [cylinder(0.042, 0.008, 0.003, 32), cylinder(0.02, 0.012, 0.002, 24)]
    holes = [
        cylinder(0.0055, 0.0016, 0.0004, 12).moved(0.031 * np.cos(a), 0.031 * np.sin(a), 0.0075)
        for a in np.deg2rad(np.arange(10) * 29 + 20)
    ]
    spot = (0.335 * d, 0.0, 0.43 * top)
    tilt = 90 - slope * 1.15
    cradle = [box((0.05, 0.022, 0.03), 0.007, 2).moved(-0.18 * d, s * w * 0.22, top - 0.004) for s in (1, -1)]
    return (
        of(body, shell, *cradle)
        + of(metal, *(s.turned("y", tilt).moved(*spot) for s in dial))
        + of(m.WHITE, *(s.turned("y", tilt).moved(*spot) for s in holes))
        + shifted(handset(w, body), -0.18 * d, 0, top)
    )


def desk_telephone(size: Size, body: Material, trim: Material) -> Parts:
    """An office telephone with keys and a display."""
    d, w, h = size
    tilt = 9.0
    rings = [
        ring_path(rounded_rectangle(d * a, w * a, 0.02, 4), z)
        for a, z in ((0.98, 0.0), (1.0, 0.006), (0.97, h * 0.3), (0.95, h * 0.34))
    ]
    for ring in rings[2:]:
        ring[:, 2] -= ring[:, 0] * np.tan(np.deg2rad(tilt))  # the top slopes, the foot is level
    drop = d / 2 * np.sin(np.deg2rad(tilt))
    wedge = loft(np.array([*rings[:2], *(ring + np.array([0.0, 0.0, drop]) for ring in rings[2:])]))
    digits = [(0.05 - 0.024 * r, 0.0) for r in range(4)]
    field = keypad(box((0.016, 0.02, 0.006), 0.002), digits, spread(3, -0.028, -0.048))
    field += keypad(box((0.01, 0.026, 0.005), 0.002), [(0.045 - 0.018 * r, 0.0) for r in range(4)], [-0.1])
    screen = box((0.035, 0.1, 0.004), 0.001).moved(-0.065, -0.05, 0)
    parts = of(trim, *(s.moved(0, 0, h * 0.33).turned("y", tilt) for s in field)) + of(
        m.SCREEN, screen.moved(0, 0, h * 0.33).turned("y", tilt)
    )
    receiver = [p.turned("z", 90).moved(0, w * 0.32, h * 0.34).turned("y", tilt) for p in handset(d * 0.98, body)]
    return of(body, wedge) + [p.moved(z=drop) for p in parts + receiver]


def cordless(size: Size, body: Material, trim: Material) -> Parts:
    """A cordless handset upright in its charger."""
    d, w, h = size
    base = lathe([(w * 0.48, 0), (w * 0.5, 0.006), (w * 0.42, 0.022), (w * 0.3, 0.03)], 32).scaled(x=d / w)
    phone = prism(rounded_rectangle(0.026, 0.048, 0.012, 5), h - 0.012, 0.008).turned("y", -7).moved(0.006, 0, 0.01)
    rows = [(0.0195, h * (0.28 + 0.075 * r)) for r in range(4)]
    keys = keypad(box((0.003, 0.009, 0.007), 0.001), rows, spread(3, 0.0125))
    screen = box((0.003, 0.034, 0.03), 0.001).moved(0.0195, 0, h * 0.64)
    return of(body, base, phone) + of(trim, *(k.turned("y", -7) for k in keys)) + of(m.SCREEN, screen.turned("y", -7))


def candlestick_phone(size: Size, metal: Material) -> Parts:
    """A telephone of the twenties: a column, its receiver on a hook."""
    d, _, h = size
    column = lathe(
        [
            (0.5 * d, 0),
            (0.5 * d, 0.008),
            (0.42 * d, 0.02),
            (0.12 * d, 0.045),
            (0.1 * d, 0.08),
            (0.09 * d, 0.8 * h),
            (0.13 * d, 0.86 * h),
            (0.08 * d, 0.9 * h),
        ],
        30,
    )
    mouth = (
        lathe([(0.012, 0), (0.014, 0.03), (0.034, 0.062), (0.031, 0.062), (0.012, 0.034)], 24)
        .turned("y", 74)
        .moved(0.01, 0, 0.9 * h)
    )
    fork = tube(bend([(0, 0, 0.72 * h), (0, 0.04, 0.72 * h), (0, 0.07, 0.75 * h)], 4), 0.0045, 8)
    ear = lathe([(0.028, 0), (0.026, 0.012), (0.013, 0.03), (0.012, 0.11), (0.017, 0.118), (0.003, 0.12)], 22).moved(
        0, 0.078, 0.42 * h
    )
    return of(BAKELITE, mouth, ear) + of(metal, column, fork, ball(0.04, 7).moved(0, 0, 0.87 * h))


def router(size: Size, body: Material, aerials: int, upright: bool = False) -> Parts:
    """A wireless router with aerials, or one that stands on its edge."""
    d, w, h = size
    if upright:
        case = prism(superellipse(d * 0.52, w, 3.4, 32), h - 0.012, 0.012).moved(z=0.012)
        lights = [
            cylinder(0.003, 0.003, 0.0006, 8).turned("y", 90).moved(d * 0.258, 0, h * f)
            for f in (0.4, 0.46, 0.52, 0.58)
        ]
        return of(body, case, prism(superellipse(d, w * 0.8, 2.4, 32), 0.014, 0.004)) + of(m.LAMP_GLOW, *lights)
    low = 0.03
    case = prism(rounded_rectangle(d, w, 0.03, 5), low, 0.01)
    vents = [
        box((d * 0.5, 0.004, 0.002), 0.0006).moved(0.02, float(y), low - 0.0008) for y in np.linspace(-0.3, 0.3, 12) * w
    ]
    lights = [
        box((0.002, 0.008, 0.003), 0.0005).moved(d / 2 - 0.0008, -0.1 * w + 0.02 * k, low * 0.55) for k in range(5)
    ]
    rods = [
        rod((-d * 0.44, y, low * 0.6), (-d * 0.44, y * 1.12, h - 0.004), 0.0075, 0.0055, 10)
        for y in np.linspace(-0.42, 0.42, aerials) * w
    ]
    return of(body, case, *rods) + of(m.CHARCOAL, *vents) + of(m.LAMP_GLOW, *lights)


def mesh_router(size: Size, body: Material) -> Parts:
    """A round mesh access point."""
    d, _, h = size
    r = d / 2
    return of(
        body,
        lathe(
            [(0.86 * r, 0), (0.95 * r, 0.006), (r, 0.3 * h), (0.9 * r, 0.8 * h), (0.6 * r, 0.97 * h), (0.003, h)],
            40,
            np.pi,
        ),
    ) + of(m.LAMP_GLOW, cylinder(0.005, 0.002, 0.0005, 12).moved(r * 0.3, 0, h * 0.985))


def remote(size: Size, body: Material, keys: Material, sparse: bool = False) -> Parts:
    """A remote control lying flat, pointing toward -X."""
    d, w, h = size
    parts = of(body, prism(rounded_rectangle(d, w, w * (0.42 if sparse else 0.2), 5), h - 0.002, 0.004))
    z = h - 0.0035
    if sparse:
        ring = lathe([(0.26 * w, 0), (0.38 * w, 0), (0.38 * w, 0.0025), (0.26 * w, 0.0025), (0.26 * w, 0)], 28).moved(
            -d * 0.26, 0, z
        )
        dots = [
            cylinder(0.1 * w, 0.0032, 0.001, 16).moved(x * d, y * w, z)
            for x, y in ((-0.26, 0), (-0.42, 0), (-0.06, 0.2), (-0.06, -0.2), (0.06, 0.2), (0.06, -0.2))
        ]
        return parts + of(keys, ring, *dots)
    across = spread(3, w * 0.27)
    rows = [(d * (0.02 + 0.065 * r), z) for r in range(6)]
    solids = [
        *keypad(box((d * 0.036, w * 0.19, 0.0034), 0.001), rows, across),
        cylinder(0.24 * w, 0.0034, 0.001, 24).moved(-d * 0.16, 0, z),
        *keypad(box((d * 0.03, w * 0.16, 0.0034), 0.001), [(-d * 0.36, z)], across),
    ]
    return parts + of(keys, *solids) + of(RED_KEY, cylinder(0.1 * w, 0.0036, 0.001, 16).moved(-d * 0.44, w * 0.3, z))


RED_KEY = m.paint("red key", "#9a4d46", 0.5)


def console(size: Size, body: Material, trim: Material, upright: bool) -> Parts:
    """A game console, upright between two curved wings, or a flat box."""
    d, w, h = size
    if upright:
        core = box((d * 0.9, w * 0.5, h * 0.94), 0.012, 2).moved(0, 0, 0.016)
        v, u = np.meshgrid(np.linspace(0, 1, 9), np.linspace(-0.5, 0.5, 9), indexing="ij")
        wing = np.stack([u * d, w * (0.3 + 0.18 * (2 * np.abs(u)) ** 2 * (0.4 + v)), 0.012 + v * (h - 0.012)], axis=-1)
        sides = slab(wing, 0.008)
        return of(trim, core, prism(superellipse(d * 0.6, w, 2, 36), 0.016, 0.005)) + of(body, *both_sides(sides))
    slot = box((0.006, w * 0.4, 0.006), 0.002).moved(d / 2 - 0.001, -w * 0.18, h * 0.62)
    return of(body, box((d, w, h - 0.008), 0.008, 2).moved(z=0.008)) + of(
        trim,
        slot,
        box((d * 1.001, w * 1.001, 0.004), 0.001).moved(z=h * 0.45),
        *four(cylinder(0.014, 0.01, 0.002, 12).moved(d * 0.36, w * 0.4)),
    )


def gamepad(size: Size, body: Material, trim: Material) -> Parts:
    """A controller with two sticks; its player sits at +X."""
    d, w, h = size
    z = h * 0.42
    middle = cushion((d * 0.62, w * 0.66, h * 0.56), 3.2, 2.8, 9).moved(-d * 0.14, 0, z - h * 0.16)
    grips = both_sides(
        cushion((d * 0.86, w * 0.27, h * 0.6), 2.3, 2.3, 8)
        .turned("z", 16)
        .turned("y", 8)
        .moved(0.04 * d, w * 0.33, h * 0.06)
    )
    sticks = [
        cylinder(0.011, 0.02, 0.004, 18, top=0.013).moved(x, y, h * 0.74)
        for x, y in ((d * 0.02, w * 0.13), (d * 0.02, -w * 0.13))
    ]
    face = [
        cylinder(0.006, 0.008, 0.002, 14).moved(-d * 0.2 + a, -w * 0.3 + b, h * 0.72)
        for a, b in ((0.013, 0), (-0.013, 0), (0, 0.013), (0, -0.013))
    ]
    cross = [box(s, 0.002).moved(-d * 0.2, w * 0.3, h * 0.72) for s in ((0.028, 0.009, 0.007), (0.009, 0.028, 0.007))]
    return of(body, middle, *grips) + of(
        trim, *sticks, *face, *cross, box((d * 0.2, w * 0.24, 0.004), 0.0015).moved(-d * 0.2, 0, h * 0.79)
    )


def handheld(size: Size, body: Material) -> Parts:
    """A console to hold, its screen upward."""
    d, w, h = size
    plate = prism(rounded_rectangle(d, w, 0.03, 6), h - 0.006, 0.005)
    screen = box((d * 0.82, w * 0.6, 0.001), 0.0004).moved(0, 0, h - 0.0065)
    sticks = [cylinder(0.008, 0.008, 0.002, 16).moved(x * d, y * w, h - 0.008) for x, y in ((-0.18, 0.4), (0.12, -0.4))]
    dots = [
        cylinder(0.0045, 0.004, 0.001, 12).moved(-0.18 * d + a, -0.4 * w + b, h - 0.0075)
        for a, b in ((0.009, 0), (-0.009, 0), (0, 0.009), (0, -0.009))
    ]
    return of(body, plate) + of(m.SCREEN, screen) + of(m.CHARCOAL, *sticks, *dots)


DESIGNS: tuple[Design, ...] = (
    design("telephone", "rotary-black", "black rotary telephone", (0.20, 0.24, 0.15), "classic", rotary_telephone, body=BAKELITE, metal=m.BRASS),
    design("telephone", "rotary-green", "sea-green rotary telephone", (0.20, 0.23, 0.14), "rustic", rotary_telephone, body=TEAL, metal=m.CHROME),
    design("telephone", "desk", "grey office telephone", (0.20, 0.24, 0.12), "modern", desk_telephone, body=m.CHARCOAL, trim=m.LIGHT_GREY),
    design("telephone", "cordless", "cordless telephone", (0.09, 0.09, 0.17), "minimal", cordless, body=m.WHITE, trim=m.GREY),
    design("telephone", "candlestick", "candlestick telephone", (0.15, 0.20, 0.30), "industrial", candlestick_phone, metal=m.BRASS),
    design("router", "black", "black router with four aerials", (0.16, 0.26, 0.20), "modern", router, body=m.BLACK, aerials=4),
    design("router", "white", "white router with two aerials", (0.14, 0.20, 0.17), "minimal", router, body=m.WHITE, aerials=2),
    design("router", "upright", "upright modem", (0.11, 0.16, 0.22), "classic", router, body=m.LIGHT_GREY, aerials=0, upright=True),
    design("router", "mesh", "round mesh router", (0.14, 0.14, 0.07), "minimal", mesh_router, 36, body=m.WHITE),
    design("remote control", "black", "black television remote", (0.20, 0.048, 0.022), "classic", remote, body=m.BLACK, keys=m.GREY),
    design("remote control", "slim", "slim remote", (0.14, 0.038, 0.014), "minimal", remote, body=m.CHARCOAL, keys=m.LIGHT_GREY, sparse=True),
    design("remote control", "white", "white remote", (0.17, 0.042, 0.018), "modern", remote, body=m.WHITE, keys=m.GREY),
    design("game console", "upright", "white upright game console", (0.26, 0.12, 0.38), "modern", console, body=m.WHITE, trim=m.BLACK, upright=True),
    design("game console", "box", "black game console", (0.27, 0.30, 0.07), "minimal", console, body=m.BLACK, trim=m.GREY, upright=False),
    design("game console", "gamepad", "game controller", (0.11, 0.16, 0.06), "modern", gamepad, body=m.WHITE, trim=m.BLACK),
    design("game console", "gamepad-black", "black game controller", (0.105, 0.155, 0.058), "industrial", gamepad, body=m.CHARCOAL, trim=m.STEEL),
    design("game console", "handheld", "handheld game console", (0.10, 0.24, 0.022), "modern", handheld, body=TEAL),
)  # fmt: skip
