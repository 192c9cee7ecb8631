"""Pictures of a furnished room with everything that is true about them.

The picture comes from the renderer's fast path: one ray a pixel, soft shadows from the room's largest window,
occlusion and one bounce, gathered without noise. Depth, normals and ids are read from the same geometry.
Everything returned is in the photo's world: origin on the floor below the camera, +Y the room axis that the camera
faces (`scene.frames`).
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass, replace
from functools import cached_property

import cv2
import numpy as np
import trimesh
from jaxtyping import Float, Float32, Int32, UInt8

from diorama_core.artefacts import Box, Inputs, LabelledBox, Photo
from diorama_core.geometry.projection import visible_bounds
from diorama_core.library.record import ShapeLibrary
from diorama_core.render.filters import as_bytes, tone_mapped
from diorama_core.render.lighting import Effort
from diorama_core.render.raycast import MeshCaster, PinholeView
from diorama_core.render.shading import Shot, shoot
from diorama_core.render.slabs import plane_surfaces
from diorama_core.render.world import scene_world
from diorama_core.scene.types import Camera, Plane, Pose, Scene, yaw_rotation
from diorama_core.scene.values import ArrayValue
from diorama_core.synthesis.finishes import finish_textures
from diorama_core.synthesis.light import room_light

FAST = Effort(window_rays=3, sky_rays=3)
MIN_PIXELS = 150
"""Objects with fewer visible pixels (of 640 x 480) are not asked for: no annotator would draw them."""
MIN_VISIBLE = 0.15
"""Objects of which less than this share is visible are left out, too."""
MIN_INSIDE = 0.15
"""Objects with less than this share of their bounding box in the picture are left out: a bath's rim in a corner."""
LETS_LIGHT_IN = ("window", "curtain", "ceiling lamp")
STEP = 3
"""Pixels between the rays that measure how much of an object is hidden."""


@dataclass(frozen=True, eq=False)
class TruthView(ArrayValue):
    """One picture and its truth. Arrays have the picture's size."""

    inputs: Inputs
    """What a build is given: photo, intrinsics, depth, and mask, box and class of every object asked for."""
    scene: Scene
    """The truth, in the photo's world, with the camera. Objects asked for carry `mask_id` and `box_px`."""
    normals_world: Float32[np.ndarray, "h w 3"]
    """Unit, toward the camera."""
    plane_ids: Int32[np.ndarray, "h w"]
    """Index into `scene.architecture.planes` of the plane seen; -1 where an object stands before it."""
    room_plane_ids: Int32[np.ndarray, "h w"]
    """Ids of the planes with all objects taken away."""
    room_depth_m: Float32[np.ndarray, "h w"]
    """Depth of the empty room."""
    object_ids: Int32[np.ndarray, "h w"]
    """Index into `scene.objects` of every object seen, however small; -1 on the room itself."""
    empty_room: UInt8[np.ndarray, "h w 3"]
    """The picture with all objects taken away."""
    amodal_boxes: tuple[Box | None, ...]
    """For every object the box of its whole outline, hidden parts included, clipped to the picture; None outside."""
    visible_fraction: Float[np.ndarray, "n"]
    """For every object the share of its outline within the picture that is visible; 0 for what is hidden."""

    @property
    def camera(self) -> Camera:
        """The camera in the photo's world."""
        if self.scene.camera is None:
            raise ValueError("a truth view has a camera")
        return self.scene.camera

    @cached_property
    def indices(self) -> tuple[int, ...]:
        """Indices of the objects that are in `inputs.instances`."""
        return tuple(k for k, o in enumerate(self.scene.objects) if o.mask_id is not None)


def render_truth(
    scene: Scene,
    camera: Camera,
    library: ShapeLibrary,
    size: tuple[int, int] = (640, 480),
    *,
    with_empty_room: bool = True,
    sensor: bool = True,
) -> TruthView:
    """Photograph a room and note what is true about the picture; several views of a room share a `Studio`.

    Args:
        scene: A room from `furnish_room`, in any frame with +Z up and the floor at z = 0.
        camera: Where it is photographed from (`cameras.sample_cameras`), in the same frame.
        library: Where its shapes are.
        size: Width and height of the picture.
        with_empty_room: Whether to make the empty room's picture too; black without.
        sensor: Whether the picture has a sensor's noise and a lens' fall-off.
    """
    return Studio(scene, library).view(camera, size, with_empty_room=with_empty_room, sensor=sensor)


