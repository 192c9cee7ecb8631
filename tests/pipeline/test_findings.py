"""The sentences that users read about sources: of measured depth, of predicted depth, of a photo alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from diorama_core.artefacts import (
    ArchitectureEstimate,
    CameraEstimate,
    CameraHypothesis,
    Cuboid,
    ObjectGeometry,
    SceneGraph,
)
from diorama_core.pipeline.findings import (
    camera_sentence,
    drawing,
    finding,
    geometry_sentence,
    graph_sentence,
    room_sentence,
)
from diorama_core.provenance import (
    AttitudeSource,
    CameraSource,
    DepthSource,
    FocalSource,
    GraphMethod,
    GraphSource,
    HeadingSource,
    LanguageModelUse,
    RoomMethod,
    RoomSource,
    ScaleSource,
)
from diorama_core.scene.types import Architecture, Camera, Intrinsics, Support
from tests.app.small_room import furnished_scene


class Room:
    architecture = furnished_scene().architecture


@pytest.mark.unchecked
@pytest.mark.parametrize(
    ("name", "artefact", "words"),
    [
        ("outlined_objects", [1], "1 object"),
        ("detected_boxes", [1, 2], "2 pieces of furniture"),
        ("shapes", [1, 2, 3], "shapes for 3 objects"),
        ("architecture", Room(), "4 walls"),
        ("architecture", None, ""),
        ("posed", [1], ""),
    ],
)
def test_what_was_found_is_told_in_a_few_words(name: str, artefact: object, words: str) -> None:
    assert finding(name, artefact) == words


@dataclass(frozen=True)
class Measured:
    camera: Camera
    cuboids: tuple[Cuboid, ...]


@pytest.mark.unchecked
def test_cuboids_and_the_room_are_drawn_over_the_photo_as_soon_as_they_are_known() -> None:
    scene = furnished_scene()
    assert scene.camera is not None
    boxes = [Cuboid(o.id, o.pose.R_world_object, o.pose.position, o.size_m, 1.0) for o in scene.objects]
    known = {"measured_geometry": Measured(scene.camera, tuple(boxes)), "architecture": Room(), "posed": [1]}
    lines = drawing("measured_geometry", known)
    assert 0 < len(lines) <= 12 * len(boxes)
    corners = scene.camera.project(boxes[0].corners_world)
    assert any(abs(x - corners[0][0]) < 0.1 and abs(y - corners[0][1]) < 0.1 for x, y, _, _ in lines)
    assert 0 < len(drawing("architecture", known)) <= sum(len(p.polygon) for p in Room.architecture.planes)
    assert drawing("posed", known) == ()
    assert drawing("architecture", {**known, "architecture": None}) == ()


K = Intrinsics.from_fov(64, 48, 1.0)
MEASURED, NETWORK = DepthSource.MEASURED, DepthSource.NETWORK
LINES = AttitudeSource.VANISHING_POINTS, HeadingSource.VANISHING_POINTS


def camera(source: CameraSource, depth: DepthSource = MEASURED, height_m: float | None = None) -> str:
    return camera_sentence(CameraEstimate((CameraHypothesis(K, np.eye(3), 1.0),), 1.0, source, height_m), depth)


def objects(source: ScaleSource, depth: DepthSource = MEASURED) -> str:
    T = np.eye(4)
    T[2, 3] = 1.4
    return geometry_sentence(ObjectGeometry(Camera(K, T), (), (), source), depth)


def room(source: RoomSource, depth: DepthSource = MEASURED) -> str:
    return room_sentence(ArchitectureEstimate(Architecture(()), (), 1.0, source), depth)


def graph(asked: LanguageModelUse | None, repaired: int = 0) -> str:
    method = GraphMethod.LANGUAGE_MODEL if asked is not None and asked.replies else GraphMethod.GEOMETRY
    edges = (Support("a", "floor"), Support("b", "a"), Support("c", "a"))
    return graph_sentence(SceneGraph(edges, (1.0,) * 3, source=GraphSource(method, asked, repaired)))


@pytest.mark.parametrize(
    ("focal", "words"),
    [
        (FocalSource.GIVEN, "focal length given"),
        (FocalSource.HEADER, "focal length from the photo's header"),
        (FocalSource.VANISHING_POINTS, "focal length from vanishing points"),
        (FocalSource.NETWORK, "focal length from the network"),
        (FocalSource.ASSUMED, "usual focal length assumed"),
    ],
)
def test_the_focal_length_comes_first(focal: FocalSource, words: str) -> None:
    assert camera(CameraSource(focal, *LINES)) == f"{words}; tilt and room directions from vanishing points"


def test_a_camera_from_lines_states_its_doubts() -> None:
    doubtful = CameraSource(FocalSource.GIVEN, *LINES, few_lines=True, no_level_surface=True)
    lines = "focal length given; tilt and room directions from vanishing points (few agreeing lines: check it); "
    assert camera(doubtful) == lines + "no floor or other level surface in the measured depth"
    assert camera(doubtful, NETWORK) == lines + "no floor or other level surface in the depth read from the photo"
    nothing = CameraSource(FocalSource.ASSUMED, AttitudeSource.ASSUMED, HeadingSource.ASSUMED)
    assert camera(nothing) == "usual focal length assumed; too few straight lines, usual tilt assumed"


def test_a_camera_over_a_floor_states_its_height_and_the_correction_of_its_tilt() -> None:
    floor = CameraSource(FocalSource.GIVEN, AttitudeSource.FLOOR, HeadingSource.WALLS)
    assert camera(floor, MEASURED, 1.456) == (
        "focal length given; tilt from the measured floor, room directions from measured walls; camera 1.46 m above it"
    )
    corrected = CameraSource(
        FocalSource.NETWORK, AttitudeSource.FLOOR, HeadingSource.VANISHING_POINTS, attitude_corrected=True
    )
    assert camera(corrected, NETWORK, 1.4) == (
        "focal length from the network; tilt from the seen floor, room directions from lines; camera 1.40 m above it; "
        "tilt set by hand"
    )


def test_a_camera_over_a_table_does_not_know_its_height() -> None:
    table = CameraSource(FocalSource.HEADER, AttitudeSource.LEVEL_SURFACES, HeadingSource.WALLS)
    rest = "no floor visible, so the height over it is unknown"
    focal = "focal length from the photo's header"
    assert camera(table) == (f"{focal}; tilt from measured level surfaces, room directions from measured walls; {rest}")
    assert camera(table, NETWORK) == f"{focal}; tilt from seen level surfaces, room directions from seen walls; {rest}"


def test_what_is_given_is_said_to_be() -> None:
    assert camera(CameraSource.exact()) == "focal length given; tilt and room directions given"
    assert objects(ScaleSource.GIVEN) == "objects given"
    assert room(RoomSource(RoomMethod.GIVEN)) == "room given"
    assert graph_sentence(SceneGraph((), (), source=GraphSource(GraphMethod.GIVEN))) == "relations given"


def test_objects_say_where_their_scale_is_from() -> None:
    sizes = "scale from the usual sizes of the named objects and the camera's usual height"
    assert objects(ScaleSource.OBJECT_SIZES) == sizes
    assert objects(ScaleSource.CAMERA_HEIGHT) == "no objects: the camera is taken to be at the usual height"
    assert objects(ScaleSource.DEPTH) == "measured depth; camera height from the floor"
    assert objects(ScaleSource.DEPTH, NETWORK) == "depth read from the photo; camera height from the floor"
    assumed = "no floor seen, camera assumed 1.4 m above it"
    assert objects(ScaleSource.DEPTH_WITHOUT_FLOOR) == f"measured depth; {assumed}"
    assert objects(ScaleSource.DEPTH_WITHOUT_FLOOR, NETWORK) == f"depth read from the photo; {assumed}"


def test_a_room_of_depth_counts_what_was_measured_and_assumed() -> None:
    found = RoomSource(
        RoomMethod.DEPTH_PLANES, 3, 1, floor_found=True, ceilings_m=(2.5,), sloped_ceilings=2, doorways=1, windows=2
    )
    assert room(found) == (
        "planes of the measured depth: floor measured, 3 walls measured and 1 assumed to close the room, "
        "ceiling at 2.50 m and 2 sloped ceilings, 1 doorway, 2 windows"
    )
    painted = RoomSource(
        RoomMethod.DEPTH_PLANES, 2, floor_found=True, sloped_ceilings=1, doorways=2, windows=1, furniture_inpainted=True
    )
    assert room(painted, NETWORK) == (
        "planes of the depth read from the photo: floor seen, 2 walls seen, 1 sloped ceiling, 2 doorways, 1 window; "
        "the furniture painted out"
    )


def test_a_room_of_which_nothing_is_seen_is_assumed() -> None:
    nothing = RoomSource(RoomMethod.DEPTH_PLANES, walls_assumed=1)
    rest = "one is assumed behind everything seen, ceiling not seen"
    assert room(nothing) == (
        f"planes of the measured depth: floor not seen, its height assumed, no wall was measured; {rest}"
    )
    assert room(nothing, NETWORK) == (
        f"planes of the depth read from the photo: floor not seen, its height assumed, no wall was seen; {rest}"
    )


def test_a_room_of_a_photo_counts_walls() -> None:
    cues = RoomSource(RoomMethod.PHOTO_CUES, 3, 1, wall_height_m=2.62, doorways=1)
    assert room(cues) == ("3 walls, 2.6 m high, from lines, edges and colours of the photo and the objects, 1 doorway")
    usual = RoomSource(RoomMethod.USUAL_SIZES, 1, wall_height_m=2.4)
    assert room(usual) == "1 wall, 2.4 m high, from the objects and usual room sizes; few lines were seen"


def test_plainrecon_says_whether_it_found_a_floor() -> None:
    found = RoomSource(RoomMethod.PLAINRECON, 2, floor_found=True)
    assert room(found) == "PlainRecon as published: floor and 2 walls from clusters of normals"
    assumed = "PlainRecon as published: no floor (one is assumed) and 0 walls from clusters of normals"
    assert room(RoomSource(RoomMethod.PLAINRECON)) == assumed


def test_baselines_say_who_they_are() -> None:
    searched = RoomSource(RoomMethod.RENDER_AND_COMPARE, 3, floor_found=True)
    assert room(searched) == "render and compare: floor and 3 walls by discrete search"
    assert room(RoomSource(RoomMethod.ACDC, 1, floor_found=True)) == (
        "as ACDC: floor and 1 walls, a rectangle for each segment"
    )


def test_a_graph_of_geometry_says_why_no_model_decided() -> None:
    assert graph(None) == "geometry: contact, containment and usual places"
    assert graph(LanguageModelUse("m", 0, 1, trouble="it is down")) == "geometry (it is down)"
    assert graph(LanguageModelUse("m", 0, 2)) == "geometry (m gave no usable answer in 2 tries)"
    spent = LanguageModelUse("m", 0, 1, calls=3, tokens=3150)
    assert graph(spent) == "geometry (m gave no usable answer in 1 tries: 3 calls, 3150 tokens)"


def test_a_graph_of_a_model_says_what_it_took() -> None:
    assert graph(LanguageModelUse("m", 1, 0)) == "m, 1 reply"
    assert graph(LanguageModelUse("m", 2, 1, 1, 1050, 0.00345), 2) == (
        "m, 2 replies (1 call, 1050 tokens, 0.003 at your prices); 2 of 3 relations from geometry"
    )
