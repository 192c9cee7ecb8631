from __future__ import annotations

import csv
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
import trimesh

from diorama_core.errors import InputError
from diorama_core.library import taxonomy
from diorama_core.library.ingest import known_shapes as known_module
from diorama_core.library.ingest.frames import GLTF, STL, UNKNOWN, Convention
from diorama_core.library.ingest.given import Given, axis_name, axis_vector
from diorama_core.library.ingest.guess import Frame, guess_frame
from diorama_core.library.ingest.known_shapes import KnownShapes, load_known_shapes
from diorama_core.library.ingest.limits import DEFAULT_LIMITS
from diorama_core.library.ingest.models import read_model
from diorama_core.library.ingest.names import NameEvidence, name_evidence
from diorama_core.library.ingest.relief import Relief, quarter_turns, relief, turn
from diorama_core.library.ingest.repair import repair
from tests.library.ingest.models import block, chair, known_shapes, table, y_up

TRUTH = Path(__file__).with_name("cad_truth.csv")


@pytest.fixture(scope="module")
def few() -> KnownShapes:
    """Two chairs and a table to compare with, upright and facing +X."""
    stout = trimesh.Trimesh(chair().vertices * [1.1, 1.0, 0.9], chair().faces, process=False)
    return known_shapes(("chair", chair()), ("chair", stout), ("table", table()))


def guessed(
    mesh: trimesh.Trimesh,
    few: KnownShapes,
    convention: Convention = UNKNOWN,
    given: Given | None = None,
    named: dict[str, float] | None = None,
) -> Frame:
    return guess_frame(mesh, relief(mesh), convention, NameEvidence(named), few, given or Given())


def legless() -> trimesh.Trimesh:
    """Another chair: a solid base instead of legs, a taller back."""
    return trimesh.util.concatenate([block((0.5, 0.5, 0.44), (0, 0, 0.22)), block((0.06, 0.5, 0.5), (-0.22, 0, 0.69))])


@pytest.mark.parametrize("turn", range(0, 24, 5))
@pytest.mark.parametrize("unit", [1.0, 0.001, 0.0254])
def test_geometry_and_size_tell_up_front_and_unit(few: KnownShapes, turn: int, unit: float) -> None:
    R = quarter_turns()[turn]
    mesh = trimesh.Trimesh(legless().vertices @ R.T / unit, legless().faces, process=False)
    frame = guessed(mesh, few, named={"chair": 0.0})
    assert axis_name(R.T @ frame.R_shape_file[2]) == "+z"
    assert axis_name(R.T @ frame.R_shape_file[0]) == "+x"
    assert frame.unit_m == pytest.approx(unit)


def test_appearance_tells_what_a_nameless_model_is(few: KnownShapes) -> None:
    tall = trimesh.Trimesh(chair().vertices * [0.95, 1.0, 1.15], chair().faces, process=False)
    assert guessed(y_up(tall), few, GLTF).category == "chair"
    assert guessed(y_up(table()), few, GLTF).category == "table"


def test_kinds_that_a_nameless_model_cannot_be_take_no_places_among_the_likest() -> None:
    small = ("cup", "bottle", "bowl", "vase", "books", "laptop", "clock", "candle", "toaster")
    stout = trimesh.Trimesh(chair().vertices * [1.1, 1.0, 0.9], chair().faces, process=False)
    known = known_shapes(*((name, chair()) for name in small), ("chair", stout))
    assert guessed(chair(), known, given=Given(up="+z", unit_m=1.0)).category == "chair"


def test_what_is_called_by_no_known_word_keeps_its_unit_and_is_unsure_what_it_is(few: KnownShapes) -> None:
    bread = guessed(block((0.05, 0.06, 0.06), (0, 0, 0)), few, named={})
    assert (bread.category, bread.unit_m) == ("object", 1.0)
    tall = trimesh.Trimesh(chair().vertices * [0.95, 1.0, 1.15], chair().faces, process=False)
    gadget = guessed(y_up(tall), few, GLTF, named={})
    assert gadget.category == "object" or gadget.guess.category.confidence < 0.8


def test_of_two_kinds_that_it_may_be_the_more_frequent_one_is_likelier() -> None:
    known = known_shapes(("desk", table()), ("table", table()))
    frame = guessed(table(), known, given=Given(up="+z", unit_m=1.0))
    assert frame.category == "table"


def test_the_format_decides_where_the_shape_does_not(few: KnownShapes) -> None:
    cube = block((0.5, 0.5, 0.5), (0, 0, 0))
    assert guessed(cube, few, GLTF).guess.up.value == "+y"
    assert guessed(cube, few, STL).guess.up.value == "+z"


