"""Names of objects that are no category of their own, each with the category most like it in form and use.

They count as near, never as exact: the user is told which category was used. Names that the class lists of indoor
data sets and the shelves of furniture shops use.
"""

from __future__ import annotations

from functools import cache

from diorama_core.library.language import tokens

_NEAR: dict[str, str] = {
    "chair": (
        "seat, wheelchair, patio chair, garden chair, deck chair, beach chair, director chair, throne, camp chair"
    ),
    "office chair": "drafting chair, executive chair",
    "armchair": "bergere, fauteuil, papasan, egg chair, massage chair, barrel chair, slipper chair",
    "stool": "perch, kneeler, pommel, tabouret",
    "bench": "pew, bleacher, window seat, banquette, weight bench, work bench, workbench, treadmill, park bench",
    "sofa": "canape, sofabed, cabriole, lawson, hideabed, ottoman sofa, swing seat, porch swing, airport seating",
    "ottoman": "tuffet, floor cushion, gym ball, exercise ball, drum stool, pet bed, dog bed, cat bed",
    "table": (
        "refectory table, picnic table, ping pong table, table tennis table, pool table, billiard table, snooker "
        "table, foosball table, altar, work table, operating table, massage table, tabletop, drop leaf table"
    ),
    "coffee table": "kotatsu, tea table, chabudai",
    "side table": (
        "plant stand, plinth, pedestal, telephone table, tray table, drum table, nest of tables, smoking table"
    ),
    "desk": (
        "escritoire, secretaire, secretary, lectern, podium, drafting table, drawing table, easel desk, school "
        "desk, roll top, reception desk, cubicle"
    ),
    "bed": "berth, hospital bed, stretcher, hammock, futon bed, air bed, sleeping bag, box spring",
    "night stand": "bedside unit, bedside shelf, bedside chest",
    "dresser": "chiffonier, highboy, lowboy, bachelor chest, semainier, bureau chest, lingerie chest",
    "cabinet": (
        "armadio, medicine cabinet, cupboard unit, storage unit, storage, safe, bathroom cabinet, bathroom vanity, "
        "washstand cabinet, vending machine, dollhouse, closet organiser, gun cabinet, cellarette, fuse box, "
        "mailbox"
    ),
    "sideboard": "dry sink, console unit, commode chest, radiogram, record player cabinet",
    "console table": "entryway table, demilune, pier table, half moon table",
    "tv stand": "av rack, hi fi rack, stereo rack, television bench, low board, lowboard",
    "bookshelf": (
        "etagere, whatnot, bookrack, book rack, magazine rack, cd rack, media shelf, baker's rack, ladder shelf, "
        "cube storage, display shelf, pigeonholes, ladder, stepladder, storage rack, newspaper rack"
    ),
    "wardrobe": (
        "chifforobe, press, schrank, kast, clothes press, cloakroom, shower, shower cabin, shower stall, phone "
        "booth, telephone booth, elevator"
    ),
    "refrigerator": "cool box, mini fridge, wine cooler, ice maker, chiller",
    "stove": "aga, rangetop, grill, barbecue, bbq, furnace",
    "washing machine": "spin dryer, boiler, water heater",
    "kitchen counter": "kitchenette, checkout counter, reception counter, work surface, workbench counter",
    "sink": "lavabo, trough, bidet sink, faucet, tap",
    "toilet": "urinal, bidet, commode toilet, water closet, latrine",
    "bathtub": "jacuzzi, hot tub, whirlpool, paddling pool",
    "floor lamp": (
        "arc lamp, uplighter, tripod lamp, studio light, street lamp, reading light, music stand, microphone stand, "
        "easel, tripod, telescope"
    ),
    "lamp": (
        "lantern, candlestick, candle, candelabra, night light, lava lamp, torch, bankers lamp, lampshade, oil "
        "lamp, nightlight, light"
    ),
    "ceiling lamp": (
        "spotlight, downlight, luster, lustre, sconce, wall lamp, wall light, track light, disco ball, bulb, light "
        "bulb, light fixture, fluorescent tube"
    ),
    "television": "plasma, lcd, led tv, oled, projector screen, home cinema, smart tv",
    "monitor": "vdu, crt, touch screen, tablet, ipad, kindle, e reader, whiteboard screen",
    "laptop": "chromebook, netbook, ultrabook, notebook",
    "computer": (
        "workstation computer, server tower, console, game console, xbox, playstation, photocopier, copier, fax, "
        "fax machine, scanner, router, speaker, loudspeaker, subwoofer, stereo, amplifier, hi fi, radio, projector, "
        "dvd player, video recorder, set top box, shredder, cash register, aquarium, fish tank, sewing machine"
    ),
    "keyboard": (
        "remote, remote control, mouse, telephone, phone, mobile phone, smartphone, calculator, game controller"
    ),
    "microwave": (
        "coffee machine, coffee maker, espresso machine, bread machine, air fryer, steamer, rice cooker, kettle, "
        "blender, mixer, food processor, juicer, slow cooker, bread bin, sandwich maker, waffle iron, iron"
    ),
    "pillow": (
        "headrest, seat pad, chair pad, blanket, throw, duvet, comforter, quilt, bedspread, towel, folded clothes, "
        "bath towel, tea towel, clothes, coat, jacket, shirt, hat, scarf, backpack"
    ),
    "books": (
        "novel, dictionary, encyclopedia, folder, ring binder, binder, notepad, notebooks, newspaper, dvd, record, "
        "vinyl, album, journal, comic, envelope, document, clipboard, board game"
    ),
    "plant": (
        "cactus, fern, palm, bonsai, orchid, ficus, monstera, ivy, shrub, bush, bouquet, herb, flowerpot, planter, "
        "christmas tree, bamboo plant, aloe, sunflower, rose, tulip, wreath, hedge"
    ),
    "vase": (
        "amphora, ewer, carafe, decanter, statue, sculpture, bust, figurine, ornament, trophy, teapot, coffeepot, "
        "watering can, statuette, globe, hourglass, birdcage, cage, pot, cooking pot, saucepan, stockpot, fire "
        "extinguisher"
    ),
    "bowl": (
        "salad bowl, basin bowl, ashtray, saucer bowl, soup bowl, dog bowl, colander, pan, frying pan, wok, helmet"
    ),
    "cup": (
        "beaker, chalice, pencil holder, pen holder, toothbrush holder, soap dish, soap, egg cup, shot glass, "
        "candle holder, salt shaker, pepper mill, can, tin can"
    ),
    "bottle": (
        "flagon, thermos, vacuum flask, water bottle, soap dispenser, shampoo, lotion, spray, beer bottle, perfume, "
        "ketchup, jerrycan"
    ),
    "clock": (
        "timepiece, wristwatch, watch, thermostat, smoke detector, cuckoo clock, sundial, metronome, dartboard, "
        "light switch, switch, socket, power outlet, outlet, fire alarm, wall plaque"
    ),
    "box": (
        "parcel, package, bin box, cooler box, crate box, toolbox, briefcase, handbag, shopping bag, sack, packet, "
        "tissue box, shoebox, tote, cat carrier, litter box, jewelry box, drawer box, block, cube, concrete block, "
        "stapler, shoe, boot, slipper, sandal, trainer"
    ),
    "basket": (
        "laundry hamper, laundry bin, picnic basket, bread basket, bucket, pail, umbrella stand, creel, pram, "
        "stroller, shopping cart"
    ),
    "trash can": (
        "ash bin, recycling bin, garbage, pedal bin, wheelie bin, waste container, waste paper basket, rubbish, "
        "barrel, drum barrel, keg"
    ),
    "picture": (
        "canvas, mural, tapestry, map, calendar, certificate, banner, flag, sign, chalkboard, noticeboard, bulletin "
        "board, pinboard, cork board, projection screen, fresco, photo, portrait, wall art, decal, wall hanging, "
        "headboard"
    ),
    "mirror": "cheval glass, pier glass, dressing mirror, hand mirror, shaving mirror",
    "shelves": (
        "bracket, ledge, plate rack, towel rack, towel rail, spice rack, hook, coat hook, mantel shelf, key rack, "
        "pegboard, wall rack, hanger, peg rail, ski rack"
    ),
    "curtain": (
        "drapery, shade, window shade, valance, shutter, venetian blind, roller blind, net curtain, sheer, screen "
        "door, mosquito net, canopy"
    ),
    "window": "skylight, casement, dormer, porthole, bay window, pane, glazing",
    "door": "gate, entrance, hatch, sliding door, garage door, patio door, turnstile, stable door",
    "radiator": "baseboard heater, storage heater, heating panel, towel warmer, vent, air vent, grille",
    "rug": (
        "runner, doormat, door mat, yoga mat, tatami, kilim, sheepskin, cowhide, exercise mat, linoleum, bathmat, "
        "bath rug, tablecloth, place mat, placemat"
    ),
    "piano": "grand piano, organ, harpsichord, spinet, pianola, harmonium, synthesizer, xylophone, drum kit",
    "toy": (
        "puppet, action figure, lego, rocking horse, toy car, robot, plush, soft toy, puzzle, stuffed toy, model "
        "car, model ship, guitar, violin, football, basketball, skateboard, cat, dog, bear, rabbit"
    ),
    "fan": "ventilator, air purifier, humidifier, dehumidifier, hair dryer, vacuum cleaner, hoover",
    "fireplace": "ingle, chimneypiece, pellet stove, kiln",
    "room divider": (
        "partition, byobu, trellis, fence, railing, stair gate, baby gate, playpen, fireguard, balustrade"
    ),
    "coat rack": (
        "valet stand, hat rack, clothes horse, drying rack, ironing board, clothes dryer rack, clothes stand, "
        "mannequin, broom, mop, vacuum"
    ),
    "chest": "coffer, ottoman box, kist, footlocker, cedar chest, treasure chest, tuck box, window chest, log box",
    "bar cart": (
        "tea cart, dessert trolley, hospital trolley, tool trolley, gueridon, luggage cart, wheelbarrow, bicycle"
    ),
}
"""Lists by category, as above."""


@cache
def near_names() -> dict[tuple[str, ...], str]:
    """Normal words of each name (`language.tokens`), and the category it is near to."""
    table: dict[tuple[str, ...], str] = {}
    for category, names in _NEAR.items():
        for name in names.split(","):
            table.setdefault(tokens(name), category)
    return table
