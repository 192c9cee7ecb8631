"""Metrics on hand-made cases with known answers; tables that carry the paper's rows and count failures."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from diorama_core.artefacts import Inputs
from diorama_core.evaluation.benchmarks.architecture import RoomResult, architecture_table
from diorama_core.evaluation.benchmarks.cases import STANDARD_SCENES, Case, recipe
from diorama_core.evaluation.benchmarks.pose import with_true_architecture, with_true_graph
from diorama_core.evaluation.benchmarks.pose_comparison import PoseScores
from diorama_core.evaluation.benchmarks.pose_tables import (
    ablation_table,
    all_in_one_table,
    category_table,
    comparison_table,
    groups_table,
    retrievals_table,
)
from diorama_core.evaluation.benchmarks.retrieval import RetrievalResult, recall_table, retrieval_table
from diorama_core.evaluation.benchmarks.system import Way, build_case
from diorama_core.evaluation.benchmarks.system_tables import (
    CaseResult,
    scene_table,
    series_table,
    substitution_table,
    system_table,
)
from diorama_core.evaluation.metrics.architecture import architecture_scores
from diorama_core.evaluation.metrics.scene import (
    SceneScores,
    mean_mask_iou,
    out_of_bounds_share,
    scene_points,
    scene_scores,
    surface_agreement,
)
from diorama_core.evaluation.metrics.shape import chamfer, shape_distance
from diorama_core.evaluation.reports import paper
from diorama_core.evaluation.speed.bench import speed_table
from diorama_core.evaluation.speed.series import Series
from diorama_core.progress import Progress
from diorama_core.render.raycast import MeshCaster
from diorama_core.scene.types import Architecture, Camera, Intrinsics, Scene, yaw_rotation
from diorama_core.synthesis.layout_rooms import box_library, generate_room, room_box
from diorama_core.synthesis.truth import TruthView, to_photo_world, transform
from tests.evaluation.truth import blank_view, without_unasked

SIZE = (80, 60)


@pytest.fixture(scope="module")
def library():
    return box_library()


@pytest.fixture(scope="module")
def view(library) -> TruthView:
    """Two boxes on a floor and a lamp on one of them, by hand; every object's box is its number."""
    room = generate_room(3, 8).truth
    objects = tuple(
        replace(o, mask_id=k + 1, box_px=(10.0 * k, 0.0, 10.0 * k + 9, 9.0)) for k, o in enumerate(room.objects)
    )
    return blank_view(replace(room, objects=objects, camera=camera(-2, 1.5)), SIZE)


def camera(y: float, height_m: float) -> Camera:
    T = np.eye(4)
    T[:3, :3] = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0.0]])
    T[:3, 3] = [0, y, height_m]
    return Camera(Intrinsics.from_fov(*SIZE, 1.2), T)


def test_the_truth_scores_full_marks(view, library):
    scores = scene_scores(view, without_unasked(view), library)
    assert scores.found == scores.asked == 8
    assert scores.pairs.acc == scores.every.acc == scores.own.acc == 1
    assert scores.relation == 1
    assert scores.structure == 1
    assert scores.shape_distance == 0
    assert scores.supported == 1
    assert scores.truly_supported == 1
    assert scores.each_axis.acc == scores.headed.acc == 1
    assert scores.height_off == pytest.approx(0)
    assert scores.out_of_bounds == 0


def test_another_frame_changes_nothing(view, library):
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = yaw_rotation(0.7), [1, 2, 0]
    scores = scene_scores(view, transform(without_unasked(view), T), library)
    assert scores.own.acc == 1
    assert scores.out_of_bounds == 0


def test_missing_moved_and_floating_objects_count(view, library):
    truth = without_unasked(view)
    first, *rest = truth.objects
    lifted = replace(rest[0], pose=rest[0].pose.move([0, 0, 0.5]))
    left = {o.id for o in (lifted, *rest[1:])}
    edges = tuple(s for s in truth.supports if s.child in left and (s.parent in left or truth.has_plane(s.parent)))
    scores = scene_scores(view, replace(truth, objects=(lifted, *rest[1:]), supports=edges), library)
    assert scores.found == 7
    assert scores.own.acc == pytest.approx(6 / 8)
    assert scores.every.acc == 0
    assert scores.relation < 1
    assert scores.supported < 1
    outside = replace(first, pose=first.pose.move([20, 0, 0]))
    far = scene_scores(view, replace(truth, objects=(outside, *rest)), library)
    assert far.out_of_bounds == pytest.approx(1 / 8)


def test_surfaces_agree_within_ten_centimetres():
    a = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]])
    b = a + np.array([0, 0.05, 0])
    assert surface_agreement(a, b) == (pytest.approx(0.05), 1.0)
    # Half of the found points are far away: precision a half, recall 1.
    found = np.concatenate([b, a + np.array([0, 0, 50.0])])
    assert surface_agreement(found, a)[1] == pytest.approx(2 * 0.5 / 1.5)
    assert surface_agreement(a + 10, a)[1] == 0.0


