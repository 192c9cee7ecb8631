"""The two kinds of questions that a photo is worth (paper, section 3.1): what is there, and what holds up what."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from diorama_core.artefacts import DetectedObject, Inputs, ObjectGeometry, Photo, SceneGraph
from diorama_core.library.taxonomy import ARCHITECTURE_WORDS
from diorama_core.perception.language.client import (
    EndpointDownError,
    LmmClient,
    LmmSettings,
    Reply,
    UnusableReplyError,
    Usage,
)
from diorama_core.perception.language.marks import draw_marks, picture_bytes
from diorama_core.perception.language.replies import (
    RECOGNITION_PROMPT,
    ClassesReply,
    GraphReply,
    count_votes,
    graph_prompt,
)
from diorama_core.progress import Progress
from diorama_core.provenance import GraphMethod, GraphSource, LanguageModelUse
from diorama_core.scene.types import Support


@dataclass(frozen=True)
class LanguageRecognition:
    """Asks the model for the categories of objects in the photo."""

    settings: LmmSettings

    def recognise(self, photo: Photo, progress: Progress) -> tuple[str, ...]:
        """Singular nouns, without the room's own parts.

        Raises:
            UnavailableError: when the model cannot be asked or never answers usably.
        """
        reply = self.ask(photo, progress)
        return tuple(w for w in reply.value.words() if w not in ARCHITECTURE_WORDS)

    def ask(self, photo: Photo, progress: Progress) -> Reply[ClassesReply]:
        """The reply, with what it took; raises as `recognise`."""
        progress.report(0.0, f"Asking {self.settings.model} what is in the photo")
        picture = picture_bytes(draw_marks(photo.rgb, (), ()))
        return LmmClient(self.settings).ask(RECOGNITION_PROMPT, [picture], ClassesReply, progress)


@dataclass(frozen=True)
class LanguageGraph:
    """Asks for the scene graph over numbered objects; geometry mends what the replies leave wrong or open."""

    settings: LmmSettings
    geometry_score: float = 0.5
    """How sure an edge is that geometry alone tells."""

    def relate(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> SceneGraph:
        """One acyclic edge per object that has a cuboid.

        Args:
            inputs, objects, geometry, progress: as documented in `protocols.GraphStage`.

        Raises:
            UnavailableError: when it is asked wrongly (key, model). One that is slow or down leaves it to geometry.
        """
        fallback = SceneGraph(geometry.supports, (self.geometry_score,) * len(geometry.supports))
        if not objects:
            return fallback
        marks = {number: o.id for number, o in enumerate(objects, start=1)}
        room = {len(objects) + 1 + i: name for i, name in enumerate(("floor", "wall", "ceiling"))}
        picture = picture_bytes(draw_marks(inputs.photo.rgb, [o.mask for o in objects], list(marks)))
        prompt = graph_prompt([(n, o.label) for n, o in zip(marks, objects, strict=True)], list(room.items()))
        replies, usage, failed, trouble = self._replies(prompt, picture, progress)
        ballot = count_votes(replies, marks, room)
        supports, scores, mended = repair_graph(ballot.edges, fallback)
        return SceneGraph(
            supports=supports,
            scores=scores,
            facing=ballot.facing,
            captions=ballot.captions,
            source=_source(self.settings, usage, len(replies), failed, mended, trouble),
            provisional=bool(trouble) and not replies,
        )

    def _replies(self, prompt: str, picture: bytes, progress: Progress) -> tuple[list[GraphReply], Usage, int, str]:
        """The usable replies, what all tries took, how many were not usable, and why no more were asked for."""
        client, usage, failed = LmmClient(self.settings), Usage(), 0
        replies: list[GraphReply] = []
        for vote in range(self.settings.votes):
            message = f"Asking {self.settings.model} what stands on what ({vote + 1} of {self.settings.votes})"
            progress.report(0.1 + 0.9 * vote / self.settings.votes, message)
            try:
                reply = client.ask(prompt, [picture], GraphReply, progress, vote=vote)
            except UnusableReplyError as error:
                failed += 1
                usage = usage + error.usage
                continue
            except EndpointDownError as error:
                return replies, usage, failed, str(error)
            replies.append(reply.value)
            usage = usage + reply.usage
        return replies, usage, failed, ""


def _source(settings: LmmSettings, usage: Usage, used: int, failed: int, mended: int, trouble: str) -> GraphSource:
    method = GraphMethod.LANGUAGE_MODEL if used else GraphMethod.GEOMETRY
    asked = LanguageModelUse(settings.model, used, failed, usage.calls, usage.tokens, usage.cost(settings), trouble)
    return GraphSource(method, asked, mended)


def repair_graph(
    proposed: Sequence[tuple[Support, float]], fallback: SceneGraph
) -> tuple[tuple[Support, ...], tuple[float, ...], int]:
    """The proposed edges where they can be, the fallback's elsewhere.

    Args:
        proposed: edges with how sure each is, 0 to 1; unknown or repeated children and unknown parents are dropped.
        fallback: one acyclic edge for every object: what the graph shall be about.

    Returns:
        Edges in the fallback's order, their scores, and how many are the fallback's.
    """
    known = {s.child for s in fallback.supports}
    chosen: dict[str, Support] = {}
    score: dict[str, float] = {}
    # The surest first: an edge that would close a cycle with surer ones is the one to go.
    for edge, sure in sorted(proposed, key=lambda pair: (-pair[1], pair[0].child)):
        room = edge.parent in ("floor", "wall", "ceiling")
        if edge.child in known and edge.child not in chosen and (room or edge.parent in known):
            chosen[edge.child], score[edge.child] = edge, sure
            if _cyclic(edge.child, chosen):
                del chosen[edge.child], score[edge.child]
    mended = 0
    for edge, sure in sorted(zip(fallback.supports, fallback.scores, strict=True), key=lambda pair: -pair[1]):
        if edge.child in chosen:
            continue
        mended += 1
        chosen[edge.child], score[edge.child] = edge, sure
        if _cyclic(edge.child, chosen):
            chosen[edge.child], score[edge.child] = Support(edge.child, "floor"), 0.1
    supports = tuple(chosen[s.child] for s in fallback.supports)
    return supports, tuple(score[s.child] for s in supports), mended


def _cyclic(start: str, edges: dict[str, Support]) -> bool:
    """Whether following supporters from an object leads back to it."""
    at, steps = start, 0
    while at in edges and steps <= len(edges):
        at, steps = edges[at].parent, steps + 1
        if at == start:
            return True
    return False
