from __future__ import annotations

import numpy as np
import trimesh

from diorama_core.library.ingest.relief import quarter_turns, relief, turned
from diorama_core.library.ingest.symmetry import symmetry_fold
from tests.library.ingest.models import block, chair, table


def test_there_are_24_quarter_turns_that_keep_hands() -> None:
    turns = quarter_turns()
    assert len(np.unique(turns.reshape(24, 9), axis=0)) == 24
    assert np.allclose(np.linalg.det(turns), 1.0)
    assert (turns[0] == np.eye(3)).all()


def test_turning_pictures_is_turning_the_shape() -> None:
    mesh = chair()
    pictures = relief(mesh)
    for R in quarter_turns():
        again = relief(trimesh.Trimesh(mesh.vertices @ R.T, mesh.faces, process=False))
        assert np.abs(turned(pictures, R) - again).mean() < 0.02


def test_a_chair_is_open_below_and_closed_behind() -> None:
    pictures = relief(chair())
    assert pictures[2, 1].min() < 0.05  # the top of the backrest
    assert pictures[0, 0].mean() < pictures[0, 1].mean()  # the backrest is nearer from behind


def test_symmetry_folds_of_known_shapes() -> None:
    folds = {
        1: chair(),
        2: table(),
        4: block((0.4, 0.4, 0.7), (0, 0, 0)),
        36: trimesh.creation.cylinder(radius=0.3, height=0.5, sections=64),
    }
    for fold, mesh in folds.items():
        assert symmetry_fold(mesh, relief(mesh)) == fold
