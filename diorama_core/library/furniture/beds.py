"""Beds, made up with mattress, duvet and pillows."""

from __future__ import annotations

from functools import partial
from typing import Literal

import numpy as np

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Builder, Design, Parts, Size, both_sides, four, of
from diorama_core.library.furniture.solids import (
    Solid,
    beam,
    box,
    cushion,
    cylinder,
    lathe,
    pillow,
    prism,
    ring_path,
    rod,
    rounded_rectangle,
    slab,
    taper,
    tube,
)

Head = Literal["none", "panel", "slats", "padded", "channels", "spindles"]


def bedding(d: float, w: float, z: float, thick: float, duvet: Material, pillows: int, throw: Material | None) -> Parts:
    """A mattress with its top at `z`, duvet folded back, pillows at the head (-X), a throw across the foot."""
    parts = of(m.WHITE_COTTON, prism(rounded_rectangle(d, w, 0.07, 5), thick, 0.035).moved(z=z - thick))
    parts += of(duvet, _cover(-0.18 * d, d / 2 + 0.012, w + 0.03, z, 0.06, thick * 0.72, thick * 0.6))
    parts += of(m.WHITE_COTTON, _cover(-0.25 * d, -0.155 * d, w + 0.034, z + 0.026, 0.05, thick * 0.6))
    if throw is not None:
        parts += of(throw, _cover(0.15 * d, 0.38 * d, w + 0.05, z + 0.062, 0.035, thick * 0.9))
    each = w / pillows
    for k in range(pillows):
        y = -w / 2 + each * (k + 0.5)
        plump = pillow((0.46, min(each - 0.05, 0.72), 0.2), 12, 0.03).turned("y", -24)
        parts += of(m.WHITE_COTTON, plump.moved(-d / 2 + 0.25, y, z + 0.06))
    return parts


def _cover(x0: float, x1: float, w: float, z: float, loft_m: float, drop: float, foot_drop: float = 0.0) -> Solid:
    """A blanket over the mattress from x0 to x1, hanging `drop` at both sides and `foot_drop` over the foot end."""
    u = np.linspace(-1, 1, 31)
    v = np.linspace(0, 1, 19)
    half = w / 2
    across = u * (half + drop)
    along = v * (x1 - x0 + foot_drop)
    y, fall_y = np.clip(across, -half, half), np.clip(np.abs(across) - half, 0, None)
    x, fall_x = np.minimum(along, x1 - x0), np.clip(along - (x1 - x0), 0, None)
    gy, gx = np.meshgrid(y, x)
    fy, fx = np.meshgrid(fall_y, fall_x)
    inner = np.clip(1 - (gy / half) ** 4, 0, 1) * np.clip(1 - (2 * gx / (x1 - x0) - 1) ** 6, 0, 1)
    ripple = 0.010 * np.sin(7 * gx + 4 * gy) * np.sin(3.3 * gy - 2 * gx) + 0.005 * np.sin(15 * gx - 9 * gy)
    fold = 0.010 * np.sin(26 * (gx + gy)) + 0.006 * np.sin(41 * (gx - gy))
    side = (fy > 0) * (0.014 + fold * np.clip(fy / max(drop, 1e-6), 0, 1))
    end = (fx > 0) * (0.014 + fold * np.clip(fx / max(foot_drop, 1e-6), 0, 1))
    height = z + loft_m * 0.35 + (0.75 * loft_m + ripple) * inner - np.maximum(fy, fx)
    return slab(np.stack([x0 + gx + end, gy + np.sign(gy) * side, height], axis=-1), 0.024)


