"""Lamps to work by."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def desk_lamp(size: Size, paint: Material, joint: Material) -> Parts:
    """A jointed desk lamp with a metal hood."""
    d, w, h = size
    x0, r = 0.05 * d, 0.49 * w  # the elbow leans back behind the foot, so that the hood does not pull it over
    elbow, head = (-d / 2 + 0.016, 0.0, h * 0.62), (d / 2 - 0.08, 0.0, h * 0.93)
    arms = [rod((x0, s, 0.03), (elbow[0], s, elbow[2]), 0.005) for s in (0.012, -0.012)] + [
        rod((elbow[0], s, elbow[2]), (head[0], s, head[2]), 0.005) for s in (0.012, -0.012)
    ]
    hood = (
        lathe([(0.02, 0.13), (0.03, 0.125), (0.036, 0.09), (0.075, 0.0), (0.072, 0.0), (0.033, 0.085), (0.02, 0.1)], 32)
        .turned("y", -24)
        .moved(head[0] + 0.03, 0, head[2] - 0.12)
    )
    joints = [
        cylinder(0.014, 0.044, 0.003, 16).turned("x", 90).moved(p[0], 0.022, p[2])
        for p in ((x0, 0, 0.035), elbow, head)
    ]
    glow = ball(0.06).moved(head[0] + 0.045, 0, head[2] - 0.115)
    return (
        of(paint, lathe([(r - 0.002, 0), (r, 0.006), (r - 0.004, 0.026), (0.03, 0.034)], 36).moved(x0), hood)
        + of(joint, *arms, *joints)
        + of(m.LAMP_GLOW, glow)
    )


def bar_lamp(size: Size, metal: Material) -> Parts:
    """A slim bar of light on a slim post."""
    d, w, h = size
    x = -d / 2 + w / 2
    post = box((0.02, 0.02, h - 0.02), 0.006, 2).moved(x)
    foot = prism(rounded_rectangle(w, w, 0.03, 5), 0.016, 0.005).moved(x)
    arm = box((d - w / 2 + 0.01, 0.034, 0.014), 0.006, 2).moved((d / 2 + x) / 2 - 0.005, 0, h - 0.014)
    strip = box((d * 0.56, 0.024, 0.004), 0.001).moved(d * 0.18, 0, h - 0.0175)
    return of(metal, post, foot, arm, cylinder(0.014, 0.05, 0.003, 16).turned("x", 90).moved(x, 0.025, h - 0.012)) + of(
        m.LAMP_GLOW, strip
    )


def bankers_lamp(size: Size, metal: Material, glass: Material) -> Parts:
    """A long green glass shade on a brass stem."""
    d, w, h = size
    r = d * 0.36
    t = np.linspace(-0.15, np.pi + 0.15, 15)
    arc = np.stack([r * np.cos(t), 0 * t, r * 0.8 * np.sin(t)], axis=1)
    outer = np.array([arc + np.array([0, y, 0]) for y in np.linspace(-w / 2, w / 2, 3)])
    hood = slab(outer, 0.005).moved(d * 0.08, 0, h - r * 0.8)
    ends = [
        loft(
            np.array(
                [
                    arc[::-1] * np.array([0.98, 1, 0.98]) + np.array([0, s * (w / 2 - 0.004) + e, 0])
                    for e in (-0.002, 0.002)
                ]
            )
        ).moved(d * 0.08, 0, h - r * 0.8)
        for s in (1, -1)
    ]
    foot = prism(superellipse(d * 0.84, w * 0.6, 2.6, 40), 0.024, 0.009)
    stem = tube(
        bend([(-0.02, 0, 0.02), (-0.02, 0, h * 0.55), (0.01, 0, h * 0.72), (d * 0.08, 0, h - r * 0.55)], 6), 0.009, 10
    )
    tubes = cylinder(0.014, w * 0.7, 0.004, 14).turned("x", 90).moved(d * 0.08, w * 0.35, h - r * 0.42)
    chain = rod((d * 0.08 + 0.03, w * 0.22, h - r * 0.5), (d * 0.08 + 0.03, w * 0.22, h - r * 1.6), 0.0016, segments=5)
    return (
        of(metal, foot, stem, chain, ball(0.014, 5).moved(d * 0.08 + 0.03, w * 0.22, h - r * 1.6 - 0.008))
        + of(glass, hood, *ends)
        + of(m.LAMP_GLOW, tubes)
    )


def gooseneck(size: Size, paint: Material, metal: Material) -> Parts:
    """A flexible neck with a small bell."""
    d, w, h = size
    x = -0.01
    path = bend(
        [
            (x, 0, 0.02),
            (-d / 2 + 0.03, 0, h * 0.42),
            (-d / 2 + 0.035, 0, h * 0.82),
            (-0.01, 0, h * 0.96),
            (d / 2 - 0.07, 0, h * 0.78),
        ],
        7,
    )
    ribs = 0.0075 + 0.0012 * np.cos(np.arange(len(path)) * np.pi)
    hood = (
        lathe([(0.016, 0.11), (0.03, 0.1), (0.05, 0.06), (0.068, 0.0), (0.065, 0.0), (0.046, 0.058), (0.02, 0.09)], 28)
        .turned("y", 24)
        .moved(d / 2 - 0.1, 0, h * 0.78 - 0.1)
    )
    foot = lathe([(w * 0.48, 0), (w * 0.5, 0.006), (w * 0.47, 0.026), (0.02, 0.034)], 32).moved(x)
    return (
        of(paint, foot, hood)
        + of(metal, tube(path, ribs, 10))
        + of(m.LAMP_GLOW, ball(0.05).moved(d / 2 - 0.088, 0, h * 0.78 - 0.085))
    )


BANKER_GLASS = m.lit("green glass shade", "#4f6d58", 0.1)


DESIGNS: tuple[Design, ...] = (
    design("lamp", "desk-black", "black jointed desk lamp", (0.42, 0.20, 0.50), "industrial", desk_lamp, paint=m.BLACK_STEEL, joint=m.STEEL),
    design("lamp", "desk-sage", "sage jointed desk lamp", (0.40, 0.18, 0.46), "modern", desk_lamp, paint=m.SAGE, joint=m.BRASS),
    design("lamp", "desk-bar", "slim bar desk lamp", (0.40, 0.14, 0.40), "minimal", bar_lamp, metal=m.CHARCOAL),
    design("lamp", "desk-bar-brass", "brass bar desk lamp", (0.38, 0.13, 0.44), "modern", bar_lamp, metal=m.BRASS),
    design("lamp", "banker", "banker's lamp with a green shade", (0.20, 0.26, 0.38), "classic", bankers_lamp, metal=m.BRASS, glass=BANKER_GLASS),
    design("lamp", "gooseneck", "cream gooseneck desk lamp", (0.34, 0.16, 0.42), "rustic", gooseneck, paint=m.CREAM, metal=m.STEEL),
    design("lamp", "desk-navy", "navy architect's lamp", (0.50, 0.20, 0.58), "industrial", desk_lamp, paint=m.NAVY, joint=m.BLACK_STEEL),
)  # fmt: skip
