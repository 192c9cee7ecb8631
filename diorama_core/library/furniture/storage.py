"""Night stands, dressers, cabinets, sideboards and media units. All of it empty."""

from __future__ import annotations

from functools import partial

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.carcass import door_front, drawer_front, open_case
from diorama_core.library.furniture.cases import case
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Builder, Design, Parts, Size, four, of, shifted
from diorama_core.library.furniture.solids import box
from diorama_core.library.record import SymmetryFold


def filing_cabinet(size: Size, steel: Material, drawers: int) -> Parts:
    """A steel filing cabinet with label holders."""
    d, w, h = size
    parts = of(
        steel, box((d - 0.03, w, h - 0.02), 0.006, 2).moved(-0.012, 0, 0.02), box((d - 0.08, w - 0.05, 0.03), 0.002)
    )
    each = (h - 0.05) / drawers
    for k in range(drawers):
        z = 0.035 + each * k
        parts += drawer_front(d / 2 - 0.027, 0, z, w - 0.02, each - 0.008, steel, m.STEEL, "cup")
        parts += of(m.WHITE, box((0.003, 0.07, 0.03), 0.001).moved(d / 2 - 0.008, 0, z + each * 0.72))
    return parts


def locker(size: Size, body: Material, doors: int) -> Parts:
    """Steel lockers with vent slots."""
    d, w, h = size
    parts = of(
        body,
        box((d - 0.02, w, h - 0.08), 0.004).moved(-0.01, 0, 0.08),
        *four(box((0.03, 0.03, 0.09), 0.003).moved(d / 2 - 0.05, w / 2 - 0.03)),
    )
    each = w / doors
    for k in range(doors):
        y = -w / 2 + each * (k + 0.5)
        parts += door_front(d / 2 - 0.02, y, 0.1, each - 0.012, h - 0.12, body, m.STEEL, "strap", -1)
        parts += of(
            m.BLACK,
            *(
                box((0.004, each * 0.45, 0.008), 0.001).moved(d / 2 - 0.001, y, z)
                for z in (h - 0.2, h - 0.23, h - 0.26, 0.3, 0.27, 0.24)
            ),
        )
    return parts


def curio(size: Size, wood: Material, levels: int) -> Parts:
    """A glazed display cabinet: closed below, glass doors' frames above, shelves visible."""
    d, w, h = size
    low = 0.38 * h
    lower = case((d, w, low), wood, ["pair"], base="plinth", base_h=0.08, panel="shaker", handle="knob", pull=m.BRASS)
    pitch = (h - low - 0.04) / levels
    upper = open_case(
        (d - 0.05, w - 0.02, h - 0.03), wood, [low + 0.02 + pitch * k for k in range(1, levels)], 0.02, base=low
    )
    x, half = d / 2 - 0.03, (w - 0.02) / 4
    frames: Parts = []
    for s in (1, -1):
        y, hh = s * half, h - low - 0.05
        frames += of(
            wood,
            *(box((0.02, 0.045, hh), 0.003).moved(x, y + f * (half - 0.024), low + 0.012) for f in (1, -1)),
            *(box((0.02, 2 * half - 0.006, 0.045), 0.003).moved(x, y, z) for z in (low + 0.012, h - 0.083)),
            box((0.012, 0.014, hh), 0.002).moved(x, y, low + 0.012),
        )
    return lower + shifted(upper, -0.02) + frames + of(wood, box((d, w + 0.01, 0.035), 0.01, 2).moved(z=h - 0.035))


def _d(
    category: str, name: str, caption: str, size: Size, style: str, build: Builder, symmetry: SymmetryFold = 1
) -> Design:
    return Design(f"{category.replace(' ', '-')}-{name}", category, caption, size, style, build, symmetry)


