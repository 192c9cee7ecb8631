"""Synthetic rooms whose truth is known: recovery, invariances, degenerate input."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.artefacts import CameraEstimate, CameraHypothesis, DetectedObject, Inputs, ObjectGeometry, Photo
from diorama_core.geometry.projection import box_iou
from diorama_core.library.kinds import outline_of
from diorama_core.library.labels import meanings
from diorama_core.perception.metrology import SingleViewMetrology
from diorama_core.progress import Progress
from diorama_core.provenance import CameraSource
from diorama_core.scene.types import Intrinsics, yaw_rotation

Measured = tuple[tuple[DetectedObject, ...], ObjectGeometry]
K = Intrinsics(640, 480, 540.0, 540.0, 320.0, 240.0)


@dataclass(frozen=True)
class RequestedObject:
    category: str
    centre: tuple[float, float, float]
    size: tuple[float, float, float]
    yaw: float = -np.pi / 2


ROOM = (
    RequestedObject("sofa", (0.2, 4.0, 0.42), (0.95, 1.95, 0.84)),
    RequestedObject("chair", (-1.3, 3.0, 0.43), (0.56, 0.52, 0.86), 0.0),
    RequestedObject("coffee table", (0.1, 2.6, 0.225), (0.65, 1.1, 0.45)),
    RequestedObject("night stand", (1.5, 3.9, 0.3), (0.43, 0.5, 0.6)),
    RequestedObject("lamp", (1.5, 3.9, 0.89), (0.34, 0.34, 0.58)),
    RequestedObject("pillow", (-0.3, 4.0, 0.64), (0.2, 0.48, 0.38)),
    RequestedObject("picture", (0.3, 4.45, 1.6), (0.03, 0.75, 0.65)),
)


def rotation(pitch_deg: float, yaw_deg: float = 0.0) -> np.ndarray:
    """World from camera: looking down by the pitch, turned by the yaw about up from +Y."""
    p, y = np.deg2rad(pitch_deg), np.deg2rad(yaw_deg)
    forward = np.array([-np.sin(y) * np.cos(p), np.cos(y) * np.cos(p), -np.sin(p)])
    right = np.array([np.cos(y), np.sin(y), 0.0])
    return np.column_stack([right, np.cross(forward, right), forward])


LEVEL = rotation(12.0)


def seen(items: tuple[RequestedObject, ...], R: np.ndarray, height_m: float) -> tuple[DetectedObject, ...]:
    """What a camera sees of things that have the outlines of their kinds: none fills its cuboid's corners."""
    points = [outline_of(t.category) * t.size @ yaw_rotation(t.yaw).T + t.centre for t in items]
    bounds = bounds_of((np.array(points) - [0, 0, height_m]) @ R)
    return tuple(
        detected(f"{t.category.replace(' ', '_')}_{n}", t.category, tuple(b), n + 1)
        for n, (t, b) in enumerate(zip(items, bounds, strict=True))
    )


def detected(name: str, category: str, box: tuple, mask_id: int = 1) -> DetectedObject:
    may_be = tuple(meanings(category, category).items()) if category == "object" else ()
    return DetectedObject(
        name, category, category, box, np.zeros((480, 640), dtype=bool), mask_id, 0.1, meanings=may_be
    )


def measure(objects: tuple[DetectedObject, ...], *rotations: np.ndarray) -> ObjectGeometry:
    inputs = Inputs(Photo(np.zeros((480, 640, 3), np.uint8), "synthetic", (640, 480)))
    scores = np.linspace(0.8, 0.79, len(rotations))
    hypotheses = tuple(CameraHypothesis(K, R, float(s)) for R, s in zip(rotations, scores, strict=True))
    return SingleViewMetrology().measure(
        inputs, CameraEstimate(hypotheses, 0.9, CameraSource.exact()), objects, Progress()
    )


def bounds_of(points_camera: np.ndarray) -> np.ndarray:
    assert (points_camera[..., 2] > 0.1).all()
    pixels = points_camera[..., :2] / points_camera[..., 2:] * [K.fx, K.fy] + [K.cx, K.cy]
    return np.clip(np.concatenate([pixels.min(axis=1), pixels.max(axis=1)], axis=1), 0, [640, 480, 640, 480])


def ious(objects: tuple[DetectedObject, ...], geometry: ObjectGeometry) -> np.ndarray:
    """IoU of the given boxes with those of things that fill the cuboids as their kinds do."""
    points = [
        outline_of(o.category) * c.size_m @ c.R_world_object.T + c.centre
        for o, c in zip(objects, geometry.cuboids, strict=True)
    ]
    found = bounds_of(np.array([geometry.camera.to_camera(p) for p in points]))
    return box_iou(found, np.array([o.box for o in objects]))


