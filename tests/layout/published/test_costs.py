from __future__ import annotations

import numpy as np
import pytest
import torch
from torch.autograd import gradcheck

from diorama_core.layout import gradients
from diorama_core.layout.published import costs


def tensor(*shape: int, seed: int = 0) -> torch.Tensor:
    generator = torch.Generator().manual_seed(seed)
    return torch.randn(*shape, generator=generator, dtype=torch.float64).requires_grad_()


def rotations(n: int, seed: int = 0) -> torch.Tensor:
    q, _ = torch.linalg.qr(tensor(n, 3, 3, seed=seed).detach())
    return q * torch.sign(torch.linalg.det(q))[:, None, None]


def known(*rows: tuple[float, ...]) -> torch.Tensor:
    return torch.tensor(rows, dtype=torch.float64)


def test_known_answers() -> None:
    up, side = known((0, 0, 1)), known((1, 0, 0))
    assert float(costs.e_align(up, up)) == pytest.approx(0.0, abs=1e-8)
    assert float(costs.e_align(up, side)) == pytest.approx(2**0.5)
    assert float(costs.e_sem(side, known((0, 1, 0.3)))) == pytest.approx(2**0.5)
    assert float(costs.e_place(known((5, 5, 0.2)), known((0, 0, 0)), up)) == pytest.approx(0.2)
    moved = costs.e_rel(known((3, 4, 0), (0, 0, 0)), known((0, 0, 0), (0, 0, 0)), torch.tensor([[0, 1]]))
    assert float(moved) == pytest.approx(5.0)


def test_volume_known_answer() -> None:
    square = known((-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0))[None] + known((0.3, 0, 0))
    outward = known((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0))[None]
    offset = torch.full((1, 4), 0.6, dtype=torch.float64)
    over = costs.e_vol(square, known((0.9,))[0], outward, offset, known((0.5,))[0])
    assert float(over) == pytest.approx(2 * 0.2 + 0.4)
    open_above = costs.e_vol(
        square, known((0.9,))[0], outward, offset, torch.tensor([float("inf")], dtype=torch.float64)
    )
    assert float(open_above) == pytest.approx(0.4)


def test_collision_known_answers() -> None:
    R, size = torch.eye(3, dtype=torch.float64).repeat(2, 1, 1), torch.ones(2, 3, dtype=torch.float64)
    pair = torch.tensor([[0, 1]])
    assert float(costs.e_col(known((0, 0, 0), (0.7, 0.1, 0.2)), R, size, pair)) == pytest.approx(0.3 + 0.9 + 0.8)
    assert float(costs.e_col(known((0, 0, 0), (1.01, 0, 0)), R, size, pair)) == 0.0
    # Two boxes that only an edge product separates.
    R = torch.tensor(np.array([np.eye(3), _turned()]))
    apart = costs.e_col(known((0, 0, 0), (0.95, 0.95, 0)), R, size, pair)
    assert float(apart) == 0.0


def _turned() -> np.ndarray:
    c = np.sqrt(0.5)
    about_z = np.array([[c, -c, 0], [c, c, 0], [0, 0, 1]])
    about_x = np.array([[1, 0, 0], [0, c, -c], [0, c, c]])
    return about_z @ about_x


def test_gradients_against_finite_differences() -> None:
    pairs = torch.tensor([[0, 1], [1, 2], [0, 2]])
    assert gradcheck(costs.e_align, (tensor(4, 3), tensor(4, 3, seed=1)))
    assert gradcheck(costs.e_sem, (tensor(4, 3), tensor(4, 3, seed=1)))
    assert gradcheck(costs.e_place, (tensor(4, 3), tensor(4, 3, seed=1), tensor(4, 3, seed=2)))
    assert gradcheck(lambda p: costs.e_rel(p, tensor(3, 3, seed=9).detach(), pairs), (tensor(3, 3),))
    clearance = torch.tensor([0.1, float("inf"), 0.3, 0.2], dtype=torch.float64)
    assert gradcheck(
        lambda c, t: costs.e_vol(c, t, tensor(4, 5, 3, seed=3).detach(), tensor(4, 5, seed=4).detach(), clearance),
        (tensor(4, 4, 3), tensor(4, seed=5)),
    )
    R, size = rotations(3), tensor(3, 3, seed=6).detach().abs() + 1.5
    assert gradcheck(lambda p: costs.e_col(p, R, size, pairs), (tensor(3, 3),))


