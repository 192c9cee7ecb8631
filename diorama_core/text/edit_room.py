"""Edits of the room itself: coverings and colours in words, lengths, light, doors and windows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_core.appearance.patterns import COLOURS
from diorama_core.appearance.surface_finish import KINDS, usual_finish
from diorama_core.editing.opening_insertion import with_opening
from diorama_core.editing.plan_edits import wall_feet
from diorama_core.editing.positioning import Positioner
from diorama_core.editing.sunlight import first_daylight, set_light
from diorama_core.errors import EditRefused
from diorama_core.geometry.wall_lines import DrawnWall
from diorama_core.library.labels import with_article
from diorama_core.library.language import tokens
from diorama_core.render.lamps import lamps_of
from diorama_core.scene.light_settings import MAX_EXPOSURE_EV
from diorama_core.scene.room_edits import (
    ceiling_height,
    floor_height,
    move_plane,
    set_ceiling_height,
    set_surface_finish,
)
from diorama_core.scene.types import Plane, Scene, SurfaceFinish, SurfacePattern
from diorama_core.text.edit_plan import Done, InsertOpening, Light, Paint, RoomLength
from diorama_core.text.looks import look_of

_PATTERNS: dict[SurfacePattern, str] = {
    "brick": "brick brickwork",
    "plaster": "plaster stucco concrete cement",
    "stripes": "stripe striped",
    "dots": "dot dotted polka",
    "leaves": "leaf leave floral flowery wallpaper wallpapered",
    "panelling": "panelling paneling panelled paneled panel wainscot wainscoting",
    "metro": "metro subway",
    "tiles": "tile tiled",
    "checker": "checker chequered checkered checkerboard",
    "parquet": "parquet",
    "herringbone": "herringbone chevron",
    "boards": "board plank floorboard wood wooden laminate timber hardwood",
    "carpet": "carpet carpeted carpeting",
}
"""Words that name a pattern; what is special comes before what is common ("metro tiles")."""
_NAMES = frozenset(name for names in _PATTERNS.values() for name in names.split())
_RELATIVE = {"darker": -0.25, "lighter": 0.3, "brighter": 0.3, "paler": 0.3}
"""How far a colour goes toward black or white."""
_BESIDE = frozenset({"pattern", "patterned", "finish", "covering", "made", "very", "much", "bit", "little", "slightly"})
_WOODS = frozenset(KINDS["boards"].colours)


def covering_in_words(text: str, plane: Plane) -> SurfaceFinish | None:
    """What a plane is to be covered with; None where words name anything else or nothing.

    Args:
        text: the words.
        plane: whose colour "darker" and "lighter" change.
    """
    words = [w for w in tokens(text) if w not in _BESIDE]
    relative = next((w for w in words if w in _RELATIVE), None)
    rest = [w for w in words if w != relative and w not in ("a", "an", "the", "in", "of", "with", "colour", "color")]
    if relative is not None:
        known = covering_in_words(" ".join(rest), plane) if rest else None
        if rest and known is None:
            return None
        return _shade(known or plane.finish or SurfaceFinish("paint", plane.colour), _RELATIVE[relative])
    pattern = next((p for p, names in _PATTERNS.items() if set(rest) & set(names.split())), None)
    others = [w for w in rest if w not in _NAMES]
    wood = next((w for w in others if w in _WOODS and w in COLOURS and w not in ("grey", "white")), None)
    if pattern is None and wood is not None and plane.role == "floor":
        pattern = "boards"
    look = look_of(" ".join(others)) if others else None
    if others and look is None:
        return None
    if pattern is None:
        return None if look is None else SurfaceFinish("paint", look.colour)
    usual = usual_finish(pattern)
    if wood is not None and pattern in ("boards", "parquet", "herringbone"):
        return replace(usual, colour=COLOURS[wood])
    return usual if look is None else replace(usual, colour=look.colour)


def _shade(known: SurfaceFinish, by: float) -> SurfaceFinish:
    toward = 1.0 if by > 0 else 0.0
    r, g, b = (float(c + (toward - c) * abs(by)) for c in known.colour)
    return replace(known, colour=(r, g, b))


ACROSS = 0.7
"""A wall ends a side of the room whose direction its normal shares at least so much."""


def cover(scene: Scene, edit: Paint) -> Done:
    """Walls, floor or ceiling in a colour, a pattern, or a darker or lighter colour than now."""
    role = {"walls": "wall", "floor": "floor", "ceiling": "ceiling"}[edit.part]
    planes = [p for p in scene.architecture.planes if p.role == role]
    if not planes:
        raise EditRefused(f"this scene has no {edit.part} to paint")
    if edit.behind:
        planes = [_wall_at(scene, edit.behind)]
    elif edit.wall:
        planes = [wall_on(scene, edit.wall)]
    after = scene
    for plane in planes:
        finish = covering_in_words(edit.colour, plane)
        if finish is None:
            raise EditRefused(f"“{edit.colour}” is no colour or covering known here; try light blue, brick, oak boards")
        after = set_surface_finish(after, [plane.id], finish)
    where = f"the wall behind {scene.object(edit.behind).label}" if edit.behind else f"the {edit.part}"
    where = f"the {edit.wall} wall" if edit.wall else where
    return Done(after, (f"make {where} {edit.colour}",))


def lengthen(scene: Scene, edit: RoomLength) -> Done:
    """The room higher, longer or wider."""
    if edit.side == "height":
        top = ceiling_height(scene)
        now = top - floor_height(scene) if top is not None else _top_of_walls(scene)
        target = edit.to_m or now + edit.by_m
        return Done(set_ceiling_height(scene, target), (f"make the room {target:.2f} m high",))
    axis, extents = _axes(scene)
    k = int(np.argmax(extents)) if edit.side == "length" else int(np.argmin(extents))
    by = edit.to_m - extents[k] if edit.to_m else edit.by_m
    wall = _far_wall(scene, axis[k])
    after = move_plane(scene, wall.id, float(by))
    return Done(after, (f"make the room {extents[k] + by:.2f} m {'long' if edit.side == 'length' else 'wide'}",))


def light(scene: Scene, edit: Light) -> Done:
    """Another time of day, more or less exposure, all lamps on or off."""
    settings, lines = scene.light_settings, []
    if edit.hour is not None:
        settings = replace(settings if settings.hour is not None else first_daylight(scene), hour=edit.hour)
        lines.append(f"set the time of day to {int(edit.hour):02d}:{round(edit.hour % 1 * 60):02d}")
    if edit.brighter_ev:
        exposure = float(np.clip(settings.exposure_ev + edit.brighter_ev, -MAX_EXPOSURE_EV, MAX_EXPOSURE_EV))
        settings = replace(settings, exposure_ev=exposure)
        lines.append(f"make the light {'brighter' if edit.brighter_ev > 0 else 'darker'}")
    if edit.lamps:
        lamps = tuple(o.id for o in lamps_of(scene))
        if not lamps:
            raise EditRefused("there is no lamp in this scene; add one first")
        settings = replace(settings, lamps_on=lamps if edit.lamps == "on" else ())
        lines.append(f"turn all lamps {edit.lamps}")
    if not lines:
        raise EditRefused("which light? For example: make it evening, turn on the lamps, make the room brighter")
    return Done(set_light(scene, settings), tuple(lines))


def open_wall(positioner: Positioner, scene: Scene, edit: InsertOpening) -> Done:
    """A new door or window in a wall."""
    feet = wall_feet(scene)
    if not feet:
        raise EditRefused("this scene has no walls")
    if edit.behind:
        wall = _wall_at(scene, edit.behind).id
        at = scene.object(edit.behind).pose.position[:2]
    else:
        foot = max(feet, key=lambda f: (_side_score(scene, f, edit.wall), _free_m(scene, f)))
        wall, at = foot.id, 0.5 * (foot.start + foot.end)
    after, new_id = with_opening(scene, positioner.library, edit.what, wall, at)
    return Done(after, (f"put {with_article(edit.what)} into a wall",), (new_id,))


def _wall_at(scene: Scene, object_id: str) -> Plane:
    """The wall that is nearest to an object's back, or else to the object."""
    walls = scene.architecture.by_role("wall")
    if not walls:
        raise EditRefused("this scene has no walls")
    corners = scene.object(object_id).corners_world
    return min(walls, key=lambda w: abs(float((corners @ w.normal).min()) - w.offset))