def test_what_is_given_is_taken_as_it_is(few: KnownShapes) -> None:
    given = Given(up="-x", front="+z", unit_m=0.5, category="couch", reason="flags")
    frame = guessed(chair(), few, GLTF, given)
    assert (frame.guess.up.value, frame.guess.front.value, frame.unit_m, frame.category) == ("-x", "+z", 0.5, "sofa")
    assert {a.confidence for a in vars(frame.guess).values()} == {1.0}
    assert {a.reason for a in vars(frame.guess).values()} == {"flags"}


def test_a_size_that_no_unit_explains_is_scaled(few: KnownShapes) -> None:
    mesh = trimesh.Trimesh(chair().vertices * 7.3, chair().faces, process=False)
    frame = guessed(mesh, few, UNKNOWN, named={"chair": 0.0})
    assert 0.6 < frame.unit_m * mesh.extents.max() < 1.2


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"up": "y"}, "choose one of"),
        ({"up": "+y", "front": "-y"}, "right angles"),
        ({"unit_m": 0.0}, "metres in one unit"),
        ({"category": "flugelhorn"}, "not a? ?known"),
    ],
    ids=["axis", "parallel", "unit", "category"],
)
def test_what_makes_no_sense_is_refused(changes: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        Given(**changes)


def test_axes_and_their_names() -> None:
    assert [axis_name(axis_vector(a)) for a in ("+x", "-y", "+z")] == ["+x", "-y", "+z"]


class Model(NamedTuple):
    """One real model with what was seen of it."""

    row: dict[str, str]
    names: tuple[str, ...]
    mesh: trimesh.Trimesh
    pictures: Relief


@pytest.fixture(scope="module")
def models(shared: Path) -> list[Model]:
    """All models of the shared set. Truth: ups and fronts by looking at pictures of them; `|` parts equal answers."""
    root = shared / "cad"
    found = []
    for row in csv.DictReader(TRUTH.open()):
        raw = read_model(root / row["file"], root)
        mesh = repair(raw.scene, DEFAULT_LIMITS).whole
        found.append(Model(row, raw.names, mesh, relief(mesh)))
    return found


@pytest.fixture(scope="module")
def built_in(tmp_path_factory: pytest.TempPathFactory) -> KnownShapes:
    """One of each kind, where imports compare with six: reliefs of those take ten seconds."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(known_module, "EACH", 1)
        return load_known_shapes(tmp_path_factory.mktemp("reliefs"))


def shares(models: list[Model], known: KnownShapes, convention: Convention, shuffled: bool) -> tuple[float, ...]:
    """Shares of ups, fronts (of those with one), categories and units that are right."""
    rng = np.random.default_rng(0)
    ups, fronts, categories, units = [], [], [], []
    for row, names, mesh, pictures in models:
        R = quarter_turns()[rng.integers(24)] if shuffled else np.eye(3, dtype=int)
        scale = float(rng.choice([1.0, 100.0, 1000.0, 39.37])) if shuffled else 1.0
        moved = trimesh.Trimesh(mesh.vertices @ R.T * scale, mesh.faces, process=False)
        named = name_evidence(Path(row["file"]).stem, [], names)
        frame = guess_frame(moved, turn(pictures, R), convention, named, known, Given())
        ups.append(axis_name(R.T @ frame.R_shape_file[2]) == row["up"])
        if row["front"]:
            fronts.append(ups[-1] and axis_name(R.T @ frame.R_shape_file[0]) in row["front"].split("|"))
        read = [taxonomy.resolve(word) for word in row["category"].split("|")]
        categories.append(
            frame.category in {r.category.name for r in read if r.exact or r.category is taxonomy.UNKNOWN}
        )
        units.append(abs(np.log(frame.unit_m * scale)) < 0.25)
    return tuple(float(np.mean(v)) for v in (ups, fronts, categories, units))


@pytest.mark.slow
def test_real_models_stand_upright_and_face_the_viewer(models: list[Model], built_in: KnownShapes) -> None:
    up, front, category, unit = shares(models, built_in, GLTF, shuffled=False)
    assert up >= 0.9
    assert front >= 0.7
    assert category >= 0.9
    assert unit >= 0.9


@pytest.mark.slow
def test_real_models_in_any_frame_and_unit_without_a_convention(models: list[Model], built_in: KnownShapes) -> None:
    """What names, sizes and looks alone tell of the same models, shuffled."""
    up, front, category, unit = shares(models, built_in, UNKNOWN, shuffled=True)
    assert up >= 0.65
    assert front >= 0.55
    assert category >= 0.9
    assert unit >= 0.8
