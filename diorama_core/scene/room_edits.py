"""Edits of the room itself, and of the scale of everything: pure functions Scene -> Scene.

What is fastened to a plane follows it: objects mounted on it, objects that stand on it, objects that stand against it,
and whatever those hold up. Locked objects stay where they are. Planes that share corners with a moved one are
stretched or cut so that the room stays closed.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.errors import EditRefused
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Camera, Plane, Pose, Scene, SceneObject, SurfaceFinish

JOINED_M = 0.01
"""Corners of two planes nearer than this are one corner of the room."""
LARGEST_MOVE_M = 30.0
LOWEST_CEILING_M, HIGHEST_CEILING_M = 1.0, 30.0
SMALLEST_FACTOR, LARGEST_FACTOR = 0.02, 50.0
KNOWN_LENGTH_SIGMA = 0.02
"""Standard deviation of the logarithm of all lengths once one of them is known: so well are others known relative to
it (median over 77 tall things on the floor of 24 rendered rooms)."""
SMALLEST_PATTERN, LARGEST_PATTERN = 0.1, 10.0
PARALLEL = 0.985
"""Planes turned by less than about ten degrees cannot be kept joined by sliding along one another."""

Points = Float[np.ndarray, "n 3"]


def move_plane(scene: Scene, plane_id: str, distance_m: float) -> Scene:
    """Move a wall, the floor or the ceiling along its normal; the planes that meet it follow, so the room stays closed.

    Where a wall goes on in the same plane, which it does after it was split, a new wall closes the gap.

    Args:
        scene: The scene.
        plane_id: The plane to move.
        distance_m: Outward: positive makes the room larger, negative smaller.

    Raises:
        EditRefused: when there is no such plane, or a plane that meets it would vanish or turn over.
    """
    plane = _plane(scene, plane_id)
    if not np.isfinite(distance_m) or abs(distance_m) > LARGEST_MOVE_M:
        raise EditRefused(f"a plane cannot move by {distance_m:g} m; give at most {LARGEST_MOVE_M:g} m")
    planes = _with_plane_moved(scene.architecture.planes, plane, float(distance_m))
    planes = tuple(replace(p, sigma_m=0.0) if p.id == plane_id and p.sigma_m else p for p in planes)
    shift = -plane.normal * distance_m
    return _carry(_with_planes(scene, planes), _followers(scene, {plane_id}), shift)


def set_ceiling_height(scene: Scene, height_m: float) -> Scene:
    """Bring the top of the room to a height above the floor; sloped ceilings keep their slope, walls grow or shrink.

    Works without a ceiling too, on the walls' tops. Lamps and whatever else hangs from the ceiling follow.

    Raises:
        EditRefused: when the room has neither ceiling nor walls, or the height is not a room's.
    """
    if not np.isfinite(height_m) or not LOWEST_CEILING_M <= height_m <= HIGHEST_CEILING_M:
        raise EditRefused(
            f"a ceiling at {height_m:g} m is no room; give {LOWEST_CEILING_M:g} to {HIGHEST_CEILING_M:g} m"
        )
    height_now_m = ceiling_height(scene)
    if height_now_m is None:
        raise EditRefused("the room has neither a ceiling nor walls; there is nothing to raise or lower")
    ceilings, rise = scene.architecture.by_role("ceiling"), height_m - height_now_m

    def lift(plane: Plane) -> Plane:
        if plane.role == "floor":
            return plane
        polygon = plane.polygon.copy()
        top = _are_at_top(plane, ceilings) if plane.role == "wall" else np.ones(len(polygon), dtype=bool)
        polygon[top, 2] += rise
        return replace(plane, polygon=polygon)

    planes = tuple(_sound(p, lift(p)) for p in scene.architecture.planes)
    attached = _followers(scene, {p.id for p in ceilings})
    return _carry(_with_planes(scene, planes), attached, np.array([0.0, 0.0, rise]))


def rescale(scene: Scene, factor: float) -> Scene:
    """Everything larger or smaller about the world's origin, camera included: the photo looks the same.

    Raises:
        EditRefused: when the factor is not a positive number of a usable size.
    """
    if not np.isfinite(factor) or not SMALLEST_FACTOR <= factor <= LARGEST_FACTOR:
        raise EditRefused(f"a scene cannot be scaled by {factor:g}; give {SMALLEST_FACTOR:g} to {LARGEST_FACTOR:g}")

    def scale_pose(pose: Pose) -> Pose:
        return Pose(pose.R_world_object, pose.position * factor, pose.scale * factor)

    def scale(item: SceneObject) -> SceneObject:
        candidates = tuple(replace(c, pose=scale_pose(c.pose)) for c in item.candidates)
        return replace(item, pose=scale_pose(item.pose), candidates=candidates)

    planes = tuple(replace(p, polygon=p.polygon * factor) for p in scene.architecture.planes)
    return replace(
        _with_planes(scene, planes),
        camera=None if scene.camera is None else _scale_camera(scene.camera, factor),
        objects=tuple(scale(o) for o in scene.objects),
        metrics=(),
    )


def rescale_to_length(scene: Scene, length_now_m: float, length_true_m: float) -> Scene:
    """Scale everything so that something that measures `length_now_m` in the scene measures `length_true_m`.

    Raises:
        EditRefused: when a length is not positive or the two are too far apart.
    """
    if not (np.isfinite([length_now_m, length_true_m]).all() and min(length_now_m, length_true_m) > 1e-6):
        raise EditRefused("a known length must be a positive number of metres")
    return replace(rescale(scene, length_true_m / length_now_m), scale_sigma=KNOWN_LENGTH_SIGMA)


def edge_length_m(scene: Scene, plane_id: str, edge: int) -> float:
    """Length of one edge of a plane: `edge` runs from that corner of its polygon to the next."""
    polygon = _plane(scene, plane_id).polygon
    return float(np.linalg.norm(polygon[(edge + 1) % len(polygon)] - polygon[edge % len(polygon)]))


def rescale_by_edge(scene: Scene, plane_id: str, edge: int, length_m: float) -> Scene:
    """ "This edge is 2.40 m": scale everything so that an edge of a plane has a known length.

    Args:
        scene: As it is.
        plane_id: Of the plane.
        edge: Index of its first corner.
        length_m: Its true length.
    """
    return rescale_to_length(scene, edge_length_m(scene, plane_id, edge), length_m)


def floor_height(scene: Scene) -> float:
    """z of the floor in the world; 0 without one."""
    floor = scene.architecture.floor
    return 0.0 if floor is None else float(floor.polygon[:, 2].mean())


def ceiling_height(scene: Scene) -> float | None:
    """Height of the room's top above its floor; None where there is neither a ceiling nor a wall."""
    upper = scene.architecture.by_role("ceiling") or scene.architecture.by_role("wall")
    return max(float(p.polygon[:, 2].max()) for p in upper) - floor_height(scene) if upper else None


