"""Desks with shelves above them."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def hutch_desk(
    size: Size,
    wood: Material,
    fitting: Material,
    drawers: int = 2,
    shelves: int = 2,
    columns: int = 2,
    depth: float = 0.28,
    back: bool = True,
) -> Parts:
    """A desk between two side panels that carry shelves over its rear half.

    Args:
        size: Its extents.
        wood: What it is made of.
        fitting: What the handles are made of.
        drawers: Under the top, side by side.
        shelves: Boards over the top, the uppermost one included.
        columns: Of the shelves.
        depth: Of the shelves.
        back: Whether the shelves have a back.
    """
    d, w, h = size
    t, desk_h, case = 0.024, 0.75, 0.11
    free = desk_h + 0.34
    x = -d / 2 + depth / 2
    parts = of(
        wood,
        box((d, w, t), 0.005, 2).moved(z=desk_h - t),
        *both_sides(box((d - 0.02, t, desk_h - t), 0.003).moved(-0.01, w / 2 - t / 2)),
        *both_sides(box((depth, t, h - desk_h), 0.003).moved(x, w / 2 - t / 2, desk_h)),
        box((0.016, w - 2 * t, 0.3), 0.002).moved(-d / 2 + 0.03, 0, desk_h - t - 0.3),
    )
    boards = np.linspace(free, h - t, shelves) if shelves > 1 else np.array([h - t])
    parts += of(wood, *(box((depth, w - 2 * t, t * 0.8), 0.003).moved(x, 0, float(z)) for z in boards))
    low = float(boards[0])
    for y in np.linspace(-w / 2, w / 2, columns + 1)[1:-1]:
        parts += of(wood, box((depth - 0.01, t * 0.8, h - low - t), 0.002).moved(x, float(y), low))
    if back:
        parts += of(wood, box((0.01, w - 2 * t, h - desk_h - 0.01), 0.001).moved(-d / 2 + 0.008, 0, desk_h))
    return parts + _drawers(d, w, desk_h - t, case, wood, fitting, drawers)


def _drawers(d: float, w: float, top: float, case: float, wood: Material, fitting: Material, count: int) -> Parts:
    """A row of shallow drawers under a top between side panels."""
    if not count:
        return []
    each = (w - 0.06) / count
    between = tuple(-w / 2 + 0.03 + each * k for k in range(1, count))
    cavity = Cavity((d - 0.05, w - 0.048, case), (-0.01, 0, top - case), wall=0.01, dividers=between)
    parts = cavity.body(wood)
    for k in range(count):
        place = (-w / 2 + 0.03 + each * (k + 0.5), top - case + 0.006, each - 0.008, case - 0.012)
        parts += drawer_front(d / 2 - 0.036, *place, wood, fitting, "knob", cavity.behind(*place))
    return parts


def ladder_desk(
    size: Size, wood: Material, frame: Material, shelves: int = 2, depth: float = 0.5, rise: float = 0.75
) -> Parts:
    """A desk in a ladder against the wall: the boards grow shallower upward.

    Args:
        size: Its extents.
        wood: What the boards are made of.
        frame: What the uprights are made of.
        shelves: Over the desk.
        depth: Of the desk's board.
        rise: Height of the desk's board.
    """
    d, w, h = size
    bar, t = 0.032, 0.022
    x0, y = -d / 2, w / 2 - bar / 2
    reach = d - bar

    def front(z: float) -> float:
        """Front edge of the leaning uprights at a height."""
        return x0 + bar + (reach - 0.11) * (1 - z / h) + 0.1

    parts = of(
        frame,
        *both_sides(taper((front(0.0) - bar / 2, y, 0), (front(h) - bar / 2, y, h), bar, bar, 0.004)),
        *both_sides(box((bar, bar, h - 0.02), 0.003).moved(x0 + bar / 2, y)),
    )
    board = box((depth, w - 2 * bar + 0.006, t), 0.005, 2).moved(x0 + depth / 2, 0, rise - t)
    rim = [box((0.016, w - 2 * bar, 0.06), 0.003).moved(x0 + 0.012, 0, rise)]
    rails = [
        beam((x0 + bar / 2, s * y, rise - 0.03), (x0 + depth - 0.02, s * y, rise - 0.03), bar, 0.04) for s in (1, -1)
    ]
    for z in np.linspace(rise, h - 0.03, shelves + 1)[1:]:
        deep = max(front(float(z)) - x0 - 0.004, 0.1)
        rim.append(box((deep, w - 2 * bar + 0.006, t * 0.8), 0.004).moved(x0 + deep / 2, 0, float(z) - t))
    return parts + of(wood, board, *rim) + of(frame, *rails)


DESIGNS: tuple[Design, ...] = (
    design("desk", "hutch-oak", "oak desk with shelves above", (0.60, 1.20, 1.45), "modern", hutch_desk, wood=m.OAK, fitting=m.BLACK_STEEL),
    design("desk", "hutch-white", "white desk with a tall hutch", (0.58, 1.05, 1.70), "minimal", hutch_desk, wood=m.WHITE, fitting=m.STEEL, drawers=1, shelves=3, columns=2, depth=0.26),
    design("desk", "hutch-cherry", "cherry computer desk with pigeon holes", (0.65, 1.30, 1.35), "classic", hutch_desk, wood=m.CHERRY, fitting=m.BRASS, drawers=3, shelves=2, columns=4, depth=0.30),
    design("desk", "hutch-pine", "pine desk with one open shelf above", (0.55, 1.10, 1.20), "rustic", hutch_desk, wood=m.PINE, fitting=m.IRON, drawers=2, shelves=1, columns=1, depth=0.24, back=False),
    design("desk", "ladder-walnut", "walnut ladder desk", (0.55, 0.75, 1.80), "modern", ladder_desk, wood=m.WALNUT, frame=m.BLACK_STEEL),
    design("desk", "ladder-birch", "white ladder desk with birch boards", (0.50, 0.65, 1.75), "minimal", ladder_desk, wood=m.BIRCH, frame=m.WHITE, shelves=3, depth=0.45),
)  # fmt: skip
