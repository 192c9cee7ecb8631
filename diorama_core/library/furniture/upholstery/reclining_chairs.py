"""Reclining armchairs, upright and tilted back with the foot rest out."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.upholstery.cushions import ArmKind, arm


def recliner(
    size: Size, cloth: Material, trim: Material, arms: str = "pillow", out: bool = False, rolls: int = 3
) -> Parts:
    """A deep chair whose back is stuffed in rolls; `out` shows the foot rest.

    Args:
        size: Extents; the foot rest is within them.
        cloth: Cover.
        trim: Feet and lever.
        arms: "pillow", "rolled" or "wood".
        out: Tilted, with the foot rest out.
        rolls: Stuffed sections of the back.
    """
    d, w, h = size
    reach = 0.5 if out else 0.0
    body = d - reach
    x0 = -d / 2 + body / 2
    thick = {"pillow": 0.2, "rolled": 0.19, "wood": 0.07}[arms]
    inner, seat_z = w - 2 * thick, 0.47
    base = box((body - 0.14, w - 0.06 - (0.06 if arms == "wood" else 0), 0.26), 0.03, 2).moved(x0, 0, 0.05)
    seat = cushion((body - 0.2, inner, 0.2), 7, 3.4, 12).moved(x0 + 0.08, 0, seat_z - 0.18)
    lean = 118.0 if out else 101.0
    tall = h - seat_z + (0.26 if out else 0.1)
    backs = []
    each = tall / rolls
    for k in range(rolls):
        pad = cushion((each * 1.14, inner + (0.04 if k else 0.0), 0.21), 6, 2.5, 10)
        backs.append(pad.moved(-tall / 2 + each * (k + 0.5)))
    backs.append(box((tall * 0.96, inner + 0.02, 0.12), 0.04, 2).moved(0, 0, -0.02))
    hinge_x = x0 - body / 2 + 0.2
    angle = np.deg2rad(lean - 90)
    stood = [
        b.turned("y", -lean).moved(
            hinge_x - np.sin(angle) * tall / 2 + 0.06, 0, seat_z - 0.12 + np.cos(angle) * tall / 2
        )
        for b in backs
    ]
    parts = of(cloth, base, seat, *stood)
    if arms == "wood":
        y = w / 2 - 0.035
        parts += of(
            trim,
            *both_sides(
                box((body - 0.16, 0.07, 0.03), 0.012, 2).moved(x0 + 0.02, y, 0.6),
                beam((x0 + body / 2 - 0.14, y, 0), (x0 + body / 2 - 0.14, y, 0.6), 0.045, 0.045, 0.008),
                beam((x0 - body / 2 + 0.14, y, 0), (x0 - body / 2 + 0.16, y, 0.6), 0.045, 0.045, 0.008),
                beam((x0 - body / 2 + 0.14, y, 0.2), (x0 + body / 2 - 0.14, y, 0.2), 0.03, 0.06),
            ),
        )
    else:
        kind: ArmKind = "rolled" if arms == "rolled" else "pillow"
        parts += of(
            cloth,
            *both_sides(*(q.moved(x0 + 0.04, w / 2 - thick / 2) for q in arm(kind, body - 0.1, thick, 0.64, 0.06))),
        )
        lever = [
            cylinder(0.035, 0.016, 0.004, 16).turned("x", -90).moved(x0 + 0.12, -w / 2 + 0.005, 0.34),
            rod((x0 + 0.12, -w / 2 - 0.004, 0.34), (x0 + 0.22, -w / 2 - 0.004, 0.4), 0.008),
        ]
        parts += of(trim, *lever)
    if out:
        panel = cushion((0.42, inner * 0.97, 0.12), 7, 3, 10).moved(d / 2 - 0.21, 0, 0.36)
        struts = both_sides(rod((x0 + body / 2 - 0.12, inner * 0.36, 0.24), (d / 2 - 0.24, inner * 0.36, 0.38), 0.012))
        return (
            parts
            + of(cloth, panel)
            + of(m.BLACK_STEEL, *struts)
            + of(trim, box((body - 0.22, w - 0.14, 0.055), 0.004).moved(x0))
        )
    front = cushion((0.3, inner * 0.99, 0.1), 8, 3.2, 9).turned("y", 90).moved(x0 + body / 2 - 0.06, 0, 0.25)
    return parts + of(cloth, front) + of(trim, box((body - 0.22, w - 0.14, 0.055), 0.004).moved(x0))


DESIGNS: tuple[Design, ...] = (
    design("recliner", "grey-out", "grey recliner with its foot rest out", (1.62, 0.90, 0.98), "modern", recliner, cloth=m.GREY_FABRIC, trim=m.BLACK, out=True),
    design("recliner", "navy", "navy reclining armchair", (0.92, 0.88, 1.04), "modern", recliner, cloth=m.NAVY_FABRIC, trim=m.BLACK),
    design("recliner", "brown-rolled", "brown leather recliner with rolled arms", (0.95, 0.94, 1.06), "classic", recliner, cloth=m.BROWN_LEATHER, trim=m.DARK_WALNUT, arms="rolled", rolls=2),
    design("recliner", "cognac-wood", "cognac leather recliner with wooden arms", (0.92, 0.80, 1.02), "industrial", recliner, cloth=s.COGNAC_LEATHER, trim=m.BLACK_STEEL, arms="wood", rolls=3),
    design("recliner", "oak-oatmeal", "oatmeal recliner in an oak frame", (0.94, 0.82, 1.04), "rustic", recliner, cloth=m.OATMEAL, trim=m.OAK, arms="wood", rolls=2),
    design("recliner", "light-plain", "plain light grey reclining chair", (0.90, 0.84, 1.00), "minimal", recliner, cloth=m.LIGHT_FABRIC, trim=m.STEEL, rolls=1),
)  # fmt: skip
