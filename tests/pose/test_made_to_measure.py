"""Retrieved shapes made to measure against rendered pictures of other members of their families."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.artefacts import (
    Cuboid,
    DepthMap,
    DetectedObject,
    Inputs,
    ObjectGeometry,
    Photo,
    PosedCandidates,
)
from diorama_core.library.catalogue import base_id, built_in_library
from diorama_core.library.furniture import designs
from diorama_core.library.furniture.measures import is_turned, made_by_id, made_id, values_of
from diorama_core.pose import MadeToMeasure, RenderAndCompare
from diorama_core.pose.details import InnerEdges
from diorama_core.pose.made_to_measure import FittedChoice
from diorama_core.pose.seen_objects import SeenObject
from diorama_core.progress import Progress
from diorama_core.provenance import DepthSource, ScaleSource
from diorama_core.render.raycast import MeshCaster
from diorama_core.scene.types import Candidate, Pose
from tests.pose.rooms import LIBRARY as BLOCKS
from tests.pose.rooms import camera_at
from tests.pose.test_turned_profile import LARGE, as_large, seen

LIBRARY = built_in_library()
STAGE = MadeToMeasure(RenderAndCompare(LIBRARY), LIBRARY)
CAMERA = camera_at()
DESIGNS = {d.id: d for d in designs()}
CHOICE = FittedChoice(LIBRARY)


def fitted(true_id: str, found_id: str, scale=(1.0, 1.0, 1.0), library=LIBRARY, measured: bool = True) -> Candidate:
    """The first candidate for one object that looks like `true_id`, for which `found_id` was retrieved."""
    out = ranked(true_id, (found_id,), measured, scale, library)
    assert out[-1].shape_id == found_id
    return out[0]


def ranked(
    true_id: str, found_ids: tuple[str, ...], measured: bool, scale=(1.0, 1.0, 1.0), library=LIBRARY
) -> tuple[Candidate, ...]:
    """The candidates for one object that looks like `true_id`, for which these were retrieved, the best first."""
    size = np.array(library.shape(true_id).size_m)
    pose = Pose.upright((0.0, 3.4, size[2] / 2), np.deg2rad(-65.0))
    seen = MeshCaster([(library.mesh(true_id), pose.matrix)]).buffers(CAMERA)
    mask = seen.instance == 0
    rows, columns = np.nonzero(mask)
    box = (float(columns.min()), float(rows.min()), float(columns.max() + 1), float(rows.max() + 1))
    shade = np.where(mask, 128 + 90 * np.nan_to_num(seen.normals_world) @ np.array([0.3, -0.5, 0.4]), 40)
    rgb = np.repeat(shade.clip(0, 255).astype(np.uint8)[..., None], 3, axis=2)
    item = DetectedObject("o", "thing", "thing", box, mask, 1, 1.0)
    cuboid = Cuboid("o", pose.R_world_object, pose.position, size, 0.9)
    sizes = [library.shape(i).size_m for i in found_ids]
    starts = [Pose(pose.R_world_object, pose.position, size / np.array(s) * scale) for s in sizes]
    found = (
        Candidate(i, s, 0.9 - 0.1 * k, p) for k, (i, s, p) in enumerate(zip(found_ids, sizes, starts, strict=True))
    )
    posed = PosedCandidates("o", tuple(found), 0.9)
    k = CAMERA.intrinsics
    source = DepthSource.MEASURED if measured else DepthSource.RENDERED
    geometry = ObjectGeometry(CAMERA, (cuboid,), (), ScaleSource.GIVEN)
    inputs = Inputs(Photo(rgb, "photo", (k.width, k.height)))
    stage = replace(STAGE, library=library)
    depth = DepthMap(seen.depth_m, seen.normals_world, source)
    (out,) = stage.fit((posed,), inputs, (item,), geometry, depth, Progress())
    return out.candidates


@pytest.mark.parametrize(
    ("true_id", "found_id", "name"),
    [("bookshelf-white-five", "bookshelf-oak-four", "levels"), ("table-oval-walnut", "table-walnut-splay", "outline")],
)
def test_parameters_are_those_of_the_object_in_the_picture(true_id: str, found_id: str, name: str) -> None:
    best = fitted(true_id, found_id)
    assert base_id(best.shape_id) == found_id
    made = made_by_id(best.shape_id, DESIGNS[found_id])
    wanted, before = values_of(DESIGNS[true_id])[name], values_of(DESIGNS[found_id])[name]
    assert before != wanted
    assert values_of(made)[name] == wanted


def test_the_right_design_stays_and_is_built_at_its_size_where_it_was_stretched() -> None:
    assert fitted("dresser-white-four", "dresser-white-four").shape_id == "dresser-white-four"
    taller = fitted("dresser-white-four", "dresser-white-four", scale=(1.0, 1.0, 1.5))
    if taller.shape_id != "dresser-white-four":
        assert taller.pose.scale == pytest.approx(np.ones(3))


def test_a_made_shape_has_scale_one_and_the_extents_that_were_measured() -> None:
    best = fitted("bookshelf-white-five", "bookshelf-oak-four")
    assert best.pose.scale == pytest.approx(np.ones(3))
    assert best.shape_size_m == pytest.approx(LIBRARY.shape("bookshelf-white-five").size_m, abs=1e-3)
    assert LIBRARY.shape(best.shape_id).size_m == best.shape_size_m


def test_peoples_own_models_stay_as_they_are() -> None:
    assert fitted("sofa", "bed", library=BLOCKS).shape_id == "bed"


def badly_fitting(measured: bool) -> tuple[str, ...]:
    """Shapes, best first, of a tall dresser for which a stool was ranked just before a dresser."""
    ids = ("stool-round-oak", "dresser-white-four")
    true = "dresser-white-four"
    assert all(i in DESIGNS for i in ids)
    return tuple(base_id(c.shape_id) for c in ranked(true, ids, measured))


def test_where_the_first_shape_fits_badly_the_next_ones_are_fitted_too() -> None:
    assert badly_fitting(measured=False)[0] == "dresser-white-four"


def test_no_candidate_gets_lost_when_another_one_comes_first() -> None:
    assert sorted(set(badly_fitting(measured=False))) == ["dresser-white-four", "stool-round-oak"]


def test_with_measured_depth_the_ranking_stands() -> None:
    assert badly_fitting(measured=True)[0] == "stool-round-oak"


def order(true_id: str, ids: tuple[str, ...], outlined: bool = True) -> tuple[str, ...]:
    """The shapes of candidates in the place of a vase, best first, of falling ranks before."""
    evidence, pose = seen(true_id)
    found = (
        Candidate(i, LIBRARY.shape(i).size_m, 0.9 - 0.1 * k, as_large(i, pose, true_id)) for k, i in enumerate(ids)
    )
    k = evidence.camera.intrinsics
    edges = InnerEdges.of(np.full((k.height, k.width, 3), 90, np.uint8), evidence.seen)
    one = SeenObject(evidence, evidence, edges, pose, 5000, 1.0 if outlined else 0.8, "vase")
    out = CHOICE.best_first(PosedCandidates("o", tuple(found), 0.9), one)
    assert all(np.isfinite(c.score) for c in out.candidates)
    return tuple(c.shape_id for c in out.candidates)


def test_a_body_of_revolution_comes_first_where_its_profile_is_that_of_the_picture() -> None:
    ids = ("night-stand-cane", "dresser-white-four", "vase-cylinder-glass")
    assert order("vase-moon-stone", ids) == ("vase-cylinder-glass", "night-stand-cane", "dresser-white-four")


def test_an_outline_that_is_not_sure_tells_no_profile() -> None:
    ids = ("vase-amphora", "vase-cylinder-glass")
    assert order("vase-moon-stone", ids, outlined=False) == ids


def test_what_fits_well_stays_first() -> None:
    assert order("vase-moon-stone", ("vase-moon-stone", "vase-urn-blue"))[0] == "vase-moon-stone"


def test_among_candidates_the_one_comes_first_that_fits_once_it_is_turned() -> None:
    true_id = made_id("vase-moon-stone", LARGE * np.array(LIBRARY.shape("vase-moon-stone").size_m), {})
    first = ranked(true_id, ("dresser-white-four", "object-drum"), measured=False)[0]
    assert base_id(first.shape_id) == "object-drum"
    assert is_turned(first.shape_id)
