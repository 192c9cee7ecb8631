"""Rooms to learn from are the same for a seed and hold what no grammar would put there."""

from __future__ import annotations

import numpy as np
import torch

from diorama_core.library.catalogue import built_in_library
from diorama_core.training.networks import Residual, convolution
from diorama_core.training.rooms import random_room


def test_a_seed_gives_one_room_with_many_categories() -> None:
    library = built_in_library()
    room, again = random_room(3, library), random_room(3, library)
    assert [o.shape_id for o in room.objects] == [o.shape_id for o in again.objects]
    assert [o.colour for o in room.objects] == [o.colour for o in again.objects]
    assert len({o.category for o in room.objects}) >= 8
    recoloured = np.mean([o.colour is not None for o in room.objects])
    assert 0.2 < recoloured < 0.95


def test_blocks_keep_or_halve_the_size() -> None:
    x = torch.zeros(1, 8, 16, 12)
    assert Residual(8).eval()(x).shape == x.shape
    assert convolution(8, 4, 3, 2).eval()(x).shape == (1, 4, 8, 6)
