"""Swivel chairs with character: bankers' chairs, shells, racing seats, low leather backs, drawing stools."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.seating.moulded_chairs import eased
from diorama_core.library.furniture.seating.office_chairs import castor_star, swivelling
from diorama_core.library.furniture.seating.wooden_chairs import curved_back


def column(seat_z: float, metal: Material) -> Parts:
    """A gas lift from the star to under the seat."""
    return of(
        metal,
        cylinder(0.029, 0.17, 0.004, 16).moved(z=0.09),
        cylinder(0.018, max(seat_z - 0.28, 0.05), 0.003, 14).moved(z=0.24),
        box((0.2, 0.15, 0.035), 0.01).moved(0, 0, seat_z - 0.075),
    )


def bankers_chair(size: Size, wood: Material, pad: Material | None) -> Parts:
    """A wooden swivel chair: dished seat, spindles under a bent arm rail, four wooden feet on castors."""
    d, w, h = size
    seat_z, r = 0.47, 0.46 * min(d, w)
    base = of(wood, *castor_star(r, 4, 0.02)) + column(seat_z, m.IRON)
    parts = of(wood, prism(superellipse(0.48, 0.5, 3.6, 36), 0.04, 0.014).moved(0.02, 0, seat_z - 0.04))
    if pad is not None:
        parts += of(pad, cushion((0.44, 0.46, 0.05), 3.6, 2.6, 10).moved(0.02, 0, seat_z - 0.012))
    t = np.linspace(-1, 1, 29)
    arm_z = seat_z + 0.22 + 0.03 * np.cos(t * np.pi / 2) ** 2
    rail = np.stack(
        [0.2 - 0.44 * np.cos(t * np.pi / 2) ** 0.55, 0.46 * w * np.sin(t * np.pi / 2) ** 1.0, arm_z], axis=1
    )
    parts += of(wood, tube(rail, 0.02, 8))
    crest = curved_back(0.62 * w, h - seat_z - 0.22, 0.09, 0.026, 0.03).moved(-0.24, 0, seat_z + 0.22)
    spindles = [
        rod(
            (0.02 + 0.215 * np.cos(np.pi - 1.75 * k), 0.225 * np.sin(np.pi - 1.75 * k), seat_z - 0.005),
            rail[np.abs(t - k).argmin()],
            0.009,
            0.008,
            7,
        )
        for k in np.linspace(-0.92, 0.92, 11)
    ]
    return base + swivelling(seat_z, parts + of(wood, crest, *spindles))


def shell_desk_chair(size: Size, shell: Material, pad: Material, base: Material) -> Parts:
    """A moulded shell with a seat pad on a castor star."""
    d, w, h = size
    seat_z, r = 0.46, 0.47 * min(d, w)
    path = bend(
        [
            (0.23, 0, seat_z),
            (0.15, 0, seat_z + 0.012),
            (-0.12, 0, seat_z),
            (-0.22, 0, seat_z + 0.1),
            (-0.27, 0, seat_z + 0.24),
            (-0.30, 0, h),
        ],
        6,
    )
    v = np.linspace(0, 1, len(path))[:, None]
    u = np.linspace(-1, 1, 17)[None, :]
    half = 0.43 * w * eased(v, [0, 0.06, 0.15, 0.5, 0.78, 0.93, 1], [0.72, 0.9, 0.98, 1.08, 1.0, 0.8, 0.42])
    wrap = eased(v, [0, 0.2, 0.55, 0.8, 1], [0.01, 0.04, 0.14, 0.1, 0.03])
    x = path[:, :1] + wrap * np.interp(v, [0, 0.45, 0.7, 1], [0.0, 0.4, 1, 1]) * u**2
    z = path[:, 2:] + wrap * np.interp(v, [0, 0.5, 0.7, 1], [0.8, 0.5, 0.0, 0.0]) * u**2
    parts = of(shell, slab(np.stack([x, half * u, z], axis=-1), 0.013))
    parts += of(pad, cushion((0.4, 0.4, 0.045), 4, 2.6, 10).moved(0.03, 0, seat_z + 0.0))
    return swivelling(seat_z, parts) + of(base, *castor_star(r)) + column(seat_z, base)


def racing_chair(size: Size, body: Material, trim: Material) -> Parts:
    """A gaming chair: bucket seat, tall winged back with a head pillow, arms."""
    d, w, h = size
    seat_z, r = 0.48, 0.48 * min(d, w)
    base = of(m.BLACK, *castor_star(r)) + column(seat_z, m.BLACK)
    seat = [cushion((0.5, 0.4, 0.11), 6, 3.2, 8).moved(0.04, 0, seat_z - 0.075)]
    sides = both_sides(cushion((0.48, 0.09, 0.15), 4, 3, 7).moved(0.02, 0.215, seat_z - 0.08))
    bh = h - seat_z - 0.02
    lean, bx = -100.0, -0.24
    back = cushion((bh, 0.36, 0.09), 6, 3.2, 9).turned("y", lean).moved(bx - 0.03, 0, seat_z + bh / 2 + 0.02)
    wing = cushion((bh * 0.5, 0.1, 0.12), 3.5, 3, 7).turned("y", lean).moved(bx - 0.0, 0.205, seat_z + bh * 0.42)
    shoulder = cushion((bh * 0.28, 0.09, 0.1), 3.5, 3, 6).turned("y", lean).moved(bx - 0.07, 0.185, seat_z + bh * 0.78)
    head = cushion((0.13, 0.26, 0.075), 4, 2.4, 6).turned("y", lean).moved(bx - 0.03, 0, seat_z + bh * 0.86)
    lumbar = cushion((0.15, 0.3, 0.075), 4, 2.4, 6).turned("y", lean).moved(bx + 0.055, 0, seat_z + bh * 0.26)
    post = box((0.05, 0.035, 0.21), 0.01, 2).moved(0.0, 0.31, seat_z - 0.04)
    rest = box((0.26, 0.09, 0.03), 0.014, 2).moved(0.01, 0.315, seat_z + 0.17)
    link = box((0.06, 0.1, 0.03), 0.008).moved(0.0, 0.27, seat_z - 0.045)
    turning = (
        of(body, *seat, back)
        + of(trim, *sides, *both_sides(wing, shoulder), head, lumbar)
        + of(m.BLACK, *both_sides(post, rest, link))
    )
    return base + swivelling(seat_z, turning)


def ribbed_chair(size: Size, hide: Material, metal: Material) -> Parts:
    """A thin leather sling stitched across in ribs, on aluminium side frames."""
    d, w, h = size
    seat_z, r = 0.47, 0.47 * min(d, w)
    path = bend(
        [
            (0.26, 0, seat_z - 0.02),
            (0.2, 0, seat_z),
            (-0.12, 0, seat_z - 0.01),
            (-0.2, 0, seat_z + 0.06),
            (-0.29, 0, h - 0.06),
            (-0.33, 0, h),
        ],
        12,
    )
    step = np.cumsum(np.concatenate([[0], np.linalg.norm(np.diff(path, axis=0), axis=1)]))
    even = np.linspace(0, step[-1], 97)
    line = np.stack([np.interp(even, step, path[:, k]) for k in range(3)], axis=1)
    normal = np.gradient(line, axis=0)[:, [2, 1, 0]] * [-1, 0, 1]
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    ribs = 0.006 * np.abs(np.sin(even / step[-1] * np.pi * 19)) ** 0.6
    line = line + normal * ribs[:, None]
    u = np.linspace(-1, 1, 5)[None, :]
    sheet = np.stack(
        [
            np.broadcast_to(line[:, :1], (97, 5)),
            np.broadcast_to(0.38 * w * u, (97, 5)),
            np.broadcast_to(line[:, 2:], (97, 5)),
        ],
        axis=-1,
    )
    edge = np.column_stack([path[:, 0], np.full(len(path), 0.385 * w), path[:, 2]])
    arm = bend(
        [
            (-0.2, 0.39 * w, seat_z + 0.06),
            (-0.22, 0.47 * w, seat_z + 0.2),
            (-0.05, 0.475 * w, seat_z + 0.215),
            (0.14, 0.47 * w, seat_z + 0.19),
            (0.16, 0.4 * w, seat_z + 0.01),
        ],
        5,
    )
    cross = [
        rod((x, 0.385 * w, z), (x, -0.385 * w, z), 0.012) for x, z in ((0.15, seat_z - 0.025), (-0.08, seat_z - 0.03))
    ]
    sling = of(hide, slab(sheet, 0.016))
    sling += of(metal, *both_sides(tube(edge[::3], 0.012, 8), tube(arm, 0.012, 8)), *cross)
    return swivelling(seat_z, sling) + of(metal, *castor_star(r)) + column(seat_z - 0.01, metal)


def drawing_chair(size: Size, seat: Material, steel: Material) -> Parts:
    """A draughtsman's chair: round wooden seat on a screw, a foot ring, a small back on a strap."""
    d, w, h = size
    seat_z = h - 0.34
    r = 0.68 * min(d, w)
    legs = [rod((r, 0, 0.01), (0.06, 0, seat_z * 0.62), 0.013, 0.013).turned("z", 45 + 90 * k) for k in range(4)]
    ring_z = 0.26
    ring_r = r + (0.06 - r) * ring_z / (seat_z * 0.62)
    ring = tube(ring_path(superellipse(2 * ring_r, 2 * ring_r, 2, 32), ring_z), 0.009, 6, closed=True)
    screw = cylinder(0.016, seat_z * 0.55, 0.002, 14).moved(z=seat_z * 0.43)
    hub = cylinder(0.075, 0.03, 0.004, 20).moved(z=seat_z * 0.6)
    plate = cylinder(0.1, 0.012, 0.002, 20).moved(z=seat_z - 0.042)
    strap = tube(
        bend(
            [(-0.06, 0, seat_z - 0.035), (-0.2, 0, seat_z - 0.02), (-0.235, 0, seat_z + 0.1), (-0.25, 0, h - 0.08)], 5
        ),
        0.01,
        8,
    )
    back = curved_back(0.34, 0.15, 0.06, 0.018, 0.015).moved(-0.245, 0, h - 0.15)
    pad = prism(superellipse(0.37, 0.37, 2.2, 36), 0.032, 0.01).moved(0, 0, seat_z - 0.032)
    return of(steel, *legs, ring, screw, hub) + swivelling(seat_z, of(steel, plate, strap) + of(seat, pad, back))


