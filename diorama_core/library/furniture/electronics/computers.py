"""Computers, keyboards and what is beside them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.library.furniture.kit import *


def laptop(size: Size, body: Material, keys: Material, angle: float = 112.0) -> Parts:
    """An open laptop; the screen faces +X."""
    d, w, h = size
    lid = h / np.sin(np.deg2rad(angle))
    lean = lid * np.cos(np.deg2rad(180 - angle))
    base_d = d - lean
    x0 = d / 2 - base_d
    parts = of(body, prism(rounded_rectangle(base_d, w, 0.012), 0.014, 0.004).moved(d / 2 - base_d / 2))
    parts += [p.moved(x0 + base_d * 0.42, 0, 0) for p in keys_of(base_d * 0.46, w * 0.88, 5, 13, 0.0135, 0.0025, keys)]
    parts += of(m.GREY, box((base_d * 0.3, w * 0.34, 0.001), 0.0004).moved(d / 2 - base_d * 0.19, 0, 0.0138))
    screen = of(body, box((0.006, w, lid), 0.003, 2).moved(-0.003)) + of(
        m.SCREEN, box((0.002, w - 0.016, lid - 0.022), 0.0005).pictured().moved(0.0, 0, 0.014)
    )
    # The axis lies in the plane of the glass, high enough for the closed lid to clear the keys.
    pivot = Joint("lid", "hinge", (0.002, 0.0, 0.009), (0.0, 1.0, 0.0), 0.0, float(np.deg2rad(angle - 2.0)))
    lifted = turned(jointed(pivot, screen), "y", -(angle - 90))
    return parts + [p.moved(x0 + 0.008, 0, 0.01) for p in lifted]


def keyboard(size: Size, body: Material, keys: Material, columns: int = 17) -> Parts:
    """A keyboard, typist at +X."""
    d, w, h = size
    parts = of(body, prism(rounded_rectangle(d, w, 0.012), h * 0.62, 0.003))
    return parts + keys_of(d - 0.016, w - 0.016, 6, columns, h * 0.55, h * 0.45, keys)


def tower(size: Size, body: Material, glass: bool = False) -> Parts:
    """A computer tower."""
    d, w, h = size
    parts = of(body, box((d - 0.012, w, h - 0.012), 0.006, 2).moved(-0.006, 0, 0.012)) + of(
        m.BLACK, *four(box((0.05, 0.022, 0.014), 0.003).moved(d / 2 - 0.07, w / 2 - 0.03))
    )
    x = d / 2 - 0.012
    if glass:
        parts += of(m.DARK_GLASS, box((d * 0.86, 0.004, h * 0.84), 0.001).moved(0, w / 2, h * 0.1))
        rings = [
            lathe([(0.045, 0), (0.055, 0.003), (0.055, 0.008), (0.045, 0.008), (0.045, 0)], 28)
            .turned("y", 90)
            .moved(x - 0.002, 0, z * h)
            for z in (0.25, 0.5, 0.75)
        ]
        return parts + of(m.STEEL, *rings)
    slots = [box((0.006, w * 0.78, 0.004), 0.001).moved(x, 0, z) for z in np.linspace(0.06, 0.4 * h, 12)]
    parts += of(m.BLACK, *slots) + of(
        m.GREY, *(box((0.008, w * 0.8, 0.042), 0.003).moved(x - 0.001, 0, h - z) for z in (0.07, 0.12))
    )
    return parts + of(m.STEEL, cylinder(0.01, 0.006, 0.001, 16).turned("y", 90).moved(x, 0, h - 0.16))


def small_computer(size: Size, body: Material) -> Parts:
    """A little square computer."""
    d, w, h = size
    ports = [box((0.004, 0.012, 0.006), 0.001).moved(d / 2 - 0.001, y, h * 0.4) for y in (0.03, 0.05)]
    return of(body, prism(rounded_rectangle(d, w, 0.03, 6), h - 0.004, 0.006).moved(z=0.004)) + of(
        m.BLACK, cylinder(d * 0.4, 0.006, 0.001, 32), *ports
    )


def all_in_one(size: Size, body: Material) -> Parts:
    """A computer within its screen, on a bent foot."""
    d, w, h = size
    low = 0.2 * h
    screen = box((0.012, w, h - low), 0.005, 2).moved(0.02, 0, low)
    glass = box((0.002, w - 0.02, (h - low) * 0.82), 0.0008).pictured().moved(0.0265, 0, low + (h - low) * 0.165)
    foot = tube(
        bend([(d / 2 - 0.01, 0, 0.004), (-d / 2 + 0.02, 0, 0.004), (-d / 2 + 0.012, 0, 0.02), (0.0, 0, low + 0.12)], 6),
        0.004,
        8,
    ).scaled(y=20)
    return of(body, screen) + of(m.STEEL, foot) + of(m.SCREEN, glass)


def mouse(size: Size, body: Material, trim: Material, wheel: bool = True) -> Parts:
    """A computer mouse, its buttons toward -X."""
    d, w, h = size
    shellbody = cushion((d, w, 2 * h), 2.6, 2.4, 10)
    v = shellbody.vertices.copy()
    v[:, 2] = np.maximum(v[:, 2] - h, 0.0) * (1 + 0.28 * v[:, 0] / d)
    parts = of(body, replace(shellbody, vertices=v))
    if wheel:
        parts += of(
            trim,
            cylinder(h * 0.24, 0.008, 0.002, 16).turned("x", 90).moved(-d * 0.24, 0.004, h * 0.72),
            box((d * 0.3, 0.0012, 0.002), 0.0004).moved(-d * 0.3, 0, h * 0.74),
        )
    return parts


def tablet(size: Size, body: Material, stand: bool) -> Parts:
    """A tablet or telephone, lying or leaning on a little stand."""
    d, w, h = size
    long, wide, t = (d, w, h) if not stand else (h * 1.03, w, 0.008)
    slab_ = prism(rounded_rectangle(long, wide, 0.07 * wide + 0.004, 5), t, min(0.003, t * 0.4))
    face = prism(rounded_rectangle(long - 0.06 * wide, wide - 0.06 * wide, 0.05 * wide, 5), 0.0006, 0.0002).moved(
        z=t - 0.0002
    )
    parts = of(body, slab_) + of(m.SCREEN, replace(face, uv=face.vertices[:, :2] / np.array([long, wide]) + 0.5))
    if not stand:
        return parts
    leaning = [p.turned("y", 72) for p in parts]
    low = min(float(p.solid.vertices[:, 2].min()) for p in leaning)
    leaning = [p.moved(0.012, 0, 0.008 - low) for p in leaning]
    return leaning + of(
        m.STEEL,
        prism(rounded_rectangle(d, 0.4 * w, 0.02, 4), 0.006, 0.002),
        box((0.006, 0.3 * w, h * 0.5), 0.002).turned("y", 8).moved(-d * 0.22, 0, 0.004),
        box((0.01, 0.3 * w, 0.018), 0.003).moved(d * 0.3, 0, 0.004),
    )


ROSE_METAL = m.metal("rose-gold", "#c9a79a", 0.35)

DESIGNS: tuple[Design, ...] = (
    design("laptop", "silver", "silver laptop", (0.28, 0.32, 0.21), "modern", laptop, body=m.STEEL, keys=m.BLACK),
    design("laptop", "black", "black laptop", (0.30, 0.36, 0.23), "industrial", laptop, body=m.CHARCOAL, keys=m.BLACK),
    design("laptop", "white", "small white laptop", (0.26, 0.30, 0.19), "minimal", laptop, body=m.WHITE, keys=m.LIGHT_GREY, angle=106.0),
    design("computer", "tower-black", "black computer tower", (0.44, 0.20, 0.43), "modern", tower, body=m.CHARCOAL),
    design("computer", "tower-glass", "computer tower with a glass side", (0.46, 0.22, 0.46), "modern", tower, body=m.BLACK, glass=True),
    design("computer", "tower-beige", "old beige computer tower", (0.42, 0.19, 0.40), "classic", tower, body=m.CREAM),
    design("keyboard", "black", "black keyboard", (0.15, 0.44, 0.03), "modern", keyboard, body=m.CHARCOAL, keys=m.BLACK),
    design("keyboard", "white", "slim white keyboard", (0.12, 0.42, 0.018), "minimal", keyboard, body=m.STEEL, keys=m.WHITE),
    design("keyboard", "compact", "compact grey keyboard", (0.13, 0.32, 0.028), "modern", keyboard, body=m.GREY, keys=m.LIGHT_GREY, columns=13),
    design("laptop", "gaming", "thick grey laptop", (0.34, 0.40, 0.25), "industrial", laptop, body=m.GREY, keys=m.BLACK, angle=108.0),
    design("laptop", "rose", "small rose-gold laptop", (0.25, 0.29, 0.19), "modern", laptop, body=ROSE_METAL, keys=m.BLACK),
    design("computer", "mini", "small silver computer", (0.20, 0.20, 0.05), "minimal", small_computer, 4, body=m.STEEL),
    design("computer", "all-in-one", "all-in-one computer", (0.20, 0.55, 0.46), "minimal", all_in_one, body=m.STEEL),
    design("mouse", "black", "black computer mouse", (0.12, 0.065, 0.038), "modern", mouse, body=m.BLACK, trim=m.GREY),
    design("mouse", "white", "flat white mouse", (0.115, 0.058, 0.026), "minimal", mouse, body=m.WHITE, trim=m.GREY, wheel=False),
    design("mouse", "grey", "old beige mouse", (0.11, 0.064, 0.036), "classic", mouse, body=m.CREAM, trim=m.GREY),
    design("tablet", "slate", "tablet lying flat", (0.25, 0.175, 0.007), "modern", tablet, body=m.CHARCOAL, stand=False),
    design("tablet", "stand", "tablet on a stand", (0.12, 0.25, 0.17), "minimal", tablet, body=m.STEEL, stand=True),
    design("tablet", "silver", "small silver tablet", (0.20, 0.135, 0.007), "minimal", tablet, body=m.STEEL, stand=False),
    design("smartphone", "black", "black smartphone", (0.15, 0.072, 0.008), "modern", tablet, body=m.BLACK, stand=False),
    design("smartphone", "blue", "blue smartphone", (0.16, 0.076, 0.009), "modern", tablet, body=m.NAVY, stand=False),
    design("smartphone", "white", "small white smartphone", (0.138, 0.067, 0.008), "minimal", tablet, body=m.WHITE, stand=False),
)  # fmt: skip
