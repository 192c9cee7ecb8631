"""What the stages of a build found, in words: so far, with lines over the photo, and in sentences that tell where
camera, objects, room and scene graph come from.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from diorama_core.artefacts import ArchitectureEstimate, CameraEstimate, ObjectGeometry, SceneGraph
from diorama_core.geometry.projection import box_edges, plane_edges, visible_segments
from diorama_core.progress import Segments
from diorama_core.provenance import (
    AttitudeSource,
    DepthSource,
    FocalSource,
    GraphMethod,
    HeadingSource,
    LanguageModelUse,
    RoomMethod,
    RoomSource,
    ScaleSource,
)


def finding(name: str, artefact: Any) -> str:
    """What is worth telling about an artefact of the plan; empty for most and for None."""
    words = WORDS.get(name)
    return "" if words is None or artefact is None else words(artefact)


def drawing(name: str, known: Mapping[str, Any]) -> Segments:
    """The objects' cuboids and the room's edges over the photo, once they are known; nothing for other artefacts."""
    artefact = known[name]
    if artefact is None:
        return ()
    if name == "measured_geometry":
        camera, edges = artefact.camera, [box_edges(c.corners_world) for c in artefact.cuboids]
    elif name == "architecture":
        camera = known["measured_geometry"].camera
        edges = [plane_edges(p) for p in artefact.architecture.planes if p.is_seen]
    else:
        return ()
    lines = np.round(visible_segments(camera, edges).reshape(-1, 4), 1)
    return tuple((x1, y1, x2, y2) for x1, y1, x2, y2 in lines.tolist())


def _count(number: int, one: str) -> str:
    return f"1 {one}" if number == 1 else f"{number} {one}s"


WORDS: dict[str, Callable[[Any], str]] = {
    "detected_boxes": lambda boxes: f"{_count(len(boxes), 'piece')} of furniture",
    "camera": lambda camera: f"field of view {np.degrees(camera.best.intrinsics.horizontal_fov_rad):.0f}°",
    "outlined_objects": lambda objects: _count(len(objects), "object"),
    "measured_geometry": lambda geometry: f"places of {_count(len(geometry.cuboids), 'object')}",
    "architecture": lambda room: _count(len(room.architecture.by_role("wall")), "wall"),
    "shapes": lambda shapes: f"shapes for {_count(len(shapes), 'object')}",
}


_FOCAL = {
    FocalSource.GIVEN: "focal length given",
    FocalSource.HEADER: "focal length from the photo's header",
    FocalSource.VANISHING_POINTS: "focal length from vanishing points",
    FocalSource.NETWORK: "focal length from the network",
    FocalSource.ASSUMED: "usual focal length assumed",
}


def camera_sentence(estimate: CameraEstimate, depth: DepthSource) -> str:
    """Where the focal length, the attitude and the height of the camera come from."""
    source = estimate.source
    parts = [_FOCAL[source.focal], *_attitude(estimate, _Words(depth))]
    if source.no_level_surface:
        parts.append(f"no floor or other level surface in the {_Words(depth).depth}")
    if source.attitude_corrected:
        parts.append("tilt set by hand")
    return "; ".join(parts)


def geometry_sentence(geometry: ObjectGeometry, depth: DepthSource) -> str:
    """Where the scale of the objects and the height of the camera come from."""
    read = _Words(depth).depth
    height_m = float(geometry.camera.position[2])
    return {
        ScaleSource.GIVEN: "objects given",
        ScaleSource.OBJECT_SIZES: "scale from the usual sizes of the named objects and the camera's usual height",
        ScaleSource.CAMERA_HEIGHT: "no objects: the camera is taken to be at the usual height",
        ScaleSource.DEPTH: f"{read}; camera height from the floor",
        ScaleSource.DEPTH_WITHOUT_FLOOR: f"{read}; no floor seen, camera assumed {height_m:g} m above it",
    }[geometry.source]


def room_sentence(estimate: ArchitectureEstimate, depth: DepthSource) -> str:
    """How the room was reconstructed, what of it was found and what was assumed."""
    source = estimate.source
    sentence = f"{_room_source(source, _Words(depth))}{_openings(source)}"
    return f"{sentence}; the furniture painted out" if source.furniture_inpainted else sentence


def graph_sentence(graph: SceneGraph) -> str:
    """Who says what holds up what, and what asking a language model took."""
    source, asked = graph.source, graph.source.asked
    if source.method is GraphMethod.GIVEN:
        return "relations given"
    if asked is None:
        return "geometry: contact, containment and usual places"
    if source.method is GraphMethod.GEOMETRY:
        return f"geometry ({asked.trouble or _no_answer(asked)})"
    sentence = f"{asked.model}, {asked.replies} {'reply' if asked.replies == 1 else 'replies'}"
    if asked.calls:
        sentence += f" ({_usage_sentence(asked)})"
    mended = f"; {source.repaired} of {len(graph.supports)} relations from geometry"
    return sentence + mended if source.repaired else sentence


class _Words:
    """What depth is called: measured depth has been measured, predicted depth only seen."""

    def __init__(self, source: DepthSource) -> None:
        measured = source is not DepthSource.NETWORK
        self.depth = "measured depth" if measured else "depth read from the photo"
        self.found = "measured" if measured else "seen"


def _attitude(estimate: CameraEstimate, words: _Words) -> tuple[str, ...]:
    """How the camera is held, and how high, where that is known."""
    source = estimate.source
    axes = f"room directions from {words.found} walls" if source.heading is HeadingSource.WALLS else ""
    axes = axes or "room directions from lines"
    unknown = "no floor visible, so the height over it is unknown"
    height = unknown if estimate.height_m is None else f"camera {estimate.height_m:.2f} m above it"
    doubt = " (few agreeing lines: check it)" if source.few_lines else ""
    return {
        AttitudeSource.GIVEN: ("tilt and room directions given",),
        AttitudeSource.FLOOR: (f"tilt from the {words.found} floor, {axes}", height),
        AttitudeSource.LEVEL_SURFACES: (f"tilt from {words.found} level surfaces, {axes}", unknown),
        AttitudeSource.VANISHING_POINTS: (f"tilt and room directions from vanishing points{doubt}",),
        AttitudeSource.ASSUMED: ("too few straight lines, usual tilt assumed",),
    }[source.attitude]


def _room_source(source: RoomSource, words: _Words) -> str:
    """Floor, walls and ceilings of a room."""
    count = f"{source.walls_found} wall{'s' * (source.walls_found > 1)}"
    if source.wall_height_m is not None:
        count += f", {source.wall_height_m:.1f} m high,"
    floor = "floor" if source.floor_found else "no floor (one is assumed)"
    clusters = f"{floor} and {source.walls_found} walls from clusters of normals"
    return {
        RoomMethod.GIVEN: "room given",
        RoomMethod.DEPTH_PLANES: f"planes of the {words.depth}: {_room_closure(source, words)}",
        RoomMethod.PHOTO_CUES: f"{count} from lines, edges and colours of the photo and the objects",
        RoomMethod.USUAL_SIZES: f"{count} from the objects and usual room sizes; few lines were seen",
        RoomMethod.SEVERAL_VIEWS: f"{count} from all views together",
        RoomMethod.PLAINRECON: f"PlainRecon as published: {clusters}",
        RoomMethod.RENDER_AND_COMPARE: f"render and compare: {floor} and {source.walls_found} walls by discrete search",
        RoomMethod.ACDC: f"as ACDC: {floor} and {source.walls_found} walls, a rectangle for each segment",
    }[source.method]


def _room_closure(source: RoomSource, words: _Words) -> str:
    """What depth shows of a room, and what was assumed to close it."""
    floor = f"floor {words.found}" if source.floor_found else "floor not seen, its height assumed"
    walls = f"{source.walls_found} walls {words.found}"
    if source.walls_assumed:
        walls += f" and {source.walls_assumed} assumed to close the room"
    if not source.walls_found:
        walls = f"no wall was {words.found}; one is assumed behind everything seen"
    overhead = [f"ceiling at {height_m:.2f} m" for height_m in source.ceilings_m]
    overhead += [f"{source.sloped_ceilings} sloped ceiling{'s' * (source.sloped_ceilings > 1)}"] * bool(
        source.sloped_ceilings
    )
    return f"{floor}, {walls}, {' and '.join(overhead) or 'ceiling not seen'}"


def _openings(source: RoomSource) -> str:
    """Doorways and windows, to go on with a sentence; nothing where there is none."""
    named = ((source.doorways, "doorway"), (source.windows, "window"))
    return "".join(f", {n} {name}{'s' * (n > 1)}" for n, name in named if n)


def _no_answer(asked: LanguageModelUse) -> str:
    took = f": {_usage_sentence(asked)}" if asked.calls else ""
    return f"{asked.model} gave no usable answer in {asked.unusable} tries{took}"


def _usage_sentence(asked: LanguageModelUse) -> str:
    """For example "3 calls, 4120 tokens, 0.021 at your prices"."""
    sentence = f"{asked.calls} call{'s' if asked.calls != 1 else ''}, {asked.tokens} tokens"
    return sentence if asked.cost is None else f"{sentence}, {asked.cost:.3f} at your prices"
