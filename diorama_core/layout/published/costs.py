"""The costs of the published layout optimiser, one function each: torch, batched, differentiable.

Section "Stage-wise scene optimization" of the paper and its supplement are the specification. Norms are smoothed by
`EPSILON`, so that gradients are finite where a cost is zero. `layout.gradients` holds the same costs with their
gradients written by hand, for the inner loops; tests hold the two together.
"""

from __future__ import annotations

import torch
from jaxtyping import Float, Int
from torch import Tensor

from diorama_core.layout.gradients import EPSILON


def _norm(v: Float[Tensor, "*b d"]) -> Float[Tensor, "*b"]:
    return torch.sqrt((v * v).sum(dim=-1) + EPSILON**2) - EPSILON


def e_align(contact_in: Float[Tensor, "e 3"], support: Float[Tensor, "e 3"]) -> Float[Tensor, ""]:
    """Penalises contact faces that are not parallel to their supports: sum of |n_contact - n_support|.

    Args:
        contact_in: unit normals of the touching faces, pointing into their objects, in the world.
        support: unit normals of the supporting surfaces, in the world.
    """
    return _norm(contact_in - support).sum()


def e_sem(front: Float[Tensor, "n 3"], front_observed: Float[Tensor, "n 3"]) -> Float[Tensor, ""]:
    """Penalises fronts that leave their observed direction, seen on the horizontal plane."""
    return _norm((front - front_observed)[:, :2]).sum()


def e_place(
    centre: Float[Tensor, "e 3"], point: Float[Tensor, "e 3"], normal: Float[Tensor, "e 3"]
) -> Float[Tensor, ""]:
    """Penalises contact faces off their support: L1 norm of the vector from face centre to the surface's plane."""
    distance = ((centre - point) * normal).sum(dim=-1)
    return (distance.abs() * normal.abs().sum(dim=-1)).sum()


def e_rel(p: Float[Tensor, "n 3"], p_observed: Float[Tensor, "n 3"], pairs: Int[Tensor, "m 2"]) -> Float[Tensor, ""]:
    """Penalises changes of the vectors between objects that are near each other."""
    moved = p - p_observed
    return _norm(moved[pairs[:, 0]] - moved[pairs[:, 1]]).sum()


def e_vol(
    corners: Float[Tensor, "e 4 3"],
    top: Float[Tensor, " e"],
    outward: Float[Tensor, "e k 3"],
    offset: Float[Tensor, "e k"],
    clearance: Float[Tensor, " e"],
) -> Float[Tensor, ""]:
    """Penalises protrusion from the supporting volume: contact corners past its sides, the top past its height.

    Args:
        corners: corners of the touching faces in the world.
        top: height of each object's top above its supporting surface, along the surface's normal.
        outward: unit in-plane normals of the volume's sides, padded with zeros.
        offset: sides are where outward . x = offset; padded with zeros.
        clearance: height of the volume; inf where it is open.
    """
    past = torch.relu(torch.einsum("eck,esk->ecs", corners, outward) - offset[:, None, :])
    bounded = torch.where(torch.isfinite(clearance), top - clearance, torch.zeros_like(top))
    return past.sum() + torch.relu(bounded).sum()


def e_col(
    p: Float[Tensor, "n 3"],
    R: Float[Tensor, "n 3 3"],
    size: Float[Tensor, "n 3"],
    pairs: Int[Tensor, "m 2"],
    walls_from: int | None = None,
) -> Float[Tensor, ""]:
    """Penalises overlapping boxes: for pairs that no axis separates, the overlaps along the three axes of each box.

    Separating axis theorem over the fifteen axes of two oriented boxes; the two boxes' sums are averaged, so that the
    order of a pair does not matter. Boxes from index `walls_from` on are walls, normal first: against them only the
    overlap along the normal counts, or a wall would push objects along itself.

    Args:
        p: centres, world, metres.
        R: rotations, world from object.
        size: extents.
        pairs: of indices.
        walls_from: index of the first wall; None without walls.
    """
    i, j = pairs[:, 0], pairs[:, 1]
    axes = box_axes(R[i], R[j])
    reach = _reach(R[i], size[i], axes) + _reach(R[j], size[j], axes)
    depth = reach - torch.einsum("mac,mc->ma", axes, p[i] - p[j]).abs()
    used = _norm(axes) > 0.5
    hit = torch.where(used, depth, torch.full_like(depth, float("inf"))).min(dim=1).values > 0
    weight = torch.full((len(i), 6), 0.5, dtype=p.dtype)
    if walls_from is not None:
        weight[j >= walls_from] = torch.eye(6, dtype=p.dtype)[3]
    return torch.where(hit[:, None], weight * depth[:, :6], torch.zeros_like(weight)).sum()


def box_axes(Ri: Float[Tensor, "m 3 3"], Rj: Float[Tensor, "m 3 3"]) -> Float[Tensor, "m 15 3"]:
    """Unit separating axes of two oriented boxes: three of each, nine products; zero where a product vanishes."""
    a, b = Ri.transpose(1, 2), Rj.transpose(1, 2)
    cross = torch.linalg.cross(a[:, :, None, :], b[:, None, :, :], dim=-1).reshape(len(Ri), 9, 3)
    square = (cross * cross).sum(dim=-1, keepdim=True)
    # Dividing by a norm that may vanish gives NaN gradients even behind `where`: keep the divisor positive.
    unit = torch.where(square > 1e-12, cross / torch.sqrt(square.clamp_min(1e-12)), torch.zeros_like(cross))
    return torch.cat([a, b, unit], dim=1)


def _reach(R: Float[Tensor, "m 3 3"], size: Float[Tensor, "m 3"], axes: Float[Tensor, "m a 3"]) -> Float[Tensor, "m a"]:
    """Half extent of boxes along axes."""
    return 0.5 * (torch.einsum("mac,mck->mak", axes, R).abs() * size[:, None, :]).sum(dim=-1)
