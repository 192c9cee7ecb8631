"""Sofas."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.upholstery.cushions import ArmKind, arm, back_cushion, seat_cushion, tufting


def sofa(
    size: Size,
    cloth: Material,
    legs: Material,
    seats: int = 3,
    arms: ArmKind = "track",
    tufted: bool = False,
    plinth_base: bool = False,
    seat_h: float = 0.44,
    pillows: tuple[Material, ...] = (),
) -> Parts:
    """A sofa or, with one seat, an armchair: base, seat and back cushions, arms."""
    d, w, h = size
    thick = {"track": 0.15, "rolled": 0.19, "slim": 0.085, "pillow": 0.2, "wood": 0.05, "none": 0.0}[arms]
    leg_h = 0.03 if plinth_base else 0.13
    cush = 0.15
    inner, back_t = w - 2 * thick, 0.17
    arm_h = min(seat_h + (0.17 if arms != "rolled" else 0.2), h - 0.05)
    base_h = seat_h - cush + 0.01
    parts = of(cloth, box((d - 0.02, w - (0 if arms == "none" else 0.03), base_h - leg_h), 0.02, 2).moved(0, 0, leg_h))
    frame_h = h - (0.02 if tufted else 0.07)
    parts += of(
        cloth,
        box((back_t, w - 2 * thick * 0.9 if arms != "none" else w, frame_h - leg_h), 0.05, 3).moved(
            -d / 2 + back_t / 2 + 0.005, 0, leg_h
        ),
    )
    parts += of(cloth, *_seats_and_backs(d, inner, h, seats, seat_h, cush, back_t, tufted))
    if arms == "wood":
        parts += _wooden_arms(d, w, arm_h, legs)
    elif arms != "none":
        parts += of(cloth, *both_sides(*(s.moved(0, w / 2 - thick / 2) for s in arm(arms, d, thick, arm_h, leg_h))))
    foot = (
        box((0.06, 0.06, leg_h + 0.01), 0.004)
        if plinth_base
        else taper((0.012, 0.012, 0), (0, 0, leg_h + 0.01), 0.026, 0.044)
    )
    if arms != "wood":
        parts += of(legs, *four(foot.moved(d / 2 - 0.07, w / 2 - 0.08)))
    for k, material in enumerate(pillows):
        side = 1 if k % 2 == 0 else -1
        lying = turned(of(material, pillow((0.42, 0.42, 0.16))), "y", -72)
        parts += [
            p.turned("z", -side * 14).moved(-d / 2 + back_t + 0.24, side * (inner / 2 - 0.25), seat_h + 0.19)
            for p in lying
        ]
    return parts


def _seats_and_backs(
    d: float, inner: float, h: float, seats: int, seat_h: float, cush: float, back_t: float, tufted: bool
) -> list[Solid]:
    each = inner / seats
    seat_d = d - back_t + 0.01
    solids: list[Solid] = []
    for k in range(seats):
        y = -inner / 2 + each * (k + 0.5)
        solids += [s.moved(d / 2 - seat_d / 2, y, seat_h - cush) for s in seat_cushion(seat_d, each - 0.006, cush)]
        if not tufted:
            solids.append(
                back_cushion(each - 0.008, h - seat_h + 0.03, 0.2).moved(-d / 2 + back_t - 0.03, y, seat_h - 0.03)
            )
    return solids + (tufting(inner, h, seat_h, -d / 2 + back_t) if tufted else [])


def _wooden_arms(d: float, w: float, arm_h: float, wood: Material) -> Parts:
    y = w / 2 - 0.025
    rest = bend([(-d / 2 + 0.03, y, arm_h - 0.04), (0, y, arm_h - 0.01), (d / 2 - 0.05, y, arm_h - 0.012)], 5)
    flat = tube(rest, 0.02, 10).scaled(y=1.0)
    posts = [
        taper((d / 2 - 0.05, y, 0), (d / 2 - 0.09, y, arm_h), 0.03, 0.04),
        taper((-d / 2 + 0.02, y, 0), (-d / 2 + 0.1, y, arm_h + 0.06), 0.03, 0.044),
    ]
    rail = beam((-d / 2 + 0.06, y, 0.24), (d / 2 - 0.07, y, 0.24), 0.03, 0.06)
    return of(wood, *both_sides(flat, *posts, rail))


DESIGNS: tuple[Design, ...] = (
    design("sofa", "grey-three", "grey three-seat sofa with track arms", (0.95, 2.10, 0.84), "modern", sofa, cloth=m.GREY_FABRIC, legs=m.OAK),
    design("sofa", "blue-two", "slate blue two-seat sofa", (0.90, 1.60, 0.82), "modern", sofa, cloth=m.BLUE_FABRIC, legs=m.WALNUT, seats=2, arms="slim"),
    design("sofa", "linen-rolled", "linen sofa with rolled arms", (0.98, 2.05, 0.88), "classic", sofa, cloth=m.LINEN, legs=m.DARK_WALNUT, seats=3, arms="rolled", plinth_base=True),
    design("sofa", "leather-tan", "tan leather sofa", (0.92, 1.95, 0.80), "industrial", sofa, cloth=m.TAN_LEATHER, legs=m.BLACK_STEEL, seats=2, arms="slim"),
    design("sofa", "chesterfield", "brown leather chesterfield sofa", (0.92, 2.05, 0.76), "classic", sofa, cloth=m.BROWN_LEATHER, legs=m.DARK_WALNUT, seats=3, arms="rolled", tufted=True),
    design("sofa", "green-plush", "forest green sofa with pillow arms", (1.00, 2.20, 0.82), "modern", sofa, cloth=m.GREEN_FABRIC, legs=m.BLACK, seats=2, arms="pillow", plinth_base=True),
    design("sofa", "oatmeal-low", "low oatmeal three-seat sofa", (1.02, 2.40, 0.74), "minimal", sofa, cloth=m.OATMEAL, legs=m.BLACK, arms="track", plinth_base=True, seat_h=0.4),
    design("sofa", "wood-arm", "sofa with a wooden frame and rust cushions", (0.85, 1.75, 0.82), "rustic", sofa, cloth=m.RUST_FABRIC, legs=m.OAK, seats=3, arms="wood"),
    design("sofa", "daybed", "armless charcoal daybed", (0.88, 1.90, 0.78), "minimal", sofa, cloth=m.CHARCOAL_FABRIC, legs=m.OAK, seats=2, arms="none"),
)  # fmt: skip
