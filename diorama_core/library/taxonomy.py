"""What objects in rooms are called, how big they usually are, and where they are usually found.

One table serves naming (synonyms, plurals, British and American), metrology (size priors), retrieval (category
groups) and support reasoning (what stands on the floor, hangs on a wall or lies on something else).
"""

from __future__ import annotations

import difflib
import re
from dataclasses import dataclass
from functools import cache
from typing import Any, Literal

import numpy as np
from jaxtyping import Float

Mount = Literal["floor", "surface", "wall", "ceiling"]
"""Where an object of a category is usually found: standing on the floor, on another object, or hung."""


@dataclass(frozen=True)
class SizePrior:
    """Log-normal sizes of a category: medians in metres and standard deviations of their logarithms."""

    height_m: float
    width_m: float
    """Left to right, seen from the front (object y)."""
    depth_m: float
    """Front to back (object x)."""
    sigma_height: float
    sigma_width: float
    sigma_depth: float

    @property
    def log_median_xyz(self) -> Float[np.ndarray, "3"]:
        """Logarithms of the medians in object order: x (depth), y (width), z (height)."""
        return np.log([self.depth_m, self.width_m, self.height_m])

    @property
    def log_sigma_xyz(self) -> Float[np.ndarray, "3"]:
        """Standard deviations of the logarithms in object order."""
        return np.array([self.sigma_depth, self.sigma_width, self.sigma_height])


@dataclass(frozen=True)
class Category:
    """One canonical category."""

    name: str
    priors: tuple[SizePrior, ...]
    """One per mode (a bed with and without a headboard), most common first."""
    mount: Mount = "floor"
    synonyms: tuple[str, ...] = ()
    seat_height_m: float | None = None
    """Height of the surface that objects lie on, where it is below the top (seats, mattresses)."""
    supports_objects: bool = False
    """Whether people put objects on it, so that its shapes must come empty."""
    quarter_turns_free: bool = False
    """Whether it often stands at odd angles to the room (chairs, plants)."""
    soft: bool = False
    """Whether it gives way: soft objects lie against and partly in one another."""
    kin: str = ""
    """The broader category whose rules it shares (where it stands, what goes with it), for a special kind of one."""


@dataclass(frozen=True)
class Resolution:
    """The category a word was understood as."""

    category: Category
    exact: bool
    """False when the word was unknown and the nearest name was taken."""
    note: str = ""
    """What to tell the user when it was not exact."""


def _c(
    name: str,
    hwd: tuple[float, float, float],
    sigma: tuple[float, float, float],
    mount: Mount = "floor",
    synonyms: str = "",
    modes: tuple[tuple[float, float, float, float, float, float], ...] = (),
    **more: Any,
) -> Category:
    """A table row; `hwd` and `sigma` are height, width, depth, as furniture is usually measured."""
    priors = (SizePrior(*hwd, *sigma), *(SizePrior(*m) for m in modes))
    words = tuple(s.strip() for s in synonyms.split(",") if s.strip())
    return Category(name, priors, mount, words, **more)


UNKNOWN = _c("object", (0.6, 0.6, 0.6), (0.7, 0.7, 0.6), synonyms="void, thing, item, other, misc, unknown, otherprop")

