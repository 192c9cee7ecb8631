"""Night stands, dressers, cabinets, sideboards and media units: one case in five styles."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.storage.styled import styled_case


def round_stand(size: Size, wood: Material, pull_metal: Material) -> Parts:
    """A drum with a drawer and an open shelf, on a recessed foot."""
    d, w, h = size
    t = 0.02
    outline = superellipse(d - 0.02, w, 2.3, 44)
    decks = [prism(outline, t, 0.006).moved(-0.01, 0, z) for z in (0.05, 0.42 * h, h - t)]
    back = [box((0.016, 0.5 * w, h - 0.09), 0.004).moved(-0.36 * d, 0, 0.06)]
    sides = [box((0.3 * d, 0.018, h - 0.09), 0.004).moved(-0.1 * d, f * 0.42 * w, 0.06) for f in (1, -1)]
    drum = prism(superellipse(d - 0.05, w - 0.03, 2.3, 44), h - 0.42 * h - 2 * t, 0.003).moved(-0.01, 0, 0.42 * h + t)
    foot = cylinder(0.36 * min(d, w), 0.055, 0.003, 32)
    front = _bowed_front(d - 0.036, w - 0.016, 0.42 * h + 2 * t, h - 2 * t)
    grip = [q.moved(d / 2 - 0.028, 0, 0.71 * h) for q in pull("knob", w)]
    return of(wood, *decks, *back, *sides, drum, foot, front) + of(pull_metal, *grip)


def _bowed_front(d: float, w: float, z0: float, z1: float) -> Solid:
    """A drawer's front that follows the drum."""
    a = np.linspace(-0.9, 0.9, 15)
    reach = (np.abs(np.cos(a)) ** 2.3 + np.abs(np.sin(a)) ** 2.3) ** (-1 / 2.3)
    x, y = np.cos(a) * reach * d / 2 - 0.01, np.sin(a) * reach * w / 2
    v = np.linspace(0, 1, 3)[:, None]
    return slab(np.stack(np.broadcast_arrays(x, y, z0 + (z1 - z0) * v), axis=-1), 0.012)


def leggy_stand(size: Size, style: Style, drawers: int = 1, shelf: bool = True) -> Parts:
    """A small case high on the style's legs, with a shelf low between them."""
    d, w, h = size
    body = 0.14 * drawers + 0.05
    thick = 0.036
    x, y = d / 2 - 0.035, w / 2 - 0.035
    legs = four(leg(style.leg, x - 0.01, y - 0.01, h - 0.03, thick))
    case_ = box((d - 0.05, w - 0.03, body), 0.004).moved(-0.012, 0, h - 0.024 - body)
    parts = (
        of(style.frame, *legs)
        + of(style.wood, case_)
        + of(style.top or style.wood, box((d, w, 0.024), style.edge_m, 2).moved(z=h - 0.024))
    )
    each = (body - 0.012) / drawers
    for k in range(drawers):
        parts += drawer_front(
            d / 2 - 0.04,
            0,
            h - 0.024 - body + 0.006 + each * k,
            w - 0.05,
            each - 0.005,
            style.wood,
            style.fitting,
            style.handle,
        )
    if shelf:
        parts += of(style.wood, box((d - 0.06, w - 0.06, 0.018), 0.004).moved(z=0.16))
    return parts


OAK_MODERN = MODERN.but(wood=m.OAK, frame=m.OAK)
SMOKED = MODERN.but(wood=s.SMOKED_OAK, frame=m.BLACK_STEEL, fitting=m.BLACK_STEEL, base="steel")
CANE = MODERN.but(wood=m.LIGHT_OAK, frame=m.LIGHT_OAK, panel="shaker", infill=m.RATTAN, handle="knob")
PAINTED = CLASSIC.but(wood=s.DUCK_EGG, frame=s.DUCK_EGG, top=m.OAK)
CHERRY = CLASSIC.but(wood=m.CHERRY, frame=m.CHERRY, top=m.CHERRY)
FOREST = CLASSIC.but(wood=s.FOREST, frame=s.FOREST, top=m.WALNUT, base="plinth", base_h=0.08)
BLACK_STEEL = INDUSTRIAL.but(wood=m.CHARCOAL, fitting=m.STEEL, handle="strap")
OAK_RUSTIC = RUSTIC.but(wood=m.OAK, top=m.OAK, panel="slats")
CREAM = RUSTIC.but(wood=m.CREAM, frame=m.CREAM, top=m.PINE)
WHITE = MINIMAL.but(wood=m.WHITE, frame=m.WHITE)
GREY = MINIMAL.but(wood=s.GREY_OAK, base="none", base_h=0.0)

