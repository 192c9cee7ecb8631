"""Printers and scanners."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *


def printer(size: Size, body: Material) -> Parts:
    """A desktop printer with a paper tray."""
    d, w, h = size
    parts = of(
        body,
        box((d * 0.82, w, h * 0.78), 0.02, 3).moved(-d * 0.07, 0, 0.0),
        box((d * 0.8, w * 0.98, 0.03), 0.012, 2).moved(-d * 0.07, 0, h * 0.78),
    )
    parts += of(
        m.CHARCOAL,
        box((0.02, w * 0.72, h * 0.2), 0.006).moved(d * 0.335, 0, h * 0.26),
        box((d * 0.26, w * 0.62, 0.012), 0.004).moved(d * 0.37, 0, h * 0.24),
    )
    parts += of(m.PAPER, box((d * 0.22, w * 0.5, 0.006), 0.001).moved(d * 0.36, 0, h * 0.29)) + of(
        m.SCREEN, box((0.006, 0.075, 0.04), 0.001).moved(d * 0.342, w * 0.36, h * 0.58)
    )
    feed = box((0.012, w * 0.6, h * 0.3), 0.004).turned("y", -20).moved(-d * 0.4, 0, h * 0.74)
    return parts + of(m.CHARCOAL, feed)


def laser_printer(size: Size, body: Material, trim: Material) -> Parts:
    """A boxy printer that lays its sheets on its top."""
    d, w, h = size
    case = box((d, w, h - 0.01), 0.022, 3)
    dip = box((d * 0.5, w * 0.66, 0.012), 0.004).moved(d * 0.08, 0, h - 0.02)
    sheets = box((d * 0.44, w * 0.54, 0.008), 0.001).turned("y", -4).moved(d * 0.1, 0, h - 0.01)
    drawer = [
        box((0.01, w * 0.9, h * 0.26), 0.004).moved(d / 2, 0, 0.02),
        box((0.008, w * 0.3, 0.014), 0.003).moved(d / 2 + 0.006, 0, h * 0.2),
    ]
    panel_ = box((0.05, w * 0.2, 0.006), 0.002).moved(d * 0.42, -w * 0.36, h - 0.01)
    return of(body, case) + of(trim, dip, *drawer, panel_) + of(m.PAPER, sheets)


def label_scanner(size: Size, body: Material) -> Parts:
    """A flat scanner with a lid."""
    d, w, h = size
    return of(
        body, box((d, w, h * 0.55), 0.014, 2), box((d * 0.98, w * 0.98, h * 0.4), 0.012, 2).moved(z=h * 0.6)
    ) + of(
        m.CHARCOAL,
        box((d * 0.97, w * 0.97, h * 0.1), 0.002).moved(z=h * 0.53),
        *(
            cylinder(0.008, 0.006, 0.002, 14).turned("y", 90).moved(d / 2 - 0.003, y * w, h * 0.3)
            for y in (0.2, 0.26, 0.32)
        ),
    )


DESIGNS: tuple[Design, ...] = (
    design("printer", "white", "white desktop printer", (0.44, 0.46, 0.24), "minimal", printer, id="computer-printer", body=m.WHITE),
    design("printer", "laser", "grey laser printer", (0.38, 0.40, 0.27), "classic", laser_printer, body=m.LIGHT_GREY, trim=m.CHARCOAL),
    design("printer", "black", "black inkjet printer", (0.40, 0.44, 0.20), "modern", printer, body=m.BLACK),
    design("printer", "office", "large office printer", (0.48, 0.46, 0.42), "industrial", laser_printer, body=m.WHITE, trim=m.GREY),
    design("printer", "scanner", "flat scanner", (0.40, 0.28, 0.06), "minimal", label_scanner, body=m.CHARCOAL),
)  # fmt: skip