DESIGNS: tuple[Design, ...] = (
    design("office chair", "bankers-oak", "oak banker's chair", (0.64, 0.64, 0.88), "rustic", bankers_chair, wood=m.OAK, pad=None),
    design("office chair", "bankers-mahogany", "mahogany captain's desk chair with a leather seat", (0.65, 0.65, 0.92), "classic", bankers_chair, wood=m.MAHOGANY, pad=m.BROWN_LEATHER),
    design("office chair", "shell-white", "white shell desk chair on castors", (0.60, 0.60, 0.86), "minimal", shell_desk_chair, shell=m.WHITE, pad=m.LIGHT_FABRIC, base=m.CHROME),
    design("office chair", "shell-sage", "sage shell desk chair", (0.58, 0.60, 0.84), "modern", shell_desk_chair, shell=m.SAGE, pad=m.OATMEAL, base=m.BLACK_STEEL),
    design("office chair", "gaming-black", "black and oxblood gaming chair", (0.68, 0.68, 1.26), "modern", racing_chair, body=m.BLACK_LEATHER, trim=s.OXBLOOD_LEATHER),
    design("office chair", "ribbed-black", "ribbed black leather desk chair on aluminium", (0.62, 0.60, 0.96), "minimal", ribbed_chair, hide=m.BLACK_LEATHER, metal=m.CHROME),
    design("office chair", "ribbed-cognac", "ribbed cognac leather office chair", (0.64, 0.61, 1.06), "modern", ribbed_chair, hide=s.COGNAC_LEATHER, metal=m.CHROME),
    design("office chair", "drawing", "draughtsman's chair of pine and black steel", (0.56, 0.56, 0.98), "industrial", drawing_chair, seat=m.PINE, steel=m.BLACK_STEEL),
)  # fmt: skip
