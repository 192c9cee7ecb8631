"""The picture that a text-to-scene build begins with, and what is known about it."""

from __future__ import annotations

import base64
import os
from collections import Counter
from dataclasses import dataclass, field, replace

from diorama_core.artefacts import Inputs
from diorama_core.errors import InputError, UnavailableError
from diorama_core.library.record import ShapeLibrary
from diorama_core.perception.inputs import read_inputs
from diorama_core.progress import Progress
from diorama_core.scene.types import Camera, Scene, SceneObject
from diorama_core.synthesis import render_truth
from diorama_core.text.compose import Composed, composed_room
from diorama_core.text.viewpoint import best_viewpoint, unseen

MAX_PROMPT_CHARS = 2000
OPENINGS = ("door", "window")
"""Every room has some; a picture may do without."""
ROOMS = 5
"""Composed until one picture shows everything in it."""
TEMPLATE = (
    "A realistic wide-angle photo of {}. Interior, taken at eye level from one side of the room, the floor visible, "
    "furniture whole and unobstructed, no people, no text."
)


@dataclass(frozen=True)
class ImageSettings:
    """An OpenAI-compatible endpoint that makes pictures."""

    base_url: str
    model: str
    key: str = field(default="", repr=False)
    timeout_s: float = field(default=180.0, repr=False)

    @classmethod
    def from_environment(cls) -> ImageSettings | None:
        """What DIORAMA_IMAGE_BASE_URL, _MODEL and _API_KEY say; None without a base URL."""
        base_url = os.environ.get("DIORAMA_IMAGE_BASE_URL", "").strip().rstrip("/")
        if not base_url:
            return None
        model = os.environ.get("DIORAMA_IMAGE_MODEL", "").strip()
        if not model:
            raise UnavailableError("DIORAMA_IMAGE_BASE_URL is set but DIORAMA_IMAGE_MODEL is not; name the model")
        key = os.environ.get("DIORAMA_IMAGE_API_KEY") or os.environ.get("OPENAI_API_KEY") or ""
        return cls(base_url, model, key)


@dataclass(frozen=True)
class TextPicture:
    """Inputs of the pipeline that were made of words."""

    inputs: Inputs
    notes: tuple[str, ...]
    """How the picture came about and what could not be met, to be shown with the scene."""


def picture_of(
    prompt: str,
    library: ShapeLibrary,
    *,
    seed: int = 0,
    endpoint: ImageSettings | None = None,
    size: tuple[int, int] = (960, 720),
    progress: Progress | None = None,
) -> TextPicture:
    """A picture of what the prompt describes: from the endpoint, or composed of the library and rendered.

    Args:
        prompt: in plain English.
        library: where composed rooms take their shapes from.
        seed: another number, another room.
        endpoint: who makes pictures; None composes.
        size: of a composed picture.
        progress: reports and cancellation.

    Raises:
        InputError: an empty or very long prompt.
        UnavailableError: the endpoint fails: one line that says why.
    """
    words = " ".join(prompt.split())
    if not words:
        raise InputError('there is no text; describe a room, such as "a reading corner with two armchairs"')
    if len(words) > MAX_PROMPT_CHARS:
        raise InputError(f"the text has {len(words)} characters; {MAX_PROMPT_CHARS} are enough for a room")
    progress = progress or Progress()
    if endpoint is None:
        return _composed(words, library, seed, size, progress)
    progress.report(0.0, f"Asking {endpoint.model} for a picture")
    read = read_inputs(_generated(words, endpoint), name="generated.png")
    progress.report(1.0, "The picture is here")
    return TextPicture(read.inputs, (f"the picture was made by {endpoint.model} from your text", *read.warnings))


def _composed(words: str, library: ShapeLibrary, seed: int, size: tuple[int, int], progress: Progress) -> TextPicture:
    room, camera = _room_and_camera(words, library, seed, size, progress)
    progress.report(0.6, "Taking its picture")
    view = render_truth(room.scene, camera, library, size, with_empty_room=False)
    photo = replace(view.inputs.photo, name="composed.png")
    progress.report(1.0, "The picture is taken")
    told = "no image endpoint is set up: the room was composed from the library by rules, photographed, and rebuilt"
    notes = (told, *room.notes, *_not_shown(room.scene, library, camera))
    return TextPicture(replace(view.inputs, photo=photo), notes)


def _room_and_camera(
    words: str, library: ShapeLibrary, seed: int, size: tuple[int, int], progress: Progress
) -> tuple[Composed, Camera]:
    """The first of some rooms that one picture shows whole, else the one that hides the least."""
    best: tuple[tuple[int, int], Composed, Camera] | None = None
    for variant in range(ROOMS):
        progress.report(0.6 * variant / ROOMS, "Composing a room from the library")
        room = composed_room(words, library, seed + 1_000_003 * variant)
        camera = best_viewpoint(room.scene, library, size, {o.id: _worth(o) for o in room.scene.objects})
        hidden = [o for o in room.scene.objects if o.id in unseen(room.scene, library, camera)]
        lacks = (len(room.notes), sum(o.category not in OPENINGS for o in hidden))
        if best is None or lacks < best[0]:
            best = (lacks, room, camera)
        if not lacks[1]:
            break
    assert best is not None
    return best[1], best[2]


def _worth(item: SceneObject) -> float:
    return 0.2 if item.category in OPENINGS else 1.0


def _not_shown(scene: Scene, library: ShapeLibrary, camera: Camera) -> tuple[str, ...]:
    """A note of what stands in the room but not in its picture, which is all that is rebuilt."""
    hidden = unseen(scene, library, camera)
    names = Counter(o.category for o in scene.objects if o.id in hidden and o.category not in OPENINGS)
    listed = ", ".join(f"{n} x {name}" for name, n in sorted(names.items()))
    return (f"the picture does not show {listed}: another seed may",) if names else ()


def _generated(words: str, endpoint: ImageSettings) -> bytes:
    """PNG or JPEG bytes from images/generations."""
    import openai

    client = openai.OpenAI(
        base_url=endpoint.base_url, api_key=endpoint.key or "none", timeout=endpoint.timeout_s, max_retries=1
    )
    words = TEMPLATE.format(words)
    try:
        with client:
            try:
                made = client.images.generate(model=endpoint.model, prompt=words, n=1, response_format="b64_json")
            except openai.BadRequestError:
                made = client.images.generate(model=endpoint.model, prompt=words, n=1)
    except openai.OpenAIError as error:
        said = " ".join(str(getattr(error, "message", error)).split())[:140]
        raise UnavailableError(
            f"no picture came from {endpoint.base_url} ({said}); try again, or unset DIORAMA_IMAGE_BASE_URL to compose "
            "the room from the library"
        ) from error
    data = made.data[0].b64_json if made.data else None
    try:
        return base64.b64decode(data or "", validate=True) or _no_picture(endpoint)
    except ValueError as error:
        raise UnavailableError(
            f"{endpoint.base_url} returned something that is no base64 picture; choose another model"
        ) from error


def _no_picture(endpoint: ImageSettings) -> bytes:
    raise UnavailableError(f"{endpoint.base_url} returned no base64 picture; choose a model that does")