@settings(max_examples=2)
@given(height_m=st.floats(1.1, 1.75), pitch_deg=st.floats(8.0, 20.0), yaw_deg=st.floats(-4.0, 4.0))
def test_a_room_of_usual_sizes_is_recovered(height_m: float, pitch_deg: float, yaw_deg: float) -> None:
    R = rotation(pitch_deg, yaw_deg)
    objects = seen(ROOM, R, height_m)
    geometry = measure(objects, R)
    assert geometry.camera.position[2] == pytest.approx(height_m, rel=0.1)
    assert ious(objects, geometry).mean() > 0.9
    for item, cuboid in list(zip(ROOM, geometry.cuboids, strict=True))[:4]:
        np.testing.assert_allclose(cuboid.centre, item.centre, rtol=0.12, atol=0.25)
        np.testing.assert_allclose(np.sort(cuboid.size_m), np.sort(item.size), rtol=0.3)


@pytest.fixture(scope="module")
def room() -> Measured:
    """The whole room, seen from 1.5 m."""
    objects = seen(ROOM, LEVEL, 1.5)
    return objects, measure(objects, LEVEL)


def test_supporters_are_found(room: Measured) -> None:
    edges = {s.child: (s.parent, s.relation) for s in room[1].supports}
    assert edges["sofa_0"] == ("floor", "placed on")
    assert edges["lamp_4"] == ("night_stand_3", "placed on")
    assert edges["pillow_5"] == ("sofa_0", "placed on")
    assert edges["picture_6"] == ("wall", "mounted on")


def test_fronts_face_the_camera(room: Measured) -> None:
    for cuboid in room[1].cuboids:
        assert cuboid.R_world_object[:2, 0] @ -cuboid.centre[:2] > 0


def test_unnamed_objects_are_placed_plausibly() -> None:
    R = rotation(2.0)
    floor = tuple(RequestedObject("object", t.centre, t.size, t.yaw) for t in ROOM[:4])
    hung = (RequestedObject("object", (-0.6, 3.2, 2.35), (0.45, 0.45, 0.4)),)
    objects = seen((*floor, *hung), R, 1.4)
    geometry = measure(objects, R)
    assert [s.parent for s in geometry.supports[:4]] == ["floor"] * 4
    assert geometry.supports[4].parent in ("ceiling", "wall")
    assert ious(objects, geometry).min() > 0.8
    assert geometry.camera.position[2] == pytest.approx(1.4, rel=0.25)


def test_mirrored_picture_gives_the_mirrored_room() -> None:
    R = rotation(14.0, 4.0)
    objects = seen(ROOM[:5], R, 1.4)
    mirrored = tuple(detected(o.id, o.category, (640 - o.box[2], o.box[1], 640 - o.box[0], o.box[3])) for o in objects)
    one, other = measure(objects, R), measure(mirrored, rotation(14.0, -4.0))
    assert one.camera.position[2] == pytest.approx(other.camera.position[2], rel=0.02)
    for a, b in zip(one.cuboids, other.cuboids, strict=True):
        np.testing.assert_allclose(a.centre * [-1, 1, 1], b.centre, atol=0.1)
    assert [s.parent for s in one.supports] == [s.parent for s in other.supports]


def test_order_of_objects_does_not_matter(room: Measured) -> None:
    objects, geometry = room
    one = {c.object_id: c for c in geometry.cuboids}
    other = {c.object_id: c for c in measure(objects[::-1], LEVEL).cuboids}
    for name, cuboid in one.items():
        np.testing.assert_allclose(cuboid.centre, other[name].centre, atol=0.02)


def test_objects_choose_the_camera_that_explains_them(room: Measured) -> None:
    geometry = measure(room[0], rotation(24.0), LEVEL)
    np.testing.assert_allclose(geometry.camera.T_world_camera[:3, :3], LEVEL)


def test_the_same_input_gives_the_same_answer(room: Measured) -> None:
    assert measure(room[0], LEVEL) == room[1]


def test_no_objects_means_the_usual_camera_height() -> None:
    geometry = measure((), rotation(10.0))
    assert geometry.cuboids == ()
    assert geometry.supports == ()
    assert geometry.camera.position[2] == pytest.approx(1.4, abs=0.02)
    assert geometry.confidence < 0.3


boxes = st.tuples(st.floats(-5, 640), st.floats(-5, 480), st.floats(-5, 645), st.floats(-5, 485))


@settings(max_examples=4)
@given(
    given_boxes=st.lists(boxes, min_size=1, max_size=4),
    names=st.lists(st.sampled_from(["chair", "object", "pillow", "door", "ceiling lamp", "rug", "bed"]), min_size=4),
    pitch=st.floats(-25, 55),
)
def test_any_boxes_give_finite_cuboids(given_boxes: list, names: list, pitch: float) -> None:
    objects = tuple(
        detected(f"thing_{n}", name, box) for n, (box, name) in enumerate(zip(given_boxes, names, strict=False))
    )
    geometry = measure(objects, rotation(pitch))
    assert [c.object_id for c in geometry.cuboids] == [o.id for o in objects]
    for cuboid in geometry.cuboids:
        assert np.isfinite(cuboid.centre).all()
        assert (cuboid.size_m > 0).all()
        assert 0 <= cuboid.confidence <= 1
    parents = {s.child: s.parent for s in geometry.supports}
    assert set(parents) == {o.id for o in objects}
    for parent in parents.values():
        assert parent in ("floor", "wall", "ceiling") or parents[parent] == "floor"
