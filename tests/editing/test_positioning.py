"""The best free place of an object."""

from __future__ import annotations

import numpy as np

from diorama_core.editing.positioning import Positioner
from diorama_core.editing.relations import Relation, is_met
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import Pose, SceneObject
from diorama_core.synthesis.grammar import furnish_room


def test_the_best_place_is_free_and_repeatable() -> None:
    library = built_in_library()
    scene = furnish_room(3, "living", library, outline="box", clutter=4)
    shape = library.in_category("armchair")[0]
    item = SceneObject("new", "armchair", shape.category, shape.id, shape.size_m, Pose.upright(np.zeros(3)))
    wish = Relation("facing", ("sofa_1",))
    positioner = Positioner(library)
    spot, again = positioner.best(scene, item, [wish]), Positioner(library).best(scene, item, [wish])
    assert spot is not None
    assert again is not None
    assert spot.pose == again.pose
    after = positioner.put(scene, item, spot)
    assert is_met(after, "new", wish, RoomFrame.of(after))
    assert not positioner.collisions.pairs(after, ["new"])
    assert positioner.is_inside(after, "new")
    aside = positioner.nearby(after, "new")
    assert aside is not None
    assert 0.0 < aside.cost < 1.2
