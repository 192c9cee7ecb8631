"""A scene from words: composed from the library and made ready to be shown; what it lacks of the words."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
import trimesh
from jaxtyping import Float, UInt8

from diorama_core.errors import InputError, UnavailableError
from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.geometry.rooms import part_of_home
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import category, with_kin
from diorama_core.perception.language.client import LmmSettings
from diorama_core.progress import SILENT, Progress
from diorama_core.render.raycast import MeshCaster
from diorama_core.render.slabs import plane_surfaces
from diorama_core.scene.types import Camera, Intrinsics, Plane, Scene
from diorama_core.synthesis import to_photo_world
from diorama_core.synthesis.cameras import level_pose
from diorama_core.synthesis.finishes import finish_textures
from diorama_core.text.compose import compose_room
from diorama_core.text.home import compose_home, rooms_asked
from diorama_core.text.language import list_request, mend
from diorama_core.text.prompt import RequestedObject, read_prompt

SIZE = (1024, 768)
PROBE_PX = (96, 72)
EYE_M, FOV_RAD = 1.6, 1.45
"""Eye level, and a wide lens as estate agents use."""
PLACES = 9
"""A side of the grid of places."""
TURNS_RAD = (-0.35, -0.18, 0.0, 0.18, 0.35)
"""Away from the middle of what was asked for."""
WALL_CLEARANCE_M, OBJECT_CLEARANCE_M = 0.15, 0.35
LOWEST_PITCH_RAD, HIGHEST_PITCH_RAD = 0.1, 0.42
SEEN_PX = 5
"""Fewer pixels of the probe show nothing that could be found again."""
CUT_WORTH = 0.45
"""Worth of an object that the picture's rim cuts off, beside one that is seen whole."""
NEAR_M = 0.9


def finish(scene: Scene, library: ShapeLibrary) -> tuple[Scene, Mapping[str, UInt8[np.ndarray, "_ _ 3"]]]:
    """The room in the world of a camera that shows most of it, and its planes' pictures by name."""
    # Every room has doors and windows; a picture may do without.
    worth = {o.id: 0.2 if o.category in OPENING_CATEGORIES else 1.0 for o in scene.objects}
    seen = part_of_home(scene, [scene.rooms[0].id]) if scene.rooms else scene
    scene = to_photo_world(replace(scene, camera=best_viewpoint(seen, library, SIZE, worth)))
    textures = finish_textures(scene.architecture)
    planes = tuple(replace(p, texture=p.id if p.id in textures else None) for p in scene.architecture.planes)
    return replace(scene, architecture=replace(scene.architecture, planes=planes)), textures


MAX_PROMPT_CHARS = 2000


@dataclass(frozen=True, eq=False)
class SceneFromText:
    """A furnished room that a text asked for."""

    scene: Scene
    """With a camera that shows most of it."""
    textures: Mapping[str, UInt8[np.ndarray, "_ _ 3"]]
    """Pictures of its planes by name."""
    notes: tuple[str, ...]
    """How it came about, and every wish that is not met."""


def words_of(prompt: str) -> str:
    """A prompt in one line.

    Raises:
        InputError: it is empty or very long.
    """
    words = " ".join(prompt.split())
    if not words:
        raise InputError('there is no text; describe a room, such as "a reading corner with two armchairs"')
    if len(words) > MAX_PROMPT_CHARS:
        raise InputError(f"the text has {len(words)} characters; {MAX_PROMPT_CHARS} are enough for a room")
    return words


def scene_from_text(
    prompt: str,
    library: ShapeLibrary,
    *,
    seed: int = 0,
    language_model: LmmSettings | None = None,
    progress: Progress = SILENT,
) -> SceneFromText:
    """The room that a prompt describes.

    Args:
        prompt: in plain English.
        library: where shapes come from.
        seed: another number, another room.
        language_model: lists what the room holds, looks at its picture and mends it; None leaves it to the grammar.
        progress: reports and cancellation.

    Raises:
        InputError: an empty or very long prompt.
        Cancelled: on request.
    """
    words = words_of(prompt)
    if rooms := rooms_asked(words):
        home, unmet_lines = compose_home(rooms, library, seed, progress.part(0.0, 0.6))
        scene, textures = finish(home, library)
        return SceneFromText(scene, textures, (f"a home of {len(scene.rooms)} rooms, composed by rules", *unmet_lines))
    request, remarks = None, ["the room was composed from the library by rules"]
    if language_model is not None:
        try:
            request = list_request(words, language_model, progress.part(0.0, 0.3))
            remarks = [f"{language_model.model} listed what the room holds; it was composed from the library by rules"]
        except UnavailableError as error:
            remarks.append(f"the language model was not used ({error})")
    room = compose_room(words, library, seed, request=request, progress=progress.part(0.3, 0.6))
    added = [f"added, as such rooms have it: {', '.join(room.added)}"] if room.added else []
    progress.report(0.6, "Looking for the best view")
    scene, textures = finish(room.scene, library)
    notes: tuple[str, ...] = (*remarks, *room.notes, *added)
    if language_model is not None and request is not None:
        better = mend(words, scene, library, textures, language_model, progress.part(0.65, 1.0))
        scene, notes = better.scene, (*notes, *better.notes)
    progress.report(1.0, "The room is ready")
    return SceneFromText(scene, textures, notes)


