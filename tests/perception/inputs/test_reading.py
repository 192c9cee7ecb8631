"""What a person says of a photo's camera, and the shared photos with everything that came with them."""

from __future__ import annotations

import json

import numpy as np
import pytest
from PIL import Image

from diorama_core.perception.inputs import read_inputs
from tests.perception.inputs.files import HEIGHT, WIDTH, box, boxes_json, encoded, npy, picture, refusal


class TestIntrinsics:
    def test_field_of_view(self) -> None:
        camera = read_inputs(encoded(picture()), fov_deg=90.0).inputs.intrinsics
        assert camera.fx == pytest.approx(WIDTH / 2)
        assert camera.horizontal_fov_rad == pytest.approx(np.pi / 2)

    @pytest.mark.parametrize(
        "given",
        [(0.0, 50.0, 48.0, 32.0), (float("nan"), 50.0, 48.0, 32.0), (50.0, 50.0, 480.0, 32.0), (5e4, 5e4, 48.0, 32.0)],
    )
    def test_refused(self, given: tuple[float, float, float, float]) -> None:
        assert "--intrinsics" in refusal(encoded(picture()), intrinsics=given)

    def test_refuses_two_statements_and_odd_angles(self) -> None:
        assert "one of them" in refusal(encoded(picture()), intrinsics=(80, 80, 48, 32), fov_deg=60.0)
        assert "--fov" in refusal(encoded(picture()), fov_deg=190.0)


def test_what_is_upside_down_is_turned_with_all_that_belongs_to_it() -> None:
    depth = np.tile(np.linspace(1.0, 3.0, HEIGHT, dtype=np.float32)[:, None], (1, WIDTH))
    masks = Image.new("L", (WIDTH, HEIGHT))
    masks.paste(80, (10, 6, 40, 30))
    given = {"boxes": boxes_json(box(10, 6, 40, 30)), "masks": encoded(masks), "intrinsics": (80.0, 80.0, 40.0, 30.0)}
    plain = read_inputs(encoded(picture()), **given).inputs
    turned = read_inputs(encoded(picture()), half_turn=True, **given).inputs
    assert (turned.photo.rgb == plain.photo.rgb[::-1, ::-1]).all()
    assert (turned.photo.half_turned, plain.photo.half_turned) == (True, None)
    assert turned.boxes[0].box == (WIDTH - 40, HEIGHT - 30, WIDTH - 10, HEIGHT - 6)
    assert (turned.instances == plain.instances[::-1, ::-1]).all()
    assert (turned.intrinsics.cx, turned.intrinsics.cy) == (WIDTH - 40.0, HEIGHT - 30.0)
    above = read_inputs(encoded(picture()), half_turn=True, depth=npy(depth), depth_kind="depth", depth_scale=1.0)
    assert above.inputs.depth_m[0].mean() == pytest.approx(3.0)


def test_every_shared_photo_is_read_with_all_that_came_with_it(photos: list) -> None:
    assert len(photos) == 21
    for entry in photos:
        inputs = entry.inputs
        assert (entry.depth is None) == (inputs.depth_m is None)
        if entry.boxes:
            assert len(inputs.boxes) == len(json.loads(entry.boxes.read_text()))
        if entry.masks:
            assert 3 <= len(inputs.instance_boxes) <= 9


def test_the_corridors_depth_needs_its_encoding(photos: list) -> None:
    corridor = next(p for p in photos if p.id == "sunrgbd_corridor")
    assert "sunrgbd" in refusal(corridor.path, depth=corridor.depth)