def headboard(kind: Head, w: float, h: float, z0: float, material: Material, legs: Material) -> Parts:
    """A headboard with its front on the plane x = 0, from z0 to h."""
    if kind == "padded":
        return of(
            material,
            box((0.09, w, h - z0), 0.035, 3).moved(-0.045, 0, z0),
            cushion((h - z0 - 0.12, w - 0.1, 0.06), 9, 3, 12).turned("y", 90).moved(-0.03, 0, (h + z0) / 2),
        )
    if kind == "channels":
        n = max(int(w / 0.16), 5)
        return of(
            material,
            box((0.05, w, h - z0), 0.02, 2).moved(-0.065, 0, z0),
            *(
                cushion((h - z0 - 0.01, w / n - 0.002, 0.075), 8, 2.6, 8)
                .turned("y", 90)
                .moved(-0.055, -w / 2 + w / n * (k + 0.5), (h + z0) / 2)
                for k in range(n)
            ),
        )
    if kind == "panel":
        return of(
            material,
            box((0.036, w, h - z0), 0.008, 2).moved(-0.03, 0, z0),
            box((0.05, w + 0.02, 0.04), 0.01, 2).moved(-0.03, 0, h - 0.04),
        )
    posts = both_sides(box((0.055, 0.055, h - 0.02), 0.008, 2).moved(-0.03, w / 2 - 0.028))
    rails = [beam((-0.03, -w / 2 + 0.03, z), (-0.03, w / 2 - 0.03, z), 0.03, 0.07, 0.01) for z in (z0 + 0.04, h - 0.05)]
    if kind == "slats":
        n = max(int(w / 0.13), 6)
        bars = [
            box((0.016, 0.06, h - z0 - 0.08), 0.004).moved(-0.03, y, z0 + 0.04)
            for y in np.linspace(-w / 2 + 0.12, w / 2 - 0.12, n)
        ]
        return of(material, *posts, *rails, *bars)
    n = max(int(w / 0.12), 6)
    bars = [
        rod((-0.03, y, z0 + 0.04), (-0.03, y, h - 0.05), 0.009, segments=8)
        for y in np.linspace(-w / 2 + 0.1, w / 2 - 0.1, n)
    ]
    posts_round = both_sides(
        cylinder(0.02, h - 0.02, 0.004, 14).moved(-0.03, w / 2 - 0.028),
        lathe([(0.02, 0), (0.034, 0.02), (0.03, 0.045), (0.01, 0.06)], 14).moved(-0.03, w / 2 - 0.028, h - 0.06),
    )
    hoops = [
        rod((-0.03, -w / 2 + 0.03, z), (-0.03, w / 2 - 0.03, z), 0.014, segments=10) for z in (z0 + 0.04, h - 0.05)
    ]
    return of(legs, *posts_round, *hoops, *bars)