def set_surface_finish(scene: Scene, plane_ids: Collection[str], finish: SurfaceFinish | None) -> Scene:
    """Finish planes alike, or with None let them look as they did before, in the photo.

    The pictures of finishes are made by `diorama_core.appearance.surface_finish`; until then planes are plain.

    Raises:
        EditRefused: when there is no such plane, or the pattern's size is no usable number.
    """
    if finish is not None and not SMALLEST_PATTERN <= finish.scale <= LARGEST_PATTERN:
        raise EditRefused(
            f"a pattern cannot be {finish.scale:g} times as large; give {SMALLEST_PATTERN:g} to {LARGEST_PATTERN:g}"
        )
    chosen = {_plane(scene, i).id for i in plane_ids}
    return _with_planes(scene, tuple(_finish(p, finish) if p.id in chosen else p for p in scene.architecture.planes))


def _finish(plane: Plane, finish: SurfaceFinish | None) -> Plane:
    if finish == plane.finish:
        return plane
    bare_colour = plane.colour if plane.photo_colour is None else plane.photo_colour
    bare_texture = plane.texture if plane.finish is None else plane.photo_texture
    if finish is None:
        return replace(
            plane, finish=None, colour=bare_colour, texture=bare_texture, photo_colour=None, photo_texture=None
        )
    return replace(
        plane,
        finish=finish,
        colour=finish.colour,
        texture=None,
        photo_colour=bare_colour,
        photo_texture=bare_texture,
    )


