"""Plain wooden tables of every home: a top on four legs or on two bent frames, and solid plinths."""

from __future__ import annotations

from typing import Literal

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.tables.tops import Outline, table_top


def four_legged_table(
    size: Size,
    top: Material,
    legs: Material,
    profile: Leg = "square",
    outline: Outline = "square",
    thick: float = 0.045,
    overhang: float = 0.02,
    apron: float = 0.06,
    edge: float = 0.028,
    shelf: float = 0.0,
) -> Parts:
    """A top on four legs.

    Args:
        size: Its extents.
        top: What the top and the shelf are made of.
        legs: What legs and apron are made of.
        profile: Of the legs.
        outline: Of the top.
        thick: Width of a leg at its head.
        overhang: From the outer side of a leg to the edge of the top; splayed feet end under the edge.
        apron: Height of the boards under the top, 0 for none.
        edge: Thickness of the top.
        shelf: Height of a shelf between the legs, as a share of the whole; 0 for none.
    """
    d, w, h = size
    width = _WIDTH.get(profile, 1.0) * thick
    inset = overhang + width / 2 + (_LEAN * (h - edge) if profile == "splay" else 0.0)
    if outline in ("round", "oval"):
        inset += (1 - np.sqrt(0.5)) * min(d, w) / 2 - overhang * 0.4
    inset, tall = min(inset, 0.4 * min(d, w)), h - edge
    x, y, apron = d / 2 - inset, w / 2 - inset, min(apron, 0.6 * tall)
    parts = of(top, table_top(d, w, edge, outline).moved(z=tall))
    parts += of(legs, *four(leg(profile, x, y, tall, thick, _LEAN)))
    if apron:
        z, back = tall - apron / 2, width / 2 - _BOARD / 2 - min(0.006, 0.1 * width)
        ax, ay = x + back, y + back
        parts += of(
            legs,
            *(beam((s * ax, -y, z), (s * ax, y, z), _BOARD, apron) for s in (1, -1)),
            *both_sides(beam((-x, ay, z), (x, ay, z), _BOARD, apron)),
        )
    if shelf:
        parts += of(top, _shelf(x, y, shelf * h, outline))
    return parts


def _shelf(x: float, y: float, z: float, outline: Outline) -> Solid:
    """A board that ends in the middle of the legs."""
    if outline in ("round", "oval"):
        return table_top(2.75 * x, 2.75 * y, 0.018, outline).moved(z=z)
    return box((2 * x, 2 * y, 0.018), 0.004).moved(z=z)


def framed_table(
    size: Size,
    top: Material,
    frame: Material,
    spread: float = 0.16,
    foot: Literal["open", "bar", "bent"] = "bent",
    bar: float = 0.04,
    edge: float = 0.026,
) -> Parts:
    """A soft-cornered top on two frames, each of two legs that lean apart.

    Args:
        size: Its extents.
        top: What the top is made of.
        frame: What the frames are made of.
        spread: How far a leg leans, as a share of its height.
        foot: Whether the feet of a frame are free, joined by a bar, or drawn in to a point behind.
        bar: Width of the legs.
        edge: Thickness of the top.
    """
    d, w, h = size
    tall, y = h - edge, 0.40 * w
    lean = spread * tall
    foot_x, head_x = d / 2 - 0.06 - bar / 2, d / 2 - 0.06 - bar / 2 - lean
    foot_y, head_y = y - bar / 2, y - bar / 2 - lean
    legs = [_rising((s * foot_x, foot_y), (s * head_x, head_y), tall, bar) for s in (1, -1)]
    rails = [box((2 * head_x + bar, bar, 0.03), 0.004).moved(0, head_y, tall - 0.03)]
    if foot == "bar":
        rails.append(box((2 * foot_x, bar * 0.9, 0.03), 0.006).moved(0, foot_y))
    if foot == "bent":
        point = (0.0, foot_y - 0.55 * foot_x)
        rails += [
            beam((s * foot_x, foot_y, bar * 0.4), (*point, bar * 0.4), bar * 0.9, bar * 0.8, 0.006) for s in (1, -1)
        ]
    tie = beam((0, -head_y, tall - 0.02), (0, head_y, tall - 0.02), bar, 0.03)
    return of(top, prism(rounded_rectangle(d, w, 0.05, 6), edge, 0.009).moved(z=tall)) + of(
        frame, *both_sides(*legs, *rails), tie
    )


def _rising(foot: tuple[float, float], head: tuple[float, float], h: float, width: float) -> Solid:
    """A leg with level ends between two points of the floor plan."""
    return taper((*foot, 0.0), (*head, h), 0.8 * width, 1.1 * width, 0.006)


def plinth_stand(
    size: Size,
    body: Material,
    outline: Outline = "square",
    cap: float = 0.0,
    recess: float = 0.012,
    waist: float = 0.0,
) -> Parts:
    """A solid block to put something on.

    Args:
        size: Its extents.
        body: What it is made of.
        outline: Of its plan.
        cap: Thickness of a slab on top that stands out, 0 for none.
        recess: How far the foot stands back.
        waist: How far the body stands back under the slab.
    """
    d, w, h = size
    foot_h = 0.02
    back = waist if cap else 0.0
    parts = of(
        body,
        _block(d - 2 * back, w - 2 * back, h - foot_h - cap, outline).moved(z=foot_h),
        _block(d - 2 * (back + recess), w - 2 * (back + recess), foot_h + 0.004, outline),
    )
    return parts + (of(body, _block(d, w, cap, outline).moved(z=h - cap)) if cap else [])


