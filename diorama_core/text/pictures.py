"""The picture that an image endpoint makes of a text, for a build as from a photo."""

from __future__ import annotations

import base64
import os
from dataclasses import dataclass, field

from diorama_core.artefacts import Inputs
from diorama_core.errors import UnavailableError
from diorama_core.perception.inputs import read_inputs
from diorama_core.progress import SILENT, Progress
from diorama_core.text.scene_from_text import words_of

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
    """How the picture came about, to be shown with the scene."""


def picture_of(prompt: str, endpoint: ImageSettings, progress: Progress = SILENT) -> TextPicture:
    """A picture of what the prompt describes, from an image endpoint.

    Args:
        prompt: in plain English.
        endpoint: who makes pictures.
        progress: reports and cancellation.

    Raises:
        InputError: an empty or very long prompt.
        UnavailableError: the endpoint fails: one line that says why.
    """
    words = words_of(prompt)
    progress.report(0.0, f"Asking {endpoint.model} for a picture")
    read = read_inputs(_generate(words, endpoint), name="generated.png")
    progress.report(1.0, "The picture is here")
    return TextPicture(read.inputs, (f"the picture was made by {endpoint.model} from your text", *read.warnings))


def _generate(words: str, endpoint: ImageSettings) -> bytes:
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
        message = " ".join(str(getattr(error, "message", error)).split())[:140]
        raise UnavailableError(
            f"no picture came from {endpoint.base_url} ({message}); try again, or unset DIORAMA_IMAGE_BASE_URL "
            "to compose the room from the library"
        ) from error
    data = made.data[0].b64_json if made.data else None
    if not data:
        raise UnavailableError(f"{endpoint.base_url} returned no base64 picture; choose a model that does")
    try:
        return base64.b64decode(data, validate=True)
    except ValueError as error:
        raise UnavailableError(
            f"{endpoint.base_url} returned something that is no base64 picture; choose another model"
        ) from error