def _with_plane_moved(planes: tuple[Plane, ...], moved: Plane, distance_m: float) -> tuple[Plane, ...]:
    """All planes with one moved outward; corners on its rim slide along the other planes that meet there."""

    def slide(corner: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
        rows = [moved.normal]
        for other in planes:
            meets = other.id != moved.id and np.linalg.norm(other.polygon - corner, axis=1).min() < JOINED_M
            if meets and abs(float(other.normal @ moved.normal)) < PARALLEL:
                # Where more than three planes meet, the first ones decide: three already fix the corner.
                more = [*rows, other.normal]
                rows = more if np.linalg.matrix_rank(np.array(more), tol=0.1) == len(more) else rows
        wanted = np.zeros(len(rows))
        wanted[0] = -distance_m
        # The least displacement that keeps the corner on every plane it belongs to.
        return corner + np.linalg.lstsq(np.array(rows), wanted, rcond=1e-6)[0]

    edges = [_common_edge(moved, p) for p in planes if _continues(moved, p)]
    staying = np.concatenate([np.zeros((0, 3)), *edges])

    def adjust(plane: Plane) -> Plane:
        if plane.id == moved.id:
            return replace(plane, polygon=np.array([slide(c) for c in plane.polygon]))
        if abs(float(plane.normal @ moved.normal)) >= PARALLEL:
            return plane
        on = _lie_on_plane(plane.polygon, moved)
        corners: list[np.ndarray] = []
        for index, corner in enumerate(plane.polygon):
            stays = len(staying) > 0 and float(np.linalg.norm(staying - corner, axis=1).min()) < JOINED_M
            if on[index] and stays and plane.role != "wall":  # the rim has a step there
                step = [corner, slide(corner)]
                corners += step if on[(index + 1) % len(on)] else step[::-1]
            else:
                corners.append(slide(corner) if on[index] else corner)
        return replace(plane, polygon=np.array(corners))

    closing, taken = [], {p.id for p in planes}
    for edge in edges:
        wall_id = next(name for n in range(1, len(taken) + 2) if (name := f"{moved.role}_{n}") not in taken)
        taken.add(wall_id)
        closing.append(_closing(moved, wall_id, edge, np.array([slide(c) for c in edge]), distance_m))
    return (*(_sound(p, adjust(p)) for p in planes), *closing)


def _continues(wall: Plane, other: Plane) -> bool:
    """Whether another wall goes on in the plane of this one, and both share an edge."""
    both = wall.role == other.role == "wall" and wall.id != other.id
    if not both or float(wall.normal @ other.normal) < PARALLEL or abs(wall.offset - other.offset) > JOINED_M:
        return False
    return len(_common_edge(wall, other)) == 2


def _common_edge(wall: Plane, other: Plane) -> Points:
    """The corners that two planes share, the lowest first."""
    near = [c for c in wall.polygon if np.linalg.norm(other.polygon - c, axis=1).min() < JOINED_M]
    return np.array(sorted(near, key=lambda c: float(c[2]))).reshape(-1, 3)


def _closing(wall: Plane, wall_id: str, edge: Points, moved: Points, distance_m: float) -> Plane:
    """The wall between an edge and where it moved to, in the wall's colour: it looks into the part that is deeper."""
    polygon = np.array([edge[0], moved[0], moved[1], edge[1]])
    inward = (wall.centre - edge.mean(axis=0)) * np.sign(distance_m)
    made = replace(wall, id=wall_id, polygon=polygon, texture=None, photo_texture=None)
    return made if float(made.normal @ inward) > 0 else replace(made, polygon=polygon[::-1])


def _lie_on_plane(points: Points, plane: Plane) -> Bool[np.ndarray, "n"]:
    """True for points on a plane, within the bounds of its polygon."""
    near = np.abs(points @ plane.normal - plane.offset) < JOINED_M
    low, high = plane.polygon.min(axis=0) - JOINED_M, plane.polygon.max(axis=0) + JOINED_M
    return np.asarray(near & ((points >= low) & (points <= high)).all(axis=1))


def _are_at_top(wall: Plane, ceilings: tuple[Plane, ...]) -> Bool[np.ndarray, "n"]:
    """True for corners that end a wall above, at a ceiling or at its highest; those of its openings do not."""
    top = wall.polygon[:, 2] > float(wall.polygon[:, 2].max()) - JOINED_M
    for ceiling in ceilings:
        top |= np.abs(wall.polygon @ ceiling.normal - ceiling.offset) < JOINED_M
    return np.asarray(top)


def _sound(before: Plane, after: Plane) -> Plane:
    """The changed plane; refused when it has vanished or turned over."""
    area = float(np.linalg.norm(np.cross(after.polygon, np.roll(after.polygon, -1, axis=0)).sum(axis=0))) / 2
    if after is not before and (area < 1e-4 or float(before.normal @ after.normal) < 0.7):
        raise EditRefused(f"that would leave nothing of {before.id}; move by less")
    return after


def _with_planes(scene: Scene, planes: tuple[Plane, ...]) -> Scene:
    return replace(scene, architecture=replace(scene.architecture, planes=planes))


def _followers(scene: Scene, plane_ids: Iterable[str]) -> frozenset[str]:
    """Objects that follow planes: held up by them or standing against them, with all they hold up; none locked."""
    ids = set(plane_ids)
    attached = {s.child for s in scene.supports if s.parent in ids or ids & set(s.adheres_to)}
    attached |= {below for top in attached for below in descendants(scene, top)}
    return frozenset(o for o in attached if scene.has_object(o) and not scene.object(o).locked)


def _carry(scene: Scene, object_ids: frozenset[str], shift_world: Float[np.ndarray, "3"]) -> Scene:
    moved = (replace(o, pose=o.pose.move(shift_world)) if o.id in object_ids else o for o in scene.objects)
    return replace(scene, objects=tuple(moved))


def _scale_camera(camera: Camera, factor: float) -> Camera:
    T = camera.T_world_camera.copy()
    T[:3, 3] *= factor
    return replace(camera, T_world_camera=T)


def _plane(scene: Scene, plane_id: str) -> Plane:
    if not scene.has_plane(plane_id):
        raise EditRefused(f"there is no plane {plane_id!r}; choose a wall, the floor or the ceiling of the outliner")
    return scene.plane(plane_id)
