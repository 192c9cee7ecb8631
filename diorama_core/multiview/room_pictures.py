"""The room's floor, walls and ceiling as all photos together show them."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from zlib import crc32

import cv2
import numpy as np
from jaxtyping import Bool, UInt8

from diorama_core.architecture.texture.best_view import best_view_textures
from diorama_core.architecture.texture.plane_textures import RoomPicture
from diorama_core.architecture.texture.refit import MARK
from diorama_core.artefacts import DetectedObject, Inputs
from diorama_core.library.record import ShapeLibrary
from diorama_core.pipeline.colours import room_illuminant
from diorama_core.protocols import EmptyRoomFiller
from diorama_core.render.raycast import PinholeView
from diorama_core.render.world import World, scene_world
from diorama_core.scene.types import Camera, Plane, Scene

SILHOUETTE_PX = 320
"""Longer side of the grid on which objects that nobody marked in a photo are looked for."""

Pictures = dict[str, UInt8[np.ndarray, "_ _ 3"]]


@dataclass(frozen=True, eq=False)
class PlacedPicture:
    """A photo of the room with what is marked in it."""

    inputs: Inputs
    objects: tuple[DetectedObject, ...]
    """Those that are objects of the scene have their ids."""
    camera: Camera
    """In the scene's world."""
    filler: EmptyRoomFiller | None = None


def room_pictures(
    scene: Scene, photos: Sequence[PlacedPicture], library: ShapeLibrary, only: Collection[str] | None = None
) -> Pictures:
    """Pictures of the planes, each texel from the photo that sees it best, by plane id.

    A photo sees neither what is behind a mark in it nor what is behind an object of the scene without a mark there.

    Args:
        scene: floor, walls, ceiling and posed objects.
        photos: the first gives the exposure.
        library: where the scene's shapes are.
        only: ids of the planes to make pictures of; all by default.
    """
    floors = {p.id for p in scene.architecture.by_role("floor")}
    standing = {edge.child for edge in scene.supports if edge.parent in floors}
    world = scene_world(scene, library)
    pictures = [_picture(scene, p, world, standing) for p in photos]
    return best_view_textures(pictures, scene.architecture, only)


def _picture(scene: Scene, photo: PlacedPicture, world: World, standing: Collection[str]) -> RoomPicture:
    illuminant = room_illuminant(photo.inputs, photo.objects, scene.architecture, photo.camera)
    marked = {o.id for o in photo.objects}
    strangers = [k for k, o in enumerate(scene.objects) if o.id not in marked and not o.hidden]
    unmarked = silhouettes(world, photo.camera, strangers)
    rgb = illuminant.white_balance(photo.inputs.photo.rgb)
    return RoomPicture(rgb, photo.objects, photo.camera, standing, photo.filler, unmarked)


def silhouettes(world: World, camera: Camera, instances: Collection[int]) -> Bool[np.ndarray, "h w"]:
    """Where a camera sees some instances of a world, on its whole picture, from a coarse grid."""
    k = camera.intrinsics
    step = max(1, max(k.width, k.height) // SILHOUETTE_PX)
    x, y = np.meshgrid(np.arange(step // 2, k.width, step) + 0.5, np.arange(step // 2, k.height, step) + 0.5)
    hits = world.caster.first_hits(PinholeView(camera).rays(np.stack([x, y], axis=-1)))
    seen = np.zeros(hits.is_hit.shape, np.uint8)
    seen[hits.is_hit] = np.isin(world.instances(hits.triangle[hits.is_hit]), list(instances))
    return cv2.resize(seen, (k.width, k.height), interpolation=cv2.INTER_NEAREST).astype(bool)


def with_pictures(scene: Scene, pictures: Mapping[str, UInt8[np.ndarray, "_ _ 3"]]) -> tuple[Scene, Pictures]:
    """The scene whose planes show the pictures, below a finish where a person gave one.

    Pictures have names of their own, so that undo finds those before.

    Args:
        scene: the scene.
        pictures: by plane id.

    Returns:
        The scene, and the pictures by name.
    """
    names = {key: f"{key.split(MARK)[0]}{MARK}{crc32(picture.tobytes()):08x}" for key, picture in pictures.items()}
    planes = tuple(_showing(p, names[p.id]) if p.id in names else p for p in scene.architecture.planes)
    named = {names[key]: picture for key, picture in pictures.items()}
    return replace(scene, architecture=replace(scene.architecture, planes=planes)), named


def _showing(plane: Plane, name: str) -> Plane:
    return replace(plane, texture=name) if plane.finish is None else replace(plane, photo_texture=name)
