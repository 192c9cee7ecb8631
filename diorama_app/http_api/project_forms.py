"""What other programs send to open projects, and what comes back at once."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from diorama_app.http_api.project_answers import JobStatusAnswer, ProjectAnswer
from diorama_core.text.edit_plan import MAX_EDITS, TypedEdit

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
