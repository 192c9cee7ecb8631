"""Kitchen islands, counters and wall cabinets in every style."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.kitchen.counters import counter
from diorama_core.library.furniture.storage.special_cabinets import glass_door

SOAPSTONE = m.Material("soapstone", "marble", "#50555a", 0.4, 0.0, 0.8)
QUARTZ = m.Material("white quartz", "speckle", "#dcd9d2", 0.3, 0.0, 0.25)
PEARL = m.paint("pearl grey paint", "#b9bab5")


def island(
    size: Size,
    body: Material,
    top: Material,
    units: tuple[str, ...],
    overhang: float = 0.28,
    panel: str = "flat",
    pull: Material = m.STEEL,
    handle: str = "bar",
) -> Parts:
    """Base units under a deep worktop that reaches over the back for stools."""
    d, w, h = size
    depth = d - overhang
    t = 0.04
    base = counter((depth, w - 0.06, h - 0.012), body, body, units, panel, pull, handle)
    parts = shifted(base, (d - depth) / 2 - 0.01)
    back = box((0.02, w - 0.07, h - t - 0.1), 0.003).moved(-d / 2 + overhang, 0, 0.1)
    parts += of(body, back) + of(top, box((d, w, t + 0.002), 0.008, 2).moved(z=h - t - 0.002))
    if overhang > 0.2:
        parts += of(
            body,
            *both_sides(
                box((overhang * 0.7, 0.035, 0.2), 0.006).moved(-d / 2 + overhang * 0.6, w / 2 - 0.12, h - t - 0.2)
            ),
        )
    return parts


def work_table(size: Size, frame: Material, top: Material, shelf: Material, drawers: bool = True) -> Parts:
    """An open island: thick top on posts, slatted shelf, drawers under the top."""
    d, w, h = size
    metal = frame.metallic > 0.2
    bar = 0.045 if metal else 0.08
    x, y, t = d / 2 - bar / 2 - 0.02, w / 2 - bar / 2 - 0.02, 0.06
    posts = four(box((bar, bar, h - t), 0.006, 2).moved(x, y)) if metal else four(leg("square", x, y, h - t, 0.064))
    rails = [
        *both_sides(beam((-x, y, h - t - 0.08), (x, y, h - t - 0.08), 0.024, 0.16)),
        *(beam((f * x, -y, h - t - 0.08), (f * x, y, h - t - 0.08), 0.024, 0.16) for f in (1, -1)),
    ]
    parts = of(frame, *posts, *rails) + of(top, box((d, w, t), 0.01, 2).moved(z=h - t))
    n = 6
    each = 2 * x / n
    parts += of(frame, *both_sides(beam((-x, y, 0.2), (x, y, 0.2), 0.02, 0.04))) + of(
        shelf, *(box((each - 0.012, 2 * y, 0.022), 0.004).moved(-x + each * (k + 0.5), 0, 0.215) for k in range(n))
    )
    if drawers:
        span = 2 * y - bar - 0.03
        parts += of(frame, box((2 * x - bar, span, 0.14), 0.003).moved(0, 0, h - t - 0.155))
        for k in range(2):
            parts += drawer_front(
                x + 0.014,
                -span / 2 + span / 2 * (k + 0.5),
                h - t - 0.15,
                span / 2 - 0.02,
                0.135,
                frame,
                m.IRON if not metal else m.STEEL,
                "cup",
            )
    return parts


def wall_units(
    size: Size,
    body: Material,
    doors: int,
    panel: str = "flat",
    pull: Material = m.STEEL,
    handle: str = "bar",
    glazed: tuple[int, ...] = (),
    crown: bool = False,
    open_bay: bool = False,
) -> Parts:
    """Cupboards that hang on a wall; some doors glazed, one bay open when asked."""
    d, w, h = size
    cap = 0.05 if crown else 0.0
    t, depth = 0.018, d - 0.02
    bays = doors + (1 if open_bay else 0)
    each = w / bays
    parts: Parts = []
    top = h - cap
    for k in range(bays):
        y = -w / 2 + each * (k + 0.5)
        is_open = open_bay and k == bays // 2
        is_glass = k in glazed
        if is_open or is_glass:
            parts += shifted(open_case((depth, each, top), body, [top / 2 + t / 2], t), -0.01, y)
        else:
            shadow = of(m.SHADOW, box((0.003, each - 0.004, top - 0.004), 0.001).moved(depth / 2 - 0.0105, y, 0.002))
            parts += Cavity((depth, each - 0.001, top), (-0.01, y, 0)).body(body, 0.003) + with_role("filler", shadow)
        if is_open:
            continue
        x = depth / 2 - 0.01
        if is_glass:
            parts += glass_door(x, y, 0.003, each - 0.005, top - 0.006, body, pull, 1 if k % 2 == 0 else -1)
        else:
            parts += door_front(
                x,
                y,
                0.003,
                each - 0.005,
                top - 0.006,
                body,
                pull,
                "tall" if handle == "bar" else handle,
                1 if k % 2 else -1,
                panel,
            )
    if crown:
        parts += of(
            body,
            box((d + 0.02, w + 0.03, 0.034), 0.012, 2).moved(z=h - 0.034),
            box((d, w + 0.006, 0.024), 0.006).moved(z=h - 0.055),
        )
    return parts


def plate_rack(size: Size, wood: Material, metal: Material) -> Parts:
    """An open wall rack: plates stand between dowels, hooks and a ledge below."""
    d, w, h = size
    t = 0.02
    parts = of(
        wood,
        *both_sides(box((d, t, h), 0.006).moved(0, w / 2 - t / 2)),
        *(box((d, w - 0.02, t), 0.004).moved(0, 0, z) for z in (h - t, 0.55 * h, 0.16)),
        box((0.012, w - 0.02, 0.06), 0.003).moved(-d / 2 + 0.01, 0, 0.06),
    )
    bars = [
        rod((x, y, 0.55 * h + t), (x, y, h - t), 0.006, segments=8)
        for x in (0.3 * d, -0.25 * d)
        for y in np.linspace(-w / 2 + 0.06, w / 2 - 0.06, int(w / 0.06))
    ]
    rail = rod((d / 2 - 0.03, -w / 2 + t, 0.11), (d / 2 - 0.03, w / 2 - t, 0.11), 0.006)
    return parts + of(wood, *bars) + of(metal, rail)


DESIGNS: tuple[Design, ...] = (
    design("kitchen counter", "duck-egg-soapstone", "duck egg base units under soapstone", (0.62, 1.80, 0.91), "classic", counter, body=s.DUCK_EGG, top=SOAPSTONE, units=("door", "drawers", "pair"), panel="shaker", pull=m.BRASS, handle="knob"),
    design("kitchen counter", "smoked-quartz", "smoked-oak base units under white quartz", (0.62, 2.40, 0.92), "modern", counter, body=s.SMOKED_OAK, top=QUARTZ, units=("drawers", "pair", "pair", "drawers"), handle="none"),
    design("kitchen counter", "charcoal-concrete", "charcoal base units under concrete", (0.62, 1.50, 0.90), "industrial", counter, body=m.CHARCOAL, top=m.CONCRETE, units=("drawers", "pair"), pull=m.BLACK_STEEL),
    design("kitchen counter", "pine-oak", "pine base units under an oak worktop", (0.60, 1.20, 0.90), "rustic", counter, body=m.PINE, top=m.OAK, units=("door", "drawers"), panel="shaker", pull=m.IRON, handle="knob"),
    design("kitchen counter", "white-sink", "white base units with a sink", (0.62, 1.20, 1.14), "minimal", counter, body=m.WHITE, top=QUARTZ, units=("pair", "drawers"), handle="none", basin=True),
    design("kitchen counter", "sage-sink", "sage base units with a sink under oak", (0.62, 1.50, 1.14), "rustic", counter, body=m.SAGE, top=m.OAK, units=("door", "pair", "drawers"), panel="shaker", pull=m.IRON, handle="cup", basin=True),
    design("kitchen island", "navy-marble", "navy kitchen island under marble", (0.95, 1.80, 0.92), "classic", island, body=m.NAVY, top=m.MARBLE, units=("pair", "drawers", "pair"), panel="shaker", pull=m.BRASS, handle="knob"),
    design("kitchen island", "oak-quartz", "oak kitchen island under white quartz", (0.90, 1.60, 0.91), "modern", island, body=m.LIGHT_OAK, top=QUARTZ, units=("drawers", "pair", "drawers")),
    design("kitchen island", "white-plain", "plain white kitchen island", (0.85, 1.40, 0.90), "minimal", island, body=m.WHITE, top=m.WHITE, units=("drawers", "pair"), handle="none", overhang=0.22),
    design("kitchen island", "steel-reclaimed", "reclaimed-wood island on black steel", (0.75, 1.50, 0.90), "industrial", work_table, 2, frame=m.BLACK_STEEL, top=m.RECLAIMED, shelf=m.RECLAIMED, drawers=False),
    design("kitchen island", "butcher-pine", "pine kitchen work table with drawers", (0.75, 1.30, 0.90), "rustic", work_table, frame=m.CREAM, top=m.PINE, shelf=m.PINE),
    design("kitchen island", "professional", "stainless-steel work table", (0.70, 1.60, 0.90), "industrial", work_table, 2, frame=m.STAINLESS, top=m.STAINLESS, shelf=m.STAINLESS, drawers=False),
    design("wall cabinet", "white-two", "white wall cabinet with two doors", (0.34, 0.80, 0.70), "minimal", wall_units, body=m.WHITE, doors=2, handle="none"),
    design("wall cabinet", "sage-glazed", "sage wall cabinets with a glazed door", (0.35, 1.20, 0.75), "rustic", wall_units, body=m.SAGE, doors=3, panel="shaker", pull=m.IRON, handle="knob", glazed=(1,)),
    design("wall cabinet", "duck-egg-crown", "duck egg wall cabinets under a moulding", (0.35, 1.00, 0.80), "classic", wall_units, body=s.DUCK_EGG, doors=2, panel="shaker", pull=m.BRASS, handle="knob", crown=True),
    design("wall cabinet", "oak-open", "oak wall cabinets with an open bay", (0.34, 1.20, 0.60), "modern", wall_units, body=m.LIGHT_OAK, doors=2, handle="none", open_bay=True),
    design("wall cabinet", "charcoal-steel", "charcoal wall cabinet with glazed steel doors", (0.33, 0.90, 0.65), "industrial", wall_units, body=m.CHARCOAL, doors=2, pull=m.STEEL, glazed=(0, 1)),
    design("wall cabinet", "single-pearl", "pearl grey single wall cupboard", (0.34, 0.45, 0.72), "modern", wall_units, body=PEARL, doors=1, pull=m.STEEL),
    design("wall cabinet", "plate-rack", "pine plate rack", (0.28, 0.85, 0.80), "rustic", plate_rack, wood=m.PINE, metal=m.IRON),
)  # fmt: skip