CATEGORIES: tuple[Category, ...] = (
    _c("chair", (0.86, 0.52, 0.56), (0.15, 0.15, 0.15), synonyms="dining chair, kitchen chair, side chair, wooden chair, folding chair", seat_height_m=0.46, supports_objects=True, quarter_turns_free=True),
    _c("office chair", (1.0, 0.62, 0.62), (0.13, 0.12, 0.12), synonyms="desk chair, swivel chair, task chair, computer chair, gaming chair", seat_height_m=0.48, quarter_turns_free=True),
    _c("armchair", (0.88, 0.82, 0.85), (0.13, 0.15, 0.12), synonyms="easy chair, lounge chair, club chair, wing chair, sofa chair, accent chair, wingback chair", seat_height_m=0.45, supports_objects=True, quarter_turns_free=True),
    _c("rocking chair", (1.0, 0.66, 0.88), (0.12, 0.13, 0.13), synonyms="rocker, glider chair, nursing chair, rocking armchair", seat_height_m=0.43, supports_objects=True, quarter_turns_free=True, kin="armchair"),
    _c("recliner", (1.02, 0.88, 0.98), (0.08, 0.12, 0.2), synonyms="reclining chair, reclining armchair, recliner chair, lazy chair", seat_height_m=0.47, supports_objects=True, quarter_turns_free=True, kin="armchair"),
    _c("stool", (0.6, 0.38, 0.38), (0.25, 0.15, 0.15), synonyms="step stool, footstep, milking stool, piano stool, vanity stool", supports_objects=True, quarter_turns_free=True),
    _c("bar stool", (0.84, 0.44, 0.44), (0.22, 0.12, 0.12), synonyms="barstool, counter stool, bar chair, kitchen stool, breakfast stool, high stool", seat_height_m=0.7, supports_objects=True, quarter_turns_free=True, kin="stool"),
    _c("high chair", (0.96, 0.54, 0.6), (0.1, 0.12, 0.15), synonyms="highchair, baby chair, feeding chair, baby high chair", seat_height_m=0.55, quarter_turns_free=True, kin="chair"),
    _c("bench", (0.46, 1.2, 0.4), (0.2, 0.3, 0.2), synonyms="settle, piano bench", supports_objects=True),
    _c("sofa", (0.84, 1.95, 0.95), (0.12, 0.25, 0.12), synonyms="couch, settee, loveseat, love seat, chesterfield, futon, divan, sofa bed, davenport", seat_height_m=0.45, supports_objects=True),
    _c("sectional sofa", (0.82, 2.7, 1.9), (0.12, 0.2, 0.25), synonyms="sectional, corner sofa, l shaped sofa, corner couch, sectional couch, modular sofa, u shaped sofa", seat_height_m=0.43, supports_objects=True, kin="sofa"),
    _c("chaise longue", (0.8, 0.72, 1.65), (0.15, 0.15, 0.12), synonyms="chaise, chaise lounge, recamier, fainting couch, lounger, sun lounger", seat_height_m=0.42, supports_objects=True, quarter_turns_free=True, kin="sofa"),
    _c("day bed", (0.85, 0.98, 2.05), (0.2, 0.15, 0.12), synonyms="daybed, day-bed, trundle bed", seat_height_m=0.48, supports_objects=True, modes=((0.85, 2.05, 0.98, 0.2, 0.12, 0.15),), kin="bed"),
    _c("ottoman", (0.43, 0.65, 0.55), (0.15, 0.2, 0.2), synonyms="pouf, pouffe, footstool, footrest, hassock", supports_objects=True, quarter_turns_free=True),
    _c("bean bag", (0.75, 0.85, 0.9), (0.2, 0.18, 0.18), synonyms="beanbag, bean bag chair, beanbag chair, sack chair", soft=True, quarter_turns_free=True, kin="ottoman"),
    _c("table", (0.72, 1.4, 0.85), (0.18, 0.35, 0.25), synonyms="dining table, kitchen table, conference table, round table, trestle table", supports_objects=True),
    _c("coffee table", (0.45, 1.1, 0.65), (0.15, 0.2, 0.2), synonyms="cocktail table, low table, centre table, center table", supports_objects=True),
    _c("side table", (0.55, 0.5, 0.45), (0.15, 0.2, 0.2), synonyms="end table, accent table, lamp table, occasional table, pedestal table", supports_objects=True),
    _c("desk", (0.75, 1.4, 0.70), (0.08, 0.22, 0.15), synonyms="writing desk, computer desk, office desk, workstation, bureau", supports_objects=True),
    _c("vanity table", (1.3, 1.0, 0.45), (0.2, 0.18, 0.13), synonyms="dressing table, vanity desk, makeup table, make up table, makeup vanity, vanity dresser", supports_objects=True, seat_height_m=0.76, modes=((0.78, 1.0, 0.45, 0.08, 0.18, 0.13),), kin="desk"),
    _c("bed", (0.62, 1.6, 2.1), (0.2, 0.2, 0.07), synonyms="double bed, single bed, queen bed, king bed, bedstead, bed frame, platform bed, four poster bed, mattress", seat_height_m=0.55, supports_objects=True, modes=((1.05, 1.6, 2.1, 0.2, 0.2, 0.07),)),
    _c("bunk bed", (1.65, 1.05, 2.08), (0.1, 0.15, 0.07), synonyms="bunk beds, bunkbed, loft bed, cabin bed, high sleeper", supports_objects=True, kin="bed"),
    _c("crib", (0.95, 1.3, 0.72), (0.12, 0.1, 0.1), synonyms="cot, cot bed, baby bed, baby crib, cradle, bassinet", supports_objects=True, kin="bed"),
    _c("changing table", (0.95, 0.85, 0.55), (0.1, 0.2, 0.15), synonyms="baby changing table, changing station, nappy table, diaper table", supports_objects=True, kin="dresser"),
    _c("night stand", (0.6, 0.5, 0.43), (0.15, 0.2, 0.15), synonyms="nightstand, bedside table, bedside cabinet, night table", supports_objects=True),
    _c("dresser", (1.0, 1.0, 0.48), (0.28, 0.35, 0.13), synonyms="chest of drawers, drawers, drawer, commode, tallboy, bureau dresser", supports_objects=True),
    _c("cabinet", (1.0, 0.9, 0.45), (0.4, 0.35, 0.2), synonyms="cupboard, sideboard cabinet, storage cabinet, vanity, accent cabinet", supports_objects=True),
    _c("filing cabinet", (0.95, 0.48, 0.58), (0.3, 0.3, 0.15), synonyms="file cabinet, office cabinet, drawer pedestal, desk pedestal, lateral file", supports_objects=True, kin="cabinet"),
    _c("display cabinet", (1.85, 0.95, 0.4), (0.15, 0.25, 0.12), synonyms="china cabinet, curio cabinet, glass cabinet, vitrine, china hutch, hutch, display case, showcase", supports_objects=True, kin="cabinet"),
    _c("shoe cabinet", (0.95, 0.82, 0.3), (0.25, 0.25, 0.2), synonyms="shoe rack, shoe storage, shoe bench, shoe shelf, shoe cupboard", supports_objects=True, kin="cabinet"),
    _c("locker", (1.8, 0.75, 0.48), (0.12, 0.4, 0.12), synonyms="lockers, school locker, metal locker, changing room locker", kin="cabinet"),
    _c("pantry cabinet", (2.0, 0.75, 0.5), (0.1, 0.25, 0.18), synonyms="larder, pantry, tall kitchen cabinet, kitchen cupboard, broom cupboard, linen cabinet, larder cupboard", kin="wardrobe"),
    _c("chest", (0.5, 0.95, 0.48), (0.15, 0.18, 0.15), synonyms="trunk, blanket box, blanket chest, toy chest, steamer trunk, storage trunk, hope chest, toy box", supports_objects=True, kin="sideboard"),
    _c("wine rack", (0.9, 0.55, 0.32), (0.4, 0.3, 0.2), synonyms="wine shelf, bottle rack, wine cabinet, wine holder", kin="bookshelf"),
    _c("sideboard", (0.8, 1.5, 0.45), (0.15, 0.2, 0.13), synonyms="buffet, console cabinet, credenza, server", supports_objects=True),
    _c("console table", (0.78, 1.1, 0.36), (0.1, 0.22, 0.18), synonyms="hall table, sofa table, entry table", supports_objects=True),
    _c("tv stand", (0.5, 1.4, 0.42), (0.2, 0.22, 0.15), synonyms="tv unit, television stand, media console, entertainment center, tv cabinet, media unit", supports_objects=True),
    _c("bookshelf", (1.7, 0.9, 0.32), (0.3, 0.3, 0.2), synonyms="bookcase, book shelf, shelving, shelving unit, shelf unit", supports_objects=True),
    _c("wardrobe", (2.0, 1.2, 0.6), (0.1, 0.3, 0.12), synonyms="closet, armoire, almirah"),
    _c("coat rack", (1.8, 0.6, 0.4), (0.1, 0.4, 0.25), synonyms="coat stand, hall stand, hall tree, coat tree, hat stand, clothes rack, clothes rail, garment rack, coat hanger, coatrack"),
    _c("room divider", (1.75, 1.4, 0.3), (0.08, 0.25, 0.4), synonyms="folding screen, privacy screen, partition screen, dressing screen, divider, partition"),
    _c("refrigerator", (1.5, 0.7, 0.68), (0.3, 0.15, 0.12), synonyms="fridge, freezer, fridge freezer, icebox", supports_objects=True),
    _c("stove", (0.9, 0.62, 0.62), (0.08, 0.12, 0.1), synonyms="oven, cooker, range, cooktop, hob, gas stove, kitchen range", supports_objects=True),
    _c("wall oven", (0.65, 0.6, 0.57), (0.35, 0.06, 0.06), synonyms="built in oven, built-in oven, double oven, integrated oven, single oven", kin="stove"),
    _c("range hood", (0.75, 0.75, 0.48), (0.35, 0.2, 0.15), "wall", synonyms="cooker hood, extractor hood, extractor fan, kitchen hood, vent hood, exhaust hood, hood"),
    _c("washing machine", (0.86, 0.6, 0.6), (0.06, 0.06, 0.1), synonyms="washer, laundry machine, clothes washer, washer dryer", supports_objects=True),
    _c("dryer", (0.86, 0.6, 0.6), (0.06, 0.06, 0.1), synonyms="tumble dryer, clothes dryer, tumble drier, drier", supports_objects=True, kin="washing machine"),
    _c("dishwasher", (0.85, 0.58, 0.59), (0.06, 0.12, 0.08), synonyms="dish washer, dishwashing machine", supports_objects=True, kin="washing machine"),
    _c("kitchen counter", (0.9, 1.8, 0.62), (0.06, 0.4, 0.12), synonyms="counter, worktop, countertop, kitchen unit, kitchen cabinet, base cabinet, bar, bar counter", supports_objects=True),
    _c("kitchen island", (0.91, 1.5, 0.8), (0.05, 0.3, 0.18), synonyms="island, island counter, butcher block island, breakfast bar, kitchen bench", supports_objects=True, kin="kitchen counter"),
    _c("wall cabinet", (0.7, 0.9, 0.34), (0.2, 0.35, 0.12), "wall", synonyms="kitchen wall cabinet, wall cupboard, kitchen wall unit, upper cabinet, overhead cabinet, hanging cabinet, wall unit", supports_objects=True),
    _c("bar cart", (0.86, 0.75, 0.44), (0.1, 0.18, 0.15), synonyms="drinks trolley, serving cart, kitchen cart, tea trolley, kitchen trolley, serving trolley, cart, trolley, utility cart", supports_objects=True, quarter_turns_free=True, kin="console table"),
    _c("sink", (0.85, 0.6, 0.5), (0.25, 0.2, 0.2), synonyms="basin, washbasin, wash basin, washstand"),
    _c("toilet", (0.75, 0.4, 0.68), (0.12, 0.12, 0.1), synonyms="wc, lavatory, loo"),
    _c("bathtub", (0.58, 0.75, 1.65), (0.12, 0.1, 0.1), synonyms="bath, tub, bath tub"),
    _c("floor lamp", (1.55, 0.4, 0.4), (0.12, 0.25, 0.25), synonyms="standing lamp, torchiere, floor light", quarter_turns_free=True),
    _c("lamp", (0.58, 0.34, 0.34), (0.22, 0.2, 0.2), "surface", synonyms="table lamp, desk lamp, bedside lamp, reading lamp"),
    _c("ceiling lamp", (0.4, 0.45, 0.45), (0.4, 0.35, 0.35), "ceiling", synonyms="pendant, pendant lamp, ceiling light, pendant light, light, light fixture, lighting"),
    _c("television", (0.65, 1.0, 0.25), (0.3, 0.3, 0.6), "surface", synonyms="tv, telly, tv set, flatscreen, tv monitor"),
    _c("monitor", (0.45, 0.55, 0.2), (0.2, 0.2, 0.3), "surface", synonyms="computer monitor, screen, display, computer screen"),
    _c("laptop", (0.24, 0.34, 0.25), (0.15, 0.12, 0.2), "surface", synonyms="notebook computer, macbook"),
    _c("computer", (0.42, 0.2, 0.45), (0.2, 0.25, 0.2), "surface", synonyms="pc, desktop computer, computer tower, tower"),
    _c("keyboard", (0.03, 0.43, 0.15), (0.3, 0.15, 0.2), "surface", synonyms="computer keyboard"),
    _c("microwave", (0.3, 0.5, 0.38), (0.12, 0.12, 0.15), "surface", synonyms="microwave oven, toaster oven, oven toaster"),
    _c("pillow", (0.38, 0.48, 0.2), (0.2, 0.2, 0.3), "surface", synonyms="cushion, throw pillow, bolster", soft=True),
    _c("books", (0.15, 0.4, 0.3), (0.5, 0.4, 0.4), "surface", synonyms="book, book stack, stack of books, magazine, papers, paper, pile of books"),
    _c("plant", (0.9, 0.5, 0.5), (0.5, 0.4, 0.4), "floor", synonyms="potted plant, houseplant, pot plant, flower, flowers, tree, pottedplant, succulent", quarter_turns_free=True),
    _c("vase", (0.3, 0.18, 0.18), (0.3, 0.3, 0.3), "surface", synonyms="urn, jug, pitcher, flower vase", modes=((0.55, 0.32, 0.32, 0.3, 0.35, 0.35),)),
    _c("bowl", (0.1, 0.24, 0.24), (0.3, 0.25, 0.25), "surface"),
    _c("cup", (0.1, 0.1, 0.09), (0.2, 0.2, 0.2), "surface", synonyms="mug, coffee cup, teacup"),
    _c("bottle", (0.27, 0.08, 0.08), (0.2, 0.2, 0.2), "surface", synonyms="wine bottle, flask"),
    _c("clock", (0.3, 0.3, 0.06), (0.3, 0.3, 0.4), "wall", synonyms="wall clock"),
    _c("box", (0.3, 0.4, 0.33), (0.4, 0.4, 0.4), "floor", synonyms="cardboard box, carton, crate, container, storage box", supports_objects=True),
    _c("basket", (0.35, 0.4, 0.4), (0.3, 0.3, 0.3), "floor", synonyms="wicker basket"),
    _c("trash can", (0.45, 0.32, 0.32), (0.3, 0.2, 0.2), "floor", synonyms="bin, garbage bin, dustbin, waste bin, wastebasket, rubbish bin, garbage can, trashcan, garbagebin"),
    _c("picture", (0.65, 0.75, 0.03), (0.4, 0.45, 0.3), "wall", synonyms="painting, poster, picture frame, artwork, print, photograph, frame"),
    _c("mirror", (0.9, 0.8, 0.04), (0.4, 0.4, 0.3), "wall", synonyms="wall mirror, looking glass"),
    _c("shelves", (0.4, 1.0, 0.25), (0.5, 0.35, 0.2), "wall", synonyms="shelf, wall shelf, floating shelf, rack", supports_objects=True),
    _c("curtain", (2.2, 1.2, 0.12), (0.2, 0.4, 0.3), "wall", synonyms="curtains, drapes, shower curtain"),
    _c("window", (1.2, 1.1, 0.08), (0.25, 0.35, 0.3), "wall", synonyms="windows, window frame"),
    _c("door", (2.03, 0.85, 0.06), (0.04, 0.1, 0.3), "wall", synonyms="doorway, doors, door frame, archway, passageway, door opening"),
    _c("radiator", (0.6, 1.0, 0.12), (0.15, 0.3, 0.2), "wall"),
    _c("rug", (0.015, 1.6, 2.2), (0.3, 0.3, 0.3), "floor", synonyms="carpet, mat, floor mat, floormat", supports_objects=True),
    _c("piano", (1.15, 1.45, 0.62), (0.15, 0.1, 0.15), synonyms="upright piano, keyboard piano"),
    _c("toy", (0.25, 0.25, 0.2), (0.4, 0.4, 0.4), "surface", synonyms="teddy bear, teddy, doll, stuffed animal, ball"),
    _c("fireplace", (1.15, 1.2, 0.42), (0.3, 0.4, 0.2), synonyms="mantelpiece, mantel, hearth, wood stove, wood burner, log burner, chimney", supports_objects=True),
    _c("heater", (0.5, 0.34, 0.28), (0.35, 0.4, 0.4), synonyms="space heater, electric heater, fan heater, oil heater, convector"),
    _c("fan", (0.9, 0.42, 0.38), (0.5, 0.3, 0.3), synonyms="pedestal fan, standing fan, table fan, desk fan, electric fan, tower fan", quarter_turns_free=True),
    _c("ceiling fan", (0.36, 1.2, 1.2), (0.25, 0.15, 0.15), "ceiling", synonyms="ceiling ventilator"),
    _c("air conditioner", (0.34, 0.75, 0.28), (0.35, 0.3, 0.35), "wall", synonyms="air conditioning, air con, aircon, ac unit, split unit, cooler"),
    _c("glass", (0.14, 0.08, 0.08), (0.35, 0.2, 0.2), "surface", synonyms="drinking glass, wine glass, tumbler, champagne glass, water glass, goblet, pint glass, glassware", kin="cup"),
    _c("plate", (0.03, 0.26, 0.26), (0.5, 0.15, 0.15), "surface", synonyms="dinner plate, dish, plates, saucer", kin="bowl"),
    _c("tray", (0.05, 0.4, 0.36), (0.45, 0.25, 0.2), "surface", synonyms="serving tray, platter, salver", kin="bowl", supports_objects=True),
    _c("jar", (0.19, 0.13, 0.13), (0.35, 0.3, 0.3), "surface", synonyms="storage jar, canister, cookie jar, biscuit jar, mason jar, preserving jar, ginger jar", kin="vase"),
    _c("fruit", (0.12, 0.2, 0.18), (0.5, 0.5, 0.5), "surface", synonyms="fruit bowl, apple, orange, banana, bananas, lemon, fruits"),
    _c("chandelier", (0.65, 0.7, 0.7), (0.25, 0.25, 0.25), "ceiling", synonyms="chandeliers, candelabrum lamp", kin="ceiling lamp"),
    _c("wall lamp", (0.26, 0.2, 0.22), (0.4, 0.5, 0.45), "wall", synonyms="sconce, wall light, wall sconce, wall lamps, picture light, vanity light"),
    _c("candle", (0.22, 0.14, 0.12), (0.7, 0.6, 0.4), "surface", synonyms="candles, candlestick, candle holder, candelabra, candleholder, tea light, tealight"),
    _c("kettle", (0.23, 0.17, 0.24), (0.2, 0.2, 0.15), "surface", synonyms="electric kettle, tea kettle, teakettle, water kettle"),
    _c("toaster", (0.19, 0.31, 0.18), (0.12, 0.2, 0.2), "surface", synonyms="bread toaster, pop up toaster"),
    _c("coffee machine", (0.29, 0.18, 0.28), (0.3, 0.35, 0.35), "surface", synonyms="coffee maker, espresso machine, espresso maker, coffeemaker, coffee pot, moka pot, french press"),
    _c("blender", (0.38, 0.21, 0.25), (0.15, 0.15, 0.4), "surface", synonyms="mixer, food processor, stand mixer, juicer, liquidiser, liquidizer"),
    _c("cooking pot", (0.13, 0.27, 0.35), (0.5, 0.25, 0.3), "surface", synonyms="pot, pan, saucepan, frying pan, skillet, wok, casserole, dutch oven, stockpot, cookware"),
    _c("utensils", (0.25, 0.13, 0.18), (0.8, 0.3, 0.2), "surface", synonyms="knife block, cutlery, kitchen utensils, utensil holder, cutlery block, silverware, fork, spoon, knife, scissors"),
    _c("cutting board", (0.03, 0.35, 0.3), (0.9, 0.3, 0.3), "surface", synonyms="chopping board, breadboard, bread board"),
    _c("mouse", (0.035, 0.063, 0.115), (0.2, 0.12, 0.1), "surface", synonyms="computer mouse"),
    _c("tablet", (0.012, 0.18, 0.2), (0.9, 0.3, 0.4), "surface", synonyms="tablet computer, ipad, e reader, ebook reader", kin="laptop"),
    _c("smartphone", (0.009, 0.073, 0.15), (0.3, 0.15, 0.12), "surface", synonyms="cell phone, mobile phone, mobile, cellphone, iphone"),
    _c("printer", (0.22, 0.42, 0.41), (0.5, 0.2, 0.15), "surface", synonyms="scanner, inkjet printer, laser printer, photocopier, copier"),
    _c("speaker", (0.32, 0.22, 0.24), (0.6, 0.4, 0.35), synonyms="loudspeaker, speakers, bookshelf speaker, floor speaker, soundbar, sound bar, smart speaker, radio, stereo, subwoofer"),
    _c("record player", (0.2, 0.42, 0.36), (0.7, 0.12, 0.15), "surface", synonyms="turntable, gramophone, vinyl player, phonograph"),
    _c("telephone", (0.16, 0.2, 0.17), (0.3, 0.4, 0.35), "surface", synonyms="phone, landline, desk phone, landline phone, rotary phone"),
    _c("router", (0.16, 0.19, 0.14), (0.45, 0.25, 0.2), "surface", synonyms="wifi router, modem, wireless router"),
    _c("remote control", (0.018, 0.043, 0.17), (0.25, 0.15, 0.2), "surface", synonyms="remote, tv remote, remote controller"),
    _c("game console", (0.08, 0.19, 0.15), (0.9, 0.35, 0.45), "surface", synonyms="games console, video game console, game controller, gamepad, joystick, controller"),
    _c("photo frame", (0.21, 0.21, 0.1), (0.2, 0.3, 0.2), "surface", synonyms="framed photo, framed photograph, family photo, standing photo", kin="picture"),
    _c("floor mirror", (1.7, 0.72, 0.4), (0.12, 0.2, 0.25), synonyms="full length mirror, standing mirror, cheval mirror, dressing mirror, leaning mirror", kin="mirror"),
    _c("vanity mirror", (0.33, 0.21, 0.14), (0.2, 0.2, 0.2), "surface", synonyms="table mirror, makeup mirror, make up mirror, shaving mirror"),
    _c("mantel clock", (0.2, 0.22, 0.1), (0.5, 0.35, 0.3), "surface", synonyms="table clock, desk clock, digital clock, alarm clock, bracket clock", kin="clock"),
    _c("grandfather clock", (1.9, 0.46, 0.26), (0.1, 0.15, 0.12), synonyms="longcase clock, tall case clock, floor clock"),
    _c("whiteboard", (1.05, 1.3, 0.1), (0.3, 0.35, 0.9), "wall", synonyms="blackboard, chalkboard, board, dry erase board, writing board, flipchart, flip chart", kin="picture"),
    _c("bulletin board", (0.6, 0.8, 0.03), (0.35, 0.4, 0.2), "wall", synonyms="cork board, corkboard, notice board, noticeboard, pinboard, pin board, letter board", kin="picture"),
    _c("sculpture", (0.3, 0.2, 0.15), (0.45, 0.3, 0.35), "surface", synonyms="statue, statuette, figurine, bust, ornament, decoration, decor, bookend, hourglass"),
    _c("globe", (0.4, 0.28, 0.28), (0.45, 0.3, 0.3), "surface", synonyms="world globe, desk globe, floor globe"),
    _c("blinds", (1.45, 1.1, 0.08), (0.2, 0.3, 0.3), "wall", synonyms="blind, roller blind, venetian blind, venetian blinds, roman blind, roman shade, window blind, window shade, roller shade", kin="curtain"),
    _c("bath mat", (0.018, 0.75, 0.5), (0.4, 0.2, 0.15), synonyms="bathroom mat, shower mat, bath rug", kin="rug"),
    _c("blanket", (0.14, 0.8, 0.55), (0.5, 0.6, 0.6), "surface", synonyms="throw, quilt, comforter, duvet, bedspread, throw blanket, coverlet", soft=True),
    _c("towel", (0.3, 0.38, 0.2), (0.8, 0.35, 0.6), "surface", synonyms="towels, hand towel, bath towel, towel rail, towel rack", soft=True),
    _c("shower", (2.1, 1.0, 0.92), (0.06, 0.2, 0.12), synonyms="shower cabin, shower cubicle, shower stall, shower enclosure, shower tray, walk in shower"),
    _c("toilet brush", (0.39, 0.1, 0.1), (0.1, 0.12, 0.12), synonyms="loo brush, toilet brush holder"),
    _c("toilet paper", (0.17, 0.15, 0.13), (0.6, 0.25, 0.25), "wall", synonyms="toilet roll, toilet roll holder, toilet paper holder, tissue, paper towel"),
    _c("soap dispenser", (0.18, 0.28, 0.11), (0.12, 0.3, 0.15), "surface", synonyms="soap, toothbrush, toothbrush holder, bathroom set, soap dish"),
    _c("bathroom scale", (0.028, 0.3, 0.29), (0.2, 0.1, 0.1), synonyms="weighing scale, scales, bathroom scales"),
    _c("laundry basket", (0.53, 0.48, 0.41), (0.25, 0.15, 0.12), synonyms="hamper, laundry hamper, laundry bag, washing basket, clothes basket", kin="basket"),
    _c("suitcase", (0.45, 0.5, 0.3), (0.6, 0.25, 0.35), synonyms="luggage, trolley case, travel bag, duffel bag, holdall, briefcase, case", kin="box"),
    _c("backpack", (0.45, 0.31, 0.25), (0.12, 0.12, 0.15), synonyms="rucksack, school bag, schoolbag, knapsack, bag", soft=True),
    _c("handbag", (0.4, 0.31, 0.15), (0.3, 0.2, 0.25), "surface", synonyms="purse, tote bag, tote, shoulder bag, shopping bag", soft=True),
    _c("umbrella stand", (0.83, 0.24, 0.24), (0.15, 0.15, 0.15), synonyms="umbrella holder, umbrella, umbrellas"),
    _c("guitar", (0.98, 0.37, 0.35), (0.2, 0.2, 0.5), synonyms="acoustic guitar, electric guitar, ukulele, bass guitar, violin, cello"),
    _c("drum", (0.64, 0.32, 0.32), (0.2, 0.15, 0.15), synonyms="drums, djembe, bongo, drum kit, conga"),
    _c("bicycle", (1.03, 0.57, 1.72), (0.08, 0.12, 0.08), synonyms="bike, cycle, pushbike"),
    _c("exercise machine", (1.2, 0.55, 1.3), (0.25, 0.2, 0.35), synonyms="exercise bike, treadmill, rowing machine, elliptical, cross trainer, stationary bike, gym equipment"),
    _c("yoga mat", (0.1, 0.62, 1.2), (0.3, 0.1, 1.0), synonyms="exercise mat, gym mat, fitness mat"),
    _c("dumbbells", (0.16, 0.4, 0.23), (0.7, 0.6, 0.4), synonyms="dumbbell, dumb bell, weights, kettlebell, barbell, weight rack"),
    _c("exercise ball", (0.6, 0.6, 0.6), (0.12, 0.12, 0.12), synonyms="gym ball, yoga ball, fitness ball, swiss ball"),
    _c("hanging plant", (0.95, 0.42, 0.42), (0.2, 0.2, 0.2), "ceiling", synonyms="hanging basket, hanging planter, hanging pot", kin="plant"),
    UNKNOWN,
)  # fmt: skip

