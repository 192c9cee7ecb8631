"""What the model is asked (paper, supplement A), what a reply may hold, the JSON object in what it wrote, and several
replies as one graph.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from diorama_core.scene.types import Relation, Support

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


_FENCE = "```"
_LANGUAGE = re.compile("json", re.IGNORECASE)
_MAX_STARTS = 50


def json_in(text: str) -> dict[str, Any] | None:
    """The object that a text is, holds between fences, or holds amid prose; None without any."""
    for candidate in (text, *_split_fences(text)):
        try:
            document = json.loads(candidate)
        except (ValueError, RecursionError):
            continue
        if isinstance(document, dict):
            return document
    return _amid_prose(text)


def _split_fences(text: str) -> list[str]:
    """What stands between pairs of fences. In one pass: replies are as long and as odd as they like."""
    inside = text.split(_FENCE)[1:-1:2]
    return [part[4:] if _LANGUAGE.match(part) else part for part in inside]


def _amid_prose(text: str) -> dict[str, Any] | None:
    """The largest object that begins at some brace."""
    decoder = json.JSONDecoder()
    best: tuple[int, dict[str, Any]] | None = None
    position = -1
    for _ in range(_MAX_STARTS):
        position = text.find("{", position + 1)
        if position < 0:
            break
        try:
            document, end = decoder.raw_decode(text, position)
        except (ValueError, RecursionError):
            continue
        if isinstance(document, dict) and (best is None or end - position > best[0]):
            best = (end - position, document)
    return None if best is None else best[1]


UNKNOWN_FACING = "unknown"


@dataclass(frozen=True)
class Ballot:
    """What the replies say together."""

    edges: tuple[tuple[Support, float], ...]
    """At most one per object, with the share of the replies that agree."""
    facing: tuple[tuple[str, str], ...]
    captions: tuple[tuple[str, str], ...]


def count_votes(replies: Sequence[GraphReply], objects: Mapping[int, str], architecture: Mapping[int, str]) -> Ballot:
    """The majority of the replies.

    Args:
        replies: validated ones.
        objects: object id by mark.
        architecture: "floor", "wall" or "ceiling" by the number that stands for it.
    """
    names = {**objects, **architecture}
    votes: dict[str, Counter[tuple[str, Relation]]] = {}
    for reply in replies:
        seen: set[int] = set()
        for entry in reply.support_relation:
            known = entry.subject_id in objects and entry.target_id in names and entry.subject_id != entry.target_id
            if not known or entry.subject_id in seen:
                continue
            seen.add(entry.subject_id)
            choice: tuple[str, Relation] = (names[entry.target_id], entry.type)
            votes.setdefault(objects[entry.subject_id], Counter())[choice] += 1
    edges = []
    for child, counts in votes.items():
        (parent, relation), agreeing = min(counts.items(), key=lambda item: (-item[1], item[0]))
        edges.append((Support(child, parent, relation), agreeing / len(replies)))
    return Ballot(tuple(edges), _fronts(replies, objects), _captions(replies, objects))


def _fronts(replies: Sequence[GraphReply], objects: Mapping[int, str]) -> tuple[tuple[str, str], ...]:
    """Directions that more than half of the replies name."""
    votes: dict[str, Counter[str]] = {}
    for reply in replies:
        for entry in reply.objects:
            if entry.id in objects and entry.face_direction != UNKNOWN_FACING:
                votes.setdefault(objects[entry.id], Counter())[entry.face_direction] += 1
    best = {key: min(c.items(), key=lambda item: (-item[1], item[0])) for key, c in votes.items()}
    return tuple((key, word) for key, (word, n) in best.items() if 2 * n > len(replies))


def _captions(replies: Sequence[GraphReply], objects: Mapping[int, str]) -> tuple[tuple[str, str], ...]:
    captions: dict[str, str] = {}
    for reply in replies:
        for entry in reply.objects:
            if entry.id in objects and entry.caption:
                captions.setdefault(objects[entry.id], entry.caption)
    return tuple(captions.items())
