"""Which place of the detector answers for which box, and what its loss wants. The outline network's size, and a loss
that is least for the truth.
"""

from __future__ import annotations

import numpy as np
import torch
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.models.recogniser import STRIDES, places
from diorama_core.training.networks import Detector, OutlineNetwork, assign, decode, detector_loss, outline_loss

SIZE = (64, 96)


def _rows_of(boxes: torch.Tensor, owner: np.ndarray, kinds: torch.Tensor, count: int) -> torch.Tensor:
    """What a perfect network would say."""
    centres, strides = (torch.from_numpy(a) for a in places(*SIZE))
    rows = torch.full((1, len(owner), 5 + count), -8.0)
    for place in np.flatnonzero(owner >= 0):
        box = boxes[owner[place]]
        reach = torch.cat([centres[place] - box[:2], box[2:] - centres[place]])
        rows[0, place, 0] = 8.0
        rows[0, place, 1:5] = (reach / strides[place]).log()
        rows[0, place, 5 + int(kinds[owner[place]])] = 12.0
    return rows


def test_every_place_has_one_row() -> None:
    network = Detector(7, width=8).eval()
    with torch.no_grad():
        rows = network(torch.zeros(2, 3, SIZE[1], SIZE[0]))
    centres, strides = places(*SIZE)
    assert rows.shape == (2, len(centres), 5 + 7)
    assert sorted(set(strides.tolist())) == list(STRIDES)
    assert (centres < np.array(SIZE)).all()


@given(
    x=st.floats(0, 40), y=st.floats(0, 70), w=st.floats(8, 60), h=st.floats(8, 90)
)  # fmt: skip
def test_a_box_is_answered_for_by_places_inside_it(x: float, y: float, w: float, h: float) -> None:
    box = np.array([[x, y, min(x + w, SIZE[0]), min(y + h, SIZE[1])]], np.float32)
    owner = assign(box, *SIZE)
    centres, _ = places(*SIZE)
    inside = ((centres > box[0, :2]) & (centres < box[0, 2:])).all(axis=1)
    assert inside[owner == 0].all()


def test_of_two_boxes_at_one_place_the_smaller_is_answered_for() -> None:
    boxes = np.array([[0, 0, 60, 60], [8, 8, 56, 56]], np.float32)
    owner = assign(boxes, *SIZE)
    assert (owner == 1).any()
    assert (assign(boxes[:0], *SIZE) == -1).all()


def test_a_perfect_answer_has_almost_no_loss_and_any_other_has_more() -> None:
    boxes = torch.tensor([[4.0, 4.0, 40.0, 44.0], [30.0, 50.0, 60.0, 90.0]])
    kinds = torch.tensor([2, 0])
    owner = assign(boxes.numpy(), *SIZE)
    rows = _rows_of(boxes, owner, kinds, 3)
    centres, strides = (torch.from_numpy(a) for a in places(*SIZE))
    wanted = boxes[torch.from_numpy(owner).clamp(min=0)][None]
    named = torch.where(torch.from_numpy(owner) >= 0, kinds[torch.from_numpy(owner).clamp(min=0)], -1)[None]
    perfect = detector_loss(rows, wanted, named, centres, strides).total
    assert perfect < 0.05
    for change, by in ((0, -8.0), (1, 1.0), (5, 30.0)):
        worse = rows.clone()
        worse[..., change] += by
        assert detector_loss(worse, wanted, named, centres, strides).total > perfect + 0.01


def test_boxes_are_read_back_from_distances() -> None:
    centres, strides = (torch.from_numpy(a) for a in places(*SIZE))
    boxes = decode(torch.zeros(1, len(centres), 4), centres, strides)
    np.testing.assert_allclose((boxes[0, :, 2:] - boxes[0, :, :2]).numpy(), 2 * strides.numpy()[:, None] * np.ones(2))


def test_logits_are_as_fine_as_the_window() -> None:
    assert OutlineNetwork(width=8)(torch.rand(2, 4, 96, 96)).shape == (2, 96, 96)


def test_the_loss_is_least_for_the_truth() -> None:
    torch.manual_seed(1)
    target = (torch.rand(3, 16, 16) > 0.5).float()
    right, wrong = 8 * (2 * target - 1), torch.zeros_like(target)
    assert outline_loss(right, target) < 0.01 < outline_loss(wrong, target) < outline_loss(-right, target)
