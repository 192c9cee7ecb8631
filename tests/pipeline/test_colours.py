from __future__ import annotations

import numpy as np

from diorama_core.artefacts import DetectedObject
from diorama_core.pipeline.colours import photo_colours, share_set_colours


def _object(name: str, category: str, mask: np.ndarray) -> DetectedObject:
    return DetectedObject(name, category, name, (0, 0, 1, 1), mask, 1, 1.0)


def _masks() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rgb = np.full((60, 80, 3), 200, np.uint8)
    sofa, pillow = np.zeros((60, 80), bool), np.zeros((60, 80), bool)
    sofa[20:50, 10:70] = True
    pillow[22:40, 12:60] = True
    rgb[sofa] = (30, 60, 140)
    rgb[pillow] = (180, 40, 30)
    return rgb, sofa, pillow


def test_what_lies_in_front_does_not_colour_what_is_behind() -> None:
    rgb, sofa, pillow = _masks()
    colours = photo_colours(rgb, (_object("sofa", "sofa", sofa), _object("pillow", "pillow", pillow)))
    np.testing.assert_allclose(colours["sofa"], np.array([30, 60, 140]) / 255, atol=0.02)
    np.testing.assert_allclose(colours["pillow"], np.array([180, 40, 30]) / 255, atol=0.02)


def test_shade_does_not_split_a_colour() -> None:
    _, sofa, _ = _masks()
    shade = np.linspace(0.6, 1.0, 80)[None, :, None]
    shaded = (np.full((60, 80, 3), (60, 120, 200)) * shade).astype(np.uint8)
    red, green, blue = photo_colours(shaded, (_object("sofa", "sofa", sofa),))["sofa"]
    assert red < green < blue


def test_many_coloured_tiny_and_empty_objects_are_left_as_they_are(rng: np.random.Generator) -> None:
    _, sofa, _ = _masks()
    noise = rng.integers(0, 255, (60, 80, 3), dtype=np.uint8)
    dot = np.zeros((60, 80), bool)
    dot[5, 5] = True
    objects = (_object("a", "sofa", sofa), _object("b", "chair", dot), _object("c", "chair", np.zeros_like(dot)))
    assert photo_colours(noise, objects) == {}
    rgb, sofa, _ = _masks()
    assert photo_colours(rgb, (_object("p", "plant", sofa),)) == {}


def test_chairs_of_one_shape_share_the_surest_colour() -> None:
    _, big, _ = _masks()
    small = big.copy()
    small[:, 20:] = False
    objects = (_object("a", "chair", small), _object("b", "chair", big), _object("c", "chair", small))
    colours = {"a": (0.8, 0.0, 0.0), "b": (0.9, 0.0, 0.0), "c": (0.2, 0.2, 0.2)}
    shared = share_set_colours(colours, objects, {"a": "shell", "b": "shell", "c": "windsor"})
    assert shared == {"a": (0.9, 0.0, 0.0), "b": (0.9, 0.0, 0.0), "c": (0.2, 0.2, 0.2)}


def test_chairs_that_differ_keep_their_colours_and_lend_them_to_their_like() -> None:
    _, big, _ = _masks()
    hidden = np.zeros_like(big)
    hidden[20:24, 10:14] = True
    objects = tuple(_object(name, "chair", hidden if name == "d" else big) for name in "abcde")
    red, dark_red, blue = (0.8, 0.1, 0.1), (0.72, 0.08, 0.09), (0.1, 0.2, 0.7)
    colours = {"a": red, "b": blue, "c": dark_red, "d": (0.4, 0.4, 0.4)}
    shared = share_set_colours(colours, objects, dict.fromkeys("abcde", "shell"))
    assert shared["b"] == blue
    assert shared["a"] == shared["c"]
    assert shared["d"] in (blue, shared["a"])
    assert shared["e"] in (blue, shared["a"])


def test_the_light_of_a_lamp_is_no_colour_of_it() -> None:
    rgb, lamp, _ = _masks()
    rgb[lamp] = (250, 240, 190)
    assert photo_colours(rgb, (_object("lit", "floor lamp", lamp),)) == {}
    rgb[15:50, 10:30] = (40, 90, 60)
    colours = photo_colours(rgb, (_object("lit", "floor lamp", lamp),))
    np.testing.assert_allclose(colours["lit"], np.array([40, 90, 60]) / 255, atol=0.02)


def test_lamps_of_one_shape_are_of_one_colour() -> None:
    _, big, small = _masks()
    objects = (_object("a", "lamp", small), _object("b", "lamp", big))
    colours = {"a": (0.2, 0.24, 0.2), "b": (0.25, 0.25, 0.24)}
    assert set(share_set_colours(colours, objects, {"a": "bell", "b": "bell"}).values()) == {colours["b"]}