class Studio:
    """A room made ready once, to be photographed from many places.

    Args:
        scene: A room from `furnish_room`, in any frame with +Z up and the floor at z = 0.
        library: Where its shapes are.
    """

    def __init__(self, scene: Scene, library: ShapeLibrary) -> None:
        self.scene, self._library, self._light = scene, library, room_light(scene)
        pictures = finish_textures(scene.architecture)
        planes = tuple(replace(p, texture=p.id) for p in scene.architecture.planes)
        self._shown = replace(scene, architecture=replace(scene.architecture, planes=planes))
        self._world = scene_world(self._shown, library, textures=pictures, photographed=False)
        count = len(scene.objects)
        clear = {k for k, o in enumerate(scene.objects) if o.category in LETS_LIGHT_IN}
        self._blockers = self._world.shadow_caster(without=clear | set(range(count, count + len(planes))))
        self._room = MeshCaster([(_face(p), np.eye(4)) for p in planes])
        self._bare = scene_world(replace(self._shown, objects=()), library, textures=pictures, photographed=False)

    def view(
        self, camera: Camera, size: tuple[int, int] = (640, 480), *, with_empty_room: bool = True, sensor: bool = True
    ) -> TruthView:
        """One picture and its truth; the arguments are those of `render_truth`.

        Args:
            camera: The photo's.
            size: Width and height in pixels.
            with_empty_room: Whether it is rendered without objects, too.
            sensor: Whether depth is as a sensor has it.
        """
        camera = Camera(camera.intrinsics.resize(*size), camera.T_world_camera)
        shot = self._shot(camera)
        room = self._room.buffers(camera)
        scene = to_photo_world(replace(self.scene, camera=camera))
        placed = scene.camera or camera
        count, instance = len(scene.objects), shot.grid.instance
        object_ids = np.where(instance < count, instance, -1).astype(np.int32)
        amodal = _amodal_boxes(scene, placed, self._library)
        visible = _visible_fractions(scene, placed, self._library, object_ids, amodal)
        boxes = _boxes(object_ids, np.where(_shares_in_picture(scene, placed) >= MIN_INSIDE, visible, 0.0), size)
        objects = tuple(
            replace(o, mask_id=k + 1 if k in boxes else None, box_px=boxes.get(k)) for k, o in enumerate(scene.objects)
        )
        scene = replace(scene, objects=objects)
        rgb = _develop(shot)
        photo = Photo(_sense(rgb, scene) if sensor else rgb, "rendered.png", size)
        R_room_photo = camera.T_world_camera[:3, :3] @ placed.T_world_camera[:3, :3].T
        return TruthView(
            inputs=_inputs(photo, scene, object_ids, shot.grid.depth),
            scene=scene,
            normals_world=shot.grid.flat_normals @ np.rint(R_room_photo).astype(np.float32),
            plane_ids=np.where(instance >= count, instance - count, -1).astype(np.int32),
            room_plane_ids=room.instance,
            room_depth_m=room.depth_m,
            object_ids=object_ids,
            empty_room=self._empty_room(camera) if with_empty_room else np.zeros_like(rgb),
            amodal_boxes=amodal,
            visible_fraction=visible,
        )

    def photograph(
        self, camera: Camera, size: tuple[int, int]
    ) -> tuple[UInt8[np.ndarray, "h w 3"], Int32[np.ndarray, "h w"]]:
        """One picture, and for every pixel the index of the object it shows (-1 for the room itself)."""
        shot = self._shot(Camera(camera.intrinsics.resize(*size), camera.T_world_camera))
        instance = shot.grid.instance
        return _develop(shot), np.where(instance < len(self.scene.objects), instance, -1).astype(np.int32)

    def empty_room_planes(self, camera: Camera) -> Int32[np.ndarray, "h w"]:
        """Index of the plane that each pixel of a camera would show without objects; -1 for none."""
        return self._room.buffers(camera).instance

    def _shot(self, camera: Camera) -> Shot:
        return shoot(self._world, self._blockers, PinholeView(camera), self._light, FAST)

    def _empty_room(self, camera: Camera) -> UInt8[np.ndarray, "h w 3"]:
        """The picture with the room's light and without its objects: nothing stands in the way of the light."""
        nothing = self._bare.shadow_caster(without=range(len(self._shown.architecture.planes)))
        return _develop(shoot(self._bare, nothing, PinholeView(camera), self._light, FAST))


