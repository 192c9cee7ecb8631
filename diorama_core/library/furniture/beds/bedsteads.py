"""Beds with character: four posters, canopies, storage drawers, wings, rattan, pipes and logs."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.beds.bedding import bedding
from diorama_core.library.furniture.beds.framed_beds import bed
from diorama_core.library.furniture.kit import *


def mattress_on(
    frame_d: float, w: float, top_z: float, thick: float, duvet: Material, throw: Material | None, x: float
) -> Parts:
    """A made mattress whose top is at `top_z`, its middle at `x`."""
    return shifted(bedding(frame_d - 0.05, w - 0.07, top_z, thick, duvet, 1 if w < 1.2 else 2, throw), x)


def side_rails(frame_d: float, w: float, z: float, tall: float, material: Material, x: float = 0.0) -> Parts:
    """Rails round a bed's slats, their upper edge at `z`."""
    return of(
        material,
        *both_sides(box((frame_d, 0.03, tall), 0.007, 2).moved(x, w / 2 - 0.015, z - tall)),
        *(box((0.03, w, tall), 0.007, 2).moved(x + f * (frame_d / 2 - 0.015), 0, z - tall) for f in (1, -1)),
        box((frame_d - 0.04, w - 0.04, 0.02), 0.002).moved(x, 0, z - 0.05),
    )


def four_poster(
    size: Size,
    frame: Material,
    duvet: Material,
    top_z: float,
    thick: float,
    turned: bool,
    throw: Material | None = None,
    drape: Material | None = None,
) -> Parts:
    """Posts to above head height joined by rails; turned and heavy, or plain bars; a hanging drape if given."""
    d, w, h = size
    bar = 0.075 if turned else 0.045 if frame.metallic < 0.2 else 0.03
    x, y = d / 2 - bar / 2, w / 2 - bar / 2
    if turned:
        r = bar / 2
        post = lathe(
            [
                (r * 0.7, 0),
                (r, 0.04),
                (r * 0.6, 0.09),
                (r, 0.12),
                (r, 0.5),
                (r * 0.7, 0.54),
                (r * 0.95, 0.62),
                (r * 0.55, 0.9),
                (r * 0.62, h - 0.3),
                (r * 0.9, h - 0.2),
                (r * 0.5, h - 0.14),
                (r * 0.8, h - 0.08),
                (r * 0.3, h - 0.03),
                (r * 0.45, h),
            ],
            14,
        )
        posts = four(post.moved(x, y))
        rail_z = h - 0.1
    else:
        posts = four(box((bar, bar, h), 0.005).moved(x, y))
        rail_z = h - bar / 2
    canopy = [
        *both_sides(beam((-x, y, rail_z), (x, y, rail_z), bar * 0.7, bar * 0.7)),
        *(beam((f * x, -y, rail_z), (f * x, y, rail_z), bar * 0.7, bar * 0.7) for f in (1, -1)),
    ]
    rail_top = top_z - thick + 0.06
    parts = of(frame, *posts, *canopy) + side_rails(d - bar, w - bar * 0.4, rail_top, 0.16, frame)
    boards = (
        [box((0.03, w - 2 * bar, 0.5), 0.008, 2).moved(-x, 0, top_z - 0.05)]
        if turned
        else [beam((-x, k, rail_top), (-x, k, top_z + 0.42), 0.016, 0.03) for k in np.linspace(-y + 0.14, y - 0.14, 9)]
    )
    boards.append(beam((-x, -y, top_z + 0.44), (-x, y, top_z + 0.44), bar * 0.8, 0.06))
    parts += of(frame, *boards) + mattress_on(d - 2 * bar, w - bar, top_z, thick, duvet, throw, 0.0)
    if drape is not None:
        t = np.linspace(0, 1, 25)
        v = np.linspace(0, 1, 7)[:, None]
        for f in (1, -1):
            wave = 0.02 * np.sin(t * 30)
            sheet = np.stack(
                np.broadcast_arrays(
                    -x + 0.02 + 0.34 * t * (1 - 0.3 * v), f * (y - 0.01) + wave, rail_z - (rail_z - 0.04) * v
                ),
                axis=-1,
            )
            parts += of(drape, slab(sheet if f > 0 else sheet[:, ::-1], 0.006))
    return parts


