"""Refrigerators, cookers, counters and small kitchen machines."""

from __future__ import annotations

from functools import partial

import numpy as np

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.carcass import door_front, drawer_front
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Builder, Design, Parts, Size, four, of
from diorama_core.library.furniture.solids import (
    bend,
    box,
    cylinder,
    lathe,
    prism,
    ring_path,
    rod,
    rounded_rectangle,
    superellipse,
    tube,
)


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


def refrigerator(size: Size, body: Material, layout: str, round_edge: float = 0.012) -> Parts:
    """`layout`: "top" (freezer above), "bottom" (freezer below), "double" (side by side), "single"."""
    d, w, h = size
    door_t = 0.06
    x = d / 2 - 0.045 - door_t
    core = box((d - 0.045 - door_t - 0.005, w - 0.006, h - 0.05), 0.008).moved(
        -d / 2 + (d - 0.05 - door_t) / 2, 0, 0.045
    )
    parts = of(body if layout != "double" else m.GREY, core) + of(
        m.BLACK, box((d - 0.14, w - 0.04, 0.06), 0.003).moved(-0.02)
    )
    z0, z1 = 0.06, h
    split = {"top": 0.68, "bottom": 0.38}.get(layout, 0.0)
    spans = [(z0, z1)] if not split else [(z0, z0 + split * (z1 - z0)), (z0 + split * (z1 - z0), z1)]
    columns = (-w / 4, w / 4) if layout == "double" else (0.0,)
    for y in columns:
        for low, high in spans:
            width, height = (w / 2 if layout == "double" else w) - 0.004, high - low - 0.008
            parts += of(body, box((door_t, width, height), round_edge, 3).moved(x + door_t / 2, y, low + 0.004))
            side = -np.sign(y) if y else 1.0
            length = min(0.5, height * 0.62) if height > 0.6 else min(0.25, 0.6 * height)
            near_split = (
                high - length / 2 - 0.09
                if split and low == z0
                else low + length / 2 + 0.09
                if split
                else (low + high) / 2
            )
            parts += at(bar_handle(length, True), x + door_t - 0.004, y + side * (width / 2 - 0.05), near_split)
    return parts


def stove(size: Size, body: Material, hob: str) -> Parts:
    """A cooker with an oven door; `hob` is "gas", "glass" or "rings"."""
    d, w, h = size
    back = 0.07 if hob != "glass" else 0.0
    top = h - back - (0.035 if hob == "gas" else 0.0)
    parts = of(body, box((d - 0.06, w, top - 0.05), 0.006, 2).moved(-0.03, 0, 0.04)) + of(
        m.BLACK, box((d - 0.14, w - 0.03, 0.05), 0.002).moved(-0.04)
    )
    parts += of(
        m.DARK_GLASS if hob == "glass" else m.STAINLESS,
        box((d - 0.03, w, 0.012), 0.004, 2).moved(-0.015, 0, top - 0.012),
    )
    xf = d / 2 - 0.06
    parts += of(
        body,
        box((0.03, w - 0.012, top - 0.36), 0.01, 2).moved(xf + 0.01, 0, 0.2),
        box((0.026, w - 0.012, 0.13), 0.008, 2).moved(xf + 0.01, 0, 0.06),
    )
    parts += of(m.DARK_GLASS, box((0.006, w - 0.14, top - 0.52), 0.002).moved(xf + 0.025, 0, 0.25)) + at(
        bar_handle(w * 0.72, False), xf + 0.02, 0, top - 0.2
    )
    parts += of(body, box((0.028, w - 0.004, 0.115), 0.006, 2).moved(xf + 0.008, 0, top - 0.14))
    for y in np.linspace(-0.36 * w, 0.36 * w, 5):
        parts += at(knob(), xf + 0.022, float(y), top - 0.08)
    if back:
        parts += of(body, box((0.04, w, back + 0.03), 0.006).moved(-d / 2 + 0.02, 0, top - 0.03))
    return parts + _burners(d, w, top, hob)