def to_photo_world(scene: Scene) -> Scene:
    """The room and camera with the origin on the floor below the camera and +Y the axis it faces."""
    if scene.camera is None:
        raise ValueError("the scene needs a camera")
    forward = scene.camera.T_world_camera[:3, 2]
    quarter = round(float(np.arctan2(forward[1], forward[0]) / (np.pi / 2)))
    T = np.eye(4)
    T[:3, :3] = np.rint(yaw_rotation(np.pi / 2 * (1 - quarter)))
    T[:3, 3] = -T[:3, :3] @ np.array([*scene.camera.position[:2], 0.0])
    return transform(scene, T)


def transform(scene: Scene, T_to_from: Float[np.ndarray, "4 4"]) -> Scene:
    """A scene expressed in another frame: `p_to = T_to_from @ p_from`, rigid."""
    R, t = T_to_from[:3, :3], T_to_from[:3, 3]
    planes = tuple(replace(p, polygon=p.polygon @ R.T + t) for p in scene.architecture.planes)
    objects = tuple(
        replace(o, pose=Pose(R @ o.pose.R_world_object, R @ o.pose.position + t, o.pose.scale)) for o in scene.objects
    )
    camera = scene.camera and Camera(scene.camera.intrinsics, T_to_from @ scene.camera.T_world_camera)
    return replace(scene, camera=camera, objects=objects, architecture=replace(scene.architecture, planes=planes))


def _develop(shot: Shot) -> UInt8[np.ndarray, "h w 3"]:
    return as_bytes(tone_mapped(shot.radiance / np.maximum(shot.coverage, 1e-3)[..., None]))


def _sense(rgb: UInt8[np.ndarray, "h w 3"], scene: Scene) -> UInt8[np.ndarray, "h w 3"]:
    """Noise and the fall-off of a phone's lens; the same scene and camera give the same noise."""
    h, w = rgb.shape[:2]
    key = b"" if scene.camera is None else np.round(scene.camera.T_world_camera, 6).tobytes()
    rng = np.random.default_rng(zlib.crc32(key))
    y, x = np.mgrid[0:h, 0:w]
    radius = ((x - w / 2) ** 2 + (y - h / 2) ** 2) / (w**2 / 4)
    soft = cv2.GaussianBlur(rgb.astype(np.float32), (0, 0), 0.45)
    return np.clip(soft * (1 - 0.06 * radius)[..., None] + rng.normal(0.0, 1.6, rgb.shape), 0, 255).astype(np.uint8)


