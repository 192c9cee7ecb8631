"""Digital cousins of a room: other shapes, colours, places, light and small things, and all of it at rest.

A variant follows from its seed. Things that two simulated seconds of gravity move go back to how they are in the room
together with what they stand on, and what was added goes away, until nothing moves. What does not rest in the room
itself is locked first.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal, get_args

import numpy as np

from diorama_core.appearance.patterns import COLOURS
from diorama_core.appearance.surface_finish import KINDS
from diorama_core.editing.collisions import Collisions
from diorama_core.editing.footprints import footprint_of, lie_within
from diorama_core.editing.placing import places_of, seat
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.editing.sunlight import first_daylight
from diorama_core.export.gathering import ExportOptions, gather
from diorama_core.export.stability import StabilityReport, stability
from diorama_core.geometry.rotations import rotation_from_vector
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.taxonomy import column, having
from diorama_core.scene import edits
from diorama_core.scene.room_edits import set_surface_finish
from diorama_core.scene.support import ancestors, descendants
from diorama_core.scene.types import PlaneRole, Pose, Scene, SceneObject, SurfaceFinish, SurfacePattern
from diorama_core.synthesis.clutter import HABITS

Aspect = Literal["shapes", "textures", "poses", "light", "clutter"]
ASPECTS: tuple[Aspect, ...] = get_args(Aspect)
FINISHES: Mapping[PlaneRole, tuple[SurfacePattern, ...]] = {
    "floor": ("boards", "parquet", "herringbone", "tiles", "carpet"),
    "wall": ("paint", "paint", "plaster", "stripes", "panelling", "brick"),
}


@dataclass(frozen=True)
class VariantSettings:
    """How far variants differ from their room."""

    changed_share: float = 0.6
    """Each aspect changes about so many of the objects."""
    stretch: float = 1.35
    """Another shape is stretched by this factor at most along each axis: beyond, furniture looks drawn out."""
    shift_m: float = 0.08
    """Standard deviation of how far things on the floor move; on furniture a third of it."""
    turn_rad: float = 0.12
    """Standard deviation of how far things turn."""
    most_added: int = 6
    removed_share: float = 0.3
    """About so many of the small things that carry nothing are left out."""
    tries: int = 8
    """Places that are tried for each thing, and rounds in which a variant comes to rest."""


@dataclass(frozen=True, eq=False)
class Variant:
    """One cousin of a room, in which nothing moves."""

    seed: int
    scene: Scene
    changes: Mapping[str, tuple[str, ...]]
    """What differs from the room, by id of an object or plane ("light" for the light): "shape ID", "moved", ..."""
    max_moved_m: float
    """How far gravity moved what moved most."""


@dataclass(frozen=True, eq=False)
class VariantMaker:
    """Draws variants of one room, in which everything is at rest (`lock_restless`)."""

    room: Scene
    library: ShapeLibrary
    aspects: Collection[Aspect] = ASPECTS
    settings: VariantSettings = VariantSettings()
    collisions: Collisions = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "collisions", Collisions(self.library))

    def draw(self, seed: int) -> Variant | None:
        """The variant of a seed; None where it does not come to rest.

        Raises:
            UnavailableError: MuJoCo is not installed.
        """
        rng, scene = np.random.default_rng(seed), self.room
        steps = {"shapes": self._reshape, "poses": self._move, "clutter": self._clutter, "textures": self._paint}
        for aspect, step in steps.items():
            if aspect in self.aspects:
                scene = step(rng, scene)
        if "light" in self.aspects:
            scene = relight(rng, scene)
        for _ in range(self.settings.tries):
            report = stability_report(scene, self.library)
            if not report.unstable:
                moved = max((d.moved_m for d in report.drifts), default=0.0)
                return Variant(seed, scene, differences(self.room, scene), moved)
            scene = self._calm(scene, {d.object_id for d in report.unstable})
        return None

    def _calm(self, scene: Scene, restless: Collection[str]) -> Scene:
        """What moves, and all that shares its furniture, as it is in the room, but for colours; additions are gone."""
        tops = {next((a for a in reversed(ancestors(scene, i)) if scene.has_object(a)), i) for i in restless}
        chosen = {i for top in tops for i in (top, *descendants(scene, top))}
        # What was left out of the same furniture comes back only as it was: the room itself is at rest.
        lacking = {i for top in tops if self.room.has_object(top) for i in (top, *descendants(self.room, top))}
        kept = [o for o in scene.objects if o.id not in chosen]
        now = {o.id: o for o in scene.objects}
        back = [
            replace(o, colour=now[o.id].colour, material_source=now[o.id].material_source) if o.id in now else o
            for o in self.room.objects
            if o.id in chosen | lacking
        ]
        ids = {o.id for o in back}
        supports = [s for s in scene.supports if s.child not in chosen | ids]
        edges = [s for s in self.room.supports if s.child in ids]
        return replace(scene, objects=(*kept, *back), supports=(*supports, *edges))

    def _some(self, rng: np.random.Generator, scene: Scene) -> list[SceneObject]:
        share = self.settings.changed_share
        return [o for o in scene.objects if not o.locked and not o.hidden and rng.random() < share]

    def _reshape(self, rng: np.random.Generator, scene: Scene) -> Scene:
        """Other shapes of the same kind in the same size; what stands on them is seated anew."""
        for item in self._some(rng, scene):
            options = [s for s in self.library.in_category(item.category) if self._alike(s, item)]
            if not options:
                continue
            shape = options[int(rng.integers(len(options)))]
            pose = Pose(item.pose.R_world_object, item.pose.position, np.asarray(item.size_m) / shape.size_m)
            new = replace(item, shape_id=shape.id, shape_size_m=shape.size_m, pose=pose, photo_materials=())
            scene = replace(scene, objects=tuple(new if o.id == item.id else o for o in scene.objects))
            children = scene.children_of(item.id)
            loose = tuple(replace(s, parent_surface=None) if s.child in children else s for s in scene.supports)
            scene = replace(scene, supports=loose)
            for child in children:
                if not scene.object(child).locked:
                    scene = seat(scene, self.library, child)
        return scene

    def _alike(self, shape: Shape, item: SceneObject) -> bool:
        stretch = np.abs(np.log(np.asarray(item.size_m) / np.asarray(shape.size_m)))
        return shape.id != item.shape_id and bool((stretch < np.log(self.settings.stretch)).all())

    def _move(self, rng: np.random.Generator, scene: Scene) -> Scene:
        """What stands free a little elsewhere with its load, clear of others and inside the room."""
        frame = RoomFrame.of(scene)
        for item in self._some(rng, scene):
            edge = scene.support_of(item.id)
            if edge is None or edge.relation != "placed on" or edge.adheres_to:
                continue
            on_floor = scene.has_plane(edge.parent)
            moved_ids = (item.id, *descendants(scene, item.id))
            before = self.collisions.pairs(scene, moved_ids)
            for _ in range(self.settings.tries):
                shift = rng.normal(0.0, self.settings.shift_m / (1 if on_floor else 3), 2)
                R = rotation_from_vector(np.array([0.0, 0.0, rng.normal(0.0, self.settings.turn_rad)]))
                pose = item.pose.move(np.array([*shift, 0.0]))
                trial = edits.move(scene, item.id, replace(pose, R_world_object=R @ pose.R_world_object))
                if not on_floor:
                    trial = seat(trial, self.library, item.id)
                outside = on_floor and not lie_within(footprint_of(trial.object(item.id))[None], frame.outline, 0.0)[0]
                if not outside and self.collisions.pairs(trial, moved_ids) <= before:
                    scene = trial
                    break
        return scene

    def _clutter(self, rng: np.random.Generator, scene: Scene) -> Scene:
        """Some small things are gone, others stand where people leave them."""
        portable = having("portable")
        bare = [o for o in scene.objects if o.category in portable and not scene.children_of(o.id) and not o.locked]
        on_things = [o.id for o in bare if (e := scene.support_of(o.id)) and scene.has_object(e.parent)]
        scene = edits.remove(scene, [i for i in on_things if rng.random() < self.settings.removed_share])
        hosts = [p for p in places_of(scene, self.library) if p.of_object and p.upward]
        hosts = [p for p in hosts if scene.object(p.parent).category in HABITS and p.surface.normal[2] > 0.99]
        for _ in range(int(rng.integers(1, self.settings.most_added + 1)) if hosts else 0):
            place = hosts[int(rng.integers(len(hosts)))]
            low, high = place.surface.polygon.min(axis=0), place.surface.polygon.max(axis=0)
            habit = HABITS[scene.object(place.parent).category]
            tallest = min(habit.tallest_m, place.surface.clearance_m - 0.015)
            kinds = self.library.in_category(habit.items[int(rng.integers(len(habit.items)))])
            options = [s for s in kinds if s.size_m[2] < tallest and max(s.size_m[:2]) < 0.8 * max((high - low)[:2])]
            for _ in range(self.settings.tries if options else 0):
                shape = options[int(rng.integers(len(options)))]
                at = np.array([*rng.uniform(low[:2], high[:2]), place.surface.level + shape.size_m[2] / 2])
                pose = Pose.upright(at, float(rng.uniform(-np.pi, np.pi)))
                name = edits.fresh_id(scene, shape.category)
                item = SceneObject(name, shape.category, shape.category, shape.id, shape.size_m, pose)
                inside = lie_within(footprint_of(item)[None], place.surface.polygon[:, :2], 0.0)[0]
                trial = edits.insert(scene, item, place.edge(name)) if inside else scene
                if inside and not self.collisions.pairs(trial, [name]):
                    scene = trial
                    break
        return scene

    def _paint(self, rng: np.random.Generator, scene: Scene) -> Scene:
        """Other colours of furniture, another floor, and walls that are all alike."""
        for item in self._some(rng, scene):
            if item.category not in having("own_colours"):
                colour = COLOURS[list(COLOURS)[int(rng.integers(len(COLOURS)))]]
                scene = edits.recolour(scene, item.id, colour)
        for role, patterns in FINISHES.items():
            pattern = patterns[int(rng.integers(len(patterns)))]
            colours = KINDS[pattern].colours
            finish = SurfaceFinish(pattern, COLOURS[colours[int(rng.integers(len(colours)))]])
            planes = [p.id for p in scene.architecture.by_role(role)]
            scene = set_surface_finish(scene, planes, finish) if planes else scene
        return scene


def relight(rng: np.random.Generator, scene: Scene) -> Scene:
    """Another time of day, the sun from about the side of the window, some of the lamps on."""
    lamps = [o.id for o in scene.objects if o.category in column("lumens") and rng.random() < 0.5]
    settings = first_daylight(scene)
    hour, north = float(rng.uniform(8.0, 16.5)), settings.north_rad + float(rng.normal(0.0, 0.5))
    return replace(scene, light_settings=replace(settings, hour=hour, north_rad=north, lamps_on=tuple(lamps)))


def stability_report(scene: Scene, library: ShapeLibrary) -> StabilityReport:
    """Report of two seconds of gravity on a scene."""
    return stability(gather(scene, library, options=ExportOptions(joints=True, lights="none", ceiling=False)))


def lock_restless(scene: Scene, library: ShapeLibrary) -> tuple[Scene, tuple[str, ...]]:
    """The scene in which what gravity moves is locked, and so welded, and the ids of that."""
    locked: tuple[str, ...] = ()
    while fresh := [d.object_id for d in stability_report(scene, library).unstable]:
        locked = (*locked, *fresh)
        for object_id in fresh:
            scene = edits.set_locked(scene, object_id, True)
    return scene, locked


def differences(room: Scene, variant: Scene) -> dict[str, tuple[str, ...]]:
    """What differs, by id, in a few words."""
    changes: dict[str, tuple[str, ...]] = {o.id: ("removed",) for o in room.objects if not variant.has_object(o.id)}
    for new in variant.objects:
        if not room.has_object(new.id):
            changes[new.id] = (f"added {new.shape_id}",)
            continue
        old = room.object(new.id)
        moved = not np.allclose(old.pose.T_world_object, new.pose.T_world_object, atol=1e-6)
        about = {
            f"shape {new.shape_id}": new.shape_id != old.shape_id,
            "moved": moved,
            f"colour {new.colour}": new.colour != old.colour,
        }
        if changed := tuple(text for text, is_so in about.items() if is_so):
            changes[new.id] = changed
    for plane in variant.architecture.planes:
        if plane.finish is not None and plane.finish != room.plane(plane.id).finish:
            changes[plane.id] = (f"{plane.finish.pattern} {plane.finish.colour}",)
    if variant.light_settings != room.light_settings and variant.light_settings.hour is not None:
        changes["light"] = (
            f"{variant.light_settings.hour:.1f} h",
            *(f"{i} on" for i in variant.light_settings.lamps_on or ()),
        )
    return changes
