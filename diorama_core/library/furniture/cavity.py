"""Bodies that look solid while closed and are hollow once something in them opens."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from diorama_core.library.furniture.carcass import DrawerSpace
from diorama_core.library.furniture.joints import Joint
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Part, Parts, Size, jointed, of, shifted, with_role
from diorama_core.library.furniture.solids import Solid, box

Hole = tuple[float, float, float, float]
"""Lower and upper limits along the face's two axes: y and z of a front, x and y of a top."""


@dataclass(frozen=True)
class Cavity:
    """A box standing at `foot`, hollow behind the side that opens."""

    size: Size
    foot: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Middle of its lower face."""
    wall: float = 0.016
    opens: Literal["front", "top"] = "front"
    hole: Hole | None = None
    """Part of that side which is open; None for all of it within the walls."""
    dividers: tuple[float, ...] = ()
    """y of upright boards inside."""

    def body(self, material: Material, radius: float = 0.004, segments: int = 1) -> Parts:
        """What is seen while it is closed, and the walls that are there once it opens."""
        closed = of(material, box(self.size, radius, segments))
        return shifted(with_role("filler", closed) + with_role("inside", of(material, *self._walls())), *self.foot)

    def behind(self, y: float, z: float, width: float, height: float) -> DrawerSpace:
        """Free space behind a drawer's front; arguments as those of `drawer_front`."""
        d, w, h = self.size
        _, foot_y, foot_z = self.foot
        edges = sorted((*(foot_y + s * w / 2 for s in (-1, 1)), *self.dividers))
        left = max(e for e in edges if e <= y) + self.wall
        right = min(e for e in edges if e >= y) - self.wall
        return DrawerSpace(
            depth=d - self.wall,
            low_y=max(left, y - width / 2),
            high_y=min(right, y + width / 2),
            low_z=max(foot_z + self.wall, z),
            high_z=min(foot_z + h - self.wall, z + height),
        )

    def _walls(self) -> list[Solid]:
        d, w, h = self.size
        t = self.wall
        sides = [box((d, t, h), 0.001).moved(0, s * (w - t) / 2) for s in (1, -1)]
        boards = [box((d, t, h - 2 * t), 0.001).moved(0, y - self.foot[1], t) for y in self.dividers]
        floor = box((d, w - 2 * t, t), 0.001)
        if self.opens == "front":
            back = box((t, w - 2 * t, h - 2 * t), 0.001).moved(-(d - t) / 2, 0, t)
            return [*sides, *boards, floor, floor.moved(z=h - t), back, *self._front_frame()]
        ends = [box((t, w - 2 * t, h - t), 0.001).moved(s * (d - t) / 2, 0, t) for s in (1, -1)]
        return [*sides, *boards, floor, *ends, *self._top_frame()]

    def _front_frame(self) -> list[Solid]:
        d, w, h = self.size
        x, t = (d - self.wall) / 2, self.wall
        if self.hole is None:
            return []
        y0, y1, z0, z1 = (v - f for v, f in zip(self.hole, (self.foot[1], self.foot[1], self.foot[2], self.foot[2])))
        plates = [(-w / 2, y0, 0.0, h), (y1, w / 2, 0.0, h), (y0, y1, 0.0, z0), (y0, y1, z1, h)]
        return [box((t, b - a, d1 - c), 0.001).moved(x, (a + b) / 2, c) for a, b, c, d1 in plates if b > a and d1 > c]

    def _top_frame(self) -> list[Solid]:
        d, w, h = self.size
        t = self.wall
        if self.hole is None:
            return []
        x0, x1, y0, y1 = (v - f for v, f in zip(self.hole, (self.foot[0], self.foot[0], self.foot[1], self.foot[1])))
        plates = [(-d / 2, x0, -w / 2, w / 2), (x1, d / 2, -w / 2, w / 2), (x0, x1, -w / 2, y0), (x0, x1, y1, w / 2)]
        return [
            box((b - a, d1 - c, t), 0.001).moved((a + b) / 2, (c + d1) / 2, h - t)
            for a, b, c, d1 in plates
            if b > a and d1 > c
        ]


def on_front(front: Parts, more: Parts) -> Parts:
    """A door or a drawer with what is fixed to it: its first part says how it moves."""
    return front + jointed(front[0].joint, more)


def drop_front(x: float, z: float, parts: list[Part]) -> Parts:
    """An oven's door: hinged along its lower edge at the front, let down by a right angle."""
    return jointed(Joint("door", "hinge", (x, 0.0, z), (0.0, 1.0, 0.0), 0.0, RIGHT_ANGLE), parts)


def hinged_lid(x: float, z: float, parts: list[Part], angle_rad: float = 1.4) -> Parts:
    """A lid hinged along its lower edge at the back, lifted at the front."""
    return jointed(Joint("lid", "hinge", (x, 0.0, z), (0.0, -1.0, 0.0), 0.0, angle_rad), parts)


RIGHT_ANGLE = 1.5707963267948966