def _burners(d: float, w: float, top: float, hob: str) -> Parts:
    parts: Parts = []
    for x in (-0.22 * d, 0.17 * d):
        for y in (-0.24 * w, 0.24 * w):
            r = 0.085 if x * y > 0 else 0.068
            if hob == "glass":
                parts += of(
                    m.GREY,
                    tube(ring_path(superellipse(2 * r, 2 * r, 2, 32), top - 0.0005), 0.0015, 4, closed=True).moved(
                        x, y
                    ),
                )
                continue
            parts += of(m.BLACK, cylinder(r * 0.5, 0.016, 0.005, 20).moved(x, y, top - 0.002))
            if hob == "rings":
                parts += of(
                    m.BLACK,
                    *(
                        tube(ring_path(superellipse(2 * a, 2 * a, 2, 24), top + 0.008), 0.006, 6, closed=True).moved(
                            x, y
                        )
                        for a in (r * 0.55, r * 0.78, r)
                    ),
                )
                continue
            bars = [
                rod((r * 0.3, 0, top + 0.028), (r * 1.25, 0, top + 0.028), 0.005, segments=6).turned("z", 90.0 * k)
                for k in range(4)
            ]
            posts = [
                rod((r * 1.25, 0, top), (r * 1.25, 0, top + 0.03), 0.005, segments=6).turned("z", 90.0 * k)
                for k in range(4)
            ]
            parts += of(m.BLACK_STEEL, *(b.moved(x, y) for b in (*bars, *posts)))
    return parts


def washing_machine(size: Size, body: Material, trim: Material, kind: str = "front") -> Parts:
    """`kind`: "front" (porthole), "top" (lid above) or "dish" (a plain dishwasher door)."""
    d, w, h = size
    parts = of(
        body,
        box((d - 0.05, w, h - 0.03), 0.01, 2).moved(-0.02, 0, 0.02),
        box((d - 0.03, w, 0.025), 0.008, 2).moved(-0.01, 0, h - 0.025),
    ) + of(m.BLACK, *four(cylinder(0.022, 0.025, 0.003, 12).moved(d / 2 - 0.1, w / 2 - 0.06)))
    x = d / 2 - 0.047
    if kind == "dish":
        parts += of(body, box((0.03, w - 0.01, h - 0.24), 0.006, 2).moved(x + 0.012, 0, 0.1)) + of(
            trim, box((0.028, w - 0.01, 0.095), 0.006, 2).moved(x + 0.012, 0, h - 0.135)
        )
        return parts + at(bar_handle(w * 0.7, False), x + 0.022, 0, h - 0.2)
    if kind == "top":
        parts += of(trim, box((d * 0.62, w - 0.07, 0.02), 0.008, 2).moved(0.05, 0, h - 0.012)) + of(
            body, box((0.12, w, 0.12), 0.02, 2).moved(-d / 2 + 0.07, 0, h - 0.03)
        )
        return parts + at(knob(0.024), -d / 2 + 0.12, 0.15, h + 0.035)
    zc, r = 0.47 * h, 0.2
    rim = (
        lathe(
            [(r * 0.72, 0.0), (r * 0.98, 0.0), (r, 0.012), (r * 0.94, 0.028), (r * 0.78, 0.03), (r * 0.72, 0.012)], 40
        )
        .turned("y", 90)
        .moved(x, 0, zc)
    )
    glass = (
        lathe([(r * 0.76, 0.0), (r * 0.74, 0.016), (r * 0.5, 0.034), (0.01, 0.04)], 36, np.pi / 2)
        .turned("y", 90)
        .moved(x - 0.004, 0, zc)
    )
    panel = box((0.02, w - 0.012, 0.115), 0.008, 2).moved(x + 0.003, 0, h - 0.15)
    tray = box((0.022, 0.16, 0.09), 0.006, 2).moved(x + 0.004, w / 2 - 0.1, h - 0.138)
    parts += (
        of(trim, rim)
        + of(m.DARK_GLASS, glass, box((0.004, 0.09, 0.034), 0.001).moved(x + 0.014, -0.16, h - 0.11))
        + of(body, panel, tray)
    )
    return parts + at(knob(0.03), x + 0.012, 0.0, h - 0.093)


