from __future__ import annotations

import io

import numpy as np
import pytest
from PIL import Image

from diorama_core.library.furniture import designs, materials
from diorama_core.library.furniture.materials import Material, picture_bytes
from tests.shared_solids import built_once

ALL = [m for m in vars(materials).values() if isinstance(m, Material)]


@pytest.mark.parametrize("material", ALL, ids=lambda m: m.name)
def test_pictures_are_small_and_of_the_colour_they_claim(material: Material) -> None:
    data = picture_bytes(material)
    image = Image.open(io.BytesIO(data)).convert("RGB")
    assert max(image.size) <= 256
    assert len(data) < 60_000
    if material.kind not in ("screen", "mirror", "sky", "marble", "wicker"):
        mean = np.asarray(image).reshape(-1, 3).mean(axis=0) / 255
        assert np.abs(mean - material.rgb).max() < 0.05


def test_pictures_are_deterministic() -> None:
    first = picture_bytes(materials.OAK)
    picture_bytes.cache_clear()
    assert picture_bytes(materials.OAK) == first


def test_colours_are_muted() -> None:
    """No clown colours: the most saturated things in a room are leather, brass and terracotta."""
    used = {material for d in designs()[::8] for material, _ in built_once(d)}
    for material in used:
        high, low = material.rgb.max(), material.rgb.min()
        assert high - low < 0.45, material.name
