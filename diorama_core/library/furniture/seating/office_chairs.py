"""Swivel chairs for desks."""

from __future__ import annotations

from typing import Literal

import numpy as np

from diorama_core.library.furniture.kit import *


def castor_star(r: float, spokes: int = 5, foot: float = 0.015) -> list[Solid]:
    """A base of radius `r` with a castor under the end of every spoke."""
    star: list[Solid] = []
    for k in range(spokes):
        spoke = tube([(0.03, 0, 0.105), (r * 0.6, 0, 0.085), (r - 0.02, 0, 0.07)], [0.026, 0.02, foot], 8)
        wheel = cylinder(0.028, 0.02, 0.006, 16).turned("x", 90)
        star += [
            s.turned("z", 360.0 / spokes * k)
            for s in (
                spoke,
                wheel.moved(r - 0.028, 0.026, 0.028),
                wheel.moved(r - 0.028, -0.006, 0.028),
                rod((r - 0.025, 0, 0.03), (r - 0.025, 0, 0.08), 0.01),
            )
        ]
    return star


def swivelling(seat_z: float, parts: Parts) -> Parts:
    """What turns above the column of a chair whose seat is this high."""
    return jointed(Joint("seat", "swivel", (0.0, 0.0, seat_z - 0.1), (0.0, 0.0, 1.0)), parts)


def office_chair(
    size: Size, cloth: Material, frame: Material, back: Literal["mesh", "padded", "high"], arms: bool = True
) -> Parts:
    """A swivel chair on a five-star base with castors."""
    d, w, h = size
    seat_z, r = 0.47, 0.5 * min(d, w) * 0.96
    star = castor_star(r)
    lift = [cylinder(0.03, 0.2, 0.004, 16).moved(z=0.09), cylinder(0.02, 0.22, 0.003, 16).moved(z=0.22)]
    plate = box((0.22, 0.16, 0.04), 0.012).moved(-0.02, 0, seat_z - 0.1)
    seat = cushion((0.47, min(0.5, 0.82 * w), 0.09), 5, 3.2, 12).moved(0.03, 0, seat_z - 0.07)
    parts = of(frame, plate) + of(cloth, seat)
    bx, bh = -0.22, h - seat_z - 0.06
    width = 0.72 * w if back != "high" else 0.78 * w
    stem = tube(
        bend(
            [
                (-0.1, 0, seat_z - 0.08),
                (-0.25, 0, seat_z - 0.04),
                (bx - 0.065, 0, seat_z + 0.14),
                (bx - 0.075, 0, seat_z + 0.3),
            ],
            5,
        ),
        0.02,
        8,
    )
    v, u = np.meshgrid(np.linspace(0, 1, 11), np.linspace(-1, 1, 15), indexing="ij")
    half = width / 2 * (1 - 0.16 * np.abs(2 * v - 0.9) ** 3) * 1.0
    x = bx + 0.06 * u**2 - 0.09 * v**2 + 0.03 * np.sin(np.pi * v)
    z = seat_z + 0.06 + bh * (0.5 + (v - 0.5) * (1 - 0.10 * np.abs(u) ** 5))
    panel = np.stack([x, -half * u, z], axis=-1)
    thick = {"mesh": 0.014, "padded": 0.05, "high": 0.085}[back]
    rim = np.concatenate([panel[0], panel[1:, -1], panel[-1, -2::-1], panel[-2:0:-1, 0]])
    parts += of(cloth, slab(panel, thick)) + of(frame, stem)
    parts += of(frame if back == "mesh" else cloth, tube(rim, max(0.012, thick / 2), 7, closed=True))
    if arms:
        y = 0.46 * w
        post = tube(
            bend(
                [
                    (-0.05, 0.2, seat_z - 0.07),
                    (-0.03, y * 0.98, seat_z - 0.05),
                    (-0.02, y, seat_z + 0.05),
                    (0.0, y, seat_z + 0.18),
                ],
                4,
            ),
            0.014,
            8,
        )
        parts += of(frame, *both_sides(post, box((0.25, 0.075, 0.03), 0.013, 2).moved(0.0, y, seat_z + 0.175)))
    return of(frame, *star, *lift) + swivelling(seat_z, parts)


DESIGNS: tuple[Design, ...] = (
    design("office chair", "mesh-black", "black mesh office chair", (0.64, 0.64, 1.00), "modern", office_chair, cloth=m.CHARCOAL_FABRIC, frame=m.BLACK, back="mesh"),
    design("office chair", "task-blue", "blue task chair without arms", (0.60, 0.60, 0.92), "minimal", office_chair, cloth=m.BLUE_FABRIC, frame=m.CHARCOAL, back="padded", arms=False),
    design("office chair", "executive", "black leather executive chair", (0.68, 0.68, 1.16), "classic", office_chair, cloth=m.BLACK_LEATHER, frame=m.BLACK, back="high"),
    design("office chair", "task-grey", "grey padded office chair with arms", (0.63, 0.64, 0.96), "modern", office_chair, cloth=m.GREY_FABRIC, frame=m.STEEL, back="padded"),
    design("office chair", "tan", "tan leather desk chair", (0.62, 0.62, 0.94), "industrial", office_chair, cloth=m.TAN_LEATHER, frame=m.BLACK_STEEL, back="padded"),
)  # fmt: skip
