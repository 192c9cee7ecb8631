"""The outline network's size, and a loss that is least for the truth."""

from __future__ import annotations

import torch

from diorama_core.training.outlining import OutlineNetwork, outline_loss


def test_logits_are_as_fine_as_the_window() -> None:
    assert OutlineNetwork(width=8)(torch.rand(2, 4, 96, 96)).shape == (2, 96, 96)


def test_the_loss_is_least_for_the_truth() -> None:
    torch.manual_seed(1)
    target = (torch.rand(3, 16, 16) > 0.5).float()
    right, wrong = 8 * (2 * target - 1), torch.zeros_like(target)
    assert outline_loss(right, target) < 0.01 < outline_loss(wrong, target) < outline_loss(-right, target)
