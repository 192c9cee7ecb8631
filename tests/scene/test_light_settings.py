from __future__ import annotations

import json
from dataclasses import replace

import pytest

from diorama_core.errors import SceneError
from diorama_core.scene.light_settings import PHOTO_LIGHT, LightSettings
from diorama_core.scene.schema import scene_from_json, scene_to_json
from diorama_core.scene.types import Scene


@pytest.mark.parametrize("wrong", [{"hour": 25.0}, {"hour": -1.0}, {"exposure_ev": 9.0}, {"north_rad": float("nan")}])
def test_impossible_light_is_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(ValueError, match=r"must be"):
        LightSettings(**wrong)


def test_a_stop_doubles_the_light() -> None:
    assert LightSettings(exposure_ev=1.0).exposure == 2.0
    assert PHOTO_LIGHT.exposure == 1.0


@pytest.mark.parametrize(
    "settings", [PHOTO_LIGHT, LightSettings(7.25, 0.3, -1.5, ("lamp_1",)), LightSettings(lamps_on=())]
)
def test_the_scene_file_keeps_it(settings: LightSettings) -> None:
    scene = replace(Scene(), light_settings=settings)
    assert scene_from_json(scene_to_json(scene)) == scene


def test_a_file_without_it_has_the_light_of_the_photo_and_a_wrong_one_is_refused() -> None:
    text = scene_to_json(Scene())
    document = json.loads(text)
    del document["light_settings"]
    assert scene_from_json(json.dumps(document)).light_settings == PHOTO_LIGHT
    with pytest.raises(SceneError, match="hour"):
        scene_from_json(text.replace('"hour": null', '"hour": 30'))
