"""A scene from words: composed from the library and made ready to be shown; what it lacks of the words."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import UInt8

from diorama_core.errors import InputError, UnavailableError
from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.geometry.rooms import part_of_home
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import category, with_kin
from diorama_core.perception.language.client import LmmSettings
from diorama_core.progress import SILENT, Progress
from diorama_core.scene.types import Scene
from diorama_core.synthesis import in_photo_world
from diorama_core.synthesis.finishes import finish_textures
from diorama_core.text.compose import composed_room
from diorama_core.text.home import composed_home, rooms_asked
from diorama_core.text.language import listed_request, mended
from diorama_core.text.prompt import RequestedObject, understood_prompt
from diorama_core.text.viewpoint import best_viewpoint

SIZE = (1024, 768)


def finished(scene: Scene, library: ShapeLibrary) -> tuple[Scene, Mapping[str, UInt8[np.ndarray, "_ _ 3"]]]:
    """The room in the world of a camera that shows most of it, and its planes' pictures by name."""
    # Every room has doors and windows; a picture may do without.
    worth = {o.id: 0.2 if o.category in OPENING_CATEGORIES else 1.0 for o in scene.objects}
    seen = part_of_home(scene, [scene.rooms[0].id]) if scene.rooms else scene
    scene = in_photo_world(replace(scene, camera=best_viewpoint(seen, library, SIZE, worth)))
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
        home, unmet_lines = composed_home(rooms, library, seed, progress.part(0.0, 0.6))
        scene, textures = finished(home, library)
        return SceneFromText(scene, textures, (f"a home of {len(scene.rooms)} rooms, composed by rules", *unmet_lines))
    request, remarks = None, ["the room was composed from the library by rules"]
    if language_model is not None:
        try:
            request = listed_request(words, language_model, progress.part(0.0, 0.3))
            remarks = [f"{language_model.model} listed what the room holds; it was composed from the library by rules"]
        except UnavailableError as error:
            remarks.append(f"the language model was not used ({error})")
    room = composed_room(words, library, seed, request=request, progress=progress.part(0.3, 0.6))
    added = [f"added, as such rooms have it: {', '.join(room.added)}"] if room.added else []
    progress.report(0.6, "Looking for the best view")
    scene, textures = finished(room.scene, library)
    notes: tuple[str, ...] = (*remarks, *room.notes, *added)
    if language_model is not None and request is not None:
        better = mended(words, scene, library, textures, language_model, progress.part(0.65, 1.0))
        scene, notes = better.scene, (*notes, *better.notes)
    progress.report(1.0, "The room is ready")
    return SceneFromText(scene, textures, notes)


def unmet(prompt: str, scene: Scene) -> tuple[str, ...]:
    """Every request of a description that a scene does not meet, one line each; empty where all are met.

    An object counts for the first request that names its category, else for one of a kindred category.
    """
    request = understood_prompt(prompt)
    present_counts = Counter(o.category for o in scene.objects)
    lines = []
    for asked in request.objects:
        number = _take(present_counts, asked)
        if number < asked.count:
            lines.append(_line(asked, number))
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