def off_wall(scene: Scene, object_id: str) -> Float[np.ndarray, "2"]:
    """The level direction away from the wall at an object."""
    normal = _wall_at(scene, object_id).normal[:2]
    return np.asarray(normal / max(float(np.linalg.norm(normal)), 1e-9))


def gap_to_wall(scene: Scene, object_id: str) -> float:
    """Metres between an object and the wall at it."""
    wall = _wall_at(scene, object_id)
    return float((scene.object(object_id).corners_world @ wall.normal).min()) - wall.offset


def _top_of_walls(scene: Scene) -> float:
    tops = [float(p.polygon[:, 2].max()) for p in scene.architecture.by_role("wall")]
    if not tops:
        raise EditRefused("the room has neither a ceiling nor walls; there is nothing to raise or lower")
    return max(tops) - floor_height(scene)


def _axes(scene: Scene) -> tuple[Float[np.ndarray, "2 2"], Float[np.ndarray, "2"]]:
    """Directions of the room's two sides, and how long it is along each."""
    feet = wall_feet(scene)
    if not feet:
        raise EditRefused("this scene has no walls")
    along = max(feet, key=lambda f: f.length_m).direction
    axes = np.array([along, [-along[1], along[0]]])
    ends = np.array([p for f in feet for p in (f.start, f.end)])
    return axes, np.ptp(ends @ axes.T, axis=0)


