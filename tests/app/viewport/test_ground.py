from __future__ import annotations

import io

import numpy as np
import trimesh

from diorama_app.viewport.ground import BELOW_M, MARGIN_M, ground_glb
from diorama_core.editing.new_room import empty_room


def test_the_ground_is_dark_below_the_room_and_fades_out_around_it() -> None:
    floor = empty_room(4.0, 2.0, 2.5).architecture.floor
    assert floor is not None
    mesh = trimesh.load(io.BytesIO(ground_glb(floor)), file_type="glb").to_geometry()
    low, high = mesh.bounds
    np.testing.assert_allclose(high - low, [4.0 + 2 * MARGIN_M, 2.0 + 2 * MARGIN_M, 0.0], atol=1e-5)
    assert low[2] == np.float32(-BELOW_M)
    alpha = np.asarray(mesh.visual.material.baseColorTexture)[..., 3]
    assert alpha[0].max() < 3
    assert alpha[alpha.shape[0] // 2, alpha.shape[1] // 2] > 90