def _visible_fractions(
    scene: Scene,
    camera: Camera,
    library: ShapeLibrary,
    object_ids: Int32[np.ndarray, "h w"],
    amodal: tuple[Box | None, ...],
) -> Float[np.ndarray, "n"]:
    """Visible over whole pixels within the picture, by casting each object alone on every third pixel of its box."""
    share = np.zeros(len(scene.objects))
    pixels = np.bincount(object_ids[object_ids >= 0], minlength=len(share))
    view = PinholeView(camera)
    for index, (item, box) in enumerate(zip(scene.objects, amodal, strict=True)):
        if pixels[index] and box is not None:
            x, y = (np.arange(box[a] // STEP * STEP + STEP / 2, box[a + 2] + STEP, STEP) for a in (0, 1))
            inside = np.stack(np.meshgrid(x[x < view.width], y[y < view.height]), axis=-1)
            hits = MeshCaster([(library.mesh(item.shape_id), item.pose.matrix)]).first_hits(view.rays(inside))
            whole = int(hits.is_hit.sum()) * STEP**2
            share[index] = min(1.0, pixels[index] / max(whole, pixels[index] * 1e-3, 1.0))
    return share


def _shares_in_picture(scene: Scene, camera: Camera, steps: int = 6) -> Float[np.ndarray, "n"]:
    """Share of every object's bounding box that lies within the picture, hidden or not."""
    along = (np.arange(steps) + 0.5) / steps - 0.5
    grid = np.stack(np.meshgrid(along, along, along), axis=-1).reshape(-1, 3)
    shares = np.zeros(len(scene.objects))
    k = camera.intrinsics
    for index, item in enumerate(scene.objects):
        points = camera.to_camera(item.pose.apply(grid * np.asarray(item.shape_size_m)))
        uv = points[:, :2] / np.maximum(points[:, 2:], 1e-6) * [k.fx, k.fy] + [k.cx, k.cy]
        within = (points[:, 2] > 1e-6) & ((uv >= 0) & (uv < [k.width, k.height])).all(axis=1)
        shares[index] = within.mean()
    return shares


def _face(plane: Plane) -> trimesh.Trimesh:
    front, _ = plane_surfaces(plane)
    return trimesh.Trimesh(front.vertices, front.faces, process=False)


def _boxes(
    object_ids: Int32[np.ndarray, "h w"], visible: Float[np.ndarray, "n"], size: tuple[int, int]
) -> dict[int, Box]:
    """The objects that a person would annotate, with the boxes of their visible parts."""
    least = MIN_PIXELS * size[0] * size[1] / (640 * 480)
    boxes: dict[int, Box] = {}
    for index in range(len(visible)):
        mask = object_ids == index
        if mask.sum() >= least and visible[index] >= MIN_VISIBLE:
            rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
            boxes[index] = (float(columns[0]), float(rows[0]), float(columns[-1] + 1), float(rows[-1] + 1))
    return boxes


def _inputs(
    photo: Photo, scene: Scene, object_ids: Int32[np.ndarray, "h w"], depth_m: Float32[np.ndarray, "h w"]
) -> Inputs:
    """What a build is given: everything measured, and the objects asked for."""
    asked = [k for k, o in enumerate(scene.objects) if o.mask_id is not None]
    labelled = tuple(
        (k + 1, LabelledBox(o.box_px, o.category, o.label)) for k, o in enumerate(scene.objects) if o.box_px is not None
    )
    return Inputs(
        photo=photo,
        boxes=tuple(b for _, b in labelled),
        instances=np.where(np.isin(object_ids, asked), object_ids + 1, 0).astype(np.int32),
        instance_boxes=labelled,
        depth_m=depth_m,
        intrinsics=None if scene.camera is None else scene.camera.intrinsics,
    )


def _amodal_boxes(scene: Scene, camera: Camera, library: ShapeLibrary) -> tuple[Box | None, ...]:
    boxes: list[Box | None] = []
    for item in scene.objects:
        points = camera.to_camera(item.pose.apply(library.mesh(item.shape_id).vertices))
        bounds = _bounds(points, camera, item.corners_world)
        boxes.append(bounds)
    return tuple(boxes)


def _bounds(points_camera: np.ndarray, camera: Camera, corners_world: np.ndarray) -> Box | None:
    """Box of an outline; from the bounding box where parts are behind the camera."""
    k = camera.intrinsics
    if (points_camera[:, 2] > 0.05).all():
        uv = points_camera[:, :2] / points_camera[:, 2:] * [k.fx, k.fy] + [k.cx, k.cy]
        low, high = np.clip(uv.min(axis=0), 0, [k.width, k.height]), np.clip(uv.max(axis=0), 0, [k.width, k.height])
    else:
        bounds, visible = visible_bounds(camera.to_camera(corners_world)[None], k)
        if not visible[0]:
            return None
        low, high = bounds[0][:2], bounds[0][2:]
    if (high - low <= 0).any():
        return None
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])
