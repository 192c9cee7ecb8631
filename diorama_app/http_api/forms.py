"""What other programs send: a photo with what is known of it, and changes to open projects, with what comes back at
once.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from fastapi import Depends, File, Form, UploadFile
from pydantic import BaseModel, ConfigDict, Field, model_validator

from diorama_app.http_api.project_answers import JobStatusAnswer, ProjectAnswer
from diorama_app.projects.uploads import Upload
from diorama_core.errors import InputError
from diorama_core.io.text import clean_text
from diorama_core.text.edit_plan import MAX_EDITS, TypedEdit


def read_upload(
    photo: Annotated[UploadFile, File(description="JPEG, PNG, WebP, TIFF and others.")],
    boxes: Annotated[
        str | None,
        Form(description='JSON list of {"bbox": [x1, y1, x2, y2], "class": "chair"}, pixels of the upright photo.'),
    ] = None,
    masks: Annotated[UploadFile | None, File(description="PNG, one colour or id per object, black is none.")] = None,
    depth: Annotated[UploadFile | None, File(description="16-bit PNG, .npy in metres, or EXR.")] = None,
    depth_scale: Annotated[float | None, Form(gt=0, description="Units of depth per metre; empty: inferred.")] = None,
    intrinsics: Annotated[str | None, Form(description="fx,fy,cx,cy in pixels of the upright photo.")] = None,
    fov_deg: Annotated[float | None, Form(description="Horizontal field of view, instead of intrinsics.")] = None,
) -> Upload:
    """What was sent, as it is read from pages, too."""
    return Upload(
        photo.file.read(),
        Path(clean_text(photo.filename or "photo")).name or "photo",
        depth=None if depth is None else depth.file.read(),
        depth_scale=depth_scale,
        intrinsics=None if intrinsics is None else _four_numbers(intrinsics),
        fov_deg=fov_deg,
        boxes=None if boxes is None else clean_text(boxes).encode(),
        masks=None if masks is None else masks.file.read(),
    )


PhotoForm = Annotated[Upload, Depends(read_upload)]


def _four_numbers(text: str) -> tuple[float, float, float, float]:
    try:
        fx, fy, cx, cy = (float(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"intrinsics {text[:60]!r}: give four numbers in pixels, fx,fy,cx,cy") from None
    return fx, fy, cx, cy


AUTHOR = "API"
Author = Annotated[str, Field(max_length=40, description="Who changes it: browsers show the name.")]


class _Body(BaseModel):
    model_config = ConfigDict(extra="forbid")


class EditRequest(_Body):
    """Typed edits or a command in words, for a version of the scene: one undo step, done whole or not at all."""

    version: str = Field(max_length=40, description="Of the scene that the edits were made for.")
    edits: list[TypedEdit] = Field(default=[], max_length=MAX_EDITS)
    words: str = Field(default="", max_length=2000, description="In plain English, instead of edits.")
    author: Author = AUTHOR

    @model_validator(mode="after")
    def _one_of_both(self) -> EditRequest:
        if bool(self.edits) == bool(self.words.strip()):
            raise ValueError("give either edits or words")
        return self


class ReviewRequest(_Body):
    """An answer to one of the questions about a scene."""

    version: str = Field(max_length=40, description="Of the scene that the question was about.")
    question: str = Field(max_length=300, description="Its id, such as kind:chair_1.")
    answer: str = Field(max_length=300, description="A value of its choices; any category, any object or plane.")
    author: Author = AUTHOR


class DescribeRequest(_Body):
    """A room in words."""

    text: str = Field(min_length=1, max_length=2000, description="The room and its furniture, in plain English.")
    author: Author = AUTHOR


class EditAnswer(BaseModel):
    """What was done."""

    version: str
    lines: list[str] = Field(description="What was done, one line each.")
    notes: list[str] = Field(description="What was done otherwise than asked.")
    changed: list[str] = Field(description="Ids of objects that differ or are new.")


class StepRequest(_Body):
    """Who takes back, or does again, their own last change."""

    author: Author = AUTHOR


class StepAnswer(BaseModel):
    """What was taken back or done again."""

    version: str
    label: str


class OptimiseRequest(_Body):
    """The layout optimiser; what people placed by hand stays unless asked."""

    version: str = Field(max_length=40)
    recipe: Literal["feasible", "paper", "all-in-one"] = "feasible"
    only: list[str] = Field(default=[], max_length=2000, description="Ids that may move; all when empty.")
    by_hand_too: bool = Field(default=False, description="Whether what people placed may move, too.")
    author: Author = AUTHOR


class ProjectList(BaseModel):
    """Projects: those that are open, then the others, newest first."""

    projects: list[ProjectAnswer]


class EventData(BaseModel):
    """What an event tells."""

    version: str
    label: str = Field(description="The last change.")
    author: str
    job: JobStatusAnswer