def test_points_stand_for_the_surface_of_a_posed_shape(library):
    item = generate_room(3, 8).truth.objects[0]
    local = (scene_points([item], library) - item.pose.position) @ item.pose.R_world_object
    assert np.allclose(np.abs(local).max(axis=0), item.size_m / 2, atol=0.03)


def test_objects_over_the_edge_of_the_floor_are_out_of_bounds(view):
    scene = without_unasked(view)
    assert out_of_bounds_share(scene) == 0
    first, *rest = scene.objects
    half_out = replace(first, pose=first.pose.move([30, 0, 0]))
    assert out_of_bounds_share(replace(scene, objects=(half_out, *rest))) == pytest.approx(1 / 8)
    assert out_of_bounds_share(replace(scene, architecture=Architecture())) == 1


def test_masks_are_compared_through_the_scenes_own_camera(view, library):
    scene = without_unasked(view)
    k = view.camera.intrinsics
    seen = MeshCaster([(library.mesh(o.shape_id), o.pose.matrix) for o in scene.objects]).buffers(view.camera).instance
    shown = [n for n in range(8) if (seen == n).any()]
    pairs = [(seen == n, scene.objects[n].id) for n in shown]
    assert mean_mask_iou(pairs, scene, library, k) == 1
    half = [(pairs[0][0], None), (pairs[1][0], pairs[1][1])]
    assert mean_mask_iou(half, scene, library, k) == 0.5
    wider = replace(scene, camera=Camera(Intrinsics.from_fov(*SIZE, 1.8), view.camera.T_world_camera))
    assert mean_mask_iou(pairs, wider, library, k) < 0.6


def test_gravity_moves_what_floats(view, library):
    pytest.importorskip("mujoco")
    scene = without_unasked(view)
    still = scene_scores(view, scene, library, physics=True)
    lifted = replace(scene, objects=tuple(replace(o, pose=o.pose.move([0, 0, 0.3])) for o in scene.objects))
    fallen = scene_scores(view, lifted, library, physics=True)
    assert still.stable > fallen.stable
    assert still.drift_cm < 2
    assert fallen.drift_cm > 10


def test_litres_that_meshes_share(view, library):
    scene = without_unasked(view)
    standing = [o for o in scene.objects if scene.has_plane(scene.support_of(o.id).parent)]
    first, second = standing[0], standing[1]
    into = replace(first, id=second.id, mask_id=second.mask_id, box_px=second.box_px)
    shared = replace(scene, objects=tuple(into if o.id == second.id else o for o in scene.objects))
    litres = 1000 * abs(library.mesh(first.shape_id).volume) * float(np.prod(first.pose.scale))
    gained = scene_scores(view, shared, library).mesh_overlap_l - scene_scores(view, scene, library).mesh_overlap_l
    assert gained >= 0.99 * litres


def test_a_build_that_fails_counts_as_wrong(view, library):
    way = Way("nothing but a picture", lambda view: Inputs(view.inputs.photo))
    built, result = build_case(Case(0, "living"), view, way, library, library, Progress())
    assert built is None or not built.scene.objects
    assert result.failure
    assert (result.scores.asked, result.scores.found, result.scores.pairs.acc) == (8, 0, 0.0)


def test_an_empty_scene_is_a_failure_not_a_crash(view, library):
    scores = scene_scores(view, Scene(camera=view.camera), library)
    assert scores.found == 0
    assert scores.pairs.acc == 0
    assert SceneScores.failure(8).own.count == 8


def test_the_photo_world_is_below_the_camera(view):
    turned = np.eye(4)
    turned[:3, :3], turned[:3, 3] = yaw_rotation(np.pi), [3, 1, 0]
    scene = to_photo_world(transform(view.scene, turned))
    assert np.allclose(scene.camera.position[:2], 0)
    assert np.allclose(scene.camera.T_world_camera[:3, 2], [0, 1, 0], atol=1e-9)


def test_truth_put_into_a_prediction(view):
    scene = without_unasked(view)
    lost = replace(scene, supports=())
    assert with_true_graph(view, lost).supports == scene.supports or {
        (s.child, s.parent) for s in with_true_graph(view, lost).supports
    } == {(s.child, s.parent) for s in scene.supports}
    smaller = replace(scene, architecture=room_box(3.0, 3.0))
    assert with_true_architecture(view, smaller).architecture == view.scene.architecture


def test_chamfer_of_known_points():
    a = np.array([[0.0, 0, 0], [1, 0, 0]])
    assert chamfer(a, a) == 0
    assert chamfer(a, a + np.array([0, 0.1, 0])) == pytest.approx(0.02)
    assert chamfer(a, a[:1]) == pytest.approx(0.5)