def unmet(prompt: str, scene: Scene) -> tuple[str, ...]:
    """Every request of a description that a scene does not meet, one line each; empty where all are met.

    An object counts for the first request that names its category, else for one of a kindred category.
    """
    request = read_prompt(prompt)
    present_counts = Counter(o.category for o in scene.objects)
    taken = [(asked, _take(present_counts, asked)) for asked in request.objects]
    lines = (_line(asked, number) for asked, number in taken if number < asked.count)
    return (*lines, *(f"the library has nothing called “{words}”" for words in request.ignored))


def _take(present_counts: Counter[str], asked: RequestedObject) -> int:
    """How many of what is asked for are there, taken out so that they count once."""
    number = 0
    for name in (asked.category, *sorted(with_kin(asked.category) - {asked.category})):
        here = min(present_counts[name], asked.count - number)
        present_counts[name] -= here
        number += here
    return number


def _line(asked: RequestedObject, number: int) -> str:
    name = asked.label or category(asked.category).name
    if not number:
        return f"no {name}" if asked.count == 1 else f"none of {asked.count} {name}"
    return f"{number} of {asked.count} {name}"


def best_viewpoint(scene: Scene, library: ShapeLibrary, size: tuple[int, int], weights: Mapping[str, float]) -> Camera:
    """The place, of all where one could stand, from which most is seen, and seen whole.

    Args:
        scene: a room with objects, walls that face it, and the floor at z = 0.
        library: where its shapes are.
        size: width and height of the picture.
        weights: by object id, how much it matters that it is seen; 0 where it is left out.
    """
    meshes = [(library.mesh(o.shape_id), o.pose.matrix) for o in scene.objects]
    planes = [(_front(p), np.eye(4)) for p in scene.architecture.planes]
    caster = MeshCaster([*meshes, *planes])
    worth = np.array([weights.get(o.id, 0.0) for o in scene.objects])
    best = max(_candidates(scene, size, worth), key=lambda camera: _score(caster, camera, worth), default=None)
    if best is None:
        raise ValueError("nobody could stand in this room")
    return best


def _front(plane: Plane) -> trimesh.Trimesh:
    front, _ = plane_surfaces(plane)
    return trimesh.Trimesh(front.vertices, front.faces, process=False)


def _candidates(scene: Scene, size: tuple[int, int], worth: Float[np.ndarray, " n"]) -> Iterator[Camera]:
    """From free places, toward the middle of what matters; ever nearer to furniture where a room is full."""
    floor = scene.architecture.floor
    outline = np.zeros((1, 2)) if floor is None else floor.polygon[:, :2]
    low, high = outline.min(axis=0) + WALL_CLEARANCE_M, outline.max(axis=0) - WALL_CLEARANCE_M
    middle = np.array([*(low + high) / 2, 0.6])
    if worth.sum() > 0:
        middle = np.average([o.pose.position for o in scene.objects], axis=0, weights=worth)
    for clearance in (OBJECT_CLEARANCE_M, 0.15, 0.0):
        places = (np.array([x, y, EYE_M]) for x, y in itertools.product(*np.linspace(low, high, PLACES).T))
        free = [eye for eye in places if _stands_free(scene, eye, clearance)]
        for eye in free:
            away = middle - eye
            distance = float(np.hypot(*away[:2]))
            if distance < 0.8:
                continue
            pitch = float(np.clip(np.arctan2(-away[2], distance), LOWEST_PITCH_RAD, HIGHEST_PITCH_RAD))
            for turn in TURNS_RAD:
                T = level_pose(eye, float(np.arctan2(away[1], away[0])) + turn, pitch)
                yield Camera(Intrinsics.from_fov(*size, FOV_RAD), T)
        if free:
            return


def _stands_free(scene: Scene, eye: Float[np.ndarray, "3"], clearance_m: float) -> bool:
    """Whether a person fits: inside the walls, and beside what reaches up to the eyes."""
    if any(p.normal @ eye - p.offset < 0.9 * WALL_CLEARANCE_M for p in scene.architecture.by_role("wall")):
        return False
    local = (
        (np.abs((eye - o.pose.position) @ o.pose.R_world_object), o.size_m / 2 + clearance_m) for o in scene.objects
    )
    return not any((away < reach).all() for away, reach in local)


def _score(caster: MeshCaster, camera: Camera, worth: Float[np.ndarray, " n"]) -> float:
    seen = caster.buffers(camera.resize(*PROBE_PX))
    count = len(worth)
    pixels = np.bincount(seen.instance[seen.instance >= 0].ravel(), minlength=count)[:count]
    rim = np.concatenate([seen.instance[0], seen.instance[-1], seen.instance[:, 0], seen.instance[:, -1]])
    cut = np.bincount(rim[rim >= 0], minlength=count)[:count] > 0
    # What is hardly seen counts little: it would not be found again.
    clear = np.clip((pixels - SEEN_PX) / (4.0 * SEEN_PX), 0.0, 1.0) * np.where(cut, CUT_WORTH, 1.0)
    near = float((seen.depth_m < NEAR_M).mean())
    biggest = float(pixels.max(initial=0)) / (PROBE_PX[0] * PROBE_PX[1])
    return float(worth @ clear) - 6.0 * near - 4.0 * max(biggest - 0.35, 0.0)