def _block(d: float, w: float, h: float, outline: Outline) -> Solid:
    return table_top(d, w, h, outline)


_WIDTH = {"square": 1.25, "slim": 0.62, "steel": 0.6, "splay": 0.92}
"""Widths of legs, as shares of what they are told."""
_LEAN, _BOARD = 0.08, 0.02


_TRAVERTINE = m.Material("travertine", "clay", "#cfc0a8", 0.6, 0.0, 0.6)


DESIGNS: tuple[Design, ...] = (
    design("coffee table", "plain-oak", "plain oak coffee table on four square legs", (0.60, 1.10, 0.45), "rustic", four_legged_table, 2, top=m.OAK, legs=m.OAK),
    design("coffee table", "plain-dark", "low dark coffee table with thick corner legs", (0.85, 1.15, 0.42), "modern", four_legged_table, 2, top=m.DARK_WALNUT, legs=m.DARK_WALNUT, thick=0.064, overhang=0.0, apron=0.085, edge=0.02),
    design("coffee table", "plain-white-shelf", "white coffee table with a shelf", (0.55, 0.90, 0.45), "minimal", four_legged_table, 2, top=m.WHITE, legs=m.WHITE, thick=0.04, overhang=0.0, apron=0.05, edge=0.05, shelf=0.22),
    design("coffee table", "square-walnut", "square walnut coffee table", (0.85, 0.85, 0.40), "modern", four_legged_table, 4, top=m.WALNUT, legs=m.WALNUT, profile="splay", outline="soft", thick=0.05, overhang=0.03, apron=0.05),
    design("coffee table", "turned-black", "black coffee table on turned legs", (0.75, 1.25, 0.47), "classic", four_legged_table, 2, top=m.BLACK_WOOD, legs=m.BLACK_WOOD, profile="turned", thick=0.085, overhang=0.015, apron=0.07, edge=0.035),
    design("coffee table", "round-oak", "round oak coffee table on splayed legs", (0.80, 0.80, 0.45), "modern", four_legged_table, 4, top=m.OAK, legs=m.OAK, profile="splay", outline="round", thick=0.055, overhang=0.05, apron=0.0),
    design("coffee table", "bent-oak", "oak coffee table on two bent wooden frames", (0.60, 1.15, 0.44), "modern", framed_table, 2, top=m.OAK, frame=m.OAK),
    design("coffee table", "trapeze-black", "walnut coffee table on black trapeze legs", (0.60, 1.20, 0.42), "industrial", framed_table, 2, top=m.WALNUT, frame=m.BLACK_STEEL, spread=0.1, foot="bar", bar=0.032),
    design("coffee table", "plinth-white", "low white block coffee table", (0.70, 1.10, 0.32), "minimal", plinth_stand, 2, body=m.WHITE, cap=0.06, waist=0.05),
    design("side table", "plain-oak", "square oak side table on four legs", (0.45, 0.45, 0.52), "rustic", four_legged_table, 4, top=m.OAK, legs=m.OAK, thick=0.032),
    design("side table", "plain-white-shelf", "white side table with a shelf", (0.45, 0.50, 0.55), "minimal", four_legged_table, 2, top=m.WHITE, legs=m.WHITE, thick=0.032, overhang=0.0, apron=0.045, edge=0.04, shelf=0.22),
    design("side table", "plain-walnut", "walnut side table on splayed legs", (0.42, 0.50, 0.54), "modern", four_legged_table, 2, top=m.WALNUT, legs=m.WALNUT, profile="splay", outline="soft", thick=0.04, overhang=0.02, apron=0.045),
    design("side table", "turned-black", "black side table on turned legs", (0.55, 0.60, 0.60), "classic", four_legged_table, 2, top=m.BLACK_WOOD, legs=m.BLACK_WOOD, profile="turned", thick=0.065, overhang=0.012, apron=0.08, edge=0.032),
    design("side table", "round-oak", "round oak side table on four splayed legs", (0.50, 0.50, 0.50), "modern", four_legged_table, 4, top=m.LIGHT_OAK, legs=m.LIGHT_OAK, profile="splay", outline="round", thick=0.046, overhang=0.04, apron=0.0),
    design("side table", "round-shelf-walnut", "round walnut side table with a lower tier", (0.48, 0.48, 0.56), "classic", four_legged_table, 4, top=m.WALNUT, legs=m.WALNUT, profile="slim", outline="round", thick=0.05, overhang=0.02, apron=0.0, edge=0.022, shelf=0.35),
    design("side table", "plinth-white", "white pedestal", (0.32, 0.32, 0.75), "minimal", plinth_stand, 4, body=m.WHITE),
    design("side table", "plinth-stone", "stone plinth with a slab on top", (0.40, 0.40, 0.52), "classic", plinth_stand, 4, body=_TRAVERTINE, cap=0.045, waist=0.045),
    design("side table", "plinth-round-cream", "round cream pedestal", (0.36, 0.36, 0.62), "modern", plinth_stand, 36, body=m.CREAM, outline="round"),
    design("desk", "plain-birch", "plain birch desk on four legs", (0.65, 1.25, 0.74), "minimal", four_legged_table, 2, top=m.BIRCH, legs=m.BIRCH, thick=0.042, overhang=0.0, apron=0.05),
    design("table", "square-walnut", "square walnut table for two", (0.75, 0.75, 0.75), "modern", four_legged_table, 4, top=m.WALNUT, legs=m.WALNUT, profile="splay", outline="soft", thick=0.055, overhang=0.02, apron=0.06),
)  # fmt: skip
