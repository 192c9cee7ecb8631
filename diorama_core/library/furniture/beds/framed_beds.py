"""Single and double beds, made up with mattress, duvet and pillows."""

from __future__ import annotations

from typing import Literal

from diorama_core.library.furniture.beds.bedding import bedding
from diorama_core.library.furniture.beds.headboards import Head, headboard
from diorama_core.library.furniture.kit import *


def bed(
    size: Size,
    frame: Material,
    head: Head = "panel",
    duvet: Material = m.LIGHT_FABRIC,
    throw: Material | None = None,
    top_z: float = 0.55,
    foot_h: float = 0.0,
    base: Literal["legs", "box"] = "legs",
    cloth: Material | None = None,
) -> Parts:
    """A bed: head at -X, foot toward +X. `top_z` is the top of the mattress."""
    d, w, h = size
    head_t = {"none": 0.0, "padded": 0.1, "channels": 0.1}.get(head, 0.06)
    x_head = -d / 2 + head_t
    frame_d = d - head_t - (0.05 if foot_h else 0.0)
    middle = x_head + frame_d / 2
    thick = 0.23
    rail_top = top_z - thick + 0.06
    if base == "box":
        parts = of(
            frame,
            box((frame_d, w, rail_top - 0.03), 0.02, 2).moved(middle, 0, 0.03),
            *four(box((0.06, 0.06, 0.04)).moved(frame_d / 2 - 0.1, w / 2 - 0.1)),
        )
    else:
        rails = [
            *both_sides(box((frame_d, 0.03, 0.14), 0.007, 2).moved(middle, w / 2 - 0.015, rail_top - 0.14)),
            *(
                box((0.03, w, 0.14), 0.007, 2).moved(middle + s * (frame_d / 2 - 0.015), 0, rail_top - 0.14)
                for s in (1, -1)
            ),
            box((frame_d - 0.04, w - 0.04, 0.02), 0.002).moved(middle, 0, rail_top - 0.05),
        ]
        legs = [
            s.moved(middle)
            for s in four(
                taper(
                    (frame_d / 2 - 0.04, w / 2 - 0.04, 0),
                    (frame_d / 2 - 0.04, w / 2 - 0.04, rail_top - 0.02),
                    0.04,
                    0.06,
                )
            )
        ]
        parts = of(frame, *rails, *legs)
    parts += [
        p.moved(middle) for p in bedding(frame_d - 0.05, w - 0.07, top_z, thick, duvet, 1 if w < 1.2 else 2, throw)
    ]
    if head != "none":
        z0 = 0.0 if head in ("padded", "channels") else 0.3 if head != "panel" else 0.12
        parts += [
            p.moved(x_head)
            for p in headboard(
                head, w + (0.04 if head in ("padded", "channels") else 0.0), h, z0, cloth or frame, frame
            )
        ]
        if head == "panel":
            parts += of(frame, *both_sides(box((0.05, 0.05, 0.2), 0.005).moved(x_head - 0.03, w / 2 - 0.05)))
    if foot_h:
        parts += [
            p.moved(d / 2 + 0.005)
            for p in headboard(head, w, foot_h, 0.14 if head == "panel" else 0.26, cloth or frame, frame)
        ]
        if head == "panel":
            parts += of(frame, *both_sides(box((0.05, 0.05, 0.2), 0.005).moved(d / 2 - 0.025, w / 2 - 0.05)))
    return parts


def bare_mattress(size: Size, cloth: Material, piping: Material) -> Parts:
    """A mattress on its own."""
    d, w, h = size
    edge = rounded_rectangle(d - 0.012, w - 0.012, 0.07, 5)
    body = prism(rounded_rectangle(d, w, 0.08, 5), h - 0.015, 0.03)
    crown = cushion((d * 0.96, w * 0.96, 0.05), 10, 3, 10).moved(z=h - 0.05)
    return of(cloth, body, crown) + of(
        piping, *(tube(ring_path(edge, z), 0.007, 5, closed=True) for z in (0.022, h - 0.04))
    )


DESIGNS: tuple[Design, ...] = (
    design("bed", "panel-oak", "oak double bed with a panel headboard", (2.12, 1.62, 1.02), "classic", bed, frame=m.OAK, duvet=m.LINEN, throw=m.TAUPE_FABRIC),
    design("bed", "low-oak", "low oak platform bed without a headboard", (2.08, 1.60, 0.66), "minimal", bed, frame=m.LIGHT_OAK, head="none", duvet=m.WHITE_COTTON, throw=m.GREY_FABRIC, top_z=0.40),
    design("bed", "padded-grey", "grey upholstered double bed", (2.18, 1.70, 1.12), "modern", bed, frame=m.GREY_FABRIC, head="padded", duvet=m.WHITE_COTTON, throw=m.CHARCOAL_FABRIC, base="box"),
    design("bed", "channel-green", "forest green bed with a channelled headboard", (2.20, 1.66, 1.16), "modern", bed, frame=m.GREEN_FABRIC, head="channels", duvet=m.LINEN, base="box", top_z=0.54),
    design("bed", "slats-walnut", "walnut bed with a slatted headboard", (2.12, 1.58, 0.98), "rustic", bed, frame=m.WALNUT, head="slats", duvet=m.OATMEAL, throw=m.RUST_FABRIC),
    design("bed", "iron", "wrought-iron double bed", (2.10, 1.45, 1.15), "rustic", bed, frame=m.IRON, head="spindles", duvet=m.WHITE_COTTON, throw=m.BLUE_FABRIC, foot_h=0.78, top_z=0.57),
    design("bed", "sleigh-mahogany", "mahogany bed with head- and footboard", (2.18, 1.66, 1.10), "classic", bed, frame=m.MAHOGANY, head="panel", duvet=m.BEIGE_FABRIC, foot_h=0.68, top_z=0.60),
    design("bed", "single-white", "white single bed", (2.05, 0.98, 0.88), "minimal", bed, frame=m.WHITE, head="panel", duvet=m.BLUE_FABRIC, top_z=0.50),
    design("bed", "single-pine", "pine single bed with slats", (2.06, 1.00, 0.86), "rustic", bed, frame=m.PINE, head="slats", duvet=m.OLIVE_FABRIC, top_z=0.48),
    design("bed", "divan-king", "king-size divan without a headboard", (2.05, 1.82, 0.82), "modern", bed, frame=m.TAUPE_FABRIC, head="none", duvet=m.WHITE_COTTON, throw=m.NAVY_FABRIC, base="box", top_z=0.56),
    design("bed", "mattress", "bare double mattress", (2.00, 1.40, 0.24), "minimal", bare_mattress, cloth=m.WHITE_COTTON, piping=m.GREY_FABRIC),
)  # fmt: skip
