"""The light on the page: the photo's, or the sun, the sky and the lamps as a person set them.

Light of strength 1 shows a white surface white, as in pictures (`render.scene_light`); three.js asks for pi times that.
The page itself casts the sun's shadows (`static/sun.js`): one shadow map that fits the room, with walls and ceiling in
it even where they are not drawn. Browsers without a graphics card get bright patches instead.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np
import trimesh
import viser
from jaxtyping import Float

from diorama_app.viewport.camera import bounds
from diorama_app.viewport.decorations import Colour, NodeName, remove_quietly
from diorama_app.viewport.mesh_assets import ShapeBytes, plane_triangles
from diorama_core.geometry.openings import OPENING_CATEGORIES, with_openings
from diorama_core.geometry.sun import Daylight, daylight, sun_patches
from diorama_core.geometry.unseen_walls import close_room
from diorama_core.scene.light_settings import LightSettings
from diorama_core.scene.types import Architecture, Plane, RoomLight, Scene, SceneObject

MAIN_LIGHT_AWAY_M = 12.0
MAIN_LIGHT_EVEN, MAIN_LIGHT_STRENGTH = 0.6, 2.2
"""Its intensity where light comes from everywhere, and how much that grows up to light from one side alone."""
SKY, GROUND, AROUND = (255, 252, 246), (176, 170, 162), (255, 250, 244)
WHITE = (255, 255, 255)
ABOVE = (-0.2, 0.2, 1.0)
"""Where light comes from in a room that no photo shows."""
SUN_INTENSITY = 8.0
"""Intensity of the sun outside the atmosphere."""
UNSHADED_SUN = 0.12
"""Share of the sun's intensity where it casts no shadows: it falls on everything, and its patches tell the rest."""
SKY_INTENSITY, AROUND_INTENSITY = 1.1, 0.9
"""Intensities of the noon sky from above and from everywhere in the room, relative to a room's usual light."""
WINDOW_INTENSITY = 0.9
"""Intensity of the noon sky from where the largest window is."""
PATCH_OPACITY = 0.7
LAMP_INTENSITY = np.pi
MAX_LAMPS, MAX_LAMPS_LIGHT = 12, 4
"""Lamps that shine on the page, of all graphics and of low: each costs every pixel. Pictures and files have all."""
ENVIRONMENT = 0.35
ENVIRONMENT_STEP = 0.07
"""The environment is sent anew where its strength differs by so much: it is a picture."""


@dataclass(frozen=True)
class _Lamp:
    node: str
    position: tuple[float, float, float]
    colour: Colour
    intensity: float


