"""Filing, display, shoe and pantry cabinets, and lockers."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.storage.filing_cabinets import filing_cabinet
from diorama_core.library.furniture.storage.lockers import locker
from diorama_core.library.furniture.storage.styled import styled_case


def wooden_files(size: Size, style: Style, drawers: int, columns: int = 1) -> Parts:
    """Deep file drawers with label frames in a wooden case."""
    d, w, h = size
    cap = 0.026
    base_h = 0.06
    depth = d - 0.036
    x, each_w, each_h = depth / 2 - 0.01, (w - 0.03) / columns, (h - base_h - cap - 0.02) / drawers
    between = tuple(-w / 2 + 0.015 + each_w * c for c in range(1, columns))
    cavity = Cavity((depth, w, h - base_h - cap), (-0.01, 0, base_h), dividers=between)
    parts = plinth(depth, w, base_h, style.wood) + cavity.body(style.wood)
    parts += of(style.top or style.wood, box((d, w + 0.02, cap), style.edge_m, 2).moved(z=h - cap))
    for c in range(columns):
        y = -w / 2 + 0.015 + each_w * (c + 0.5)
        for k in range(drawers):
            z = base_h + 0.01 + each_h * k
            space = cavity.behind(y, z, each_w - 0.008, each_h - 0.008)
            front = drawer_front(x, y, z, each_w - 0.008, each_h - 0.008, style.wood, style.fitting, "cup", space)
            frame = [box((0.004, 0.085, 0.005), 0.001).moved(x + 0.019, y, z + each_h * 0.72 + f) for f in (0, 0.034)]
            paper = box((0.002, 0.075, 0.03), 0.0005).moved(x + 0.019, y, z + each_h * 0.72 + 0.005)
            parts += on_front(front, of(style.fitting, *frame) + of(m.PAPER, paper))
    return parts


def glass_door(
    x: float,
    y: float,
    z: float,
    w: float,
    h: float,
    frame: Material,
    metal: Material,
    side: int,
    bars: int = 0,
    rail: float = 0.045,
) -> Parts:
    """A glazed door, its back on the plane `x`; `bars` cross the glass; the handle is toward `side`."""
    t = 0.02
    stiles = [box((t, rail, h), 0.003).moved(x + t / 2, y + f * (w - rail) / 2, z) for f in (1, -1)]
    rails = [box((t, w, rail), 0.003).moved(x + t / 2, y, zz) for zz in (z, z + h - rail)]
    cross = [
        box((t * 0.6, w - 2 * rail, 0.014), 0.002).moved(x + t / 2, y, z + h * (k + 1) / (bars + 1))
        for k in range(bars)
    ]
    pane = box((0.004, w - 2 * rail + 0.01, h - 2 * rail + 0.01), 0.001).moved(x + t * 0.35, y, z + rail - 0.005)
    knob = [q.moved(x + t, y + side * (w / 2 - rail / 2), z + h * 0.45) for q in pull("knob", w)]
    return of(frame, *stiles, *rails, *cross) + of(m.GLASS, pane) + of(metal, *knob)


def display_cabinet(
    size: Size,
    style: Style,
    levels: int,
    low: float = 0.0,
    bars: int = 0,
    doors: int = 2,
    crown: bool = False,
    lit_back: Material | None = None,
) -> Parts:
    """Shelves behind glass, glass at the sides too; with a closed part below when `low` is given.

    Args:
        size: Extents.
        style: Woods and fittings.
        levels: Compartments behind the glass.
        low: Height of the closed part's top, as a share of the height; 0 stands it on the style's feet.
        bars: Glazing bars across each door.
        doors: Glazed doors.
        crown: A moulding round the top.
        lit_back: Material of the back.
    """
    d, w, h = size
    cap = 0.045 if crown else 0.0
    if low:
        parts = styled_case(
            (d, w - 0.02 * crown, low * h),
            style,
            ["pair"] if w < 1.1 else ["pair", "pair"],
            top=style.wood,
            base="plinth",
            base_h=0.07,
        )
        z0 = low * h
    else:
        z0 = 0.16 if style.base in ("splay", "legs", "steel") else 0.06
        parts = feet(style.base if style.base != "none" else "plinth", d - 0.04, w, z0, style.frame)
    depth, width, top = d - 0.04 - 0.02 * crown, w - 0.03 * crown, h - cap
    t, post = 0.022, 0.04
    boards = [box((depth, width, t), 0.003).moved(-0.02, 0, z) for z in (z0, top - t)]
    posts = both_sides(
        *(
            box((post, 0.024, top - z0), 0.003).moved(-0.02 + f * (depth - post) / 2, width / 2 - 0.012, z0)
            for f in (1, -1)
        )
    )
    pitch = (top - z0 - t) / levels
    shelves = [
        box((depth - 0.03, width - 0.05, 0.012), 0.002).moved(-0.02, 0, z0 + t + pitch * k - 0.012)
        for k in range(1, levels)
    ]
    side = both_sides(
        box((depth - 2 * post + 0.01, 0.004, top - z0 - 2 * t), 0.001).moved(-0.02, width / 2 - 0.012, z0 + t)
    )
    back = box((0.01, width - 0.02, top - z0 - 0.02), 0.002).moved(-d / 2 + 0.012, 0, z0 + 0.01)
    glassy = style.name in ("modern", "minimal", "industrial")
    parts += (
        of(style.wood, *boards)
        + of(style.frame if style.name == "industrial" else style.wood, *posts)
        + of(lit_back or style.wood, back)
    )
    parts += of(m.GLASS, *side) + of(m.GLASS if glassy else style.wood, *shelves)
    each = (width - 0.004) / doors
    for k in range(doors):
        frame = style.frame if style.name == "industrial" else style.wood
        parts += glass_door(
            depth / 2 - 0.02,
            -width / 2 + 0.002 + each * (k + 0.5),
            z0 + 0.004,
            each - 0.004,
            top - z0 - 0.008,
            frame,
            style.fitting,
            1 if k % 2 == 0 else -1,
            bars,
            0.028 if glassy else 0.05,
        )
    if crown:
        parts += of(
            style.wood,
            box((d, w, 0.03), 0.012, 2).moved(z=h - 0.03),
            box((d - 0.025, w - 0.02, 0.02), 0.006).moved(z=h - 0.048),
        )
    return parts


def tilting_shoe_cabinet(size: Size, style: Style, flaps: int, columns: int = 1) -> Parts:
    """A shallow cabinet whose fronts tilt out."""
    d, w, h = size
    cap, base_h = 0.024, 0.08
    depth = d - 0.03
    parts = feet("legs" if style.leg != "steel" else "steel", depth, w, base_h, style.frame)
    parts += of(style.wood, box((depth, w, h - base_h - cap), 0.004).moved(-0.01, 0, base_h)) + of(
        style.top or style.wood, box((d, w + 0.016, cap), style.edge_m, 2).moved(z=h - cap)
    )
    x, each, tall = depth / 2 - 0.01, (w - 0.02) / columns, (h - base_h - cap - 0.012) / flaps
    for c in range(columns):
        y = -w / 2 + 0.01 + each * (c + 0.5)
        for k in range(flaps):
            z = base_h + 0.006 + tall * k
            parts += of(m.SHADOW, box((0.003, each - 0.002, tall), 0.001).moved(x, y, z)) + of(
                style.wood, box((0.018, each - 0.008, tall - 0.007), 0.004, 2).moved(x + 0.009, y, z)
            )
            if style.infill is not None:
                parts += of(style.infill, box((0.004, each - 0.09, tall - 0.1), 0.001).moved(x + 0.018, y, z + 0.045))
            handle = "bar" if style.handle == "none" else style.handle
            parts += of(style.fitting, *(q.moved(x + 0.018, y, z + tall - 0.05) for q in pull(handle, each)))
    return parts


def shoe_rack(size: Size, slats: Material, frame: Material, levels: int, bench: Material | None = None) -> Parts:
    """Slatted shelves for shoes in an open frame; with a padded seat on top when `bench` is given."""
    d, w, h = size
    top = h - (0.07 if bench is not None else 0.0)
    metal = frame.metallic > 0.2
    bar = 0.022 if metal else 0.034
    posts = four(box((bar, bar, top), 0.004).moved(d / 2 - bar / 2, w / 2 - bar / 2))
    parts = of(frame, *posts)
    for z in np.linspace(0.1, top - 0.024, levels):
        xs = np.linspace(-d / 2 + 0.03, d / 2 - 0.03, 5)
        parts += of(frame, *both_sides(box((d - 0.01, bar * 0.8, bar), 0.003).moved(0, w / 2 - bar / 2, z - bar)))
        parts += of(
            slats,
            *(
                rod((x, -w / 2 + 0.01, z), (x, w / 2 - 0.01, z), 0.007, segments=8)
                if metal and slats.metallic > 0.2
                else box((0.045, w - 0.02, 0.014), 0.003).moved(x, 0, z - 0.004)
                for x in xs
            ),
        )
    if bench is not None:
        parts += of(bench, cushion((d, w, 0.08), 12, 3.6, 12).moved(z=h - 0.08))
    return parts


def pantry(size: Size, style: Style, split: float = 0.46, glazed: bool = False) -> Parts:
    """A tall kitchen cupboard: doors above, doors or drawers below, under a moulding where the style has one."""
    d, w, h = size
    cap = 0.05 if style.name in ("classic", "rustic") else 0.0
    low = styled_case(
        (d, w, split * h),
        style,
        ["pair"] if style.name != "industrial" else ["3"],
        base="plinth",
        base_h=0.09,
        top=None,
    )
    high_h = h - cap - split * h
    shift = 0.0
    high = styled_case(
        (d, w, high_h),
        style,
        ["pair"],
        base="none",
        base_h=0.0,
        top=None,
        infill=m.GLASS if glazed else style.infill,
        panel="shaker" if glazed else style.panel,
    )
    parts = low + shifted(high, shift, 0, split * h)
    if cap:
        parts += of(
            style.wood,
            box((d + 0.02, w + 0.03, 0.034), 0.012, 2).moved(z=h - 0.034),
            box((d, w + 0.01, 0.022), 0.006).moved(z=h - 0.054),
        )
    return parts


OAK_MODERN = MODERN.but(wood=m.OAK, frame=m.OAK)
SMOKED = MODERN.but(wood=s.SMOKED_OAK, frame=m.BLACK_STEEL, fitting=m.BLACK_STEEL, base="steel")
CANE = MODERN.but(wood=m.LIGHT_OAK, frame=m.LIGHT_OAK, infill=m.RATTAN, handle="knob")
STEEL = INDUSTRIAL.but(wood=m.CHARCOAL, fitting=m.STEEL)
WHITE = MINIMAL.but(wood=m.WHITE, frame=m.WHITE)
DUCK = CLASSIC.but(wood=s.DUCK_EGG, frame=s.DUCK_EGG, top=m.OAK)
CREAM = RUSTIC.but(wood=m.CREAM, frame=m.CREAM, handle="knob")

DESIGNS: tuple[Design, ...] = (
    design("filing cabinet", "oak-two", "oak filing cabinet with two drawers", (0.56, 0.46, 0.74), RUSTIC.but(wood=m.OAK), wooden_files, drawers=2),
    design("filing cabinet", "walnut-lateral", "walnut lateral file", (0.48, 0.92, 0.76), MODERN.but(handle="cup"), wooden_files, drawers=2),
    design("filing cabinet", "mahogany-four", "mahogany filing cabinet with four drawers", (0.60, 0.48, 1.32), CLASSIC, wooden_files, drawers=4),
    design("filing cabinet", "steel-four", "tall charcoal steel filing cabinet", (0.62, 0.47, 1.32), "industrial", filing_cabinet, steel=m.CHARCOAL, drawers=4),
    design("filing cabinet", "cards", "oak card-index cabinet", (0.45, 0.92, 1.05), RUSTIC.but(wood=m.OAK, fitting=m.BRASS), wooden_files, drawers=6, columns=3),
    design("display cabinet", "mahogany-crown", "mahogany china cabinet with glazing bars", (0.44, 1.15, 2.05), CLASSIC, display_cabinet, levels=4, low=0.4, bars=3, crown=True),
    design("display cabinet", "steel-glass", "black steel and glass cabinet", (0.40, 0.90, 1.75), INDUSTRIAL, display_cabinet, levels=4, bars=3),
    design("display cabinet", "oak-hutch", "oak kitchen hutch with glazed doors", (0.45, 1.30, 1.95), RUSTIC.but(wood=m.OAK), display_cabinet, levels=3, low=0.45, bars=1, doors=3, crown=True),
    design("display cabinet", "walnut-splay", "walnut glass cabinet on splayed legs", (0.40, 1.00, 1.50), MODERN, display_cabinet, levels=3),
    design("display cabinet", "white-tall", "narrow white vitrine", (0.36, 0.45, 1.70), WHITE, display_cabinet, levels=5, doors=1),
    design("shoe cabinet", "oak-tilting", "oak shoe cabinet with tilting fronts", (0.26, 0.80, 1.10), CANE, tilting_shoe_cabinet, flaps=3),
    design("shoe cabinet", "white-slim", "slim white shoe cabinet", (0.20, 0.70, 1.20), WHITE, tilting_shoe_cabinet, flaps=4),
    design("shoe cabinet", "duck-egg", "duck egg shoe cabinet with an oak top", (0.30, 1.00, 0.86), DUCK, tilting_shoe_cabinet, flaps=2, columns=2),
    design("shoe cabinet", "steel-rack", "steel shoe rack", (0.32, 0.90, 0.66), "industrial", shoe_rack, slats=m.BLACK_STEEL, frame=m.BLACK_STEEL, levels=3),
    design("shoe cabinet", "pine-bench", "pine shoe bench with a linen seat", (0.35, 0.95, 0.50), "rustic", shoe_rack, slats=m.PINE, frame=m.PINE, levels=2, bench=m.LINEN),
    design("shoe cabinet", "birch-rack", "birch shoe rack with four shelves", (0.30, 0.75, 0.80), "minimal", shoe_rack, slats=m.BIRCH, frame=m.BIRCH, levels=4),
    design("locker", "grey-two", "light grey steel lockers", (0.48, 0.62, 1.80), "minimal", locker, body=m.LIGHT_GREY, doors=2),
    design("locker", "navy-four", "row of navy steel lockers", (0.46, 1.24, 1.78), "modern", locker, body=m.NAVY, doors=4),
    design("locker", "forest-three", "forest green changing-room lockers", (0.50, 0.96, 1.85), "classic", locker, body=s.FOREST, doors=3),
    design("locker", "rust-two", "rust-brown steel lockers", (0.46, 0.64, 1.70), "rustic", locker, body=m.paint("rust paint", "#7d5a45", 0.7), doors=2),
    design("locker", "iron-single", "single charcoal locker", (0.46, 0.38, 1.75), "industrial", locker, body=m.CHARCOAL, doors=1),
    design("pantry cabinet", "cream-glazed", "cream larder cupboard with glazed doors", (0.48, 0.95, 2.05), CREAM, pantry, glazed=True),
    design("pantry cabinet", "duck-egg", "duck egg panelled larder", (0.55, 0.90, 2.10), CLASSIC.but(wood=s.DUCK_EGG, frame=s.DUCK_EGG), pantry),
    design("pantry cabinet", "white-plain", "tall white kitchen cupboard", (0.58, 0.60, 2.10), WHITE.but(handle="bar"), pantry),
    design("pantry cabinet", "oak-modern", "tall oak kitchen cupboard", (0.56, 0.80, 2.05), OAK_MODERN, pantry),
    design("pantry cabinet", "charcoal", "charcoal larder with drawers below", (0.50, 0.80, 1.95), STEEL, pantry, split=0.42),
)  # fmt: skip
