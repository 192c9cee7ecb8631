"""The scene on the page: updates viser nodes where the displayed scene differs, and the ground that a room stands on,
with its soft shadow, so that it does not hang in the air.

Every object is a frame `/objects/<n>` in its pose, with the mesh as a child (`marks` adds what each browser sees).
Nodes belong to the server, so that all browsers see the same and a reload shows it again.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import trimesh
import viser
from jaxtyping import UInt8
from PIL import Image, ImageDraw, ImageFilter
from trimesh.visual.material import PBRMaterial

from diorama_app.viewport.decorations import remove_quietly
from diorama_app.viewport.mesh_assets import NO_PICTURES, ShapeBytes, plane_glb, plane_triangles, reduce
from diorama_app.viewport.room_light import RoomLightView
from diorama_core.geometry.openings import with_openings
from diorama_core.geometry.rotations import quaternion_wxyz
from diorama_core.library.photo_materials import Pictures
from diorama_core.library.stretch import Scale, relative_scale
from diorama_core.scene.types import Finish, PhotoMaterial, Plane, Pose, Scene, SceneObject

PIXELS = 192
MARGIN_M = 1.2
BELOW_M = 0.08
"""So far below the floor."""
BLUR_M = 0.32
DARKEST = 110
"""Opacity of the shadow beside the room, of 255."""


def ground_glb(floor: Plane) -> bytes:
    """A rectangle below a floor with its blurred outline in black, as GLB bytes; seen from above only."""
    low, high = floor.polygon[:, :2].min(axis=0) - MARGIN_M, floor.polygon[:, :2].max(axis=0) + MARGIN_M
    size = high - low
    shape = np.maximum((PIXELS * size / size.max()).astype(int), 2)
    outline = Image.new("L", (int(shape[0]), int(shape[1])))
    corners = (floor.polygon[:, :2] - low) / size * shape
    ImageDraw.Draw(outline).polygon([(float(x), float(y)) for x, y in corners], fill=DARKEST)
    mask = np.asarray(outline.filter(ImageFilter.GaussianBlur(BLUR_M * float(shape[0] / size[0]))))[::-1]
    picture = np.zeros((*mask.shape, 4), np.uint8)
    picture[..., 3] = mask
    z = float(floor.polygon[:, 2].min()) - BELOW_M
    vertices = np.array([[low[0], low[1], z], [high[0], low[1], z], [high[0], high[1], z], [low[0], high[1], z]])
    material = PBRMaterial(
        baseColorTexture=Image.fromarray(picture), alphaMode="BLEND", metallicFactor=0.0, roughnessFactor=1.0
    )
    mesh = trimesh.Trimesh(
        vertices=vertices,
        faces=[[0, 1, 2], [0, 2, 3]],
        visual=trimesh.visual.TextureVisuals(uv=[[0, 0], [1, 0], [1, 1], [0, 1]], material=material),
        process=False,
    )
    return bytes(trimesh.Scene(mesh).export(file_type="glb"))


MESH_NAMES = 8
"""An object's meshes take turns among so many names, so that what is on its way out keeps its own."""

SHADOW_ON_PLANES = 0.25
"""How dark."""

UNSEEN_M = 0.0002
"""A preview that moves no point of an object further than this is not sent: nobody would see it."""

Appearance = tuple[str, tuple[float, float, float] | None, Finish | None, tuple[PhotoMaterial, ...], Scale, float]
Pick = Callable[[str, Any], None]
Later = Callable[[Callable[[], None]], None]


@dataclass
class _Shown:
    """One object as it is on the page."""

    frame: viser.FrameHandle
    item: SceneObject
    mesh: viser.GlbHandle | None = None
    version: int = 0
    appearance: Appearance | None = None
    pose: Pose | None = None
    """Where it is shown: the document's place, or a preview's."""
    drawn: SceneObject | None = None
    """The object that is shown; None since a preview moved it."""


