"""Rendered rooms with a known truth.

```
scene = furnish_room(seed, "living")                 # truth in the room frame, no camera
camera, *others = sample_cameras(scene, library, seed)  # cameras as people hold them
view = render_truth(scene, camera, library)           # picture, depth, ids, truth in the photo's world
built = build_scene(view.inputs, library)
```
"""

from diorama_core.synthesis.cameras import sample_cameras
from diorama_core.synthesis.grammar import ROOM_KINDS, RoomKind, furnish_room
from diorama_core.synthesis.truth import TruthView, render_truth, to_photo_world

__all__ = ["ROOM_KINDS", "RoomKind", "TruthView", "furnish_room", "render_truth", "sample_cameras", "to_photo_world"]