def test_gradients_are_finite_where_costs_vanish() -> None:
    up = known((0, 0, 1)).requires_grad_()
    (slope,) = torch.autograd.grad(costs.e_align(up, known((0, 0, 1))), up)
    assert torch.isfinite(slope).all()
    # Parallel boxes: every edge product is degenerate.
    p = known((0, 0, 0), (0.5, 0, 0)).requires_grad_()
    R = torch.eye(3, dtype=torch.float64).repeat(2, 1, 1).requires_grad_()
    value = costs.e_col(p, R, torch.ones(2, 3, dtype=torch.float64), torch.tensor([[0, 1]]))
    assert all(torch.isfinite(g).all() for g in torch.autograd.grad(value, [p, R]))


def autograd(value: torch.Tensor, *wanted: torch.Tensor) -> list[np.ndarray]:
    return [g.numpy() for g in torch.autograd.grad(value, wanted)]


def test_hand_written_gradients_equal_autograd() -> None:
    a, b, n = tensor(6, 3), tensor(6, 3, seed=1), tensor(6, 3, seed=2)
    for hand, value, want in (
        (gradients.align(a.detach().numpy(), b.detach().numpy()), costs.e_align(a, b), a),
        (gradients.semantic(a.detach().numpy(), b.detach().numpy()), costs.e_sem(a, b), a),
        (gradients.place(a.detach().numpy(), b.detach().numpy(), n.detach().numpy()), costs.e_place(a, b, n), a),
    ):
        assert hand[0] == pytest.approx(float(value.detach()))
        assert np.allclose(hand[1], autograd(value, want)[0])


def test_hand_written_pair_gradients_equal_autograd() -> None:
    pairs = np.array([[0, 1], [1, 2], [0, 3], [2, 3]])
    p, start = tensor(4, 3), tensor(4, 3, seed=1).detach()
    links = gradients.incidence(pairs, 4)
    value = costs.e_rel(p, start, torch.tensor(pairs))
    hand = gradients.relative((p.detach() - start).numpy(), pairs, links)
    assert hand[0] == pytest.approx(float(value.detach()))
    assert np.allclose(hand[1], autograd(value, p)[0])
    R, size = rotations(4), tensor(4, 3, seed=3).detach().abs() + 1.0
    for walls_from in (4, 3):
        value = costs.e_col(p, R, size, torch.tensor(pairs), walls_from)
        assert float(value.detach()) > 0
        boxes = gradients.BoxPairs.of(R.numpy(), size.numpy(), pairs, walls_from=walls_from)
        hand = boxes.collision(p.detach().numpy(), links)
        assert hand[0] == pytest.approx(float(value.detach()))
        assert np.allclose(hand[1], autograd(value, p)[0])


def test_hand_written_volume_gradients_equal_autograd() -> None:
    corners, top = tensor(3, 4, 3), tensor(3, seed=1)
    outward, offset = tensor(3, 5, 3, seed=2).detach(), tensor(3, 5, seed=3).detach()
    clearance = torch.tensor([0.1, float("inf"), -1.0], dtype=torch.float64)
    value = costs.e_vol(corners, top, outward, offset, clearance)
    hand = gradients.volume(*(x.detach().numpy() for x in (corners, top, outward, offset, clearance)))
    assert hand[0] == pytest.approx(float(value.detach()))
    for ours, theirs in zip(hand[1:], autograd(value, corners, top)):
        assert np.allclose(ours, theirs)
