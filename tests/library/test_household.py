"""The families of household things: how many, how heavy, in which styles, and that glass is glass."""

from __future__ import annotations

from collections import Counter, defaultdict
from pathlib import Path

import numpy as np
import pytest

from diorama_core.io.glb import read_glb
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.furniture import (
    bathroom,
    climate,
    containers,
    decor,
    electronics,
    kitchenware,
    leisure,
    lighting,
    openings,
    plants,
    textiles,
)
from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.materials import Material, pbr, picture_bytes
from diorama_core.library.furniture.model import Design
from diorama_core.library.furniture.prints import PRINTS
from diorama_core.library.taxonomy import UNKNOWN, resolve
from diorama_core.render.appearance import shape_surfaces
from diorama_core.render.world import PlacedSurface, World

FAMILIES = (
    lighting, climate, bathroom, electronics, leisure, textiles, plants, kitchenware, decor, containers, openings,
)  # fmt: skip
DESIGNS: tuple[Design, ...] = tuple(design for family in FAMILIES for design in family.DESIGNS)
STYLES = {"modern", "classic", "industrial", "rustic", "minimal"}


def test_there_are_many_in_every_style() -> None:
    assert len(DESIGNS) >= 300
    styles = Counter(design.style for design in DESIGNS)
    assert set(styles) == STYLES
    assert min(styles.values()) >= 50


def test_every_category_can_be_swapped_across_styles() -> None:
    styles: dict[str, set[str]] = defaultdict(set)
    for design in DESIGNS:
        styles[design.category].add(design.style)
    assert all(len(found) >= 2 for found in styles.values()), {c for c, found in styles.items() if len(found) < 2}


@pytest.mark.parametrize(
    ("word", "category"),
    [
        ("sconce", "wall lamp"), ("wine glasses", "glass"), ("frying pan", "cooking pot"),
        ("aircon", "air conditioner"),
        ("telly remote", "remote control"), ("rucksack", "backpack"), ("corkboard", "bulletin board"),
        ("blackboard", "whiteboard"), ("longcase clock", "grandfather clock"), ("cell phone", "smartphone"),
        ("exercise bike", "exercise machine"), ("loo brush", "toilet brush"),
        ("duvet", "blanket"), ("purse", "handbag"),
        ("teapot kettle", "kettle"), ("hamper", "laundry basket"), ("bike", "bicycle"), ("loudspeakers", "speaker"),
    ],
    ids=lambda value: value,
)  # fmt: skip
def test_people_find_them_by_their_words(word: str, category: str) -> None:
    assert resolve(word).category.name == category


@pytest.mark.parametrize("kind", sorted(PRINTS))
def test_prints_are_small_and_the_same_every_time(kind: str) -> None:
    material = Material(f"test {kind}", kind, "#6d7f83")
    first = picture_bytes(material)
    picture_bytes.cache_clear()
    assert picture_bytes(material) == first
    assert len(first) < 45_000


def test_glass_is_blended_and_lamps_shine_in_gltf(tmp_path: Path) -> None:
    library = built_in_library(tmp_path)
    tumbler, lamp = _materials(library.glb("cup-tumbler")), _materials(library.glb("lamp-globe"))
    assert tumbler["glass"]["alphaMode"] == "BLEND"
    assert tumbler["glass"]["pbrMetallicRoughness"]["baseColorFactor"][3] == pytest.approx(m.GLASS.alpha, abs=0.01)
    assert min(lamp["warm lampshade"]["emissiveFactor"]) > 0.05
    assert pbr(m.OAK).alphaMode in (None, "OPAQUE")


def _materials(glb: bytes) -> dict[str, dict]:
    return {material["name"]: material for material in read_glb(glb)[0]["materials"]}


def test_light_passes_through_glass_but_not_through_clay(tmp_path: Path) -> None:
    library = built_in_library(tmp_path)
    across = np.array([[-1.0, 0.0, 0.02, 2.0, 0.0, 0.0]], dtype=np.float32)
    for shape_id, blocked in (("cup-tumbler", False), ("cup-beaker", True)):
        world = World([PlacedSurface(shape_surfaces(library, shape_id), np.eye(4), 0)])
        assert world.caster.first_hits(across).is_hit.all()
        assert bool(world.shadow_caster().is_occluded(across, far=1.0)[0]) is blocked


@pytest.mark.parametrize(
    ("word", "category"),
    [("chiar", "chair"), ("tabel", "table"), ("lmap", "lamp"), ("wardrob", "wardrobe"), ("nightsand", "night stand"),
     ("armchiar", "armchair"), ("refridgerator", "refrigerator")],
)  # fmt: skip
def test_slips_are_understood(word: str, category: str) -> None:
    found = resolve(word)
    assert found.category.name == category
    assert "read as" in found.note


@pytest.mark.parametrize(
    "word",
    ["cat", "cats", "dog", "person", "wall", "floor", "cable", "fish", "car", "boots", "ladder", "food", "hammer"],
)
def test_words_of_other_things_are_no_slips(word: str) -> None:
    assert resolve(word).category is UNKNOWN
