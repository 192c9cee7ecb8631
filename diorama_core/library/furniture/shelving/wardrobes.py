"""Wardrobes."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *


def wardrobe(
    size: Size,
    body: Material,
    doors: int,
    front: Material | None = None,
    pull: Material = m.STEEL,
    panel: str = "flat",
    drawers: bool = False,
    crown: bool = False,
    mirror: int | None = None,
) -> Parts:
    """A tall closet with hinged doors."""
    d, w, h = size
    base = 0.08
    low = 0.26 if drawers else 0.0
    cap = 0.06 if crown else 0.0
    depth, width = d - 0.03, w - (0.04 if crown else 0)
    closed = of(body, box((depth, width, h - base - cap), 0.004).moved(-0.012, 0, base))
    boards = [base + low, h - cap - 0.3] if drawers else [h - cap - 0.3]
    hollow = shifted(open_case((depth, width, h - cap), body, boards, base=base), -0.012)
    parts = with_role("filler", closed) + with_role("inside", hollow) + plinth(d - 0.02, w - 0.02, base, body)
    if crown:
        parts += of(
            body,
            box((d, w, 0.04), 0.012, 2).moved(z=h - 0.04),
            box((d - 0.02, w - 0.025, 0.03), 0.006).moved(z=h - 0.065),
        )
    span = w - (0.05 if crown else 0.008)
    each = span / doors
    x = d / 2 - 0.027
    for k in range(doors):
        y = -span / 2 + each * (k + 0.5)
        leaf = door_front(
            x,
            y,
            base + low + 0.005,
            each - 0.005,
            h - base - low - cap - 0.012,
            front or body,
            pull,
            "tall",
            1 if k % 2 else -1,
            panel,
        )
        parts += leaf
        if mirror == k:
            glass = box((0.004, each - 0.08, h - base - 0.16), 0.001).pictured().moved(x + 0.0185, y, base + 0.07)
            parts += jointed(leaf[0].joint, of(m.MIRROR, glass))
    if drawers:
        n = max(doors // 2, 1)
        for k in range(n):
            y, broad = -span / 2 + span / n * (k + 0.5), span / n - 0.06
            space = DrawerSpace(depth - 0.03, y - broad / 2, y + broad / 2, base + 0.02, base + low - 0.02)
            parts += drawer_front(x, y, base + 0.006, span / n - 0.006, low - 0.012, front or body, pull, "bar", space)
    return parts


def sliding_wardrobe(size: Size, body: Material, front: Material, doors: int) -> Parts:
    """A wardrobe with sliding doors in aluminium frames."""
    d, w, h = size
    parts = of(
        body,
        box((d - 0.04, w, h), 0.004).moved(-0.02),
        box((d, w, 0.03), 0.003),
        box((d, w, 0.03), 0.003).moved(z=h - 0.03),
    )
    each = w / doors
    for k in range(doors):
        x = d / 2 - (0.028 if k % 2 else 0.012)
        y = -w / 2 + each * (k + 0.5)
        parts += of(front, box((0.012, each - 0.02, h - 0.07), 0.002).moved(x - 0.003, y, 0.035))
        parts += of(
            m.STEEL,
            *(box((0.018, 0.024, h - 0.06), 0.003).moved(x, y + s * (each / 2 - 0.012), 0.03) for s in (1, -1)),
            *(box((0.015, each - 0.02, 0.022), 0.003).moved(x, y, z) for z in (0.032, h - 0.054)),
        )
    return parts


DESIGNS: tuple[Design, ...] = (
    design("wardrobe", "white-two", "white two-door wardrobe", (0.58, 1.00, 2.00), "minimal", wardrobe, body=m.WHITE, doors=2),
    design("wardrobe", "oak-three", "oak three-door wardrobe with drawers", (0.60, 1.45, 2.02), "modern", wardrobe, body=m.OAK, doors=3, drawers=True, pull=m.BLACK_STEEL),
    design("wardrobe", "armoire", "walnut armoire with a cornice", (0.62, 1.20, 2.08), "classic", wardrobe, body=m.WALNUT, doors=2, panel="shaker", drawers=True, crown=True, pull=m.BRASS),
    design("wardrobe", "sliding", "sliding-door wardrobe in light oak", (0.65, 1.80, 2.10), "modern", sliding_wardrobe, body=m.WHITE, front=m.LIGHT_OAK, doors=2),
    design("wardrobe", "mirror", "white wardrobe with a mirror door", (0.58, 1.50, 2.10), "modern", wardrobe, body=m.WHITE, doors=3, mirror=1),
    design("wardrobe", "rustic", "cream painted rustic wardrobe", (0.58, 1.10, 1.95), "rustic", wardrobe, body=m.CREAM, doors=2, panel="shaker", crown=True, pull=m.IRON),
)  # fmt: skip
