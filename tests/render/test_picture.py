"""Pictures of scenes: the right things in the right places, in the right colours."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.errors import Cancelled, InputError, SceneError
from diorama_core.progress import CancelToken, Progress, ProgressEvent
from diorama_core.render.lighting import Effort
from diorama_core.render.picture import BACKGROUND_SRGB, instances_seen, picture, scene_view
from diorama_core.render.raycast import PinholeView
from diorama_core.scene.types import Architecture, Camera, Plane, Scene, SurfaceFinish
from tests.primitives import PrimitiveLibrary, box_room, eye_camera, furnished_room, place

LIBRARY = PrimitiveLibrary()
SCENE = furnished_room(LIBRARY)
QUICK = Effort(1, 1)
SMALL = (160, 120)
BACKGROUND = np.rint(np.array(BACKGROUND_SRGB) * 255)


def quick(scene: Scene, **how) -> np.ndarray:
    return picture(scene, LIBRARY, **{"size": SMALL, "effort": QUICK, **how})


def camera_of(scene: Scene, view: str = "photo", size: tuple[int, int] = SMALL) -> Camera:
    shown = scene_view(scene, view, size)
    assert isinstance(shown, PinholeView)
    return shown.camera


def pixel(camera: Camera, point: object) -> tuple[int, int]:
    """Row and column."""
    column, row = camera.project(np.asarray(point))
    return int(row), int(column)


def pixel_of(scene: Scene, object_id: str) -> tuple[int, int]:
    """Row and column where the object's centre is in the photo view."""
    return pixel(camera_of(scene), scene.object(object_id).pose.position)


def redness(colour: np.ndarray) -> float:
    return float(colour[0]) - float(max(colour[1], colour[2]))


def test_photo_view_puts_objects_where_the_camera_sees_them() -> None:
    image = quick(SCENE)
    assert image.shape == (120, 160, 3)
    assert image.dtype == np.uint8
    assert redness(image[pixel_of(SCENE, "b")]) > 80, "the red ball"
    without = quick(replace(SCENE, objects=SCENE.objects[:3]))
    assert redness(without[pixel_of(SCENE, "b")]) < 80


def test_what_a_pixel_shows_is_told_without_light() -> None:
    shown = instances_seen(SCENE, LIBRARY, size=SMALL)
    assert shown.shape == (120, 160)
    assert set(range(len(SCENE.objects))) <= set(np.unique(shown).tolist())
    ball = next(k for k, item in enumerate(SCENE.objects) if item.id == "b")
    assert shown[pixel_of(SCENE, "b")] == ball
    planes = np.unique(shown[shown >= len(SCENE.objects)]) - len(SCENE.objects)
    assert len(planes)
    assert all(0 <= p < len(SCENE.architecture.planes) for p in planes)


def test_any_point_may_be_looked_from_and_at() -> None:
    x, y, z = SCENE.object("b").pose.position
    shown = instances_seen(SCENE, LIBRARY, view=f"look:{x},{y - 1.0},{z + 0.3}:{x},{y},{z}", size=SMALL)
    assert SCENE.objects[shown[60, 80]].id == "b"
    above = instances_seen(SCENE, LIBRARY, view=f"look:{x},{y},{z + 1.0}:{x},{y},{z}", size=SMALL)
    assert SCENE.objects[above[60, 80]].id == "b"


@pytest.mark.parametrize("view", ["look:", "look:0,0,1", "look:0,0,1:0,0,1", "look:0,0,nan:1,1,1", "look:a,b,c:0,0,0"])
def test_a_look_from_nowhere_is_refused(view: str) -> None:
    with pytest.raises(InputError, match="two points in metres"):
        scene_view(SCENE, view, SMALL)


def test_hidden_objects_are_not_drawn() -> None:
    hidden = replace(SCENE, objects=tuple(replace(o, hidden=o.id == "b") for o in SCENE.objects))
    assert redness(quick(hidden)[pixel_of(SCENE, "b")]) < 80


def test_colour_override_shows() -> None:
    paint = (0.1, 0.8, 0.1)
    green = replace(SCENE, objects=tuple(replace(o, colour=paint) if o.id == "b" else o for o in SCENE.objects))
    colour = quick(green)[pixel_of(SCENE, "b")].astype(int)
    assert colour[1] > colour[0] + 60