def counter(
    size: Size,
    body: Material,
    top: Material,
    units: tuple[str, ...],
    panel: str = "flat",
    pull: Material = m.STEEL,
    handle: str = "bar",
    basin: bool = False,
) -> Parts:
    """Base units under a worktop; `units` are "door", "drawers" or "pair" from right to left."""
    d, w, h = size
    h -= 0.24 if basin else 0.0  # the tap reaches above the worktop
    t = 0.038
    parts = of(body, box((d - 0.05, w - 0.01, h - t - 0.1), 0.003).moved(-0.015, 0, 0.1)) + of(
        m.CHARCOAL, box((d - 0.1, w - 0.02, 0.1), 0.002).moved(-0.025)
    )
    parts += of(m.SHADOW, box((0.004, w - 0.014, h - t - 0.104), 0.001).moved(d / 2 - 0.039, 0, 0.102))
    if basin:
        parts += _worktop_with_basin(d, w, h, t, top)
    else:
        parts += of(top, box((d, w, t), 0.006, 2).moved(z=h - t))
    each, x, z, hh = w / len(units), d / 2 - 0.038, 0.105, h - t - 0.112
    for k, unit_kind in enumerate(units):
        y = -w / 2 + each * (k + 0.5)
        if unit_kind == "drawers":
            for low, share in ((0.0, 0.4), (0.4, 0.36), (0.76, 0.24)):
                parts += drawer_front(x, y, z + low * hh, each - 0.006, share * hh - 0.006, body, pull, handle)
        elif unit_kind == "pair":
            for s in (1, -1):
                parts += door_front(
                    x,
                    y + s * each / 4,
                    z,
                    each / 2 - 0.006,
                    hh,
                    body,
                    pull,
                    "tall" if handle == "bar" else handle,
                    s,
                    panel,
                )
        else:
            parts += door_front(
                x, y, z, each - 0.006, hh, body, pull, "tall" if handle == "bar" else handle, 1 if k % 2 else -1, panel
            )
    return parts


def _worktop_with_basin(d: float, w: float, h: float, t: float, top: Material) -> Parts:
    bw, bd = 0.5, d * 0.62
    strips = [box((d, (w - bw) / 2, t), 0.005).moved(0, s * (w + bw) / 4, h - t) for s in (1, -1)]
    strips += [box(((d - bd) / 2, bw + 0.002, t), 0.005).moved(s * (d + bd) / 4, 0, h - t) for s in (1, -1)]
    sides = [box((bd, 0.006, 0.16), 0.002).moved(0, s * (bw / 2 - 0.003), h - 0.165) for s in (1, -1)] + [
        box((0.006, bw, 0.16), 0.002).moved(s * (bd / 2 - 0.003), 0, h - 0.165) for s in (1, -1)
    ]
    floor = box((bd, bw, 0.006), 0.002).moved(z=h - 0.168)
    return of(top, *strips) + of(m.STAINLESS, *sides, floor) + at(tap(0.24), -bd / 2 - 0.04, 0, h)


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