def test_shapes_of_a_kind_are_nearer_than_others(library):
    tables = [s.id for s in library.in_category("table")]
    lamp = library.in_category("lamp")[0].id
    assert shape_distance(library, tables[0], tables[0]) == 0
    near, far = shape_distance(library, tables[0], tables[1]), shape_distance(library, tables[0], lamp)
    assert 0 < near < far
    assert shape_distance(library, lamp, tables[0]) == pytest.approx(far)


def test_the_recipe_is_long_enough_and_names_are_unique():
    cases = recipe()
    assert len(cases) >= 180
    assert STANDARD_SCENES >= 60
    assert len({c.name for c in cases}) == len(cases)
    assert recipe(2, 1, 5) == recipe(4, 1, 5)[:2]


def _tables():
    failed = PoseScores.failure(4)
    result = CaseResult("living-0-0", SceneScores.failure(4), 1.0, 1.0, "DioramaError: nothing")
    alone = (("words alone", 6.0, 7.0),)
    item = RetrievalResult("a", "a", "chair", ("furniture", "complete"), 5.0, 4.0, 9.0, 8.0, 2, True, False, alone)
    room = room_box(4.0, 4.0).planes
    scores = architecture_scores(room, room, camera(-1, 1.4))
    counts = {"furniture": [(0.5, 0.6, 0.7, 0.4, 0.3)] * 3, "category: chair": [(0, 0, 0, 0, 1), (0, 0, 0, 0, 0)]}
    rooms = {name: [failed] for name in ("none", "O, P, S, R", "all-in-one", "feasible")}
    return {
        "system": system_table([("true masks and depth", [result])]),
        "scenes": scene_table([("true masks and depth", [result])]),
        "substitution": substitution_table([("true room", [result])]),
        "series": series_table([("true masks and depth", [result, replace(result, seed=1)])]),
        "architecture": architecture_table([("d", [RoomResult("a", scores, 0.1), RoomResult("b", None, 0.1)])]),
        "retrieval": retrieval_table([item]),
        "recall": recall_table([item]),
        "pose": comparison_table("Pose", {"ours": [failed]}, paper.POSE_TRUE_DEPTH),
        "groups": groups_table(counts),
        "retrievals": retrievals_table({1: [failed]}, {1: [failed]}),
        "ablation": ablation_table(rooms),
        "all": all_in_one_table(rooms),
        "category": category_table(counts),
        "speed": speed_table([Series("x", "objects", ((1, 0.1), (10, 1.0)))], "objects"),
    }


TABLES = _tables()
WITHOUT_PAPER = ("scenes", "recall", "speed", "substitution", "series")


@pytest.mark.parametrize("name", TABLES)
def test_tables_stand_beside_the_papers(name):
    text = TABLES[name].to_markdown()
    assert ("other dataset" in text) == (name not in WITHOUT_PAPER)
    rows = [line for line in text.splitlines() if line.startswith("|")]
    assert len({line.count("|") for line in rows}) == 1
    assert json.loads(json.dumps(TABLES[name].to_json()))["rows"]


def test_failures_are_counted():
    assert TABLES["system"].row("true masks and depth, mean over pairs")["failed"] == 1
    assert TABLES["system"].row("true masks and depth, mean over pairs")["Acc"] == 0
    row = TABLES["architecture"].row("d")
    assert row["success"] == 0.5
    assert row["IoU"] == pytest.approx(50, abs=1)
    assert row["PE"] == pytest.approx(50, abs=1)
    assert TABLES["retrieval"].row("embedded, first")["furniture OOD"] == 9
    assert TABLES["recall"].row("all")["first"] == 0
    assert TABLES["recall"].row("all")["first five"] == TABLES["recall"].row("all")["right kind"] == 1
    assert TABLES["recall"].row("furniture")["right kind OOD"] == 0
    assert TABLES["category"].row("embedded, true depth and shapes")["chair"] == 50


def test_the_graph_of_the_scene_itself_does_not_vouch_for_its_supports(view, library):
    """A thing that stands far from its table is supported by its own graph's floor, not by the true table."""
    truth = without_unasked(view)
    edge = next(s for s in truth.supports if not truth.has_plane(s.parent))
    item = truth.object(edge.child)
    fallen = replace(item, pose=item.pose.move([30, 0, item.size_m[2] / 2 - item.pose.position[2]]))
    edges = tuple(replace(s, parent="floor", parent_surface=None) if s is edge else s for s in truth.supports)
    scene = replace(truth, objects=tuple(fallen if o is item else o for o in truth.objects), supports=edges)
    scores = scene_scores(view, scene, library)
    assert scores.supported == 1
    assert scores.truly_supported < 1
