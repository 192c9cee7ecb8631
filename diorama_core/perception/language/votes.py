"""Several replies as one graph: the majority decides over pairs (supporter, relation) of every object."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from diorama_core.perception.language.replies import GraphReply
from diorama_core.scene.types import Relation, Support

UNKNOWN_FACING = "unknown"


@dataclass(frozen=True)
class Ballot:
    """What the replies say together."""

    edges: tuple[tuple[Support, float], ...]
    """At most one per object, with the share of the replies that agree."""
    facing: tuple[tuple[str, str], ...]
    captions: tuple[tuple[str, str], ...]
    rejected: int
    """Relations that named unknown ids or an object as its own support."""


def counted(replies: Sequence[GraphReply], objects: Mapping[int, str], architecture: Mapping[int, str]) -> Ballot:
    """The majority of the replies.

    Args:
        replies: validated ones.
        objects: object id by mark.
        architecture: "floor", "wall" or "ceiling" by the number that stands for it.
    """
    names = {**objects, **architecture}
    votes: dict[str, Counter[tuple[str, Relation]]] = {}
    rejected = 0
    for reply in replies:
        seen: set[int] = set()
        for entry in reply.support_relation:
            known = entry.subject_id in objects and entry.target_id in names and entry.subject_id != entry.target_id
            if not known or entry.subject_id in seen:
                rejected += 1
                continue
            seen.add(entry.subject_id)
            choice: tuple[str, Relation] = (names[entry.target_id], entry.type)
            votes.setdefault(objects[entry.subject_id], Counter())[choice] += 1
    edges = []
    for child, counts in votes.items():
        (parent, relation), agreeing = min(counts.items(), key=lambda item: (-item[1], item[0]))
        edges.append((Support(child, parent, relation), agreeing / len(replies)))
    return Ballot(tuple(edges), _facing(replies, objects), _captions(replies, objects), rejected)


def _facing(replies: Sequence[GraphReply], objects: Mapping[int, str]) -> tuple[tuple[str, str], ...]:
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
