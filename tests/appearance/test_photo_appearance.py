"""A room with a picture of known art is rendered; the look taken from that photo is that art."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from diorama_core.appearance.photo_appearance import photo_appearance, texture_name
from diorama_core.artefacts import DetectedObject
from diorama_core.library.catalogue import built_in_library
from diorama_core.render.picture import picture
from diorama_core.render.raycast import MeshCaster
from diorama_core.scene.types import Camera, Intrinsics, PhotoMaterial, Pose, Scene, SceneObject

LIBRARY = built_in_library()
SIZE = (480, 360)


def art() -> np.ndarray:
    colours = np.random.default_rng(2).integers(30, 230, (4, 5, 3)).astype(np.uint8)
    return cv2.resize(colours, (200, 150), interpolation=cv2.INTER_CUBIC)


def camera() -> Camera:
    T = np.eye(4)
    T[:3, :3] = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
    T[:3, 3] = [0.7, -2.0, 1.4]
    return Camera(Intrinsics(*SIZE, 420.0, 420.0, 240.0, 180.0), T)


def hung(shape_id: str, *, worn: bool) -> Scene:
    shape = LIBRARY.shape(shape_id)
    own = (PhotoMaterial("picture", (0.5,) * 3, "art", "front"),) if worn else ()
    pose = Pose.upright((0.3, 0.0, 1.5), -np.pi / 2 + 0.3)
    item = SceneObject("picture_1", "print", "picture", shape.id, shape.size_m, pose, photo_materials=own)
    return Scene(camera=camera(), objects=(item,))


def detected(scene: Scene) -> tuple[DetectedObject, ...]:
    item = scene.objects[0]
    mask = MeshCaster([(LIBRARY.mesh(item.shape_id), item.pose.matrix)]).buffers(camera()).silhouette
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    box = (float(columns[0]), float(rows[0]), float(columns[-1] + 1), float(rows[-1] + 1))
    return (DetectedObject(item.id, item.category, item.label, box, mask, 1, 1.0),)


@pytest.fixture(scope="module")
def photo() -> np.ndarray:
    return picture(hung("picture-hills-oak", worn=True), LIBRARY, size=SIZE, textures={"art": art()})


def test_a_picture_wears_the_photo(photo) -> None:
    scene = hung("picture-hills-oak", worn=False)
    look = photo_appearance(photo, detected(scene), scene, LIBRARY)
    (material,) = (m for m in look.materials["picture_1"] if m.slot == "picture")
    found = look.pictures[str(material.texture)]
    want = cv2.resize(art(), found.shape[1::-1], interpolation=cv2.INTER_AREA).astype(float)
    assert material.layout == "front"
    assert np.corrcoef(found.ravel().astype(float), want.ravel())[0, 1] > 0.97
    seen = picture(look.apply(scene), LIBRARY, size=SIZE, textures=look.pictures)
    plain = picture(scene, LIBRARY, size=SIZE)
    mask = detected(scene)[0].mask
    off = [float(np.abs(p.astype(float) - photo)[mask].mean()) for p in (seen, plain)]
    assert off[0] < 0.45 * off[1]


def test_a_print_too_small_to_be_read_gives_way_to_its_colour() -> None:
    """Not the library's print, which nobody saw."""
    scene = hung("picture-hills-oak", worn=True)
    far = replace(scene.objects[0].pose, position=np.array([0.7, 8.5, 1.4]))
    own = (PhotoMaterial("picture", (0.5,) * 3, "red", "front"),)
    scene = replace(scene, objects=(replace(scene.objects[0], pose=far, photo_materials=own),))
    red = np.broadcast_to(np.array([200, 40, 30], np.uint8), (30, 40, 3)).copy()
    seen = picture(scene, LIBRARY, size=SIZE, textures={"red": red})
    look = photo_appearance(seen, detected(scene), scene, LIBRARY)
    (material,) = (m for m in look.materials["picture_1"] if m.slot == "picture")
    worn = look.pictures[str(material.texture)]
    assert worn.reshape(-1, 3).std(axis=0).max() < 4
    assert material.colour[0] > 2 * max(material.colour[1:])


