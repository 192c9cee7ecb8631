"""The picture that a text-to-scene build begins with, and what is known about it."""

from __future__ import annotations

import base64
import os
from dataclasses import dataclass, field, replace

import numpy as np

from diorama_core.artefacts import Inputs
from diorama_core.errors import InputError, UnavailableError
from diorama_core.evaluation.dataset import hold_cameras, render_truth
from diorama_core.evaluation.dataset.cameras import Holding
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import category
from diorama_core.perception.inputs import read_inputs
from diorama_core.progress import Progress
from diorama_core.render.raycast import render_buffers
from diorama_core.scene.types import Camera, Scene
from diorama_core.text.compose import composed_room

MOST_PROMPT_CHARS = 2000
LOOKS = 4
"""Rounds of looking for a place to take the picture from."""
PROBE_PX = (96, 72)
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
    if len(words) > MOST_PROMPT_CHARS:
        raise InputError(f"the text has {len(words)} characters; {MOST_PROMPT_CHARS} are enough for a room")
    progress = progress or Progress()
    if endpoint is None:
        return _composed(words, library, seed, size, progress)
    progress.report(0.0, f"Asking {endpoint.model} for a picture")
    read = read_inputs(_generated(words, endpoint), name="generated.png")
    progress.report(1.0, "The picture is here")
    return TextPicture(read.inputs, (f"the picture was made by {endpoint.model} from your text", *read.warnings))


def _composed(words: str, library: ShapeLibrary, seed: int, size: tuple[int, int], progress: Progress) -> TextPicture:
    progress.report(0.0, "Composing a room from the library")
    room = composed_room(words, library, seed)
    progress.report(0.4, "Choosing where to stand")
    camera = _best_camera(room.scene, library, seed, size)
    progress.report(0.6, "Taking its picture")
    view = render_truth(room.scene, camera, library, size, with_empty_room=False)
    photo = replace(view.inputs.photo, name="composed.png")
    progress.report(1.0, "The picture is taken")
    told = "no image endpoint is set up: the room was composed from the library by rules, photographed, and rebuilt"
    return TextPicture(replace(view.inputs, photo=photo), (told, *room.notes))


def _best_camera(scene: Scene, library: ShapeLibrary, seed: int, size: tuple[int, int]) -> Camera:
    """Of some places where people would stand, the one from which most of the room's things are seen whole."""
    meshes = [(library.mesh(o.shape_id), o.pose.matrix) for o in scene.objects]
    holding = Holding(pitch_rad=(0.16, 0.42), fov_rad=(1.2, 1.4), clearance_m=0.12)
    best: tuple[float, Camera] | None = None
    for attempt in range(LOOKS):
        for camera in hold_cameras(scene, library, seed + 1000 * attempt, count=2, size=size, holding=holding):
            probe = Camera(camera.intrinsics.scaled(*PROBE_PX), camera.T_world_camera)
            seen = render_buffers(meshes, probe).instance
            rim = np.concatenate([seen[0], seen[-1], seen[:, 0], seen[:, -1]])
            present = set(np.unique(seen[seen >= 0]))
            weights = [2.0 if category(scene.objects[k].category).mount == "floor" else 1.0 for k in present]
            cut = len(set(np.unique(rim[rim >= 0])))
            score = float(sum(weights)) - 1.2 * cut
            if best is None or score > best[0]:
                best = (score, camera)
    assert best is not None
    return best[1]


def _generated(words: str, endpoint: ImageSettings) -> bytes:
    """PNG or JPEG bytes from images/generations."""
    import openai

    client = openai.OpenAI(
        base_url=endpoint.base_url, api_key=endpoint.key or "none", timeout=endpoint.timeout_s, max_retries=1
    )
    asked = {"model": endpoint.model, "prompt": TEMPLATE.format(words), "n": 1}
    try:
        with client:
            try:
                made = client.images.generate(**asked, response_format="b64_json")  # type: ignore[call-overload]
            except openai.BadRequestError:
                made = client.images.generate(**asked)  # type: ignore[call-overload]
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