def test_the_print_is_upright_and_not_mirrored() -> None:
    """Seen from inside the room: blue bar above, red left of green."""
    camera, pose = camera_of(SCENE, size=(480, 360)), SCENE.object("p").pose
    image = quick(SCENE, size=(480, 360)).astype(int)

    def seen(across: float, up: float) -> np.ndarray:
        return image[pixel(camera, pose.apply(np.array([0.01, across, up])))]

    assert seen(-0.2, 0.0).argmax() == 0, "its own right, which the viewer sees on the left, is red"
    assert seen(0.2, 0.0).argmax() == 1
    assert seen(0.0, 0.26).argmax() == 2


def test_plane_textures_are_laid_the_right_way() -> None:
    """Quarters of a wall's picture, seen from inside the room."""
    quarters = np.zeros((64, 64, 3), np.uint8)
    quarters[:32, :32], quarters[:32, 32:] = (200, 0, 0), (0, 200, 0)
    quarters[32:, :32], quarters[32:, 32:] = (0, 0, 200), (200, 200, 0)
    room = box_room()
    planes = tuple(replace(p, texture="w.png") if p.id == "back" else p for p in room.planes)
    scene = Scene(eye_camera(), Architecture(planes))
    image = quick(scene, textures={"w.png": quarters}).astype(int)

    def seen(x: float, z: float) -> np.ndarray:
        return image[pixel(camera_of(scene), (x, 5.0, z))]

    assert seen(-1, 1.9).argmax() == 0
    assert seen(1, 1.9).argmax() == 1
    assert seen(-1, 0.6).argmax() == 2
    assert seen(1, 0.6)[2] < 60


def test_top_view_is_open_and_to_scale() -> None:
    view = scene_view(SCENE, "top", (200, 200))
    image = picture(SCENE, LIBRARY, view="top", size=(200, 200), effort=QUICK)
    plain = picture(replace(SCENE, objects=()), LIBRARY, view="top", size=(200, 200), effort=QUICK)
    changed = np.abs(image.astype(int) - plain.astype(int)).max(axis=-1) > 40
    assert changed.sum() > 100, "furniture is seen through the missing ceiling"
    middle_column = 100 + 0.2 / view.metres_per_pixel  # the table's x; north is up
    assert changed[:, int(middle_column)].any()


@pytest.mark.parametrize("view", ["front", "orbit:0", "orbit:45", "orbit:-120.5"])
def test_rooms_stay_open_toward_the_viewer(view: str) -> None:
    image = picture(SCENE, LIBRARY, view=view, size=SMALL, effort=QUICK)
    red = [redness(c) for c in image.reshape(-1, 3)]
    assert max(red) > 80, "the ball on the table is seen past the walls"
    assert (image[0, 0] == BACKGROUND).all()


def test_objects_on_a_wall_seen_from_behind_go_with_it() -> None:
    without = replace(SCENE, objects=SCENE.objects[:4], supports=SCENE.supports[:4])
    image, bare = (quick(one, view="orbit:180").astype(int) for one in (SCENE, without))
    at = pixel(camera_of(SCENE, "orbit:180"), SCENE.object("p").corners_world.mean(axis=0))
    assert np.abs(image[at] - bare[at]).max() < 12


def test_everything_fits_an_orbit_picture() -> None:
    corners = np.concatenate([p.polygon for p in SCENE.architecture.planes])
    for angle in (0, 33, 90, 200):
        camera = camera_of(SCENE, f"orbit:{angle}", (300, 200))
        pixels = camera.project(corners)
        assert (camera.to_camera(corners)[:, 2] > 0).all()
        assert (pixels >= 0).all()
        assert (pixels <= [300, 200]).all()
        spread = pixels.max(axis=0) - pixels.min(axis=0)
        assert (spread / [300, 200]).max() > 0.8, "and fills it"


def test_another_aspect_is_never_stretched() -> None:
    for size in ((320, 240), (500, 200), (200, 500)):
        k = camera_of(SCENE, size=size).intrinsics
        assert k.fx == pytest.approx(k.fy)
        assert (k.width, k.height) == size


