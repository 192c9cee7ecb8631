from __future__ import annotations

import numpy as np
import trimesh

from diorama_core.library.catalogue import built_in_library
from diorama_core.library.ingest.relief import coincides, quarter_turns, relief, symmetry_fold, turn
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
        assert np.abs(turn(pictures, R) - again).mean() < 0.02


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


def prism(sides: int) -> trimesh.Trimesh:
    mesh = trimesh.creation.cylinder(radius=0.3, height=0.5, sections=sides)
    mesh.apply_translation(-mesh.bounds.mean(axis=0))
    return mesh


def legs(count: int) -> trimesh.Trimesh:
    """A round top on legs at equal angles, all within its rim."""
    angles = 2 * np.pi * np.arange(count) / count
    parts = [
        trimesh.creation.cylinder(0.02, segment=[(0.25 * np.cos(a), 0.25 * np.sin(a), 0), (0, 0, 0.6)]) for a in angles
    ]
    parts.append(
        trimesh.creation.cylinder(0.3, 0.04, transform=trimesh.transformations.translation_matrix((0, 0, 0.6)))
    )
    mesh = trimesh.util.concatenate(parts)
    mesh.apply_translation(-mesh.bounds.mean(axis=0))
    return mesh


def test_folds_beyond_quarter_turns_are_found_where_the_surface_coincides() -> None:
    for fold in (3, 5):
        assert symmetry_fold(legs(fold), relief(legs(fold))) == fold
    assert symmetry_fold(prism(6), relief(prism(6))) == 6


def test_what_is_nearly_symmetric_is_not_said_to_be() -> None:
    """A tripod with one leg longer; a mug, round but for its handle."""
    crooked = trimesh.util.concatenate([legs(3), trimesh.creation.box((0.3, 0.05, 0.05))])
    handle = trimesh.creation.box((0.1, 0.02, 0.2), trimesh.transformations.translation_matrix((0.33, 0, 0)))
    mug = trimesh.util.concatenate([prism(48), handle])
    assert not any(coincides(crooked, fold) for fold in (2, 3, 4, 5, 6, 8))
    assert not any(coincides(mug, fold) for fold in (2, 3, 4, 5, 6, 8))


def test_the_built_in_shapes_of_uncommon_folds_coincide_when_turned() -> None:
    library = built_in_library()
    uncommon = [s for s in library.shapes() if s.symmetry in (3, 5, 6, 8)]
    assert len(uncommon) >= 6
    for shape in uncommon:
        assert coincides(library.mesh(shape.id), shape.symmetry), shape.id
