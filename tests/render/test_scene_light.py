"""The sun comes in through the window only, lamps shine where they are switched on, exposure brightens all."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.render.lamps import lamps_of, shining_lamps
from diorama_core.render.lighting import Effort
from diorama_core.render.picture import picture
from diorama_core.scene.light_settings import LightSettings
from diorama_core.scene.types import Scene, SceneObject
from tests.geometry.test_sun import room
from tests.primitives import PrimitiveLibrary, furnished_room

LIBRARY = PrimitiveLibrary()
QUICK = Effort(1, 1)
NORTH_NEAR = -np.pi / 2
"""North is near (-y), so that the noon sun shines in through the far wall."""


def seen(scene: Scene, settings: LightSettings) -> np.ndarray:
    """The floor from above, linear enough to compare."""
    shown = replace(scene, light_settings=settings)
    return picture(shown, LIBRARY, view="top", size=(80, 80), effort=QUICK).astype(float).mean(axis=-1)


def sunny_room() -> Scene:
    scene = room()
    shape = LIBRARY.shapes()[0]
    window = replace(scene.objects[0], shape_id=shape.id)
    return replace(scene, objects=(window,))


def test_the_sun_falls_through_the_window_and_nowhere_else() -> None:
    scene = sunny_room()
    noon = seen(scene, LightSettings(12.0, NORTH_NEAR))
    walled = seen(replace(scene, objects=(), supports=()), LightSettings(12.0, NORTH_NEAR))
    behind = seen(scene, LightSettings(12.0, -NORTH_NEAR))
    patch, corner = noon[30:36, 38:42].mean(), noon[55:65, 15:25].mean()
    assert patch > corner + 40, "a patch of sun before the window"
    assert np.ptp(walled[20:60, 20:60]) < 60, "no sun without a window"
    assert behind[30:36, 38:42].mean() < patch - 40, "none when it stands behind the house"


def test_night_is_dark_and_exposure_brightens() -> None:
    scene = sunny_room()
    night = seen(scene, LightSettings(0.0, NORTH_NEAR))[20:60, 20:60].mean()
    day = seen(scene, LightSettings(12.0, NORTH_NEAR))[20:60, 20:60].mean()
    long = seen(scene, LightSettings(0.0, NORTH_NEAR, exposure_ev=2.0))[20:60, 20:60].mean()
    assert night < 0.6 * day
    assert night + 10 < long


def lamp_room() -> tuple[Scene, SceneObject]:
    scene = furnished_room(LIBRARY)
    lamp = replace(scene.object("b"), category="lamp")
    return replace(scene, objects=tuple(lamp if o.id == "b" else o for o in scene.objects)), lamp


def test_only_lamps_that_are_on_and_shown_shine() -> None:
    scene, lamp = lamp_room()
    assert lamps_of(scene) == (lamp,)
    assert shining_lamps(scene) == ()
    on = replace(scene, light_settings=LightSettings(lamps_on=("b", "gone")))
    assert shining_lamps(on) == (lamp,)
    hidden = replace(on, objects=tuple(replace(o, hidden=o.id == "b") for o in on.objects))
    assert shining_lamps(hidden) == ()


def test_a_lamp_lights_the_room_at_night() -> None:
    scene, _ = lamp_room()
    dark = picture(
        replace(scene, light_settings=LightSettings(0.0)), LIBRARY, view="photo", size=(96, 72), effort=QUICK
    ).mean()
    lit = picture(
        replace(scene, light_settings=LightSettings(0.0, lamps_on=("b",))),
        LIBRARY, view="photo", size=(96, 72), effort=QUICK,
    )  # fmt: skip
    assert lit.mean() > dark + 8
    assert lit[..., 0].mean() > lit[..., 2].mean() + 2, "warm"


def test_nothing_chosen_leaves_pictures_as_they_were() -> None:
    scene = furnished_room(LIBRARY)
    given = picture(scene, LIBRARY, size=(48, 36), effort=QUICK)
    same = picture(replace(scene, light_settings=LightSettings(north_rad=1.0)), LIBRARY, size=(48, 36), effort=QUICK)
    assert given == pytest.approx(same)