ARCHITECTURE_WORDS = frozenset({"wall", "floor", "ceiling", "walls"})
"""Words that name the room itself, never an object."""


def _key(word: str) -> str:
    return re.sub(r"[^a-z0-9]+", " ", word.lower()).strip()


def _singulars(key: str) -> tuple[str, ...]:
    """The key and its likely singulars."""
    forms = [key]
    if key.endswith("ies"):
        forms.append(key[:-3] + "y")
    if key.endswith("ves"):
        forms += [key[:-3] + "f", key[:-3] + "fe"]
    if key.endswith("es"):
        forms.append(key[:-2])
    if key.endswith("s"):
        forms.append(key[:-1])
    return tuple(forms)


@cache
def _words() -> dict[str, Category]:
    table = {_key(c.name): c for c in CATEGORIES}
    for category in CATEGORIES:
        for word in category.synonyms:
            table.setdefault(_key(word), category)
    return table


def category(name: str) -> Category:
    """The category with this canonical name; raises `KeyError` when there is none."""
    found = _words().get(_key(name))
    if found is None or found.name != name:
        raise KeyError(name)
    return found


@cache
def broad(name: str) -> str:
    """The category whose rules hold for this one: its kin, or itself when it has none or is unknown."""
    return next((c.kin for c in CATEGORIES if c.name == name and c.kin), name)


