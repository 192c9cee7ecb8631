"""Day beds: a mattress to sit and sleep on, with backs and arms round it."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def mattress(d: float, w: float, thick: float) -> list[Solid]:
    """A bare mattress with piped edges, standing on z = 0."""
    body = prism(rounded_rectangle(d, w, 0.05, 4), thick, 0.025)
    pipes = [
        tube(ring_path(superellipse(d * 0.998, w * 0.998, 22, 52), z), 0.006, 5, closed=True)
        for z in (thick * 0.16, thick * 0.84)
    ]
    return [body, *pipes]


def bolsters(cloth: Material, d: float, w: float, z: float, accent: Material) -> Parts:
    """Cushions along the back and rolls at both ends; sitters face +X."""
    parts: Parts = of(
        cloth,
        *both_sides(cylinder(0.095, d - 0.14, 0.03, 20).turned("y", 90).moved(-d / 2 + 0.08, w / 2 - 0.16, z + 0.09)),
    )
    for k, y in enumerate(np.linspace(-0.26 * w, 0.26 * w, 3)):
        soft = pillow((0.44, 0.5, 0.17)).turned("y", -74).moved(-d / 2 + 0.2, y, z + 0.22)
        parts += of(accent if k == 1 else cloth, soft)
    return parts


def framed_day_bed(
    size: Size, frame: Material, cloth: Material, accent: Material, kind: str, seat_z: float = 0.46
) -> Parts:
    """Sides and back of "slats", "metal" spindles, "panel" or "cane"; the sitter faces +X, the length is along y."""
    d, w, h = size
    bar = 0.05 if kind != "metal" else 0.03
    x, y, thick = d / 2 - bar / 2, w / 2 - bar / 2, 0.19
    rail = seat_z - thick + 0.03
    if kind == "metal":
        post = lathe(
            [
                (0.014, 0),
                (0.016, 0.02),
                (0.016, h - 0.07),
                (0.022, h - 0.05),
                (0.016, h - 0.035),
                (0.024, h - 0.018),
                (0.006, h),
            ],
            12,
        )
        posts = list(four(post.moved(x, y)))
    else:
        posts = list(four(box((bar, bar, h - 0.02), 0.007).moved(x, y)))
    rails = [
        *both_sides(beam((-x, y, rail - 0.05), (x, y, rail - 0.05), 0.026, 0.1)),
        *(beam((f * x, -y, rail - 0.05), (f * x, y, rail - 0.05), 0.026, 0.1) for f in (1, -1)),
        box((2 * x, 2 * y, 0.018), 0.002).moved(0, 0, rail - 0.03),
    ]
    top = h - 0.06
    solid = (
        rod((-x, -y, top), (-x, y, top), 0.014) if kind == "metal" else beam((-x, -y, top), (-x, y, top), 0.04, 0.06)
    )
    ends = [
        rod((-x, f * y, top), (x, f * y, top), 0.014)
        if kind == "metal"
        else beam((-x, f * y, top), (x, f * y, top), 0.04, 0.06)
        for f in (1, -1)
    ]
    fill: list[Solid] = []
    n_back, n_end = int(w / 0.13), int(d / 0.13)
    back_y, end_x = np.linspace(-y + 0.1, y - 0.1, n_back), np.linspace(-x + 0.1, x - 0.1, n_end)
    if kind == "metal":
        fill = [rod((-x, k, rail), (-x, k, top), 0.007, segments=7) for k in back_y] + [
            rod((k, f * y, rail), (k, f * y, top), 0.007, segments=7) for f in (1, -1) for k in end_x
        ]
    elif kind == "slats":
        fill = [box((0.014, 0.045, top - rail), 0.003).moved(-x, k, rail) for k in back_y] + [
            box((0.045, 0.014, top - rail), 0.003).moved(k, f * y, rail) for f in (1, -1) for k in end_x
        ]
    else:
        fill = [
            box((0.014, 2 * y, top - rail), 0.003).moved(-x, 0, rail),
            *both_sides(box((2 * x, 0.014, top - rail), 0.003).moved(0, y, rail)),
        ]
    filling = m.RATTAN if kind == "cane" else frame
    parts = of(frame, *posts, *rails, solid, *ends) + of(filling, *fill)
    parts += of(cloth, *(q.moved(0.005, 0, seat_z - thick) for q in mattress(d - 0.07, w - 0.09, thick)))
    return parts + bolsters(cloth, d - 0.06, w - 0.06, seat_z, accent)


def upholstered_day_bed(
    size: Size, cloth: Material, legs: Material, accent: Material, profile: Leg, seat_z: float = 0.46
) -> Parts:
    """Padded back and arms of one height round a mattress."""
    d, w, h = size
    t = 0.1
    feet = four(leg(profile, d / 2 - 0.09, w / 2 - 0.1, 0.14, 0.045))
    padding = [
        box((t, w, h - 0.12), 0.035, 3).moved(-d / 2 + t / 2, 0, 0.12),
        *both_sides(box((d, t, h - 0.12), 0.035, 3).moved(0, w / 2 - t / 2, 0.12)),
    ]
    front = box((d - t, w - 2 * t + 0.02, 0.16), 0.025, 2).moved(t / 2, 0, 0.12)
    pad = [q.moved(t / 2, 0, seat_z - 0.19) for q in mattress(d - t - 0.01, w - 2 * t - 0.01, 0.19)]
    soft = []
    for k, y in enumerate(np.linspace(-0.27 * w, 0.27 * w, 3)):
        soft.append(
            (
                accent if k == 1 else cloth,
                pillow((0.46, 0.5, 0.18)).turned("y", -73).moved(-d / 2 + t + 0.13, y, seat_z + 0.22),
            )
        )
    return of(legs, *feet) + of(cloth, *padding, front, *pad) + [p for material, q in soft for p in of(material, q)]


def bench_day_bed(size: Size, wood: Material, cloth: Material) -> Parts:
    """A backless couch: a thin mattress with buttons on a low frame, a roll at one end."""
    d, w, h = size
    top = 0.42
    thick = 0.13
    frame = [
        *both_sides(
            beam(
                (-d / 2 + 0.03, w / 2 - 0.03, top - thick - 0.03),
                (d / 2 - 0.03, w / 2 - 0.03, top - thick - 0.03),
                0.03,
                0.06,
            )
        ),
        *(
            beam(
                (f * (d / 2 - 0.03), -w / 2 + 0.02, top - thick - 0.03),
                (f * (d / 2 - 0.03), w / 2 - 0.02, top - thick - 0.03),
                0.03,
                0.06,
            )
            for f in (1, -1)
        ),
        box((d - 0.06, w - 0.06, 0.016), 0.002).moved(0, 0, top - thick - 0.02),
    ]
    legs = four(leg("splay", d / 2 - 0.12, w / 2 - 0.2, top - thick - 0.05, 0.04, 0.12))
    n = 33
    v, u = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, 65), indexing="ij")
    x, y = v * (d / 2 - 0.01), u * (w / 2 - 0.01)
    wave = np.clip(np.cos(np.pi * x / (d / 4)) * np.cos(np.pi * y / (w / 8)), 0, 1) ** 4
    edge = np.clip((1 - u**20) * (1 - v**12), 0, 1) ** 0.5
    upper = np.stack([x, y, top - 0.045 + (0.045 - 0.018 * wave) * edge], axis=-1)
    lower = upper * np.array([1, 1, 0]) + np.array([0, 0, top - thick])
    roll = cylinder(0.09, d - 0.08, 0.03, 22).turned("y", 90).moved(-d / 2 + 0.04, w / 2 - 0.14, h - 0.09)
    return of(wood, *frame, *legs) + of(cloth, shell(upper, lower, 1.0), roll)


DESIGNS: tuple[Design, ...] = (
    design("day bed", "iron", "white iron day bed", (0.98, 2.06, 0.96), "classic", framed_day_bed, frame=m.metal("cream iron", "#d9d2c3", 0.5, 0.1), cloth=m.LINEN, accent=m.BLUE_FABRIC, kind="metal"),
    design("day bed", "steel", "black steel day bed", (0.96, 2.04, 0.92), "industrial", framed_day_bed, frame=m.BLACK_STEEL, cloth=m.GREY_FABRIC, accent=s.COGNAC_LEATHER, kind="metal"),
    design("day bed", "pine", "slatted pine day bed", (1.00, 2.10, 0.92), "rustic", framed_day_bed, frame=m.PINE, cloth=m.OATMEAL, accent=m.RUST_FABRIC, kind="slats"),
    design("day bed", "cane", "light oak day bed with cane sides", (0.98, 2.08, 0.89), "modern", framed_day_bed, frame=m.LIGHT_OAK, cloth=m.WHITE_COTTON, accent=m.OLIVE_FABRIC, kind="cane", seat_z=0.44),
    design("day bed", "velvet", "teal velvet day bed", (1.02, 2.12, 0.92), "modern", upholstered_day_bed, cloth=s.TEAL_VELVET, legs=m.BRASS, accent=s.GOLD_VELVET, profile="taper"),
    design("day bed", "white-panel", "plain white day bed", (0.96, 2.02, 0.87), "minimal", framed_day_bed, frame=m.WHITE, cloth=m.LIGHT_FABRIC, accent=m.LIGHT_FABRIC, kind="panel", seat_z=0.42),
    design("day bed", "bench-black", "black leather day bed on walnut", (0.86, 1.95, 0.60), "modern", bench_day_bed, wood=m.WALNUT, cloth=m.BLACK_LEATHER),
)  # fmt: skip