class Viewport:
    """What all browsers see. Used from the UI thread only."""

    def __init__(self, server: viser.ViserServer, shapes: ShapeBytes, *, pick: Pick, drag: Pick, later: Later) -> None:
        """Set up an empty view.

        Args:
            server: the page.
            shapes: where GLB bytes come from.
            pick: told (object id, click event) from viser's event loop when an object is clicked.
            drag: told (object id, drag event) likewise while an object is dragged.
            later: runs a task on the UI thread a moment later (an old mesh goes when the new one is loaded).
        """
        self._server = server
        self._shapes = shapes
        self._pick = pick
        self._drag = drag
        self._later = later
        self._objects: dict[str, _Shown] = {}
        self._planes: dict[str, tuple[Plane, viser.MeshHandle | viser.GlbHandle]] = {}
        self._ground: viser.GlbHandle | None = None
        self._ground_of: Plane | None = None
        self.room_light = RoomLightView(server, shapes)
        self._pictures: Pictures = NO_PICTURES
        """Pictures of planes and objects, as shown last."""
        self._shadow_on_planes: float | bool = SHADOW_ON_PLANES

    def light(self, *, low_graphics: bool) -> None:
        """Soft light from all sides; shadows and an environment where the browser can afford them."""
        self.room_light.begin(low_graphics=low_graphics)
        if low_graphics:
            self._shadow_on_planes = False  # even without shadows, every plane would be drawn twice for them

    def show(self, scene: Scene, textures: Mapping[str, UInt8[np.ndarray, "_ _ 3"]]) -> None:
        """Make the page show this scene, changing only what differs."""
        self._pictures = textures
        with self._server.atomic():
            self._show_planes(scene, textures)
            self._show_ground(scene.architecture.floor)
            for gone in [i for i in self._objects if not scene.has_object(i)]:
                self._objects.pop(gone).frame.remove()
            for item in scene.objects:
                self._show_object(item)
            self.room_light.show(scene, self.node_name)
            self._receive_shadows()
        self._server.flush()  # ahead of the panels, which take longer

    def preview(self, poses: Mapping[str, Pose]) -> None:
        """Put objects into poses that are not part of the document (a drag, a running optimiser)."""
        with self._server.atomic():
            for object_id, pose in poses.items():
                shown = self._objects.get(object_id)
                if shown is not None and (shown.pose is None or _is_seen(shown.pose, pose, shown.item)):
                    shown.drawn = None
                    self._set_pose(shown, pose)
        self._server.flush()

    def preview_item(self, item: SceneObject) -> None:
        """Show an object as it would be; the next `show` takes it back."""
        with self._server.atomic():
            if item.id in self._objects:
                self._show_object(item)

    def mesh_name(self, object_id: str) -> str | None:
        """The node of an object's present mesh."""
        shown = self._objects.get(object_id)
        return None if shown is None or shown.mesh is None else shown.mesh.name

    def node_name(self, object_id: str) -> str | None:
        """The frame that carries an object, for tests and for gizmos."""
        shown = self._objects.get(object_id)
        return None if shown is None else shown.frame.name

    def plane_name(self, plane_id: str) -> str | None:
        """The node of a plane."""
        shown = self._planes.get(plane_id)
        return None if shown is None else shown[1].name

    def _show_planes(self, scene: Scene, textures: Mapping[str, UInt8[np.ndarray, "_ _ 3"]]) -> None:
        wanted = {p.id: p for p in with_openings(scene).architecture.planes}
        for plane_id, (plane, handle) in list(self._planes.items()):
            if wanted.get(plane_id) != plane:
                handle.remove()
                del self._planes[plane_id]
        for plane_id, plane in wanted.items():
            if plane_id not in self._planes:
                picture = textures.get(plane.texture) if plane.texture is not None else None
                self._planes[plane_id] = (plane, self._add_plane(plane, picture))

    def _show_ground(self, floor: Plane | None) -> None:
        """The room's soft shadow, where the browser can afford it."""
        if self._shadow_on_planes is False or floor is self._ground_of or floor == self._ground_of:
            return
        if self._ground is not None:
            self._ground.remove()
            self._ground = None
        self._ground_of = floor
        if floor is not None:
            self._ground = self._server.scene.add_glb(
                "/ground", ground_glb(floor), cast_shadow=False, receive_shadow=False
            )

    def _receive_shadows(self) -> None:
        """Planes are darkened a little by soft light that is held off; the sun they receive in full or not at all."""
        wanted = True if self.room_light.casts_sun else self._shadow_on_planes
        for _, handle in self._planes.values():
            if handle.receive_shadow is not wanted:
                handle.receive_shadow = wanted

    def _add_plane(
        self, plane: Plane, texture: UInt8[np.ndarray, "h w 3"] | None
    ) -> viser.MeshHandle | viser.GlbHandle:
        name = self._fresh_name("/room")
        if texture is not None:
            return self._server.scene.add_glb(
                name, plane_glb(plane, reduce(texture, 1024)), cast_shadow=False, receive_shadow=self._shadow_on_planes
            )
        return self._server.scene.add_mesh_simple(
            name,
            vertices=plane.polygon,
            faces=plane_triangles(plane),
            color=plane.colour,
            flat_shading=True,
            side="front",
            cast_shadow=False,
            receive_shadow=self._shadow_on_planes,
        )

    def _show_object(self, item: SceneObject) -> None:
        shown = self._objects.get(item.id)
        if shown is None:
            frame = self._server.scene.add_frame(self._fresh_name("/objects"), show_axes=False)
            shown = self._objects[item.id] = _Shown(frame, item)
        if shown.drawn is item:
            return  # as most objects are after an edit
        shown.item = shown.drawn = item
        replaced = shown.appearance != _appearance(item)
        if replaced:
            self._replace_mesh(shown, item)
        if shown.pose is not item.pose or replaced:
            self._set_pose(shown, item.pose)
        shown.frame.visible = not item.hidden

    def _replace_mesh(self, shown: _Shown, item: SceneObject) -> None:
        # A node whose bytes change vanishes until the browser has parsed them, so the old one stays for a moment.
        data = self._shapes.glb(*_appearance(item), self._pictures)
        old = shown.mesh
        shown.version = (shown.version + 1) % MESH_NAMES
        mesh = self._server.scene.add_glb(
            f"{shown.frame.name}/v{shown.version}", data, scale=tuple(float(s) for s in item.pose.scale)
        )
        shown.mesh = mesh
        shown.appearance = _appearance(item)
        object_id = item.id

        async def click(event: viser.SceneNodePointerEvent[Any]) -> None:
            self._pick(object_id, event)

        mesh.on_click(click)
        for modifier in ("shift", "cmd/ctrl"):
            mesh.on_click(modifier=modifier)(click)

        async def drag(event: viser.SceneNodeDragEvent[Any]) -> None:
            self._drag(object_id, event)

        for modifier_key in (None, "alt"):
            mesh.on_drag("left", modifier=modifier_key)(drag)
        if old is not None:
            self._later(lambda: remove_quietly(old))

    def _set_pose(self, shown: _Shown, pose: Pose) -> None:
        before, shown.pose = shown.pose, pose
        if before is None or not np.array_equal(before.R_world_object, pose.R_world_object):
            shown.frame.wxyz = quaternion_wxyz(pose.R_world_object)
        if before is None or not np.array_equal(before.position, pose.position):
            shown.frame.position = pose.position
        scale = tuple(float(s) for s in pose.scale)
        if shown.mesh is not None and shown.mesh.scale != scale:
            shown.mesh.scale = scale

    def _fresh_name(self, stem: str) -> str:
        """A name not in use. Names are used again: the server keeps a few messages for every name there ever was."""
        taken = {h.name for _, h in self._planes.values()} | {s.frame.name for s in self._objects.values()}
        return next(name for n in range(1, len(taken) + 2) if (name := f"{stem}/{n}") not in taken)


def _is_seen(before: Pose, after: Pose, item: SceneObject) -> bool:
    """Whether two poses of an object differ on the page."""
    turned = np.abs(after.R_world_object - before.R_world_object).max() * np.linalg.norm(item.size_m) / 2
    moved = np.abs(after.position - before.position).max()
    return bool(moved + turned > UNSEEN_M or not np.array_equal(before.scale, after.scale))


def _appearance(item: SceneObject) -> Appearance:
    scale = relative_scale(item.pose.scale)
    return (item.shape_id, item.colour, item.finish, item.visible_materials, scale, item.open_share)