def bed(
    size: Size,
    frame: Material,
    head: Head = "panel",
    duvet: Material = m.LIGHT_FABRIC,
    throw: Material | None = None,
    top_z: float = 0.55,
    foot_h: float = 0.0,
    base: Literal["legs", "box"] = "legs",
    cloth: Material | None = None,
) -> Parts:
    """A bed: head at -X, foot toward +X. `top_z` is the top of the mattress."""
    d, w, h = size
    head_t = {"none": 0.0, "padded": 0.1, "channels": 0.1}.get(head, 0.06)
    x_head = -d / 2 + head_t
    frame_d = d - head_t - (0.05 if foot_h else 0.0)
    middle = x_head + frame_d / 2
    thick = 0.23
    rail_top = top_z - thick + 0.06
    if base == "box":
        parts = of(
            frame,
            box((frame_d, w, rail_top - 0.03), 0.02, 2).moved(middle, 0, 0.03),
            *four(box((0.06, 0.06, 0.04)).moved(frame_d / 2 - 0.1, w / 2 - 0.1)),
        )
    else:
        rails = [
            *both_sides(box((frame_d, 0.03, 0.14), 0.007, 2).moved(middle, w / 2 - 0.015, rail_top - 0.14)),
            *(
                box((0.03, w, 0.14), 0.007, 2).moved(middle + s * (frame_d / 2 - 0.015), 0, rail_top - 0.14)
                for s in (1, -1)
            ),
            box((frame_d - 0.04, w - 0.04, 0.02), 0.002).moved(middle, 0, rail_top - 0.05),
        ]
        legs = [
            s.moved(middle)
            for s in four(
                taper(
                    (frame_d / 2 - 0.04, w / 2 - 0.04, 0),
                    (frame_d / 2 - 0.04, w / 2 - 0.04, rail_top - 0.02),
                    0.04,
                    0.06,
                )
            )
        ]
        parts = of(frame, *rails, *legs)
    parts += [
        p.moved(middle) for p in bedding(frame_d - 0.05, w - 0.07, top_z, thick, duvet, 1 if w < 1.2 else 2, throw)
    ]
    if head != "none":
        z0 = 0.0 if head in ("padded", "channels") else 0.3 if head != "panel" else 0.12
        parts += [
            p.moved(x_head)
            for p in headboard(
                head, w + (0.04 if head in ("padded", "channels") else 0.0), h, z0, cloth or frame, frame
            )
        ]
        if head == "panel":
            parts += of(frame, *both_sides(box((0.05, 0.05, 0.2), 0.005).moved(x_head - 0.03, w / 2 - 0.05)))
    if foot_h:
        parts += [
            p.moved(d / 2 + 0.005)
            for p in headboard(head, w, foot_h, 0.14 if head == "panel" else 0.26, cloth or frame, frame)
        ]
        if head == "panel":
            parts += of(frame, *both_sides(box((0.05, 0.05, 0.2), 0.005).moved(d / 2 - 0.025, w / 2 - 0.05)))
    return parts


def bunk_bed(size: Size, wood: Material, duvet: Material) -> Parts:
    """Two single beds one above the other, with a ladder."""
    d, w, h = size
    posts = four(box((0.065, 0.065, h), 0.008, 2).moved(d / 2 - 0.033, w / 2 - 0.033))
    parts = of(wood, *posts)
    for z in (0.42, h - 0.42):
        rails = [
            *both_sides(box((d - 0.06, 0.028, 0.13), 0.006).moved(0, w / 2 - 0.033, z - 0.2)),
            *(box((0.028, w - 0.06, 0.13), 0.006).moved(s * (d / 2 - 0.033), 0, z - 0.2) for s in (1, -1)),
            box((d - 0.08, w - 0.08, 0.02), 0.002).moved(0, 0, z - 0.14),
        ]
        boards = [
            box((0.022, w - 0.08, 0.09), 0.005).moved(s * (d / 2 - 0.033), 0, zz)
            for s in (1, -1)
            for zz in (z + 0.05, z + 0.22)
        ]
        parts += of(wood, *rails, *boards)
        parts += bedding(d - 0.09, w - 0.1, z, 0.14, duvet, 1, None)
    guard = [
        *(box((d - 0.06, 0.022, 0.08), 0.005).moved(0, -w / 2 + 0.033, h - zz) for zz in (0.12, 0.26)),
        *(box((d * 0.62, 0.022, 0.08), 0.005).moved(-0.17 * d, w / 2 - 0.033, h - zz) for zz in (0.12, 0.26)),
    ]
    x = d / 2 - 0.5
    ladder = [
        beam((x + s * 0.18, w / 2 - 0.01, 0), (x + s * 0.18, w / 2 - 0.01, h - 0.1), 0.045, 0.022) for s in (1, -1)
    ]
    rungs = [
        rod((x - 0.18, w / 2 - 0.01, z), (x + 0.18, w / 2 - 0.01, z), 0.014) for z in np.arange(0.28, h - 0.35, 0.27)
    ]
    return parts + of(wood, *guard, *ladder, *rungs)


