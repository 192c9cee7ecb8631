"""Poses of rendered rooms with exact truth, and of input that says nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.artefacts import Cuboid, DepthMap, ObjectGeometry, PosedCandidates, RankedShapes
from diorama_core.errors import Cancelled
from diorama_core.geometry.projection import box_iou
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.pose import RenderAndCompare
from diorama_core.progress import CancelToken, Progress
from diorama_core.provenance import DepthSource, ScaleSource
from diorama_core.scene.types import Pose
from tests.pose.rooms import LIBRARY, Room, camera_at, random_room, standing, yaw_error_deg

STAGE = RenderAndCompare(LIBRARY)


def posed(room: Room, depth: DepthMap | None = None, ranked=None) -> tuple[PosedCandidates, ...]:
    depth = room.depth(measured=False) if depth is None else depth
    return STAGE.pose(room.inputs, room.objects, room.geometry, depth, ranked or room.ranked(), Progress())


@pytest.mark.parametrize("measured", [False, True])
def test_the_true_shape_is_turned_as_it_stands(measured: bool) -> None:
    right = total = 0
    for seed in range(6):
        room = random_room(seed)
        for found, index in zip(posed(room, room.depth(measured)), room.seen, strict=True):
            truth = room.placed[index]
            fold = LIBRARY.shape(truth.shape_id).symmetry
            right += yaw_error_deg(found.candidates[0].pose, truth.pose, fold) < 15.0
            total += 1
    assert right / total >= 0.9


def test_posed_shapes_land_on_their_boxes_and_keep_their_base() -> None:
    for seed in (1, 2):
        room = random_room(seed)
        for found, item in zip(posed(room), room.objects, strict=True):
            best = found.candidates[0]
            assert shape_box_iou(room, best.shape_id, best.pose, item.box) > 0.85
            base = best.pose.position[2] - 0.5 * best.pose.scale[2] * best.shape_size_m[2]
            assert base == pytest.approx(0.0, abs=1e-6)


def shape_box_iou(room: Room, shape_id: str, pose: Pose, box) -> float:
    batch = PoseBatch.single(pose)
    return float(box_iou(ShapeCaster(LIBRARY.mesh(shape_id)).bounds_px(room.camera, batch), np.array(box))[0])


def test_the_shape_that_fits_the_picture_comes_first() -> None:
    room = Room(camera_at(), (standing("low chair", 0.0, 3.0, 200.0),), (1,))
    ranked = (RankedShapes("o0", (("chair", 0.8), ("low chair", 0.8), ("round table", 0.8))),)
    candidates = posed(room, ranked=ranked)[0].candidates
    assert candidates[0].shape_id == "low chair"
    assert [c.score for c in candidates] == sorted((c.score for c in candidates), reverse=True)
    assert len(candidates) == 3


def test_retrieval_says_more_of_a_thing_without_a_name() -> None:
    """Some shape of all kinds always has its outline."""
    room = Room(camera_at(), (standing("low chair", 0.0, 3.0, 200.0),), (1,))
    ranked = (RankedShapes("o0", (("chair", 0.9), ("low chair", 0.6))),)
    said = []
    for label in ("chair", "object"):
        objects = (replace(room.objects[0], label=label),)
        (found,) = STAGE.pose(room.inputs, objects, room.geometry, room.depth(False), ranked, Progress())
        score = {c.shape_id: c.score for c in found.candidates}
        said.append(score["chair"] / score["low chair"])
    assert said[1] > 1.5 * said[0]


def test_what_a_nearer_object_hides_is_not_supported_against_a_shape() -> None:
    room = Room(camera_at(), (standing("desk", 0.0, 4.0, -60.0), standing("carton", 0.1, 2.6, 0.0)), (0, 0))
    found = posed(room)[0]
    assert yaw_error_deg(found.candidates[0].pose, room.placed[0].pose, 1) < 15.0


def test_chairs_face_their_table_when_the_picture_does_not_tell() -> None:
    table, chair = standing("table", 0.0, 4.0, 0.0), standing("chair", 1.1, 4.0, 180.0)
    room = Room(camera_at(), (table, chair), (0, 0))
    blind = tuple(replace(o, mask=np.zeros_like(o.mask), mask_confidence=0.0) for o in room.objects)
    found = STAGE.pose(room.inputs, blind, room.geometry, room.depth(False), room.ranked(), Progress())
    assert yaw_error_deg(found[1].candidates[0].pose, chair.pose, 1) < 31.0


def test_a_sofa_turns_its_back_to_the_wall() -> None:
    sofa = standing("sofa", 0.0, 4.0, -90.0)
    room = Room(camera_at(), (sofa,), (2,))
    blind = tuple(replace(o, mask=np.zeros_like(o.mask), mask_confidence=0.0) for o in room.objects)
    found = STAGE.pose(room.inputs, blind, room.geometry, room.depth(False), room.ranked(), Progress())
    assert yaw_error_deg(found[0].candidates[0].pose, sofa.pose, 1) < 15.0


def broken_masks(shape) -> dict[str, np.ndarray]:
    one = np.zeros(shape, bool)
    one[shape[0] // 2, shape[1] // 2] = True
    return {"empty": np.zeros(shape, bool), "one pixel": one, "everything": np.ones(shape, bool)}


@pytest.mark.parametrize("measured", [False, True])
@pytest.mark.parametrize("kind", ["empty", "one pixel", "everything"])
def test_useless_masks_are_survived_with_low_confidence(kind: str, measured: bool) -> None:
    room = random_room(4)
    depth = room.depth(measured)
    shape = room.buffers.instance.shape
    objects = tuple(replace(o, mask=broken_masks(shape)[kind], mask_confidence=0.2) for o in room.objects)
    good = posed(room, depth)
    found = STAGE.pose(room.inputs, objects, room.geometry, depth, room.ranked(), Progress())
    assert len(found) == len(objects)
    for item, usual in zip(found, good, strict=True):
        check_finite(item)
        assert item.confidence < min(0.5, usual.confidence)


def check_finite(item: PosedCandidates) -> None:
    assert 0.0 <= item.confidence <= 1.0
    for candidate in item.candidates:
        assert np.isfinite(candidate.score)
        assert np.isfinite(candidate.pose.matrix).all()


@pytest.mark.parametrize("value", [0.0, 1.0, np.nan, np.inf, -2.0])
def test_flat_or_missing_depth_is_survived(value: float) -> None:
    room = random_room(5)
    flat = np.full(room.buffers.depth_m.shape, value, np.float32)
    normals = np.full((*flat.shape, 3), np.nan if np.isnan(value) else 0.0, np.float32)
    for item in posed(room, DepthMap(flat, normals, DepthSource.MEASURED)):
        check_finite(item)


@pytest.mark.parametrize("measured", [False, True])
@pytest.mark.parametrize("shape_id", ["triangle", "round table"])
def test_degenerate_and_round_shapes_are_survived(shape_id: str, measured: bool) -> None:
    room = Room(camera_at(), (standing("chair", 0.0, 3.0, 20.0),), (0,))
    found = posed(room, room.depth(measured), (RankedShapes("o0", ((shape_id, 1.0),)),))
    check_finite(found[0])
    assert found[0].confidence < 0.8


def test_a_shape_that_looks_the_same_from_behind_may_face_either_way() -> None:
    """The blocks of a table are mirror-symmetric; said to have one front, it fits both ways round."""
    room = Room(camera_at(), (standing("table", 0.0, 3.5, 25.0),), (0,))
    result = RenderAndCompare(OneFront()).pose(
        room.inputs, room.objects, room.geometry, room.depth(True), room.ranked(), Progress()
    )[0]
    check_finite(result)
    headings = np.array(result.headings)
    behind = np.roll(headings, len(headings) // 2)
    assert headings.max() < 0.9
    assert behind[int(headings.argmax())] > 0.1


class OneFront(type(LIBRARY)):
    def shape(self, shape_id):
        return replace(super().shape(shape_id), symmetry=1)


def test_chairs_of_a_set_are_equally_large_where_the_picture_allows_it() -> None:
    chairs = tuple(standing("chair", x, y, 40.0) for x, y in ((-1, 3), (0, 3.4), (1, 3)))
    room = Room(camera_at(), chairs, (0, 0, 0))
    exact = room.depth(True)
    noise = 1 + 0.04 * np.random.default_rng(5).standard_normal(exact.depth_m.shape)
    found = posed(room, replace(exact, depth_m=(exact.depth_m * noise).astype(np.float32)))
    scales = np.array([f.candidates[0].pose.scale for f in found])
    assert np.array_equal(scales, scales[[0, 0, 0]])
    for item in found:
        best = item.candidates[0]
        assert best.pose.position[2] - 0.5 * best.pose.scale[2] * best.shape_size_m[2] == pytest.approx(0, abs=0.03)


def test_an_object_twice_as_large_is_no_part_of_the_set() -> None:
    chairs = (standing("chair", -0.7, 3.0, 40.0), standing("chair", 0.7, 3.0, 40.0, (1.3, 1.3, 1.3)))
    room = Room(camera_at(), chairs, (0, 0))
    small, large = (f.candidates[0].pose.scale for f in posed(room, room.depth(True)))
    assert (large > 1.15 * small).all()


def test_a_tiny_box_and_an_object_behind_the_camera_are_survived_with_low_confidence() -> None:
    room = Room(camera_at(), (standing("chair", 0.0, 3.0, 20.0),), (0,))
    tiny = (replace(room.objects[0], box=(100.0, 100.0, 101.0, 101.0), mask=np.zeros_like(room.objects[0].mask)),)
    behind = Cuboid("o0", np.eye(3), np.array([0.0, -3.0, 0.4]), np.array([0.5, 0.5, 0.8]), 0.1)
    geometry = ObjectGeometry(room.camera, (behind,), (), ScaleSource.GIVEN)
    found = STAGE.pose(room.inputs, tiny, geometry, room.depth(False), room.ranked(), Progress())
    check_finite(found[0])
    assert found[0].confidence < 0.1


def test_an_object_cut_by_the_border_is_believed_less() -> None:
    whole = Room(camera_at(), (standing("sofa", 0.0, 4.0, -90.0),), (0,))
    cut = Room(camera_at(), (standing("sofa", 2.4, 4.0, -90.0),), (0,))
    assert cut.objects[0].box[2] >= 479.0
    assert posed(cut)[0].confidence < 0.9 * posed(whole)[0].confidence


def test_no_chair_becomes_a_pancake() -> None:
    room = Room(camera_at(), (standing("chair", 0.0, 3.0, 0.0),), (0,))
    wide = replace(room.geometry.cuboids[0], size_m=np.array([1.6, 1.8, 0.25]))
    geometry = replace(room.geometry, cuboids=(wide,))
    found = STAGE.pose(room.inputs, room.objects, geometry, room.depth(False), room.ranked(), Progress())
    scale = found[0].candidates[0].pose.scale
    assert scale.max() / scale.min() < 1.7
    assert 0.7 <= scale[2] * LIBRARY.shape("chair").size_m[2] <= 1.2


def test_the_same_input_gives_the_same_poses() -> None:
    room = random_room(6)
    assert posed(room) == posed(room)


def test_objects_without_cuboid_or_shapes_are_left_out() -> None:
    room = random_room(7)
    geometry = replace(room.geometry, cuboids=room.geometry.cuboids[1:])
    ranked = (*room.ranked()[:-1], RankedShapes(room.ranked()[-1].object_id, ()))
    found = STAGE.pose(room.inputs, room.objects, geometry, room.depth(False), ranked, Progress())
    assert {f.object_id for f in found} == {r.object_id for r in ranked[1:-1]}


def test_it_stops_when_asked_to() -> None:
    token = CancelToken()
    token.cancel()
    room = random_room(7)
    with pytest.raises(Cancelled):
        STAGE.pose(room.inputs, room.objects, room.geometry, room.depth(False), room.ranked(), Progress(token=token))


def test_its_name_is_short_and_changes_with_the_library() -> None:
    class Fewer(type(LIBRARY)):
        def shapes(self):
            return super().shapes()[1:]

    assert len(repr(STAGE)) < 80
    assert repr(STAGE) == repr(RenderAndCompare(LIBRARY)) != repr(RenderAndCompare(Fewer()))