DESIGNS: tuple[Design, ...] = (
    _d(
        "night stand",
        "oak-drawers",
        "oak night stand with two drawers",
        (0.42, 0.48, 0.55),
        "modern",
        partial(case, body=m.OAK, bays=["2"], base="splay", base_h=0.16),
    ),
    _d(
        "night stand",
        "white-open",
        "white night stand with an open shelf",
        (0.40, 0.45, 0.58),
        "minimal",
        partial(case, body=m.WHITE, bays=["open"], front=m.WHITE, base="legs", base_h=0.14, legs=m.BIRCH),
    ),
    _d(
        "night stand",
        "walnut-knob",
        "walnut bedside cabinet with three drawers",
        (0.44, 0.50, 0.64),
        "classic",
        partial(case, body=m.WALNUT, bays=["3"], base="plinth", base_h=0.06, handle="knob", pull=m.BRASS, top=m.WALNUT),
    ),
    _d(
        "night stand",
        "door-sage",
        "sage bedside cabinet with a panelled door",
        (0.40, 0.44, 0.62),
        "rustic",
        partial(case, body=m.SAGE, bays=["door"], panel="shaker", handle="knob", pull=m.BRASS, top=m.OAK),
    ),
    _d(
        "night stand",
        "steel",
        "steel-legged night stand",
        (0.40, 0.46, 0.52),
        "industrial",
        partial(case, body=m.RECLAIMED, bays=["2"], base="steel", base_h=0.18, legs=m.BLACK_STEEL, handle="cup"),
    ),
    _d(
        "night stand",
        "cane",
        "night stand with a cane door",
        (0.42, 0.48, 0.60),
        "modern",
        partial(
            case,
            body=m.LIGHT_OAK,
            bays=["door"],
            panel="shaker",
            infill=m.RATTAN,
            base="splay",
            base_h=0.18,
            handle="knob",
            pull=m.BRASS,
        ),
    ),
    _d(
        "dresser",
        "oak-six",
        "oak dresser with six drawers",
        (0.48, 1.40, 0.80),
        "modern",
        partial(case, body=m.OAK, bays=["3", "3"], base="splay", base_h=0.16),
    ),
    _d(
        "dresser",
        "white-four",
        "white chest of four drawers",
        (0.46, 0.80, 1.00),
        "minimal",
        partial(case, body=m.WHITE, bays=["4"], base="plinth", base_h=0.06, handle="none"),
    ),
    _d(
        "dresser",
        "mahogany",
        "mahogany chest of five drawers",
        (0.50, 0.92, 1.15),
        "classic",
        partial(
            case, body=m.MAHOGANY, bays=["5"], handle="knob", pull=m.BRASS, base="legs", base_h=0.1, top=m.MAHOGANY
        ),
    ),
    _d(
        "dresser",
        "tallboy",
        "tall narrow chest of drawers",
        (0.42, 0.56, 1.28),
        "modern",
        partial(case, body=m.WALNUT, bays=["6"], base="legs", base_h=0.12),
    ),
    _d(
        "dresser",
        "cream-rustic",
        "cream painted dresser with an oak top",
        (0.48, 1.15, 0.86),
        "rustic",
        partial(case, body=m.CREAM, bays=["3", "3"], handle="cup", pull=m.IRON, base="plinth", base_h=0.07, top=m.OAK),
    ),
    _d(
        "dresser",
        "industrial",
        "reclaimed-wood dresser on steel",
        (0.45, 1.20, 0.82),
        "industrial",
        partial(
            case, body=m.RECLAIMED, bays=["2", "2", "2"], base="steel", base_h=0.14, legs=m.BLACK_STEEL, handle="cup"
        ),
    ),
    _d(
        "cabinet",
        "two-door-white",
        "white two-door cabinet",
        (0.42, 0.82, 0.90),
        "minimal",
        partial(case, body=m.WHITE, bays=["pair"], base="plinth", base_h=0.07),
    ),
    _d(
        "cabinet",
        "shaker-navy",
        "navy cabinet with panelled doors",
        (0.45, 0.95, 1.05),
        "classic",
        partial(
            case,
            body=m.NAVY,
            bays=["pair"],
            panel="shaker",
            handle="knob",
            pull=m.BRASS,
            top=m.OAK,
            base="plinth",
            base_h=0.08,
        ),
    ),
    _d(
        "cabinet",
        "cane-oak",
        "oak cabinet with cane doors",
        (0.42, 0.90, 1.10),
        "modern",
        partial(
            case,
            body=m.LIGHT_OAK,
            bays=["pair"],
            panel="shaker",
            infill=m.RATTAN,
            base="splay",
            base_h=0.18,
            handle="knob",
            pull=m.BRASS,
        ),
    ),
    _d(
        "cabinet",
        "filing",
        "grey steel filing cabinet",
        (0.60, 0.46, 1.02),
        "industrial",
        partial(filing_cabinet, steel=m.LIGHT_GREY, drawers=3),
    ),
    _d(
        "cabinet",
        "low-filing",
        "white pedestal on castors' plinth",
        (0.55, 0.42, 0.60),
        "minimal",
        partial(filing_cabinet, steel=m.WHITE, drawers=3),
    ),
    _d(
        "cabinet",
        "lockers",
        "sage steel lockers",
        (0.45, 0.90, 1.80),
        "industrial",
        partial(locker, body=m.SAGE, doors=3),
    ),
    _d(
        "cabinet",
        "display",
        "glazed walnut display cabinet",
        (0.42, 0.95, 1.90),
        "classic",
        partial(curio, wood=m.WALNUT, levels=4),
    ),
    _d(
        "cabinet",
        "slatted",
        "pine cupboard with louvred doors",
        (0.42, 0.80, 1.20),
        "rustic",
        partial(
            case, body=m.PINE, bays=["pair"], panel="slats", base="plinth", base_h=0.07, handle="knob", pull=m.IRON
        ),
    ),
    _d(
        "sideboard",
        "walnut-long",
        "long walnut sideboard",
        (0.45, 1.75, 0.72),
        "modern",
        partial(
            case, body=m.WALNUT, bays=["door", "3", "door"], base="splay", base_h=0.18, handle="knob", pull=m.BRASS
        ),
    ),
    _d(
        "sideboard",
        "oak-classic",
        "oak sideboard with panelled doors",
        (0.48, 1.50, 0.88),
        "classic",
        partial(
            case,
            body=m.OAK,
            bays=["door", "2", "2", "door"],
            panel="shaker",
            handle="knob",
            pull=m.BRASS,
            base="legs",
            base_h=0.12,
            top=m.OAK,
        ),
    ),
    _d(
        "sideboard",
        "white-minimal",
        "white sideboard without handles",
        (0.42, 1.60, 0.74),
        "minimal",
        partial(case, body=m.WHITE, bays=["door", "door", "door"], handle="none", base="plinth", base_h=0.06),
    ),
    _d(
        "sideboard",
        "rustic",
        "reclaimed-wood sideboard",
        (0.46, 1.40, 0.82),
        "rustic",
        partial(
            case,
            body=m.RECLAIMED,
            bays=["pair", "3"],
            panel="shaker",
            handle="cup",
            pull=m.IRON,
            base="plinth",
            base_h=0.07,
        ),
    ),
    _d(
        "sideboard",
        "cane",
        "black sideboard with cane doors",
        (0.44, 1.55, 0.78),
        "modern",
        partial(
            case,
            body=m.BLACK_WOOD,
            bays=["door", "door", "door"],
            panel="shaker",
            infill=m.RATTAN,
            base="steel",
            base_h=0.16,
            legs=m.BLACK_STEEL,
            handle="knob",
            pull=m.BRASS,
        ),
    ),
    _d(
        "tv stand",
        "oak-open",
        "oak media unit with open bays",
        (0.42, 1.50, 0.50),
        "modern",
        partial(case, body=m.OAK, bays=["door", "open", "door"], base="splay", base_h=0.14, handle="none"),
    ),
    _d(
        "tv stand",
        "white-low",
        "low white television stand",
        (0.40, 1.60, 0.40),
        "minimal",
        partial(case, body=m.WHITE, bays=["1", "1", "1"], handle="none", base="plinth", base_h=0.05),
    ),
    _d(
        "tv stand",
        "industrial",
        "reclaimed-wood media console on steel",
        (0.42, 1.40, 0.52),
        "industrial",
        partial(
            case,
            body=m.RECLAIMED,
            bays=["open", "2", "open"],
            base="steel",
            base_h=0.13,
            legs=m.BLACK_STEEL,
            handle="cup",
        ),
    ),
    _d(
        "tv stand",
        "walnut-slats",
        "walnut media unit with slatted doors",
        (0.44, 1.80, 0.48),
        "modern",
        partial(
            case,
            body=m.WALNUT,
            bays=["door", "door", "door", "door"],
            panel="slats",
            base="legs",
            base_h=0.1,
            handle="none",
        ),
    ),
    _d(
        "tv stand",
        "classic",
        "cherry television cabinet",
        (0.46, 1.25, 0.60),
        "classic",
        partial(
            case,
            body=m.CHERRY,
            bays=["door", "open", "door"],
            panel="shaker",
            handle="knob",
            pull=m.BRASS,
            base="plinth",
            base_h=0.07,
            top=m.CHERRY,
        ),
    ),
)