def bare_mattress(size: Size, cloth: Material, piping: Material) -> Parts:
    """A mattress on its own."""
    d, w, h = size
    edge = rounded_rectangle(d - 0.012, w - 0.012, 0.07, 5)
    body = prism(rounded_rectangle(d, w, 0.08, 5), h - 0.015, 0.03)
    crown = cushion((d * 0.96, w * 0.96, 0.05), 10, 3, 10).moved(z=h - 0.05)
    return of(cloth, body, crown) + of(
        piping, *(tube(ring_path(edge, z), 0.007, 5, closed=True) for z in (0.022, h - 0.04))
    )


def _bed(name: str, caption: str, size: Size, style: str, build: Builder) -> Design:
    return Design(f"bed-{name}", "bed", caption, size, style, build)


DESIGNS: tuple[Design, ...] = (
    _bed(
        "panel-oak",
        "oak double bed with a panel headboard",
        (2.12, 1.62, 1.02),
        "classic",
        partial(bed, frame=m.OAK, duvet=m.LINEN, throw=m.TAUPE_FABRIC),
    ),
    _bed(
        "low-oak",
        "low oak platform bed without a headboard",
        (2.08, 1.60, 0.66),
        "minimal",
        partial(bed, frame=m.LIGHT_OAK, head="none", duvet=m.WHITE_COTTON, throw=m.GREY_FABRIC, top_z=0.40),
    ),
    _bed(
        "padded-grey",
        "grey upholstered double bed",
        (2.18, 1.70, 1.12),
        "modern",
        partial(bed, frame=m.GREY_FABRIC, head="padded", duvet=m.WHITE_COTTON, throw=m.CHARCOAL_FABRIC, base="box"),
    ),
    _bed(
        "channel-green",
        "forest green bed with a channelled headboard",
        (2.20, 1.66, 1.16),
        "modern",
        partial(bed, frame=m.GREEN_FABRIC, head="channels", duvet=m.LINEN, base="box", top_z=0.54),
    ),
    _bed(
        "slats-walnut",
        "walnut bed with a slatted headboard",
        (2.12, 1.58, 0.98),
        "rustic",
        partial(bed, frame=m.WALNUT, head="slats", duvet=m.OATMEAL, throw=m.RUST_FABRIC),
    ),
    _bed(
        "iron",
        "wrought-iron double bed",
        (2.10, 1.45, 1.15),
        "rustic",
        partial(bed, frame=m.IRON, head="spindles", duvet=m.WHITE_COTTON, throw=m.BLUE_FABRIC, foot_h=0.78, top_z=0.57),
    ),
    _bed(
        "sleigh-mahogany",
        "mahogany bed with head- and footboard",
        (2.18, 1.66, 1.10),
        "classic",
        partial(bed, frame=m.MAHOGANY, head="panel", duvet=m.BEIGE_FABRIC, foot_h=0.68, top_z=0.60),
    ),
    _bed(
        "single-white",
        "white single bed",
        (2.05, 0.98, 0.88),
        "minimal",
        partial(bed, frame=m.WHITE, head="panel", duvet=m.BLUE_FABRIC, top_z=0.50),
    ),
    _bed(
        "single-pine",
        "pine single bed with slats",
        (2.06, 1.00, 0.86),
        "rustic",
        partial(bed, frame=m.PINE, head="slats", duvet=m.OLIVE_FABRIC, top_z=0.48),
    ),
    _bed(
        "divan-king",
        "king-size divan without a headboard",
        (2.05, 1.82, 0.82),
        "modern",
        partial(
            bed, frame=m.TAUPE_FABRIC, head="none", duvet=m.WHITE_COTTON, throw=m.NAVY_FABRIC, base="box", top_z=0.56
        ),
    ),
    _bed(
        "bunk",
        "pine bunk bed with a ladder",
        (2.06, 1.00, 1.62),
        "rustic",
        partial(bunk_bed, wood=m.PINE, duvet=m.LIGHT_FABRIC),
    ),
    _bed(
        "mattress",
        "bare double mattress",
        (2.00, 1.40, 0.24),
        "minimal",
        partial(bare_mattress, cloth=m.WHITE_COTTON, piping=m.GREY_FABRIC),
    ),
)
