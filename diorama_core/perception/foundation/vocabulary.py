"""The default vocabulary of indoor object names for open-vocabulary detection."""

from __future__ import annotations

from diorama_core.library.taxonomy import ARCHITECTURE_WORDS, CATEGORIES, UNKNOWN

_MORE = """
sofa bed, corner sofa, chaise longue, bean bag chair, dining bench, window seat, high chair, rocking horse, papasan
chair, director's chair, deck chair, stool chair, counter stool, foot stool, massage chair, throne, pew, bunk bed,
canopy bed, crib, bassinet, playpen, air mattress, headboard, blanket, duvet, quilt, bedspread, throw blanket,
towel, bath towel, nesting tables, drop-leaf table, round dining table, picnic table, drafting table, standing desk,
reception desk, vanity table, dressing table, tea table, ping pong table, pool table, foosball table, folding table,
bar table, bar cart, serving trolley, kitchen island, workbench, butcher block, china cabinet, display cabinet,
curio cabinet, medicine cabinet, shoe cabinet, shoe rack, coat rack, coat stand, hat stand, umbrella stand, garment
rack, clothes rack, drying rack, ironing board, wine rack, magazine rack, spice rack, plate rack, dish rack, ladder
shelf, cube shelf, corner shelf, pegboard, hook, coat hook, locker, safe, trunk, chest, toy box, storage ottoman,
storage bin, plastic bin, laundry hamper, dish drainer, stove hood, range hood, dishwasher, freezer, ice maker,
coffee machine, coffee maker, espresso machine, kettle, electric kettle, toaster, blender, food processor, stand
mixer, rice cooker, slow cooker, air fryer, pressure cooker, juicer, water dispenser, water cooler, frying pan, pot,
saucepan, wok, cutting board, knife block, utensil holder, canister, jar, teapot, pitcher, carafe, plate, tray, cake
stand, fruit bowl, napkin holder, candle, candlestick, candelabra, lantern, table lamp, desk lamp, floor lamp, arc
lamp, tripod lamp, pendant light, chandelier, wall sconce, ceiling fan, spotlight, track light, night light, string
lights, lava lamp, wall clock, alarm clock, grandfather clock, mantel clock, television, projector, projector
screen, soundbar, speaker, subwoofer, stereo, record player, turntable, radio, game console, dvd player, set-top
box, router, remote control, monitor, computer mouse, keyboard, laptop, tablet, desktop computer, printer, scanner,
copier, shredder, telephone, fax machine, webcam, headphones, power strip, extension cord, fan, pedestal fan, tower
fan, air purifier, humidifier, dehumidifier, space heater, radiator, fireplace, wood stove, air conditioner,
thermostat, vacuum cleaner, robot vacuum, broom, mop, bucket, dustpan, ironing machine, sewing machine, washing
machine, dryer, water heater, bathtub, shower, shower cabin, shower curtain, toilet, bidet, washbasin, pedestal
sink, faucet, towel rack, towel bar, toilet paper holder, soap dispenser, toothbrush holder, bathroom scale, bath
mat, hand dryer, bathroom cabinet, painting, poster, photo frame, canvas print, tapestry, wall art, wall decal,
mirror, full-length mirror, corkboard, bulletin board, whiteboard, blackboard, map, globe, calendar, flag,
sculpture, statue, bust, figurine, trophy, vase, urn, potted plant, cactus, palm plant, bonsai, hanging plant,
flower pot, planter, bouquet, wreath, terrarium, aquarium, fish tank, bird cage, pet bed, cat tree, dog crate,
litter box, curtain, drapes, roller blind, venetian blind, window shade, window sill, rug, area rug, runner rug,
doormat, carpet, yoga mat, cushion, floor cushion, bolster, seat cushion, pillow, stuffed animal, teddy bear, doll,
doll house, toy car, building blocks, puzzle, board game, ball, balloon, piano, grand piano, upright piano, keyboard
piano, guitar, violin, cello, drum, drum kit, harp, music stand, easel, mannequin, treadmill, exercise bike,
dumbbell, weight bench, punching bag, bicycle, skateboard, scooter, stroller, car seat, suitcase, backpack, handbag,
briefcase, duffel bag, shopping bag, box, cardboard box, crate, wicker basket, laundry basket, waste bin, recycling
bin, pedal bin, ashtray, book, stack of books, magazine, newspaper, notebook, binder, file folder, paper tray, pen
holder, desk organizer, stapler, scissors, ladder, step stool, toolbox, drill, fire extinguisher, first aid kit,
room divider, folding screen, partition, column, bookend, pouf, tissue box, hair dryer, iron, shoes, slippers,
boots, coat, hat, umbrella, clothes hanger, wall hook, door, sliding door, french door, cabinet door, closet door,
window, bay window, skylight, stairs, banister, elevator
""".replace("\n", " ")


def _words() -> tuple[str, ...]:
    own = [c.name for c in CATEGORIES if c is not UNKNOWN]
    synonyms = [s for c in CATEGORIES if c is not UNKNOWN for s in c.synonyms]
    more = [w.strip() for w in _MORE.split(",")]
    known = dict.fromkeys(" ".join(w.split()) for w in (*own, *synonyms, *more))
    return tuple(w for w in known if w and w not in ARCHITECTURE_WORDS)


INDOOR_WORDS: tuple[str, ...] = _words()
"""Several hundred nouns, each once: the library's own categories first, then their synonyms, then the rest."""