class RoomLightView:
    """Lights of the page. Used from the UI thread only."""

    def __init__(self, server: viser.ViserServer, shapes: ShapeBytes) -> None:
        self._server, self._shapes = server, shapes
        self._low = False
        self._main: tuple[RoomLight | None, float] | None = None
        self._nodes: dict[str, Any] = {}
        self._walls: Architecture | None = None
        self._patches: tuple[Any, ...] = ()
        self._lamps: dict[str, tuple[_Lamp, viser.PointLightHandle]] = {}
        self._environment = -1.0
        self.told = "null"
        """What pages cast the sun's shadows and let lamps glow by, as JSON (`static/sun.js`)."""

    @property
    def casts_sun(self) -> bool:
        """Whether pages cast the sun's shadows, which planes then receive."""
        return "/lights/sun" in self._nodes and not self._low

    def begin(self, *, low_graphics: bool) -> None:
        """Soft light from all sides; shadows and an environment where the browser can afford them."""
        self._low = low_graphics
        scene = self._server.scene
        scene.configure_default_lights(enabled=False)  # switching them loads the environment anew
        if low_graphics:
            scene.configure_environment_map(None)
        self._sky(1.0, 1.0, 1.0)

    def show(self, scene: Scene, node_name: NodeName) -> None:
        """Light the page as the scene says, changing only what differs."""
        settings = scene.light_settings
        outside = None if settings.hour is None else daylight(settings.hour, settings.north_rad)
        self._show_main(scene, settings, outside)
        self._show_sun(scene, settings, outside, node_name)
        self._show_lamps(scene, settings, node_name)
        self.told = self._light_data(scene, settings, outside, node_name)

    def _light_data(self, scene: Scene, settings: LightSettings, outside: Daylight | None, node_name: NodeName) -> str:
        """Data by which pages cast shadows and let lamps glow; "null" where there is nothing to do."""
        about: dict[str, Any] = {}
        if outside is not None and not self._low:
            corners = np.stack(bounds(scene))
            panes = [node_name(o.id) for o in scene.objects if o.category in OPENING_CATEGORIES]
            about = {
                "sun": "/lights/sun",
                "walls": "/lights/walls",
                "middle": [round(float(v), 3) for v in corners.mean(axis=0)],
                "radius": round(_radius(corners), 3),
                "panes": [name for name in panes if name is not None],
            }
        if settings.lamps_on is not None:
            from diorama_core.render.lamps import lamps_of  # the ray-caster; opening a project does without it

            lamps = [(node_name(o.id), o.id in settings.lamps_on, self._shapes.lamp_shade(o)) for o in lamps_of(scene)]
            about["lamps"] = [lamp for lamp in lamps if lamp[0] is not None]
        return json.dumps(about, separators=(",", ":")) if about else "null"

    def _show_main(self, scene: Scene, settings: LightSettings, outside: Daylight | None) -> None:
        """The photo's main light in place of the usual ones, as far as it is stronger from one side; none by day."""
        if outside is not None:
            level = float(outside.sky.max()) * settings.exposure
            self._sky(SKY_INTENSITY * level, AROUND_INTENSITY * level, SKY_INTENSITY * level, tint=outside.sky)
        else:
            self._sky(settings.exposure, settings.exposure, settings.exposure)
        wanted = (scene.light, settings.exposure) if outside is None else None
        if wanted == self._main:
            return
        self._main = wanted
        for name in ("/lights/main", "/lights/below"):
            self._drop(name)
        if wanted is None:
            return
        if scene.light is None:
            self._directional("/lights/main", WHITE, 3.0 * settings.exposure, ABOVE, cast_shadow=not self._low)
            self._directional("/lights/below", WHITE, 0.4 * settings.exposure, (0.0, 0.0, -1.0))
            return
        light = scene.light
        red, green, blue = (round(255 * c) for c in light.colour)
        x, y, z = (float(v) for v in MAIN_LIGHT_AWAY_M * np.array(light.direction))
        self._directional(
            "/lights/main",
            (red, green, blue),
            (MAIN_LIGHT_EVEN + MAIN_LIGHT_STRENGTH * light.strength) * settings.exposure,
            (x, y, max(z, 1.0)),
            cast_shadow=not self._low,
        )

    def _show_sun(self, scene: Scene, settings: LightSettings, outside: Daylight | None, node_name: NodeName) -> None:
        """The sun itself, the light of the largest window, and what holds the sun off."""
        if outside is None:
            for name in ("/lights/sun", "/lights/window"):
                self._drop(name)
            self._casters(None)
            self._show_patches((), WHITE)
            return
        colour, strength = _split(outside.sun)
        intensity = SUN_INTENSITY * strength * (UNSHADED_SUN if self._low else 1.0) * settings.exposure
        corners = np.stack(bounds(scene))
        middle = corners.mean(axis=0)
        x, y, z = (float(v) for v in middle + 2.0 * _radius(corners) * outside.direction)
        self._directional("/lights/sun", colour, intensity, (x, y, z))
        self._window_light(scene, settings, outside, middle)
        if self._low:
            self._show_patches(tuple(sun_patches(scene, outside.direction) if strength > 0.0 else ()), colour)
        else:
            self._casters(close_room(with_openings(scene)).architecture if strength > 0.0 else None)

    def _window_light(
        self, scene: Scene, settings: LightSettings, outside: Daylight, middle: Float[np.ndarray, 3]
    ) -> None:
        """Soft light from where the largest window is, so that the room is not lit evenly."""
        windows = [o for o in scene.objects if o.category == "window" and not o.hidden]
        if not windows:
            self._drop("/lights/window")
            return
        window = max(windows, key=lambda o: (float(np.prod(o.size_m[1:])), o.id))
        colour, strength = _split(outside.sky)
        x, y, z = (float(v) for v in window.pose.position - middle + np.array([0.0, 0.0, 0.6]))
        self._directional("/lights/window", colour, WINDOW_INTENSITY * strength * settings.exposure, (x, y, z))

    def _casters(self, planes: Architecture | None) -> None:
        """Walls and ceiling as the sun meets them, drawn by nobody."""
        if planes == self._walls:
            return
        self._walls = planes
        self._drop("/lights/walls")
        if planes is None or not planes.planes:
            return
        polygons, triangles = [p.polygon for p in planes.planes], [plane_triangles(p) for p in planes.planes]
        vertices, faces = trimesh.util.append_faces(polygons, triangles)
        self._nodes["/lights/walls"] = self._server.scene.add_mesh_simple(
            "/lights/walls",
            vertices=vertices,
            faces=faces,
            opacity=0.0,
            side="front",
            cast_shadow=True,
            receive_shadow=False,
        )

    def _show_patches(self, patches: tuple[Float[np.ndarray, "_ 3"], ...], colour: Colour) -> None:
        state = (colour, *(tuple(map(tuple, p.round(3).tolist())) for p in patches))
        if state == self._patches:
            return
        self._patches = state
        for name in [n for n in self._nodes if n.startswith("/lights/patch")]:
            self._drop(name)
        for number, patch in enumerate(patches):
            name = f"/lights/patch{number}"
            self._nodes[name] = self._server.scene.add_mesh_simple(
                name,
                vertices=patch @ np.eye(3),
                faces=plane_triangles(Plane("patch", "floor", patch)),
                color=colour,
                opacity=PATCH_OPACITY,
                side="front",
                cast_shadow=False,
                receive_shadow=False,
            )

    def _show_lamps(self, scene: Scene, settings: LightSettings, node_name: NodeName) -> None:
        """Lamps that shine, below the frames of their objects, so that they move with them."""
        on = settings.lamps_on or ()
        most = MAX_LAMPS_LIGHT if self._low else MAX_LAMPS
        lit = [o for o in scene.objects if o.id in on and not o.hidden][:most]
        wanted: dict[str, _Lamp] = {}
        for item in lit:
            node = node_name(item.id)
            lamp = None if node is None else self._lamp(item, f"{node}/lamp", settings.exposure)
            if lamp is not None:
                wanted[item.id] = lamp
        for gone in [i for i, (lamp, _) in self._lamps.items() if wanted.get(i) != lamp]:
            remove_quietly(self._lamps.pop(gone)[1])
        for lamp_id, lamp in wanted.items():
            if lamp_id not in self._lamps:
                handle = self._server.scene.add_light_point(
                    lamp.node, color=lamp.colour, intensity=lamp.intensity, decay=2.0, position=lamp.position
                )
                self._lamps[lamp_id] = (lamp, handle)

    def _lamp(self, item: SceneObject, node: str, exposure: float) -> _Lamp | None:
        from diorama_core.render.lamps import LAMP_LUMENS, WARM  # the ray-caster; opening a project does without it
        from diorama_core.render.scene_light import lamp_strength

        if item.category not in LAMP_LUMENS:
            return None
        place = self._shapes.lamp_place(item)
        x, y, z = (float(v) for v in (place - item.pose.position) @ item.pose.R_world_object)
        red, green, blue = (round(255 * c) for c in WARM)
        return _Lamp(node, (x, y, z), (red, green, blue), LAMP_INTENSITY * lamp_strength(item) * exposure)

    def _sky(self, above: float, around: float, environment: float, tint: Float[np.ndarray, 3] | None = None) -> None:
        """Light from above and from everywhere; 1 is the usual light of a room."""
        scene = self._server.scene
        colour = None if tint is None else _split(tint)[0]
        if "/lights/sky" not in self._nodes:
            self._nodes["/lights/sky"] = scene.add_light_hemisphere("/lights/sky", ground_color=GROUND)
            self._nodes["/lights/around"] = scene.add_light_ambient("/lights/around")
        sky, all_round = (1.0, 0.9) if self._low else (0.75, 0.55)
        _set(self._nodes["/lights/sky"], intensity=round(sky * above, 4), sky_color=colour or SKY)
        _set(self._nodes["/lights/around"], intensity=round(all_round * around, 4), color=colour or AROUND)
        strength = ENVIRONMENT * environment
        if not self._low and abs(strength - self._environment) >= ENVIRONMENT_STEP * max(self._environment, 0.1):
            self._environment = strength
            scene.configure_environment_map("apartment", environment_intensity=strength)

    def _directional(
        self,
        name: str,
        colour: Colour,
        intensity: float,
        position: tuple[float, float, float],
        *,
        cast_shadow: bool = False,
    ) -> None:
        if name in self._nodes:
            _set(self._nodes[name], color=colour, intensity=intensity, position=position)
        else:
            self._nodes[name] = self._server.scene.add_light_directional(
                name, color=colour, intensity=intensity, cast_shadow=cast_shadow, position=position
            )

    def _drop(self, name: str) -> None:
        handle = self._nodes.pop(name, None)
        if handle is not None:
            handle.remove()


def _set(handle: Any, **properties: Any) -> None:
    """Change what differs: each change is a message."""
    for name, value in properties.items():
        if not np.array_equal(getattr(handle, name), value):
            setattr(handle, name, value)


def _split(light: Float[np.ndarray, 3]) -> tuple[Colour, float]:
    """A colour whose largest component is full, and how strong it is."""
    strength = float(light.max())
    red, green, blue = (round(255 * float(c) / strength) if strength > 0.0 else 255 for c in light)
    return (red, green, blue), strength


def _radius(corners: Float[np.ndarray, "2 3"]) -> float:
    return 0.5 * float(np.linalg.norm(corners[1] - corners[0])) + 0.2
