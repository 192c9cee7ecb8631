from __future__ import annotations

import numpy as np
import pytest

from diorama_core.errors import LibraryError
from diorama_core.layout.problem.problem import build_problem
from diorama_core.layout.report import measure
from diorama_core.scene.support import check_scene
from diorama_core.synthesis.layout_rooms import Noise, box_library, generate_room, perturb_graph


@pytest.mark.parametrize(("seed", "count"), [(0, 10), (1, 20), (2, 50)])
def test_truth_is_exact_and_free_of_overlap(seed: int, count: int) -> None:
    room = generate_room(seed, count)
    assert len(room.truth.objects) == count
    check_scene(room.truth)
    problem = build_problem(room.truth, box_library())
    figures = measure(problem, problem)
    assert figures["structure"] == 1.0
    assert figures["in_support"] == 1.0
    assert figures["part_overlap_m"] < 1e-6


def test_same_seed_same_room_and_noise_disturbs() -> None:
    assert generate_room(3, 20) == generate_room(3, 20)
    assert generate_room(3, 20) != generate_room(4, 20)
    room = generate_room(3, 20)
    gaps = [np.linalg.norm(room.observed.object(o.id).pose.position - o.pose.position) for o in room.truth.objects]
    assert 0.05 < np.mean(gaps) < 0.1
    quiet = generate_room(3, 20, Noise(0.0, 0.0, 0.0))
    assert np.allclose(quiet.observed.objects[0].pose.position, quiet.truth.objects[0].pose.position)


def test_a_perturbed_graph_differs_and_stays_valid() -> None:
    scene = generate_room(5, 40).observed
    changed = perturb_graph(scene, 0.1, 0)
    check_scene(changed)
    assert 2 <= len(set(scene.supports) - set(changed.supports)) <= 4


def test_unknown_shapes_are_refused() -> None:
    with pytest.raises(LibraryError):
        box_library().shape("spaceship")