def test_an_object_darkens_the_floor_beneath_it() -> None:
    floor = Plane("floor", "floor", np.array([[-3.0, 0, 0], [3, 0, 0], [3, 6, 0], [-3, 6, 0]]))
    scene = Scene(eye_camera(), Architecture((floor,)), (place(LIBRARY, "t", "table", (0, 3, 0.36)),))
    lit = picture(replace(scene, objects=()), LIBRARY, size=SMALL).astype(int)
    shaded = picture(scene, LIBRARY, size=SMALL).astype(int)
    row, column = pixel(camera_of(scene), (0.0, 3.0, 0.0))
    difference = (lit - shaded)[row - 1 : row + 2, column - 5 : column + 5]
    assert difference.mean() > 25


def test_refusals() -> None:
    with pytest.raises(InputError, match="sideways"):
        picture(SCENE, LIBRARY, view="sideways")
    with pytest.raises(InputError, match="0x10"):
        picture(SCENE, LIBRARY, size=(0, 10))
    with pytest.raises(SceneError, match="no camera"):
        picture(replace(SCENE, camera=None), LIBRARY)


def test_empty_scene_is_plain_background() -> None:
    image = quick(Scene(eye_camera()))
    assert (image == BACKGROUND).all()
    assert picture(Scene(), LIBRARY, view="orbit:10", size=SMALL).shape == (120, 160, 3)


def test_a_photographed_plane_is_not_lit_a_second_time() -> None:
    """A grey photo on the ceiling, which no lamp reaches: nearly its own grey; as bare material it is darker."""
    grey = np.full((8, 8, 3), 180, np.uint8)
    room = box_room()
    planes = tuple(replace(p, texture="c") if p.id == "ceiling" else p for p in room.planes)
    scene = Scene(eye_camera(), Architecture(planes))
    row, column = 3, 80
    photo = quick(scene, textures={"c": grey})[row, column]
    bare = quick(scene, textures={"c": grey}, photographed=False)[row, column]
    assert np.abs(photo.astype(int) - 180).max() < 45
    assert (bare < photo).all()


def test_photographed_walls_do_not_darken_one_another() -> None:
    """Black photographs all around: the grey floor, whose photo holds the room's light, stays as grey as it is."""
    grey, black = np.full((8, 8, 3), 180, np.uint8), np.full((8, 8, 3), 10, np.uint8)
    room = box_room()
    planes = tuple(replace(p, texture=p.id) for p in room.planes)
    textures = {p.id: grey if p.role == "floor" else black for p in planes}
    scene = Scene(eye_camera(), Architecture(planes))
    shown = quick(scene, textures=textures)
    floor = shown.min(axis=-1) > 170
    assert floor.mean() > 0.1
    assert shown[floor].std() < 2.0
    bare = tuple(p if p.role == "floor" else replace(p, texture=None, colour=(0.04,) * 3) for p in planes)
    beside = quick(replace(scene, architecture=Architecture(bare)), textures=textures)
    assert np.abs(beside.astype(int) - shown).max() < 12  # a plain colour of the same photo is in the same light
    black_paint = SurfaceFinish("paint", (0.04,) * 3)
    painted = tuple(p if p.role == "floor" else replace(p, finish=black_paint) for p in bare)
    darker = quick(replace(scene, architecture=Architecture(painted)), textures=textures)
    assert (shown[floor].astype(int) - darker[floor]).max() > 10


def test_progress_rises_to_the_end_and_changes_nothing() -> None:
    scene, events = SCENE, []
    told = quick(scene, progress=Progress(events.append))
    np.testing.assert_array_equal(told, quick(scene))
    shares = [e.fraction for e in events]
    assert shares == sorted(shares)
    assert shares[-1] == pytest.approx(1.0)
    assert len(set(shares)) > 8


@pytest.mark.parametrize("after", ["gathering meshes", "casting", "gathering light", "shading"])
def test_a_picture_is_cancelled_at_every_step(after: str) -> None:
    token = CancelToken()

    def stop(event: ProgressEvent) -> None:
        if event.message.startswith(after):
            token.cancel()

    with pytest.raises(Cancelled):
        picture(SCENE, LIBRARY, size=(160, 240), effort=QUICK, progress=Progress(stop, token))