def storage_bed(
    size: Size,
    wood: Material,
    duvet: Material,
    top_z: float,
    thick: float,
    head: str,
    drawers: int = 2,
    cloth: Material | None = None,
    throw: Material | None = None,
) -> Parts:
    """A bed on a box with drawers in its left side; `head` is "shelf", "panel", "padded" or "none"."""
    d, w, h = size
    head_t = {"shelf": 0.24, "panel": 0.05, "padded": 0.1, "none": 0.0}[head]
    frame_d = d - head_t
    x = -d / 2 + head_t + frame_d / 2
    rail_top = top_z - thick + 0.05
    body = box((frame_d, w - 0.02, rail_top - 0.06), 0.006, 2).moved(x, 0, 0.06)
    foot = box((frame_d - 0.1, w - 0.14, 0.065), 0.003).moved(x)
    parts = of(wood, body) + of(m.SHADOW, foot)
    each = (frame_d - 0.3) / drawers
    for side in (1, -1):
        for k in range(drawers):
            front = drawer_front(0, 0, 0, each - 0.012, rail_top - 0.12, wood, m.STEEL, "strap")
            parts += [
                p.turned("z", 90 * side).moved(x + frame_d / 2 - 0.12 - each * (k + 0.5), side * (w / 2 - 0.018), 0.085)
                for p in front
            ]
    parts += mattress_on(frame_d, w, top_z, thick, duvet, throw, x)
    xb = -d / 2
    if head == "shelf":
        t = 0.022
        parts += of(
            wood,
            box((t, w, h), 0.004).moved(xb + t / 2),
            *both_sides(box((head_t, t, h), 0.004).moved(xb + head_t / 2, w / 2 - t / 2)),
            *(box((head_t, w - 0.02, t), 0.004).moved(xb + head_t / 2, 0, z) for z in (top_z + 0.02, h - t)),
            box((t, w - 0.02, top_z), 0.003).moved(xb + head_t - t / 2),
            box((head_t - 0.02, t, h - top_z - 0.04), 0.003).moved(xb + head_t / 2, 0, top_z + 0.03),
        )
    elif head == "panel":
        parts += of(wood, box((head_t, w, h), 0.012, 2).moved(xb + head_t / 2))
    elif head == "padded":
        parts += of(
            cloth or wood,
            box((0.06, w + 0.04, h), 0.02, 2).moved(xb + 0.03),
            *(
                cushion((h - top_z + 0.02, w / 2 - 0.005, 0.075), 9, 3, 10)
                .turned("y", 90)
                .moved(xb + 0.06, f * w / 4, (h + top_z) / 2 + 0.0)
                for f in (1, -1)
            ),
        )
    return parts


def wing_bed(
    size: Size,
    cloth: Material,
    legs: Material,
    duvet: Material,
    top_z: float,
    thick: float,
    buttons: bool,
    throw: Material | None = None,
) -> Parts:
    """An upholstered bed whose tall headboard has wings."""
    d, w, h = size
    t = 0.1
    frame_d = d - t
    x = -d / 2 + t + frame_d / 2
    rail_top = top_z - thick + 0.07
    parts = of(
        cloth,
        *both_sides(box((frame_d, 0.07, rail_top - 0.1), 0.025, 2).moved(x, w / 2 - 0.035, 0.1)),
        box((0.07, w, rail_top - 0.1), 0.025, 2).moved(d / 2 - 0.035, 0, 0.1),
        box((frame_d - 0.05, w - 0.1, 0.03), 0.004).moved(x, 0, rail_top - 0.06),
    )
    parts += of(legs, *four(cylinder(0.022, 0.11, 0.003, 14, 0.03).moved(d / 2 - 0.08, w / 2 - 0.08)))
    parts += of(
        cloth,
        box((0.09, w + 0.02, h - 0.06), 0.03, 3).moved(-d / 2 + 0.05, 0, 0.06),
        *both_sides(box((0.2, 0.075, h - 0.1), 0.03, 3).moved(-d / 2 + 0.12, w / 2 + 0.0, 0.06)),
    )
    n, rows = 49, 21
    v, u = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, 1, n), indexing="ij")
    y, z = -(u - 0.5) * (w - 0.12), top_z - 0.12 + v * (h - top_z + 0.04)
    pitch = 0.17
    wave = (
        np.clip(np.cos(2 * np.pi * y / pitch) * np.cos(2 * np.pi * (z - top_z) / pitch), 0, 1) ** 2
        if buttons
        else 0.5 + 0.5 * np.cos(2 * np.pi * y / 0.2) ** 8
    )
    edge = np.clip((1 - (2 * u - 1) ** 10) * (1 - (2 * v - 1) ** 10), 0, 1)
    parts += of(cloth, slab(np.stack([-d / 2 + 0.09 + (0.05 - 0.028 * wave) * edge**0.6, y, z], axis=-1), 0.02))
    return parts + mattress_on(frame_d, w - 0.04, top_z, thick, duvet, throw, x)


