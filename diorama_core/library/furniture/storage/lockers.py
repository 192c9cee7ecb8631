"""Steel lockers."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *


def locker(size: Size, body: Material, doors: int) -> Parts:
    """Steel lockers with vent slots."""
    d, w, h = size
    each = w / doors
    between = tuple(-w / 2 + each * k for k in range(1, doors))
    parts = Cavity((d - 0.02, w, h - 0.08), (-0.01, 0, 0.08), wall=0.008, dividers=between).body(body)
    parts += of(body, *four(box((0.03, 0.03, 0.09), 0.003).moved(d / 2 - 0.05, w / 2 - 0.03)))
    for k in range(doors):
        y = -w / 2 + each * (k + 0.5)
        slots = [
            box((0.004, each * 0.45, 0.008), 0.001).moved(d / 2 - 0.001, y, z)
            for z in (h - 0.2, h - 0.23, h - 0.26, 0.3, 0.27, 0.24)
        ]
        leaf = door_front(d / 2 - 0.02, y, 0.1, each - 0.012, h - 0.12, body, m.STEEL, "strap", -1)
        parts += on_front(leaf, of(m.BLACK, *slots))
    return parts


DESIGNS: tuple[Design, ...] = (
    design("locker", "lockers", "sage steel lockers", (0.45, 0.90, 1.80), "industrial", locker, id="cabinet-lockers", body=m.SAGE, doors=3),
)  # fmt: skip
