"""Models that nobody here made, posed in rendered views: the paper's columns over rooms of them."""

from __future__ import annotations

import csv
import hashlib
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import trimesh

from diorama_core.evaluation.metrics.pose import Alignment, Placed, pool, scene_alignment
from diorama_core.library.ingest.relief import relief, symmetry_fold
from diorama_core.library.record import Shape
from diorama_core.library.taxonomy import resolve
from diorama_core.pose import RenderAndCompare
from diorama_core.progress import Progress
from tests.pose import rooms
from tests.pose.rooms import BlockLibrary, Room, camera_at, standing

SOME = (
    "chair", "loungeSofa", "desk", "bookcaseOpen", "bedSingle", "toilet", "kitchenFridge", "sideTable",
    "painted_wooden_cabinet", "sofa_03", "wooden_table_02", "wooden_bookshelf_worn",
)  # fmt: skip


class ForeignLibrary(BlockLibrary):
    """GLB files by name; their own frames, turned upright."""

    def __init__(self, folder: Path) -> None:
        with (folder / "index.csv").open(newline="") as table:
            self.rows = {row["name"]: (row["category_guess"], folder / row["file"]) for row in csv.DictReader(table)}

    def _mesh(self, shape_id: str) -> trimesh.Trimesh:
        return upright(self.rows[shape_id][1])

    def shape(self, shape_id: str) -> Shape:
        guess, path = self.rows[shape_id]
        mesh = upright(path)
        size = tuple(float(e) for e in mesh.extents)
        name = resolve(guess.split("/")[0]).category.name
        key = hashlib.sha256(path.read_bytes()).hexdigest()
        return Shape(shape_id, name, shape_id, size, symmetry=fold_of(path), content_hash=f"foreign-{key}")

    def shapes(self) -> tuple[Shape, ...]:
        return tuple(self.shape(name) for name in self.rows if self.rows[name][1].stem in SOME)


@cache
def upright(path: Path) -> trimesh.Trimesh:
    mesh = trimesh.load(path, force="mesh")
    mesh = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    mesh.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, [1, 0, 0]))
    mesh.apply_translation(-mesh.bounds.mean(axis=0))
    return mesh


@cache
def fold_of(path: Path) -> int:
    return symmetry_fold(upright(path), relief(upright(path)))


def furnished(names: Sequence[str], seed: int) -> Room:
    """Models side by side at any heading."""
    rng = np.random.default_rng(seed)
    placed = []
    for slot, name in enumerate(names):
        x, y = (slot - (len(names) - 1) / 2) * 1.9 + rng.uniform(-0.2, 0.2), rng.uniform(4.0, 5.5)
        placed.append(standing(name, x, y, rng.uniform(0, 360), tuple(rng.uniform(0.95, 1.05, 3))))
    return Room(camera_at(1.6), tuple(placed), tuple(int(t) for t in rng.integers(0, 4, len(names))))


def alignment(room: Room, library: ForeignLibrary) -> tuple[Alignment, Alignment]:
    found = RenderAndCompare(library).pose(
        room.inputs, room.objects, room.geometry, room.depth(True), room.ranked(), Progress()
    )
    truth, placed = [], []
    for index, item in zip(room.seen, found, strict=True):
        true, best = room.placed[index], item.candidates[0]
        fold = library.shape(true.shape_id).symmetry
        truth.append(Placed(true.pose.R_world_object, true.pose.position, true.size_m, fold))
        size_m = np.array(best.shape_size_m) * best.pose.scale
        placed.append(Placed(best.pose.R_world_object, best.pose.position, size_m))
    return scene_alignment(truth, placed)


@pytest.fixture
def library(shared: Path, monkeypatch: pytest.MonkeyPatch) -> ForeignLibrary:
    if not (shared / "cad" / "index.csv").exists():
        pytest.skip("needs the models in 'shared/cad' beside the repository, which are absent")
    found = ForeignLibrary(shared / "cad")
    monkeypatch.setattr(rooms, "LIBRARY", found)
    return found


def test_foreign_models_are_placed_where_they_stand(library: ForeignLibrary) -> None:
    trios = [SOME[k : k + 3] for k in range(0, len(SOME), 3)]
    pairs = pool([alignment(furnished(trio, seed), library)[0] for seed, trio in enumerate(trios)])
    assert pairs.r_acc >= 0.8
    assert pairs.t_acc >= 0.9
    assert pairs.s_acc >= 0.8
    assert pairs.acc >= 0.6