def microwave(size: Size, body: Material, kind: str = "microwave") -> Parts:
    """`kind`: "microwave", "oven" (a mini oven with knobs) or "toaster"."""
    d, w, h = size
    if kind == "toaster":
        shell = prism(rounded_rectangle(h, w, 0.05, 6), d, 0.02).turned("y", -90).moved(d / 2, 0, h / 2)
        slots = [box((0.026, w * 0.68, 0.012), 0.003).moved(x, 0, h - 0.009) for x in (-0.17 * d, 0.17 * d)]
        lever = box((0.03, 0.03, 0.014), 0.004).moved(0, w / 2 + 0.004, h * 0.6)
        return of(body, shell.moved(0, 0, 0.0)) + of(m.BLACK, *slots, lever, box((d - 0.03, w - 0.03, 0.012), 0.003))
    parts = of(body, box((d - 0.03, w, h - 0.012), 0.008, 2).moved(-0.015, 0, 0.012)) + of(
        m.BLACK, *four(cylinder(0.014, 0.015, 0.002, 10).moved(d / 2 - 0.07, w / 2 - 0.05))
    )
    x, glass_w = d / 2 - 0.032, w * 0.68
    y = w / 2 - glass_w / 2 - 0.014
    parts += of(
        body if kind == "oven" else m.CHARCOAL, box((0.024, glass_w, h - 0.035), 0.006, 2).moved(x + 0.01, y, 0.022)
    ) + of(m.DARK_GLASS, box((0.004, glass_w - 0.07, h - 0.12), 0.001).moved(x + 0.022, y, 0.06))
    side_y = -w / 2 + (w - glass_w) / 2 - 0.008
    parts += of(
        m.CHARCOAL if kind != "oven" else body,
        box((0.02, w - glass_w - 0.03, h - 0.035), 0.005, 2).moved(x + 0.006, side_y, 0.022),
    )
    if kind == "oven":
        for z in (0.27, 0.52, 0.77):
            parts += at(knob(0.017), x + 0.016, side_y, z * h)
        return parts + at(bar_handle(glass_w * 0.8, False), x + 0.01, y, h - 0.045)
    keys = [
        box((0.004, 0.02, 0.012), 0.001).moved(x + 0.016, side_y + (c - 1) * 0.028, 0.07 + 0.03 * r)
        for r in range(4)
        for c in range(3)
    ]
    display = box((0.004, 0.085, 0.032), 0.001).moved(x + 0.015, side_y, h - 0.08)
    return (
        parts
        + of(m.GREY, *keys)
        + of(m.SCREEN, display)
        + at(bar_handle(h * 0.7, True), x + 0.016, y - glass_w / 2 + 0.03, h / 2)
    )


def _d(category: str, name: str, caption: str, size: Size, style: str, build: Builder) -> Design:
    return Design(f"{category.replace(' ', '-')}-{name}", category, caption, size, style, build)