def with_kin(*names: str) -> frozenset[str]:
    """These categories and all the special kinds of them."""
    return frozenset(names) | {c.name for c in CATEGORIES if c.kin in names}


AGAINST_WALLS = with_kin(
    *("bed", "dresser", "cabinet", "sideboard", "console table", "tv stand", "bookshelf", "wardrobe", "refrigerator"),
    *("stove", "night stand", "kitchen counter", "washing machine", "toilet", "piano"),
) - {"kitchen island", "bar cart"}
"""Categories whose backs stand at walls."""

LAMPS = with_kin("lamp", "floor lamp", "ceiling lamp", "wall lamp", "chandelier")

PORTABLE = with_kin("plant", "box", "basket", "speaker", "fan", "heater", "wine rack") - {"hanging plant", "suitcase"}
"""What stands on the floor or on furniture, by its size."""

NEVER_OPEN = with_kin(
    *("picture", "mirror", "window", "curtain", "rug", "door", "television", "monitor", "pillow", "blanket"),
)
"""What nobody looks through: what has the colours of its surroundings within it, has them itself."""


def lies_on_furniture(name: str) -> bool:
    """Whether people put things of a category on furniture: what lies there only, and what is portable."""
    return category(name).mount == "surface" or name in PORTABLE


def is_furniture(name: str) -> bool:
    """Whether a category is what people call furniture: it stands on the floor, and is no lamp, plant, basket or rug."""
    return category(name).mount == "floor" and name not in PORTABLE | LAMPS and broad(name) != "rug"