def woven_bed(
    size: Size,
    wood: Material,
    weave: Material,
    duvet: Material,
    top_z: float,
    thick: float,
    arched: bool = False,
    throw: Material | None = None,
) -> Parts:
    """A wooden frame whose headboard is filled with cane or rope."""
    d, w, h = size
    t = 0.05
    frame_d = d - t
    x = -d / 2 + t + frame_d / 2
    rail_top = top_z - thick + 0.06
    xb = -d / 2 + t / 2
    parts = side_rails(frame_d, w, rail_top, 0.15, wood, x) + of(
        wood,
        *(
            q.moved(x)
            for q in four(
                rod(
                    (frame_d / 2 - 0.06, w / 2 - 0.06, 0),
                    (frame_d / 2 - 0.08, w / 2 - 0.08, rail_top - 0.1),
                    0.018,
                    0.028,
                    14,
                )
            )
        ),
    )
    y, z0 = w / 2 - 0.025, rail_top - 0.1
    a = np.linspace(0, np.pi, 25)
    if arched:
        top = np.column_stack([np.full(25, xb), y * np.cos(a), h - 0.32 + 0.3 * np.sin(a)])
        parts += of(wood, tube(np.vstack([[xb, y, 0.0], top, [xb, -y, 0.0]]), 0.022, 8))
        v = np.linspace(0, 1, 5)[:, None]
        sheet = np.stack(np.broadcast_arrays(xb, y * np.cos(a), z0 + (top[:, 2] - z0) * v), axis=-1)
        parts += of(weave, slab(sheet[:, ::-1], 0.01))
    else:
        parts += of(
            wood,
            *both_sides(box((t, 0.05, h), 0.008, 2).moved(xb, y)),
            *(box((t * 0.8, 2 * y, 0.06), 0.008, 2).moved(xb, 0, z) for z in (z0, h - 0.07)),
            box((t * 0.7, 0.04, h - z0), 0.005).moved(xb, 0, z0),
        )
        parts += of(weave, box((0.01, 2 * y, h - z0 - 0.06), 0.002).moved(xb, 0, z0 + 0.03))
    return parts + mattress_on(frame_d, w, top_z, thick, duvet, throw, x)


def pipe_bed(
    size: Size,
    steel: Material,
    duvet: Material,
    top_z: float,
    thick: float,
    planks: Material | None = None,
    throw: Material | None = None,
    foot: bool = True,
) -> Parts:
    """A frame of steel pipe with ball joints; planks fill the headboard when given."""
    d, w, h = size
    r = 0.019
    x, y = d / 2 - r, w / 2 - r
    rail_top = top_z - thick + 0.06
    foot_h = top_z + 0.14
    head = [
        *both_sides(cylinder(r, h - 0.02, 0.004, 14).moved(-x, y)),
        *(rod((-x, -y, z), (-x, y, z), r * 0.85) for z in (h - 0.03, h - 0.26, rail_top - 0.05)),
    ]
    end = [
        *both_sides(cylinder(r, foot_h, 0.004, 14).moved(x, y)),
        *(
            rod((x, -y, z), (x, y, z), r * 0.85)
            for z in ((foot_h - 0.02, rail_top - 0.05) if foot else (rail_top - 0.05,))
        ),
    ]
    if not foot:
        end = [
            *both_sides(cylinder(r, rail_top - 0.03, 0.004, 14).moved(x, y)),
            rod((x, -y, rail_top - 0.05), (x, y, rail_top - 0.05), r * 0.85),
        ]
    joints = [ball(0.056, 5).moved(-x, f * y, z - 0.028) for f in (1, -1) for z in (h - 0.03, rail_top - 0.05)]
    parts = of(
        steel, *head, *end, *joints, *both_sides(rod((-x, y, rail_top - 0.05), (x, y, rail_top - 0.05), r * 0.85))
    )
    if planks is not None:
        parts += of(
            planks,
            *(
                box((0.022, 2 * y - 0.03, 0.13), 0.005).moved(-x, 0, z)
                for z in np.arange(rail_top + 0.02, h - 0.14, 0.14)
            ),
        )
    else:
        parts += of(
            steel,
            *(
                rod((-x, k, rail_top - 0.05), (-x, k, h - 0.03), 0.008, segments=8)
                for k in np.linspace(-y + 0.12, y - 0.12, int(w / 0.16))
            ),
        )
    return parts + mattress_on(d - 0.06, w, top_z, thick, duvet, throw, 0.0)


