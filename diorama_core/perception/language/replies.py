"""What the model is asked (paper, supplement A) and what a reply may hold."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Annotated, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

RELATIONS = ("placed on", "mounted on")
FACING = ("toward camera", "away from camera", "left", "right", "unknown")
MAX_WORDS = 80
MAX_LABEL_CHARS = 60

RECOGNITION_PROMPT = """What are objects in the image? Includes architectural elements such as floor and wall if \
applicable. Ensure that each class is singular and has no quantifiers.

Return the output in a JSON format according to the following format:
{"classes": ["object1", "object2", "object3"]}"""


def tidy_label(text: object) -> str:
    """One short line of letters, digits and plain punctuation: whatever was written in the photo, this is a label."""
    plain = re.sub(r"[^\w\s'&/,.()-]+", " ", str(text))
    return " ".join(plain.split())[:MAX_LABEL_CHARS].strip()


def _relation(text: object) -> object:
    words = str(text).strip().lower().replace("_", " ")
    if words in RELATIONS:
        return words
    hung = ("mount", "hang", "attach", "fix")
    return "mounted on" if any(h in words for h in hung) else "placed on" if " on" in f" {words}" else words


def _facing(text: object) -> object:
    words = str(text).strip().lower().replace("_", " ").replace("towards", "toward").replace("the ", "")
    return words if words in FACING else "unknown"


def _sound(kind: type[BaseModel]) -> BeforeValidator:
    """Leaves out the entries of a list that are not of a kind: one odd entry costs itself, not the reply."""

    def sound(entries: object) -> object:
        if not isinstance(entries, list):
            return entries
        sound_entries = [entry for entry in entries if _is(kind, entry)]
        return sound_entries if sound_entries or not entries else entries

    return BeforeValidator(sound)


def _is(kind: type[BaseModel], entry: object) -> bool:
    try:
        kind.model_validate(entry)
    except ValidationError:
        return False
    return True


Label = Annotated[str, BeforeValidator(tidy_label)]


class ClassesReply(BaseModel):
    """The categories of objects in a photo."""

    model_config = ConfigDict(extra="ignore")

    classes: Annotated[list[Label], Field(max_length=500)]

    def words(self) -> tuple[str, ...]:
        """Each once, lower case, without empty ones."""
        return tuple(dict.fromkeys(c.lower() for c in self.classes if c))[:MAX_WORDS]


class ObjectEntry(BaseModel):
    """What the model says of one marked object."""

    model_config = ConfigDict(extra="ignore")

    id: int
    name: Label = ""
    caption: Label = ""
    face_direction: Annotated[
        Literal["toward camera", "away from camera", "left", "right", "unknown"], BeforeValidator(_facing)
    ] = "unknown"


class SupportEntry(BaseModel):
    """One relation of a reply."""

    model_config = ConfigDict(extra="ignore")

    subject_id: int
    type: Annotated[Literal["placed on", "mounted on"], BeforeValidator(_relation)]
    target_id: int


class GraphReply(BaseModel):
    """A whole scene graph."""

    model_config = ConfigDict(extra="ignore")

    room_type: Label = ""
    objects: Annotated[list[ObjectEntry], _sound(ObjectEntry), Field(max_length=1000)] = []
    support_relation: Annotated[list[SupportEntry], _sound(SupportEntry), Field(max_length=2000)]


def graph_prompt(marks: Sequence[tuple[int, str]], architecture: Sequence[tuple[int, str]]) -> str:
    """The paper's prompt, with the marks of objects and ids for floor, wall and ceiling."""
    entries = ",\n    ".join(
        f'{{"id": {i}, "name": "{tidy_label(name)}", "caption": "...", "face_direction": "..."}}' for i, name in marks
    )
    relations = ",\n    ".join(f'{{"subject_id": {i}, "type": "...", "target_id": ...}}' for i, _ in marks)
    listed = ", ".join(f"<{i}, {tidy_label(name)}>" for i, name in (*marks, *architecture))
    unmarked = ", ".join(f"{i} ({name})" for i, name in architecture)
    return f"""Please follow the examples in the Visual Genome dataset and generate a scene graph that best describes \
the image. Every object carries its number as a mark; {unmarked} are parts of the room and carry none. A reference \
list of labelled objects is provided as "{listed}" in the format of <object_id, object_name>.
caption: brief description of object appearance (excluding relationship).
face_direction: direction the object's front faces, seen by the viewer, from {list(FACING)}.
type: from the supporting relationships {list(RELATIONS)}.
target_id: id of the one object, or part of the room, that holds the subject up.
Return the output in JSON according to the following format:
{{
  "room_type": "type of room",
  "objects": [
    {entries}
  ],
  "support_relation": [
    {relations}
  ]
}}
Relationships are expressed as <subject_id, type, target_id>. Each pair of <subject_id, target_id> only occurs once."""