def test_another_shape_takes_the_look(photo) -> None:
    scene = hung("picture-hills-oak", worn=False)
    look = photo_appearance(photo, detected(scene), scene, LIBRARY)
    worn = look.apply(scene)
    other = LIBRARY.shape("picture-portrait")
    swapped = replace(worn.objects[0], shape_id=other.id, shape_size_m=other.size_m)
    shown = picture(replace(worn, objects=(swapped,)), LIBRARY, size=SIZE, textures=look.pictures)
    own = picture(replace(worn, objects=(replace(swapped, material_source="library"),)), LIBRARY, size=SIZE)
    assert np.abs(shown.astype(float) - own).max() > 60


def test_what_stands_before_it_is_not_on_it(photo) -> None:
    scene = hung("picture-hills-oak", worn=False)
    mask = np.zeros(SIZE[::-1], dtype=bool)
    x1, y1, x2, y2 = (round(v) for v in detected(scene)[0].box)
    mask[(y1 + y2) // 2 :, (x1 + x2) // 2 :] = True
    before = np.where(mask[..., None], (0, 255, 0), photo).astype(np.uint8)
    lamp = DetectedObject("lamp_1", "lamp", "lamp", (0.0, 0.0, 9.0, 9.0), mask & detected(scene)[0].mask, 2, 1.0)
    look = photo_appearance(before, (*detected(scene), lamp), scene, LIBRARY)
    assert all(not (p == (0, 255, 0)).all(axis=-1).any() for p in look.pictures.values())


def test_without_a_camera_nothing_is_taken(photo) -> None:
    scene = replace(hung("picture-hills-oak", worn=False), camera=None)
    assert not photo_appearance(photo, detected(hung("picture-hills-oak", worn=False)), scene, LIBRARY).materials


def test_other_books_wear_the_spines_of_the_photo() -> None:
    def row(shape_id: str) -> Scene:
        shape = LIBRARY.shape(shape_id)
        scale = np.array(LIBRARY.shape("books-row-long").size_m) / shape.size_m
        pose = Pose.upright((0.5, -0.6, 1.4), -np.pi / 2 + 0.2, scale)
        item = SceneObject("books_1", "books", "books", shape.id, shape.size_m, pose)
        return Scene(camera=camera(), objects=(item,))

    seen = picture(row("books-row-long"), LIBRARY, size=SIZE)
    other = row("books-row")
    look = photo_appearance(seen, detected(row("books-row-long")), other, LIBRARY)
    assert sum(m.layout == "front" for m in look.materials["books_1"]) >= 5
    worn = picture(look.apply(other), LIBRARY, size=SIZE, textures=look.pictures)
    plain = picture(other, LIBRARY, size=SIZE)
    mask = detected(other)[0].mask & detected(row("books-row-long"))[0].mask
    off = [float(np.abs(p.astype(float) - seen)[mask].mean()) for p in (worn, plain)]
    assert off[0] < 0.6 * off[1]


def test_a_television_that_is_off_shows_no_picture_of_the_library() -> None:
    def standing(shape_id: str) -> Scene:
        shape = LIBRARY.shape(shape_id)
        scale = np.array(LIBRARY.shape("television-large").size_m) / shape.size_m
        pose = Pose.upright((0.5, 0.4, 1.4), -np.pi / 2 + 0.2, scale)
        item = SceneObject("tv_1", "tv", "television", shape.id, shape.size_m, pose)
        return Scene(camera=camera(), objects=(item,))

    seen = picture(standing("television-large"), LIBRARY, size=SIZE)
    framed = standing("television-framed")
    look = photo_appearance(seen, detected(standing("television-large")), framed, LIBRARY)
    (screen,) = (m for m in look.materials["tv_1"] if m.slot == "picture")
    assert max(screen.colour) < 0.35
    assert look.pictures[str(screen.texture)].std() < 25


def test_names_tell_pictures_apart() -> None:
    first, second = texture_name("a b/1", "wood 2", art()), texture_name("a b/1", "wood 2", art() // 2)
    assert first != second
    assert first.startswith("a-b-1-wood-2-")
