"""Bar and counter stools."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.seating.stools import pad_stool, round_stool, swivel_stool

DESIGNS: tuple[Design, ...] = (
    design("bar stool", "walnut", "walnut bar stool with a brass foot ring", (0.40, 0.40, 0.75), "modern", round_stool, 4, id="stool-bar-walnut", wood=m.WALNUT, seat=m.WALNUT, foot_ring=m.BRASS),
    design("bar stool", "pad", "bar stool with a grey pad on a steel frame", (0.40, 0.42, 0.68), "industrial", pad_stool, 2, id="stool-bar-pad", cloth=m.GREY_FABRIC, frame=m.BLACK_STEEL),
    design("bar stool", "leather", "tan leather bar stool", (0.38, 0.40, 0.76), "industrial", pad_stool, 2, id="stool-bar-leather", cloth=m.TAN_LEATHER, frame=m.IRON),
    design("bar stool", "swivel", "swivel stool with a black leather seat", (0.40, 0.40, 0.72), "modern", swivel_stool, 36, id="stool-swivel", seat=m.BLACK_LEATHER, steel=m.CHROME),
)  # fmt: skip
