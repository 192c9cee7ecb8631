from __future__ import annotations

import numpy as np

from diorama_core.geometry.sphere import sphere_pixels
from diorama_core.library.catalogue import built_in_library
from diorama_core.synthesis import furnish_room
from diorama_core.synthesis.sphere import sphere_photo
from diorama_core.synthesis.truth import Studio


def test_a_thing_is_shown_where_it_is() -> None:
    library = built_in_library()
    scene = furnish_room(3, "kitchen", library)
    T = np.eye(4)
    T[2, 3] = 1.4
    seen = sphere_photo(Studio(scene, library), T, 256)
    assert seen.rgb.shape == (128, 256, 3)
    for index in np.unique(seen.object_ids[seen.object_ids >= 0]):
        rows = np.nonzero(seen.object_ids == index)[0]
        if len(rows) > 60:
            corners = sphere_pixels(scene.objects[index].corners_world - T[:3, 3], 256)
            assert corners[:, 1].min() - 2 < rows.mean() < corners[:, 1].max() + 2
