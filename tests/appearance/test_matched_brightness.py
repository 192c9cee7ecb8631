from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from diorama_core.appearance.matched_brightness import brighten, brightness_gains
from diorama_core.appearance.photo_appearance import photo_appearance
from diorama_core.appearance.room_cues import SETTINGS
from diorama_core.io.srgb import linear_to_srgb, srgb_to_linear
from diorama_core.library.catalogue import built_in_library
from diorama_core.render.picture import picture
from diorama_core.scene.types import PhotoMaterial, Pose, Scene, SceneObject
from tests.appearance.test_photo_appearance import SIZE, camera, detected

LIBRARY = built_in_library()


def dresser(linear: float) -> Scene:
    shape = LIBRARY.shape("dresser-white-four")
    grey = float(linear_to_srgb(np.array(linear)))
    own = (PhotoMaterial("wood", (grey, grey, grey), main=True), PhotoMaterial("paint", (grey, grey, grey)))
    pose = Pose.upright((0.5, 0.6, shape.size_m[2] / 2), -np.pi / 2 + 0.3)
    item = SceneObject("dresser_1", "dresser", shape.category, shape.id, shape.size_m, pose, photo_materials=own)
    return Scene(camera=camera(), objects=(item,))


@pytest.mark.parametrize("factor", [1.3, 0.75])
def test_the_gain_is_what_the_material_lacks(factor: float) -> None:
    seen, read = dresser(0.3), dresser(0.3 / factor)
    photo, mask = picture(seen, LIBRARY, size=SIZE), detected(seen)[0].mask
    inner = cv2.erode(mask.astype(np.uint8), np.ones((5, 5), np.uint8)).astype(bool)
    gains = brightness_gains(photo, {"dresser_1": inner}, read, {}, LIBRARY)
    assert gains["dresser_1"] == pytest.approx(factor, rel=0.12)


def test_highlights_and_what_lies_before_it_do_not_make_a_thing_brighter() -> None:
    seen = dresser(0.15)
    photo, mask = picture(seen, LIBRARY, size=SIZE), detected(seen)[0].mask
    inner = cv2.erode(mask.astype(np.uint8), np.ones((5, 5), np.uint8)).astype(bool)
    _, columns = np.nonzero(inner)
    glossy = inner.copy()
    glossy[:, : int(np.quantile(columns, 0.7))] = False
    photo[glossy] = 255
    gains = brightness_gains(photo, {"dresser_1": inner}, seen, {}, LIBRARY)
    assert gains["dresser_1"] == pytest.approx(1.0, rel=0.05)


def test_another_surface_than_the_one_that_is_seen_is_not_followed() -> None:
    seen, read = dresser(0.6), dresser(0.02)
    photo, mask = picture(seen, LIBRARY, size=SIZE), detected(seen)[0].mask
    assert brightness_gains(photo, {"dresser_1": mask}, read, {}, LIBRARY)["dresser_1"] == SETTINGS.max_gain
    few = np.zeros_like(mask)
    few[100:102, 200:202] = True
    assert brightness_gains(photo, {"dresser_1": few}, read, {}, LIBRARY) == {}
    assert brightness_gains(photo, {"dresser_1": mask}, replace(read, camera=None), {}, LIBRARY) == {}


def test_colours_and_pictures_are_scaled_and_sets_stay_alike() -> None:
    plaid = np.random.default_rng(0).integers(40, 120, (8, 8, 3)).astype(np.uint8)
    cloth = PhotoMaterial("fabric", (0.3, 0.4, 0.35), "chair-1-fabric-00000000", main=True)
    white = PhotoMaterial("paint", (0.95, 0.95, 0.95), main=True)
    materials = {"chair_1": (cloth,), "chair_2": (cloth,), "vase_1": (white,), "cup_1": (white,)}
    made, pictures = brighten(
        materials, {cloth.texture: plaid}, {"chair_1": 1.44, "chair_2": 1.0, "vase_1": 1.5}, [["chair_1", "chair_2"]]
    )
    assert made["chair_1"] == made["chair_2"]
    np.testing.assert_allclose(
        srgb_to_linear(np.array(made["chair_1"][0].colour)), 1.2 * srgb_to_linear(np.array(cloth.colour)), rtol=1e-6
    )
    ((name, lit),) = pictures.items()
    assert name == made["chair_1"][0].texture != cloth.texture
    np.testing.assert_allclose(srgb_to_linear(lit / 255.0), 1.2 * srgb_to_linear(plaid / 255.0), atol=0.004)
    assert made["cup_1"] == (white,)
    np.testing.assert_allclose(made["vase_1"][0].colour, white.colour, atol=0.01)


def test_the_photos_look_is_as_bright_as_the_photo() -> None:
    seen = dresser(0.35)
    photo, found = picture(seen, LIBRARY, size=SIZE), detected(seen)
    plain = replace(seen, objects=(replace(seen.objects[0], photo_materials=()),))
    look = photo_appearance(photo, found, plain, LIBRARY)
    shown = picture(look.apply(plain), LIBRARY, size=SIZE, textures=look.pictures)
    level = [float(srgb_to_linear(p[found[0].mask] / 255.0).mean()) for p in (photo, shown)]
    assert level[1] == pytest.approx(level[0], rel=0.08)
