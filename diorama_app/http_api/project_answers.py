"""What other programs are told of an open project: its objects, its room, what is wrong and what is doubtful."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

import numpy as np
from pydantic import BaseModel, Field

from diorama_app.session.problem_checker import Problems, problems
from diorama_app.session.session import EditorSession
from diorama_app.viewport.decorations import is_unsure
from diorama_core.artefacts import Reason
from diorama_core.editing.clearances import clearances
from diorama_core.editing.collisions import Collisions
from diorama_core.editing.free_space import free_space
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.evaluation.metrics.text_scene import Asked, access_shares, measure
from diorama_core.geometry.rooms import part_of_home
from diorama_core.library.record import ShapeLibrary, record_of
from diorama_core.scene.types import Plane, Scene, SceneObject

Point3 = tuple[float, float, float]
RIVAL_SHARE = 0.9
"""A shape whose score is so near to that of the shape that was taken may be meant as well."""
MAX_DOUBTS = 3
HARD_TO_REACH = 0.5
"""Share of the floor before an object below which people hardly get at it."""
UNCONNECTED = 0.98
"""Share of the walkable floor in one piece below which parts of the room are cut off; a cell or two are noise."""


class ObjectAnswer(BaseModel):
    """One object. Lengths are metres, +Z is up."""

    id: str
    label: str
    category: str
    base_m: Point3 = Field(description="The middle of its underside in the world.")
    heading_deg: float = Field(description="Where its front points: counter-clockwise seen from above, 0 along +X.")
    size_m: Point3 = Field(description="Depth, width and height.")
    held_by: str | None = Field(description="Id of the object or plane that holds it up.")
    hangs: bool = Field(description="Whether it is mounted there and does not stand.")
    locked: bool
    hidden: bool
    by_hand: bool = Field(description="Whether somebody placed it: the optimiser leaves it unless asked.")
    problems: list[str] = Field(description="collides, floats or outside, as the page shows them.")
    doubts: list[str] = Field(description="What the build of the photo was not sure of.")


class ChoiceAnswer(BaseModel):
    """One answer that a question offers."""

    value: str
    label: str
    probability: float = Field(ge=0, le=1)


class QuestionAnswer(BaseModel):
    """Something about an object that a person can tell better than the build."""

    id: str
    object_id: str
    subject: str = Field(description="presence, kind, front or supporter.")
    sentence: str
    choices: list[ChoiceAnswer] = Field(description="Likeliest first. Other kinds and supporters may be answered, too.")
    gain: float = Field(description="How many more objects are right after the answer, as far as can be expected.")


class QuestionsAnswer(BaseModel):
    """What is worth asking about a scene, the most helpful question first."""

    version: str
    questions: list[QuestionAnswer]


class PlaneAnswer(BaseModel):
    """Floor, wall or ceiling."""

    id: str
    role: str
    corners_m: list[Point3]
    inward: Point3 = Field(description="Unit normal into the room.")


class JobStatusAnswer(BaseModel):
    """The long work of a project; one at a time."""

    running: bool
    kind: str | None
    message: str = Field(description="What is happening now, or how the last one ended.")
    progress: float = Field(ge=0, le=1)
    error: str | None = Field(description="Why the last one failed; null where it did not.")
    version: str = Field(description="Of the scene.")


class SceneAnswer(BaseModel):
    """An open project."""

    project: str
    title: str
    page: str = Field(description="Where a browser shows it.")
    version: str = Field(description="Of the scene: edits must bring the newest one.")
    read_only: str = Field(description="Why it cannot be changed; empty where it can.")
    undo: str | None = Field(description="What `undo` would take back first; null for nothing.")
    job: JobStatusAnswer
    objects: list[ObjectAnswer]
    room: list[PlaneAnswer]
    notes: list[str] = Field(description="What to know of how the scene was made.")


class ClearanceAnswer(BaseModel):
    """The free length on one side of an object."""

    side: Literal["front", "back", "left", "right"]
    free_m: float
    other: str = Field(description="Id of the object or wall that ends it.")


class AlternativeAnswer(BaseModel):
    """A shape that an object may have instead."""

    shape: str
    caption: str
    score: float


class DetailAnswer(BaseModel):
    """One object and what is around it."""

    object: ObjectAnswer
    carries: list[str] = Field(description="Ids of what stands or hangs on it.")
    clearances: list[ClearanceAnswer]
    gaps_m: dict[str, float] = Field(
        description="Distance on the floor plan to other objects, nearest first; 0: meets."
    )
    alternatives: list[AlternativeAnswer]
    reasons: list[str] = Field(description="Why it is where and what it is, strongest first.")


class FreeFloorAnswer(BaseModel):
    """Where the floor is free."""

    free_m2: float
    spots: list[tuple[float, float]] = Field(description="Middles of free places of the size that was asked for.")


class CheckAnswer(BaseModel):
    """Whether people could use the room."""

    problems: dict[str, list[str]] = Field(description="By object: collides, floats, outside.")
    collisions: list[tuple[str, str]]
    walkways: float = Field(description="Share of the walkable floor that is one piece: 1 is good.")
    reach: dict[str, float] = Field(description="Share of free floor before furniture that people hardly get at.")
    lines: list[str] = Field(description="All of it in words, and what to do.")


class ProjectAnswer(BaseModel):
    """A project that can be opened."""

    project: str
    title: str
    open: bool
    folder: str


def object_answer(scene: Scene, item: SceneObject, bad: Problems, reasons: Sequence[Reason]) -> ObjectAnswer:
    """One object as it is told.

    Args:
        scene: that it is in.
        item: the object.
        bad: problems by object.
        reasons: of the build.
    """
    edge, pose = scene.support_of(item.id), item.pose
    return ObjectAnswer(
        id=item.id,
        label=item.label,
        category=item.category,
        base_m=_point(pose.position - pose.R_world_object[:, 2] * item.size_m[2] / 2),
        heading_deg=round(float(np.degrees(pose.yaw_rad)), 1),
        size_m=_point(item.size_m),
        held_by=None if edge is None else edge.parent,
        hangs=edge is not None and edge.relation == "mounted on",
        locked=item.locked,
        hidden=item.hidden,
        by_hand=item.by_hand,
        problems=list(bad.get(item.id, ())),
        doubts=_doubts(item, reasons),
    )


def _doubts(item: SceneObject, reasons: Sequence[Reason]) -> list[str]:
    doubts = (
        [f"it may be wrong (confidence {item.confidence:.2f}); see the questions about it"] if is_unsure(item) else []
    )
    if item.by_hand:
        return doubts  # somebody has decided since
    scores = [c.score for c in item.candidates if c.shape_id != item.shape_id]
    score = next((c.score for c in item.candidates if c.shape_id == item.shape_id), None)
    if score is not None and scores and max(scores) >= RIVAL_SHARE * score > 0:
        doubts.append("another shape fits almost as well; see its alternatives")
    against = sorted((r for r in reasons if r.object_id == item.id and r.amount < 0), key=lambda r: r.amount)
    return doubts + [f"{r.decision}: {r.sentence}" for r in against[:MAX_DOUBTS]]


def plane_answer(plane: Plane) -> PlaneAnswer:
    """A plane of the room as it is told."""
    corners = [_point(corner) for corner in plane.polygon]
    return PlaneAnswer(id=plane.id, role=plane.role, corners_m=corners, inward=_point(plane.normal))


def job_answer(session: EditorSession) -> JobStatusAnswer:
    """The long work of a session, or how the last one ended."""
    status, ended = session.jobs.status, session.outcome
    error = None if ended is None else ended.error
    over = "nothing runs" if ended is None else "cancelled" if ended.cancelled else "failed" if error else "done"
    return JobStatusAnswer(
        running=status is not None,
        kind=status.kind if status is not None else None if ended is None else ended.kind,
        message=over if status is None else status.message,
        progress=min(max(status.fraction, 0.0), 1.0) if status is not None else float(over == "done"),
        error=None if status is not None else error,
        version=session.document.version,
    )


def detail_answer(
    scene: Scene, item: SceneObject, about: ObjectAnswer, library: ShapeLibrary, why: Sequence[Reason]
) -> DetailAnswer:
    """One object and what is around it.

    Args:
        scene: that it is in.
        item: the object.
        about: as it is told.
        library: of its shapes.
        why: reasons of the build, strongest first for each object.
    """
    import shapely

    from diorama_core.editing.footprints import footprint_of

    outline = shapely.Polygon(footprint_of(item))
    gaps = {
        o.id: round(outline.distance(shapely.Polygon(footprint_of(o))), 3) for o in scene.objects if o.id != item.id
    }
    return DetailAnswer(
        object=about,
        carries=list(scene.children_of(item.id)),
        clearances=[
            ClearanceAnswer(side=c.side, free_m=round(c.distance_m, 3), other=c.other)
            for c in clearances(scene, item.id)
        ],
        gaps_m=dict(sorted(gaps.items(), key=lambda pair: pair[1])),
        alternatives=[
            AlternativeAnswer(
                shape=c.shape_id, caption=record_of(library, c.shape_id).caption, score=round(float(c.score), 3)
            )
            for c in item.candidates
        ],
        reasons=[f"{r.decision}: {r.sentence}" for r in why if r.object_id == item.id],
    )


def free_floor_answer(scene: Scene, width_m: float, depth_m: float) -> FreeFloorAnswer:
    """Where the floor of any room is free for something so large."""
    spaces = [free_space(part_of_home(scene, [r.id])) for r in scene.rooms] or [free_space(scene)]
    spots = [(round(x, 2), round(y, 2)) for space in spaces for x, y in space.spots(width_m, depth_m)]
    return FreeFloorAnswer(free_m2=round(sum(s.free_m2 for s in spaces), 2), spots=spots)


def check_answer(scene: Scene, library: ShapeLibrary) -> CheckAnswer:
    """Collisions, what floats or is outside, walkways, and what people hardly get at."""
    collisions = Collisions(library)
    bad = problems(scene, library, collisions)
    pairs = sorted(tuple(sorted(pair)) for pair in collisions.pairs(scene, [o.id for o in scene.objects]))
    walkways = 1.0 if scene.architecture.floor is None else measure(Asked("", {}, {}, ()), scene, library).navigable
    shares = access_shares(scene, RoomFrame.of(scene)) if scene.architecture.floor is not None else {}
    reach = {i: round(share, 2) for i, share in sorted(shares.items(), key=lambda p: p[1]) if share < HARD_TO_REACH}
    return CheckAnswer(
        problems={i: list(words) for i, words in sorted(bad.items())},
        collisions=[(a, b) for a, b in pairs],
        walkways=round(walkways, 3),
        reach=reach,
        lines=_lines(scene, bad, pairs, walkways, reach),
    )


def _lines(
    scene: Scene, bad: Problems, pairs: Sequence[tuple[str, ...]], walkways: float, reach: Mapping[str, float]
) -> list[str]:
    lines = [f"{a} collides with {b}: move one of them, or optimise" for a, b in pairs]
    lines += [f"{i} floats: give it a support, or optimise" for i, words in bad.items() if "floats" in words]
    lines += [f"{i} is outside the room: move it, or move the wall" for i, words in bad.items() if "outside" in words]
    if walkways < UNCONNECTED:
        lines.append(f"only {walkways:.0%} of the walkable floor is one piece: move what cuts it")
    lines += [f"{i} is hard to get at ({share:.0%} of the floor before it is free)" for i, share in reach.items()]
    if scene.architecture.floor is None:
        lines.append("there is no floor, so walkways and reach are not known")
    return lines


def _point(values: np.ndarray) -> Point3:
    x, y, z = (round(float(v), 3) + 0.0 for v in values)
    return x, y, z
