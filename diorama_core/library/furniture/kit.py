"""What designs are made with: materials, styles, solids, and the parts that many kinds share.

A module of designs starts with `from diorama_core.library.furniture.kit import *`, as the scripts of CAD kits do: its
text is mostly these words. `__all__` says which they are, and type checking knows each of them.
"""

from __future__ import annotations

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture import styles as s
from diorama_core.library.furniture.carcass import DrawerSpace, door_front, drawer_front, open_case, plinth, pull
from diorama_core.library.furniture.cases import Base, Cell, case, feet
from diorama_core.library.furniture.cavity import Cavity, drop_front, hinged_lid, on_front
from diorama_core.library.furniture.fittings import at, bar_handle, knob, tap
from diorama_core.library.furniture.frames import frame, stand_up, wall_outline
from diorama_core.library.furniture.hollow_ware import hollow
from diorama_core.library.furniture.joints import Joint, door_hinge, drawer_slide
from diorama_core.library.furniture.keys import keypad, keys_of, piano_keys, spread
from diorama_core.library.furniture.legs import Leg, leg, trumpet
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import (
    Design,
    Part,
    Parts,
    Size,
    both_sides,
    design,
    four,
    joined,
    jointed,
    of,
    shifted,
    turned,
    with_role,
)
from diorama_core.library.furniture.solids import (
    Profile,
    Solid,
    ball,
    beam,
    bend,
    box,
    cushion,
    cylinder,
    lathe,
    loft,
    pillow,
    prism,
    ring_path,
    rod,
    rounded_rectangle,
    shell,
    slab,
    smooth_profile,
    superellipse,
    taper,
    tube,
    unit,
)
from diorama_core.library.furniture.standing import lowered, seated
from diorama_core.library.furniture.styles import CLASSIC, INDUSTRIAL, MINIMAL, MODERN, RUSTIC, Style

__all__ = [  # noqa: RUF022
    "Design", "design", "Material", "m", "Style", "s", "CLASSIC", "INDUSTRIAL", "MINIMAL", "MODERN", "RUSTIC",
    "Part", "Parts", "Size", "of", "at", "shifted", "turned", "both_sides", "four", "joined",
    "Joint", "jointed", "with_role", "door_hinge", "drawer_slide", "DrawerSpace",
    "Cavity", "drop_front", "hinged_lid", "on_front",
    "Solid", "Profile", "ball", "beam", "bend", "box", "cushion", "cylinder", "lathe", "loft", "pillow", "prism",
    "ring_path", "rod", "rounded_rectangle", "shell", "slab", "smooth_profile", "superellipse", "taper", "tube", "unit",
    "Leg", "leg", "trumpet", "Base", "Cell", "case", "feet", "door_front", "drawer_front", "open_case", "plinth", "pull",
    "bar_handle", "knob", "tap", "frame", "stand_up", "wall_outline", "hollow", "keypad", "keys_of",
    "piano_keys", "spread", "lowered", "seated",
]  # fmt: skip