_OTHER_THINGS = frozenset({
    "beam", "belt", "bird", "bolt", "boot", "bread", "cable", "cake", "car", "cat", "coat", "coin", "cord", "corn",
    "cow", "deer", "dress", "face", "fence", "fish", "flag", "food", "foot", "glove", "goat", "grass", "hammer",
    "hand", "hat", "head", "hook", "horse", "ladder", "leaf", "letter", "lid", "man", "meat", "menu", "nail", "pen", "person",
    "pet", "pipe", "plug", "rail", "road", "rope", "sign", "skateboard", "sky", "snow", "socket", "step", "switch",
    "tent", "tile", "train", "truck", "vent", "wall", "wheel", "wire",
})  # fmt: skip
"""Words of other things that are a letter or two away from words of the table."""
_SLIP_LETTERS, _SLIP_RATIO = 8, 0.75
"""A word of fewer letters is misspelt by one letter too many or too few; and how alike both must be."""


def _misspelt(key: str, words: tuple[str, ...]) -> str | None:
    """The word that a misspelt one stands for: people get the first letter right, and other words are not slips."""
    if len(key) < 4 or _OTHER_THINGS.intersection(_singulars(key)):
        return None
    off = 1 if len(key) < _SLIP_LETTERS else 2
    alike = [w for w in words if w[:1] == key[:1] and abs(len(w) - len(key)) <= off]
    near = difflib.get_close_matches(key, alike, n=1, cutoff=_SLIP_RATIO)
    return near[0] if near else None


@cache
def resolve(word: str) -> Resolution:
    """Understand a word that a person or a detector used.

    Exact names, synonyms and plurals first; then the last words of a phrase ("wooden armchair"); then the nearest
    spelling, with a note; at last the category "object".
    """
    table = _words()
    key = _key(word)
    parts = key.split()
    for start in range(len(parts)):
        for form in _singulars(" ".join(parts[start:])):
            if form in table:
                return Resolution(table[form], exact=True)
    near = _misspelt(key, tuple(table))
    if near is not None:
        found = table[near]
        return Resolution(found, exact=False, note=f"'{word}' is not a known class; read as '{found.name}'")
    return Resolution(UNKNOWN, exact=False, note=f"'{word}' is not a known class; treated as an unnamed object")