DESIGNS: tuple[Design, ...] = (
    design("night stand", "round-walnut", "round walnut night stand", (0.42, 0.44, 0.52), "modern", round_stand, wood=m.WALNUT, pull_metal=m.BRASS),
    design("night stand", "round-birch", "round birch night stand", (0.38, 0.40, 0.48), "minimal", round_stand, wood=m.BIRCH, pull_metal=m.BIRCH),
    design("night stand", "leggy-cherry", "cherry night stand on turned legs", (0.42, 0.46, 0.68), CHERRY, leggy_stand),
    design("night stand", "leggy-pine", "pine night stand with a low shelf", (0.38, 0.44, 0.60), RUSTIC, leggy_stand),
    design("night stand", "leggy-steel", "reclaimed-wood night stand on steel legs", (0.40, 0.45, 0.56), INDUSTRIAL, leggy_stand),
    design("night stand", "low-white", "low white night stand", (0.40, 0.50, 0.38), WHITE, styled_case, bays=["2"]),
    design("dresser", "tall-oak", "tall oak chest of five drawers", (0.48, 0.80, 1.22), OAK_MODERN, styled_case, bays=["5"]),
    design("dresser", "smoked-wide", "wide smoked-oak dresser on steel", (0.50, 1.60, 0.78), SMOKED, styled_case, bays=["3", "3", "3"]),
    design("dresser", "duck-egg", "duck egg painted dresser with an oak top", (0.48, 1.20, 0.90), PAINTED, styled_case, bays=["4", "4"], base="legs", base_h=0.14),
    design("dresser", "charcoal-locker", "charcoal steel chest of drawers", (0.45, 0.80, 1.05), BLACK_STEEL, styled_case, bays=["4"]),
    design("dresser", "pine-four", "pine chest of four drawers", (0.46, 0.85, 0.92), RUSTIC, styled_case, bays=["4"], top=m.PINE),
    design("dresser", "grey-low", "low grey-oak dresser", (0.46, 1.40, 0.62), GREY, styled_case, bays=["3", "3"]),
    design("cabinet", "forest-tall", "forest green cabinet with panelled doors", (0.45, 0.95, 1.45), FOREST, styled_case, bays=["pair"]),
    design("cabinet", "smoked-drawers", "smoked-oak cabinet of drawers and a door", (0.42, 1.10, 1.00), SMOKED, styled_case, bays=["door", "4"]),
    design("cabinet", "steel-two", "charcoal steel cupboard", (0.42, 0.90, 1.40), BLACK_STEEL, styled_case, bays=["pair"]),
    design("cabinet", "reclaimed", "reclaimed-wood cabinet on a steel base", (0.42, 1.00, 1.10), INDUSTRIAL, styled_case, bays=["pair", "2"], base_h=0.2),
    design("cabinet", "oak-louvred", "oak cupboard with louvred doors", (0.44, 1.00, 1.30), OAK_RUSTIC, styled_case, bays=["pair"], handle="knob"),
    design("cabinet", "birch-low", "low birch cabinet without handles", (0.40, 1.20, 0.65), MINIMAL, styled_case, bays=["pair", "pair"], base="legs", base_h=0.12),
    design("sideboard", "smoked-steel", "smoked-oak sideboard on a steel base", (0.44, 1.80, 0.74), SMOKED, styled_case, bays=["pair", "3", "pair"]),
    design("sideboard", "reclaimed-steel", "reclaimed-wood sideboard on steel", (0.44, 1.60, 0.82), INDUSTRIAL, styled_case, bays=["door", "open", "3"]),
    design("sideboard", "cherry", "cherry sideboard with brass knobs", (0.50, 1.40, 0.92), CHERRY, styled_case, bays=["door", "3", "door"]),
    design("sideboard", "cream-pine", "cream farmhouse sideboard with a pine top", (0.48, 1.50, 0.90), CREAM, styled_case, bays=["door", "2", "2", "door"]),
    design("sideboard", "grey-floating", "plain grey-oak sideboard", (0.42, 1.80, 0.68), GREY, styled_case, bays=["door", "door", "door", "door"]),
    design("tv stand", "cane", "light oak media unit with cane doors", (0.42, 1.60, 0.56), CANE, styled_case, bays=["door", "open", "door"]),
    design("tv stand", "smoked-low", "low smoked-oak media unit", (0.42, 2.00, 0.44), SMOKED, styled_case, bays=["1", "1", "1"]),
    design("tv stand", "pine", "pine television cabinet", (0.45, 1.20, 0.58), RUSTIC, styled_case, bays=["door", "open", "door"], handle="knob"),
    design("tv stand", "oak-slats", "oak television stand with louvred doors", (0.44, 1.50, 0.54), OAK_RUSTIC, styled_case, bays=["door", "open", "door"], handle="knob"),
    design("tv stand", "steel", "charcoal steel media console", (0.40, 1.30, 0.50), BLACK_STEEL, styled_case, bays=["open", "1", "open"]),
    design("tv stand", "grey", "grey-oak television bench", (0.40, 1.80, 0.38), GREY, styled_case, bays=["open", "1", "open"]),
    design("tv stand", "mahogany", "mahogany television cabinet", (0.48, 1.10, 0.64), CLASSIC, styled_case, bays=["pair"]),
)  # fmt: skip