DESIGNS: tuple[Design, ...] = (
    _d(
        "refrigerator",
        "white-top",
        "white refrigerator with a freezer above",
        (0.68, 0.66, 1.55),
        "minimal",
        partial(refrigerator, body=m.WHITE, layout="top"),
    ),
    _d(
        "refrigerator",
        "steel-bottom",
        "stainless-steel fridge freezer",
        (0.68, 0.62, 1.86),
        "modern",
        partial(refrigerator, body=m.STAINLESS, layout="bottom"),
    ),
    _d(
        "refrigerator",
        "double",
        "side-by-side stainless-steel refrigerator",
        (0.74, 0.92, 1.78),
        "modern",
        partial(refrigerator, body=m.STAINLESS, layout="double"),
    ),
    _d(
        "refrigerator",
        "retro",
        "rounded sage refrigerator",
        (0.70, 0.60, 1.52),
        "classic",
        partial(refrigerator, body=m.SAGE, layout="single", round_edge=0.055),
    ),
    _d(
        "refrigerator",
        "small",
        "small white refrigerator",
        (0.56, 0.52, 0.84),
        "minimal",
        partial(refrigerator, body=m.WHITE, layout="single"),
    ),
    _d(
        "stove", "gas-white", "white gas cooker", (0.62, 0.60, 0.95), "classic", partial(stove, body=m.WHITE, hob="gas")
    ),
    _d(
        "stove",
        "glass-steel",
        "stainless-steel cooker with a glass hob",
        (0.62, 0.60, 0.90),
        "modern",
        partial(stove, body=m.STAINLESS, hob="glass"),
    ),
    _d(
        "stove",
        "range",
        "wide charcoal range cooker",
        (0.64, 0.90, 0.96),
        "classic",
        partial(stove, body=m.CHARCOAL, hob="gas"),
    ),
    _d(
        "stove",
        "rings",
        "cream electric cooker",
        (0.60, 0.54, 0.93),
        "rustic",
        partial(stove, body=m.CREAM, hob="rings"),
    ),
    _d(
        "washing machine",
        "white",
        "white front-loading washing machine",
        (0.58, 0.60, 0.85),
        "minimal",
        partial(washing_machine, body=m.WHITE, trim=m.LIGHT_GREY),
    ),
    _d(
        "washing machine",
        "graphite",
        "graphite washing machine",
        (0.60, 0.60, 0.85),
        "modern",
        partial(washing_machine, body=m.CHARCOAL, trim=m.STEEL),
    ),
    _d(
        "washing machine",
        "top-loader",
        "white top-loading washing machine",
        (0.62, 0.62, 1.00),
        "classic",
        partial(washing_machine, body=m.WHITE, trim=m.GREY, kind="top"),
    ),
    _d(
        "washing machine",
        "dishwasher",
        "stainless-steel dishwasher",
        (0.60, 0.60, 0.84),
        "modern",
        partial(washing_machine, body=m.STAINLESS, trim=m.BLACK, kind="dish"),
    ),
    _d(
        "kitchen counter",
        "white-oak",
        "white kitchen units with an oak worktop",
        (0.62, 1.80, 0.90),
        "modern",
        partial(counter, body=m.WHITE, top=m.OAK, units=("door", "drawers", "door")),
    ),
    _d(
        "kitchen counter",
        "sage-marble",
        "sage panelled units with a marble top",
        (0.62, 2.00, 0.91),
        "classic",
        partial(
            counter, body=m.SAGE, top=m.MARBLE, units=("pair", "drawers"), panel="shaker", pull=m.BRASS, handle="knob"
        ),
    ),
    _d(
        "kitchen counter",
        "sink-unit",
        "grey kitchen unit with a steel sink",
        (0.62, 1.60, 1.14),
        "modern",
        partial(counter, body=m.LIGHT_GREY, top=m.GRANITE, units=("door", "pair"), basin=True),
    ),
    _d(
        "kitchen counter",
        "island",
        "navy kitchen island",
        (0.90, 1.60, 0.92),
        "modern",
        partial(
            counter, body=m.NAVY, top=m.LIGHT_OAK, units=("drawers", "door", "drawers"), panel="shaker", pull=m.BRASS
        ),
    ),
    _d(
        "kitchen counter",
        "concrete",
        "walnut units with a concrete worktop",
        (0.64, 2.40, 0.90),
        "industrial",
        partial(
            counter, body=m.WALNUT, top=m.CONCRETE, units=("door", "drawers", "drawers", "door"), pull=m.BLACK_STEEL
        ),
    ),
    _d("microwave", "black", "black microwave oven", (0.38, 0.50, 0.29), "modern", partial(microwave, body=m.BLACK)),
    _d(
        "microwave",
        "steel",
        "stainless-steel microwave",
        (0.40, 0.52, 0.31),
        "modern",
        partial(microwave, body=m.STAINLESS),
    ),
    _d("microwave", "white", "white microwave", (0.36, 0.46, 0.27), "minimal", partial(microwave, body=m.WHITE)),
    _d(
        "microwave",
        "mini-oven",
        "small countertop oven with knobs",
        (0.36, 0.45, 0.27),
        "classic",
        partial(microwave, body=m.STAINLESS, kind="oven"),
    ),
    _d(
        "microwave",
        "toaster",
        "cream two-slot toaster",
        (0.18, 0.30, 0.20),
        "classic",
        partial(microwave, body=m.CREAM, kind="toaster"),
    ),
)
