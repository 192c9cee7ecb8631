from __future__ import annotations

import numpy as np
import pytest

from diorama_core.editing.new_room import empty_room
from diorama_core.errors import EditRefused
from diorama_core.geometry.planes import plane_rectangle
from diorama_core.scene.room_edits import ceiling_height, move_plane, set_surface_finish


def test_the_room_has_its_lengths_and_everything_faces_inward() -> None:
    scene = empty_room(4.0, 5.0, 2.6)
    middle = np.array([0.0, 0.0, 1.3])
    assert [p.role for p in scene.architecture.planes] == ["floor", *["wall"] * 4, "ceiling"]
    for plane in scene.architecture.planes:
        assert plane.normal @ middle > plane.offset, plane.id
    np.testing.assert_allclose(plane_rectangle(scene.plane("floor"))[2], (4.0, 5.0))
    assert ceiling_height(scene) == pytest.approx(2.6)
    assert scene.plane("wall_1").centre[1] == pytest.approx(2.5)
    assert [round(float(plane_rectangle(w)[2][0]), 6) for w in scene.architecture.by_role("wall")] == [4, 5, 4, 5]


def test_walls_move_with_their_neighbours_and_finishes_come_off() -> None:
    scene = move_plane(empty_room(4.0, 5.0, 2.6), "wall_2", 1.0)
    np.testing.assert_allclose(plane_rectangle(scene.plane("floor"))[2], (5.0, 5.0))
    bare = set_surface_finish(scene, ("floor", "wall_1"), None)
    assert bare.plane("floor").texture is None
    assert bare.plane("floor").finish is None


@pytest.mark.parametrize("lengths", [(0.2, 5, 2.5), (4, 300, 2.5), (4, 5, 0.5), (float("nan"), 5, 2.5)])
def test_what_is_no_room_is_refused(lengths) -> None:
    with pytest.raises(EditRefused, match="a room cannot have"):
        empty_room(*lengths)
