"""A scene from words: composed from the library, and the result itself, not rebuilt from a picture of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import UInt8

from diorama_core.errors import InputError, UnavailableError
from diorama_core.library.record import ShapeLibrary
from diorama_core.perception.language.client import LmmSettings
from diorama_core.progress import Progress
from diorama_core.scene.types import Scene
from diorama_core.text.compose import composed_room
from diorama_core.text.finish import finished
from diorama_core.text.language import listed_request, mended

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
    progress: Progress | None = None,
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
    words, progress = words_of(prompt), progress or Progress()
    request, said = None, ["the room was composed from the library by rules"]
    if language_model is not None:
        try:
            request = listed_request(words, language_model, progress.part(0.0, 0.3))
            said = [f"{language_model.model} listed what the room holds; it was composed from the library by rules"]
        except UnavailableError as error:
            said.append(f"the language model was not used ({error})")
    room = composed_room(words, library, seed, request=request, progress=progress.part(0.3, 0.6))
    added = [f"added, as such rooms have it: {', '.join(room.added)}"] if room.added else []
    progress.report(0.6, "Looking for the best view")
    scene, textures = finished(room.scene, library)
    notes: tuple[str, ...] = (*said, *room.notes, *added)
    if language_model is not None and request is not None:
        better = mended(words, scene, library, textures, language_model, progress.part(0.65, 1.0))
        scene, notes = better.scene, (*notes, *better.notes)
    progress.report(1.0, "The room is ready")
    return SceneFromText(scene, textures, notes)
