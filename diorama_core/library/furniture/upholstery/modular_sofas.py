"""Sofas put together from corner, seat and chaise modules."""

from __future__ import annotations

from typing import Literal

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.upholstery.cushions import back_cushion, seat_cushion

Layout = Literal["left", "right", "corner", "u"]
"""Where the sofa reaches forward: a chaise at the left or right, a seat round the left corner, or chaises at both."""


def modular_sofa(
    size: Size,
    cloth: Material,
    base: Material,
    layout: Layout,
    arm_t: float = 0.12,
    seat_h: float = 0.43,
    leg_h: float = 0.06,
    seam: bool = True,
) -> Parts:
    """Seats along the back, arms or chaises at the ends.

    Args:
        size: Extents of the whole.
        cloth: Cover.
        base: Plinth or feet.
        layout: Where it reaches forward.
        arm_t: Thickness of the arms.
        seat_h: Height of the seats.
        leg_h: Height of the base under the cover.
        seam: Piping round the seat cushions.
    """
    d, w, h = size
    body, back_t, cush = 0.95, 0.18, 0.17
    wing = 0.92
    left, right = layout in ("left", "corner", "u"), layout in ("right", "u")
    y1 = w / 2 - (wing if left else arm_t)
    y0 = -w / 2 + (wing if right else arm_t)
    xb = -d / 2
    low = seat_h - cush + 0.01
    solids: list[Solid] = [
        box((body, w, low - leg_h), 0.025, 2).moved(xb + body / 2, 0, leg_h),
        box((back_t, w, h - 0.09 - leg_h), 0.05, 3).moved(xb + back_t / 2, 0, leg_h),
    ]
    n = max(round((y1 - y0) / 0.72), 1)
    each = (y1 - y0) / n
    for k in range(n):
        solids += _seat(
            xb + back_t + (body - back_t) / 2,
            y0 + each * (k + 0.5),
            body - back_t + 0.01,
            each - 0.006,
            seat_h,
            cush,
            seam,
        )
        solids.append(
            back_cushion(each - 0.01, h - seat_h + 0.02, 0.2).moved(
                xb + back_t - 0.03, y0 + each * (k + 0.5), seat_h - 0.03
            )
        )
    for side, there in ((1, left), (-1, right)):
        y = side * (w / 2 - wing / 2)
        if not there:
            solids.append(
                box((body, arm_t, seat_h + 0.17 - leg_h), 0.04, 3).moved(
                    xb + body / 2, side * (w / 2 - arm_t / 2), leg_h
                )
            )
            continue
        solids.append(box((d, wing, low - leg_h), 0.025, 2).moved(0, y, leg_h))
        solids += _seat(
            xb + back_t + (d - back_t) / 2,
            y - side * 0.06 * (layout == "corner"),
            d - back_t,
            wing - (0.14 if layout == "corner" else 0.012),
            seat_h,
            cush,
            seam,
        )
        solids.append(back_cushion(wing - 0.03, h - seat_h + 0.02, 0.2).moved(xb + back_t - 0.03, y, seat_h - 0.03))
        if layout == "corner":
            solids.append(
                box((d - 0.02, back_t, h - 0.09 - leg_h), 0.05, 3).moved(0, side * (w / 2 - back_t / 2), leg_h)
            )
            m_ = max(round((d - body) / 0.72), 1)
            for k in range(m_):
                pad = back_cushion((d - body) / m_ - 0.01, h - seat_h + 0.02, 0.2).turned("z", -90)
                solids.append(pad.moved(xb + body + (d - body) / m_ * (k + 0.5), w / 2 - back_t + 0.03, seat_h - 0.03))
    foot = [box((body - 0.14, w - 0.12, leg_h + 0.01), 0.004).moved(xb + body / 2)]
    foot += [
        box((d - 0.14, wing - 0.14, leg_h + 0.01), 0.004).moved(0, f * (w / 2 - wing / 2))
        for f, there in ((1, left), (-1, right))
        if there
    ]
    return of(cloth, *solids) + of(base, *foot)


def _seat(x: float, y: float, d: float, w: float, seat_h: float, cush: float, seam: bool) -> list[Solid]:
    if seam:
        return [q.moved(x, y, seat_h - cush) for q in seat_cushion(d, w, cush)]
    return [cushion((d, w, cush + 0.015), 10, 4.0, 10).moved(x, y, seat_h - cush)]


DESIGNS: tuple[Design, ...] = (
    design("sectional sofa", "chaise-left-grey", "grey sectional sofa with a chaise at its left", (1.70, 2.75, 0.84), "modern", modular_sofa, cloth=m.GREY_FABRIC, base=m.BLACK, layout="left"),
    design("sectional sofa", "chaise-right-blue", "slate blue sectional sofa with a chaise at its right", (1.65, 2.60, 0.82), "modern", modular_sofa, cloth=m.BLUE_FABRIC, base=m.DARK_WALNUT, layout="right"),
    design("sectional sofa", "corner-linen", "linen corner sofa", (2.20, 2.60, 0.86), "classic", modular_sofa, cloth=m.LINEN, base=m.DARK_WALNUT, layout="corner", arm_t=0.2),
    design("sectional sofa", "corner-leather", "cognac leather corner sofa", (2.10, 2.50, 0.80), "industrial", modular_sofa, cloth=s.COGNAC_LEATHER, base=m.BLACK_STEEL, layout="corner", arm_t=0.1, leg_h=0.09),
    design("sectional sofa", "u-oatmeal", "oatmeal U-shaped sofa", (1.75, 3.30, 0.84), "rustic", modular_sofa, cloth=m.OATMEAL, base=m.OAK, layout="u"),
    design("sectional sofa", "low-white", "low pale sectional without piping", (1.80, 3.00, 0.70), "minimal", modular_sofa, cloth=m.LIGHT_FABRIC, base=m.BLACK, layout="right", arm_t=0.2, seat_h=0.38, leg_h=0.03, seam=False),
)  # fmt: skip