OATMEAL_THROW, LINEN_DUVET = m.TAUPE_FABRIC, m.LINEN

DESIGNS: tuple[Design, ...] = (
    design("bed", "four-poster", "mahogany four-poster bed", (2.16, 1.66, 2.05), "classic", four_poster, frame=m.MAHOGANY, duvet=s.SKY_FABRIC, top_z=0.68, thick=0.28, turned=True),
    design("bed", "canopy-black", "black steel canopy bed", (2.10, 1.60, 1.98), "industrial", four_poster, frame=m.BLACK_STEEL, duvet=m.LIGHT_FABRIC, top_z=0.50, thick=0.22, turned=False, throw=m.CHARCOAL_FABRIC),
    design("bed", "canopy-birch", "birch canopy bed with a white drape", (2.12, 1.50, 2.02), "minimal", four_poster, frame=m.BIRCH, duvet=m.WHITE_COTTON, top_z=0.46, thick=0.20, turned=False, drape=m.WHITE_COTTON),
    design("bed", "storage-oak", "oak bed with drawers and a shelf headboard", (2.30, 1.50, 0.98), "modern", storage_bed, wood=m.OAK, duvet=m.BLUE_FABRIC, top_z=0.56, thick=0.20, head="shelf"),
    design("bed", "storage-white", "white storage bed without a headboard", (2.04, 1.42, 0.84), "minimal", storage_bed, wood=m.WHITE, duvet=m.LIGHT_FABRIC, top_z=0.54, thick=0.18, head="none", drawers=3),
    design("bed", "storage-single", "single walnut bed with drawers", (2.06, 0.98, 0.90), "modern", storage_bed, wood=m.WALNUT, duvet=m.OLIVE_FABRIC, top_z=0.52, thick=0.18, head="panel"),
    design("bed", "wing-linen", "buttoned linen bed with a winged headboard", (2.16, 1.72, 1.30), "classic", wing_bed, cloth=m.LINEN, legs=m.DARK_WALNUT, duvet=m.WHITE_COTTON, top_z=0.64, thick=0.27, buttons=True, throw=m.ROSE_FABRIC),
    design("bed", "wing-navy", "navy bed with a channelled headboard", (2.14, 1.90, 1.22), "modern", wing_bed, cloth=m.NAVY_FABRIC, legs=m.BRASS, duvet=m.LIGHT_FABRIC, top_z=0.58, thick=0.24, buttons=False),
    design("bed", "cane-oak", "light oak bed with a cane headboard", (2.08, 1.58, 1.04), "modern", woven_bed, wood=m.LIGHT_OAK, weave=m.RATTAN, duvet=m.WHITE_COTTON, top_z=0.50, thick=0.21, throw=m.RUST_FABRIC),
    design("bed", "rattan-arch", "rattan bed with an arched headboard", (2.06, 1.46, 1.20), "rustic", woven_bed, wood=m.WALNUT, weave=m.WICKER, duvet=m.OATMEAL, top_z=0.52, thick=0.22, arched=True),
    design("bed", "pipe-double", "steel pipe bed with a reclaimed headboard", (2.10, 1.52, 1.08), "industrial", pipe_bed, steel=m.BLACK_STEEL, duvet=m.GREY_FABRIC, top_z=0.55, thick=0.23, planks=m.RECLAIMED, foot=False, throw=m.CHARCOAL_FABRIC),
    design("bed", "pipe-single", "single iron bed", (2.02, 0.96, 1.02), "industrial", pipe_bed, steel=m.IRON, duvet=m.NAVY_FABRIC, top_z=0.52, thick=0.18),
    design("bed", "brass", "brass double bed", (2.06, 1.42, 1.25), "classic", pipe_bed, steel=m.BRASS, duvet=m.WHITE_COTTON, top_z=0.66, thick=0.26, throw=m.BLUE_FABRIC),
    design("bed", "pine-high", "high pine farmhouse bed", (2.14, 1.62, 1.18), "rustic", bed, frame=m.PINE, head="panel", duvet=m.LINEN, throw=m.GREEN_FABRIC, top_z=0.70, foot_h=0.78),
    design("bed", "floor-oak", "very low oak platform bed", (2.20, 1.80, 0.66), "minimal", bed, frame=m.OAK, head="none", duvet=m.CHARCOAL_FABRIC, top_z=0.36),
)  # fmt: skip
