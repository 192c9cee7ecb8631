from __future__ import annotations

import json
from dataclasses import replace

import pytest

from diorama_app.viewport.mesh_assets import ShapeBytes
from diorama_app.viewport.room_light import MAX_LAMPS_LIGHT, RoomLightView
from diorama_core.scene.light_settings import LightSettings
from diorama_core.scene.types import RoomLight, Scene
from tests.app.people import node
from tests.app.small_room import PlainLibrary, furnished_scene
from tests.geometry.test_sun import room

SCENE = furnished_scene()
DAY, NIGHT = LightSettings(hour=12.0, north_rad=-1.5707963), LightSettings(hour=0.0, north_rad=-1.5707963)


@pytest.fixture(params=[False, True], ids=["full graphics", "low graphics"])
def lights(server, request):
    made = RoomLightView(server, ShapeBytes(PlainLibrary()))
    made.begin(low_graphics=request.param)
    made.low = request.param
    yield made
    server.scene.reset()


def lit(scene: Scene, settings: LightSettings) -> Scene:
    return replace(scene, light_settings=settings)


def names(server, stem: str) -> list[str]:
    return [n for n in server.scene._handle_from_node_name if n.startswith(stem)]


def test_the_photos_light_is_the_default_and_comes_back(server, lights) -> None:
    scene = replace(SCENE, light=RoomLight((0.0, 0.6, 0.8), 0.5, (1.0, 0.5, 0.25)))
    lights.show(scene, lambda i: f"/objects/{i}")
    main = node(server, "/lights/main")
    assert main.color == (255, 128, 64)
    before = main.intensity
    lights.show(lit(scene, DAY), lambda i: f"/objects/{i}")
    assert node(server, "/lights/main") is None
    assert node(server, "/lights/sun").intensity > 0
    lights.show(scene, lambda i: f"/objects/{i}")
    assert node(server, "/lights/main").intensity == before
    assert node(server, "/lights/sun") is None
    assert lights.told == "null"


def test_walls_hold_the_sun_off_or_patches_show_it(server, lights) -> None:
    lights.show(lit(room(), DAY), lambda i: f"/objects/{i}")
    if lights.low:
        assert names(server, "/lights/patch")
        assert node(server, "/lights/walls") is None
        assert not lights.casts_sun
    else:
        walls = node(server, "/lights/walls")
        assert walls.cast_shadow
        assert walls.opacity == 0.0
        told = json.loads(lights.told)
        assert told["panes"] == ["/objects/window_1"]
        assert told["radius"] > 2.0
        assert lights.casts_sun
        assert not names(server, "/lights/patch")
    lights.show(lit(room(), NIGHT), lambda i: f"/objects/{i}")
    assert node(server, "/lights/sun").intensity == 0.0
    assert not names(server, "/lights/patch")


def test_exposure_scales_every_light(server, lights) -> None:
    lights.show(SCENE, lambda i: f"/objects/{i}")
    before = node(server, "/lights/sky").intensity, node(server, "/lights/main").intensity
    lights.show(lit(SCENE, LightSettings(exposure_ev=1.0)), lambda i: f"/objects/{i}")
    after = node(server, "/lights/sky").intensity, node(server, "/lights/main").intensity
    assert after == pytest.approx((2 * before[0], 2 * before[1]))


def test_lamps_shine_below_their_objects_and_stop(server, lights) -> None:
    frame = server.scene.add_frame("/objects/lamp_1")
    lights.show(lit(SCENE, LightSettings(lamps_on=("lamp_1",))), lambda i: f"/objects/{i}")
    lamp = node(server, "/objects/lamp_1/lamp")
    assert lamp.intensity > 0
    assert json.loads(lights.told)["lamps"][0][:2] == ["/objects/lamp_1", True]
    lights.show(lit(SCENE, LightSettings(lamps_on=())), lambda i: f"/objects/{i}")
    assert node(server, "/objects/lamp_1/lamp") is None
    frame.remove()


def test_low_graphics_shows_a_few_lamps_only(server) -> None:
    view = RoomLightView(server, ShapeBytes(PlainLibrary()))
    view.begin(low_graphics=True)
    lamp = SCENE.object("lamp_1")
    many = tuple(replace(lamp, id=f"lamp_{n}") for n in range(7))
    for item in many:
        server.scene.add_frame(f"/objects/{item.id}")
    scene = replace(SCENE, objects=many, supports=(), light_settings=LightSettings(lamps_on=tuple(o.id for o in many)))
    view.show(scene, lambda i: f"/objects/{i}")
    assert sum(name.endswith("/lamp") for name in names(server, "/objects/")) == MAX_LAMPS_LIGHT
    server.scene.reset()