def _far_wall(scene: Scene, axis: Float[np.ndarray, "2"]) -> Plane:
    """The wall that ends a side of the room, the one that is farther from the camera."""
    ends = [w for w in scene.architecture.by_role("wall") if abs(float(w.normal[:2] @ axis)) > ACROSS]
    if not ends:
        raise EditRefused("no wall of this room stands across that direction; drag a wall in the plan instead")
    eye = np.zeros(3) if scene.camera is None else np.asarray(scene.camera.position)
    return max(ends, key=lambda w: abs(float(eye @ w.normal) - w.offset))


def direction_of(scene: Scene, side: str) -> Float[np.ndarray, "2"]:
    """The level direction of a side of the room as somebody sees it who looks at the room from the camera."""
    away = np.array([0.0, 1.0]) if scene.camera is None else np.array(scene.camera.T_world_camera[:2, 2])
    away = away / max(float(np.linalg.norm(away)), 1e-6)
    right = np.array([away[1], -away[0]])
    return np.asarray({"right": right, "left": -right, "back": away, "front": -away}[side])


def _side_score(scene: Scene, foot: DrawnWall, side: str) -> float:
    """Cosine between a wall's outward normal and a side's direction, rounded."""
    return round(float(foot.outward @ direction_of(scene, side)), 1) if side else 0.0


def wall_on(scene: Scene, side: str) -> Plane:
    """The wall on a side of the room."""
    feet = wall_feet(scene)
    foot = max(feet, key=lambda f: _side_score(scene, f, side), default=None)
    if foot is None or _side_score(scene, foot, side) < ACROSS:
        raise EditRefused(
            f"this room has no {side} wall; the photo shows {len(feet) or 'no'} wall{'s' * (len(feet) != 1)}"
        )
    return scene.plane(foot.id)


def _free_m(scene: Scene, foot: DrawnWall) -> float:
    """Length of a wall that no opening or picture takes."""
    standing = [o for o in scene.objects if (s := scene.support_of(o.id)) is not None and s.parent == foot.id]
    return foot.length_m - sum(float(o.size_m[1]) for o in standing)
