"""Cases on feet: bays of doors, drawers and open shelves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.carcass import DrawerSpace, door_front, drawer_front, open_case, plinth
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Parts, Size, both_sides, four, of, shifted, with_role
from diorama_core.library.furniture.solids import box, rod, taper

Base = Literal["legs", "splay", "plinth", "steel", "none"]


Cell = str
"""What fills one bay of a front: "open", "door", "pair" (of doors), or "3" and so on for that many drawers."""


@dataclass(frozen=True)
class _Fronts:
    """How the doors and drawers of one case are made."""

    wood: Material
    pull: Material
    handle: str
    panel: str
    infill: Material | None

    def over(
        self, bay: Cell, x: float, y: float, z: float, w: float, h: float, hinge: int, space: DrawerSpace
    ) -> Parts:
        """What closes one bay, its back on the plane `x`, bottom at `z`; the gap's shadow and free `space` behind it."""
        if bay == "open":
            return []
        shadow = with_role("filler", of(m.SHADOW, box((0.003, w + 0.005, h), 0.001).moved(x, y, z)))
        if bay == "door":
            return shadow + self._door(x, y, z, w, h, hinge)
        if bay == "pair":
            left, right = (self._door(x, y + f * w / 4, z, w / 2 - 0.004, h, f) for f in (1, -1))
            return shadow + left + right
        each = h / int(bay)
        handle = "bar" if self.handle == "tall" else self.handle
        parts = shadow
        for k in range(int(bay)):
            low, height = z + each * k, each - 0.006
            inside = replace(space, low_z=max(low, space.low_z), high_z=min(low + height, space.high_z))
            parts = parts + drawer_front(x, y, low, w, height, self.wood, self.pull, handle, inside)
        return parts

    def _door(self, x: float, y: float, z: float, w: float, h: float, hinge: int) -> Parts:
        return door_front(x, y, z, w, h, self.wood, self.pull, self.handle, hinge, self.panel, self.infill)


def feet(kind: Base, d: float, w: float, height: float, material: Material) -> Parts:
    """What a case stands on."""
    if kind == "plinth":
        return plinth(d, w, height, material)
    if kind == "none":
        return []
    x, y = d / 2 - 0.05, w / 2 - 0.06
    if kind == "splay":
        return of(material, *four(rod((x + 0.015, y + 0.03, 0), (x - 0.02, y - 0.02, height + 0.01), 0.011, 0.02, 14)))
    if kind == "steel":
        bar = both_sides(
            box((d - 0.06, 0.022, 0.022), 0.003).moved(0, y),
            *(box((0.022, 0.022, height), 0.003).moved(s * (x + 0.008), y) for s in (1, -1)),
        )
        return of(material, *bar)
    return of(material, *four(taper((x, y, 0), (x, y, height + 0.01), 0.028, 0.044)))


def case(
    size: Size,
    body: Material,
    bays: Sequence[Cell],
    *,
    front: Material | None = None,
    pull: Material = m.BLACK_STEEL,
    handle: str = "bar",
    base: Base = "legs",
    base_h: float = 0.12,
    legs: Material | None = None,
    top: Material | None = None,
    panel: str = "flat",
    infill: Material | None = None,
    shelves: int = 1,
) -> Parts:
    """A case of bays side by side, each open, with a door, or a stack of drawers."""
    d, w, h = size
    fronts, t, reveal = _Fronts(front or body, pull, handle, panel, infill), 0.02, 0.02
    cap = 0.024 if top is not None else 0.0
    depth = d - reveal - 0.018
    z0, z1 = base_h, h - cap
    parts = feet(base, depth, w, base_h, legs or body)
    inner_w = (w - 2 * t) / len(bays)
    levels = [z0 + t + (z1 - z0 - t) * (k + 1) / (shelves + 1) for k in range(shelves)] if "open" in bays else []
    shell = open_case((depth, w, z1), body, levels, t, base=z0)
    dividers = [
        box((depth - 0.012, t * 0.9, z1 - z0 - 2 * t + 0.004), 0.002).moved(
            -0.004, -w / 2 + t + inner_w * k, z0 + t - 0.002
        )
        for k in range(1, len(bays))
    ]
    solid = [
        box((depth - 0.004, inner_w, z1 - z0 - t), 0.002).moved(-0.002, -w / 2 + t + inner_w * (k + 0.5), z0 + t / 2)
        for k, bay in enumerate(bays)
        if bay != "open"
    ]
    parts += shifted(shell + of(body, *dividers) + with_role("filler", of(body, *solid)), -reveal / 2)
    x = depth / 2 - reveal / 2
    front_w = (w - 0.004) / len(bays)  # fronts lie over the sides and dividers, edge to edge
    for k, bay in enumerate(bays):
        y = -w / 2 + 0.002 + front_w * (k + 0.5)
        place = (x, y, z0 + 0.004, front_w - 0.007, z1 - z0 - 0.008)
        left = -w / 2 + t + inner_w * k
        space = DrawerSpace(depth - 0.03, left + 0.01, left + inner_w - 0.01, z0 + t, z1 - t)
        parts += fronts.over(bay, *place, hinge=1 if k % 2 else -1, space=space)
    if top is not None:
        parts += of(top, box((d, w + 0.02, cap + 0.001), 0.006, 2).moved(z=h - cap - 0.001))
    return parts
