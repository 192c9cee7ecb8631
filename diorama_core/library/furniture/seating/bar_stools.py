"""Bar and counter stools."""

from __future__ import annotations

from functools import partial

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.model import Design
from diorama_core.library.furniture.seating.stools import pad_stool, round_stool, swivel_stool

DESIGNS: tuple[Design, ...] = (
    Design(
        "stool-bar-walnut",
        "bar stool",
        "walnut bar stool with a brass foot ring",
        (0.40, 0.40, 0.75),
        "modern",
        partial(round_stool, wood=m.WALNUT, seat=m.WALNUT, foot_ring=m.BRASS),
        4,
    ),
    Design(
        "stool-bar-pad",
        "bar stool",
        "bar stool with a grey pad on a steel frame",
        (0.40, 0.42, 0.68),
        "industrial",
        partial(pad_stool, cloth=m.GREY_FABRIC, frame=m.BLACK_STEEL),
        2,
    ),
    Design(
        "stool-bar-leather",
        "bar stool",
        "tan leather bar stool",
        (0.38, 0.40, 0.76),
        "industrial",
        partial(pad_stool, cloth=m.TAN_LEATHER, frame=m.IRON),
        2,
    ),
    Design(
        "stool-swivel",
        "bar stool",
        "swivel stool with a black leather seat",
        (0.40, 0.40, 0.72),
        "modern",
        partial(swivel_stool, seat=m.BLACK_LEATHER, steel=m.CHROME),
        36,
    ),
)
