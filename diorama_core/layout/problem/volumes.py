"""Supporting volumes of all objects at once: where contact faces may be, how high objects may be there, and what parts
of a supporter enclose the place.

An object touches the board it stands on, so it never collides with its supporter as a whole. It does collide with the
back and the sides of a bookcase, with the arms of a chair, with the frame of a mirror on a dresser and with the tap of
a worktop. Soft loads sink into bedding and cushions: of what rises above their place they meet what stands beside it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Bool, Float, Int

from diorama_core.arrangement.surfaces import RestingSurface
from diorama_core.geometry.sat import PosedBodies
from diorama_core.layout.problem.problem import Problem


@dataclass(frozen=True, eq=False)
class WorldVolumes:
    """Volumes at given poses of their owners."""

    outward: Float[np.ndarray, "e k 3"]
    """Unit normals of the sides, padded with zeros."""
    offset: Float[np.ndarray, "e k"]
    """Inside is where outward . x <= offset."""
    normal: Float[np.ndarray, "e 3"]
    """Normals of the supporting surfaces."""
    level: Float[np.ndarray, " e"]
    """The surfaces lie where normal . x = level."""
    clearance: Float[np.ndarray, " e"]
    """Heights of the volumes; inf where open."""


@dataclass(frozen=True, eq=False)
class Volumes:
    """The volumes of all supported objects, in their owners' frames."""

    supported: Int[np.ndarray, " e"]
    """Indices of the supported objects."""
    supporter: Int[np.ndarray, " e"]
    """Indices of the supporting objects; -1 for planes."""
    local: WorldVolumes
    axis: Int[np.ndarray, " e"]
    """The owner's axis along which the clearance scales."""

    @classmethod
    def of(cls, problem: Problem) -> Volumes:
        """The volumes of a problem."""
        surfaces = [(i, s) for i, s in enumerate(problem.surface) if s is not None]
        k = max((len(s.offset) for _, s in surfaces), default=0)
        outward, offset = np.zeros((len(surfaces), k, 3)), np.zeros((len(surfaces), k))
        for row, (_, s) in enumerate(surfaces):
            outward[row, : len(s.offset)], offset[row, : len(s.offset)] = s.outward, s.offset
        normal = np.array([s.normal for _, s in surfaces]).reshape(-1, 3)
        supported = np.array([i for i, _ in surfaces], dtype=int)
        local = WorldVolumes(
            outward,
            offset,
            normal,
            np.array([s.level for _, s in surfaces]),
            np.array([s.clearance_m for _, s in surfaces]),
        )
        return cls(supported, problem.parent[supported], local, np.abs(normal).argmax(axis=1))

    def world_volumes(
        self, R: Float[np.ndarray, "n 3 3"], p: Float[np.ndarray, "n 3"], scale: Float[np.ndarray, "n 3"]
    ) -> WorldVolumes:
        """The volumes when objects are at these poses.

        Args:
            R: rotations, world from object.
            p: centres, world, metres.
            scale: along the axes of each object.
        """
        on_object = self.supporter >= 0
        owner_R = np.where(on_object[:, None, None], R[self.supporter], np.eye(3))
        owner_p = np.where(on_object[:, None], p[self.supporter], 0.0)
        owner_s = np.where(on_object[:, None], scale[self.supporter], 1.0)
        to_world = owner_R.transpose(0, 2, 1)
        local = self.local
        outward = local.outward / owner_s[:, None, :]
        length = np.sqrt((outward * outward).sum(axis=2))
        length = np.where(length > 0, length, 1.0)
        outward = np.matmul(outward / length[..., None], to_world)
        normal = np.matmul(local.normal[:, None, :], to_world)[:, 0]
        stretch = owner_s[np.arange(len(self.supported)), self.axis]
        return WorldVolumes(
            outward=outward,
            offset=local.offset / length + np.matmul(outward, owner_p[..., None])[..., 0],
            normal=normal,
            level=local.level * stretch + (normal * owner_p).sum(axis=1),
            clearance=local.clearance * stretch,
        )


def contact_templates(problem: Problem, supported: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Corners of the touching faces in object frames at scale 1, and half extents."""
    half = problem.shape_size[supported] / 2
    signs = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    template = np.zeros((len(supported), 4, 3))
    for row, contact in enumerate(problem.contact[supported]):
        axis = int(np.abs(contact).argmax())
        others = [k for k in range(3) if k != axis]
        template[row][:, others] = signs
        template[row][:, axis] = contact[axis]
    return template * half[:, None, :], half


def may_meet(
    problem: Problem, bodies: PosedBodies, surface: Sequence[RestingSurface | None]
) -> Bool[np.ndarray, "b b"]:
    """Which pairs of parts must not overlap: those of unrelated objects, and what encloses a place with what is there.

    Args:
        problem: who holds up whom.
        bodies: every part, posed.
        surface: the place of every object, in the world; None without one.
    """
    owner = bodies.owner
    allowed = ~problem.kin[owner[:, None], owner[None]]
    for i in range(problem.count):
        chain = problem.chain(i)
        for above, below in pairwise(chain):
            place = surface[above]
            if place is None or problem.yielding[i, below]:
                continue
            parts = np.flatnonzero(owner == below)
            rises = _rises(bodies, parts, place, problem.settings.above_m)
            soft, reach_m = problem.firm[i] < 1.0, problem.settings.beside_m
            beside = parts[rises & _stands_beside(bodies, parts, place, reach_m) if soft else rises]
            body_rows = np.flatnonzero(owner == i)
            allowed[np.ix_(body_rows, beside)] = allowed[np.ix_(beside, body_rows)] = True
    return allowed


def _rises(bodies: PosedBodies, parts: np.ndarray, place: RestingSurface, above_m: float) -> Bool[np.ndarray, " k"]:
    """Which parts rise above a place (world) beside its middle.

    One that has the middle of the place inside it encloses nothing: it is the hull of a worktop and of what rises
    behind it, and nothing could stand there.
    """
    vertices, normals = bodies.vertices[parts], bodies.normals[parts]
    middle = place.polygon.mean(axis=0)
    middle = middle + (place.level + above_m - float(middle @ place.normal)) * place.normal
    along = np.einsum("pvc,pfc->pvf", vertices, normals)
    here = normals @ middle
    around = ((along.min(axis=1) <= here) & (here <= along.max(axis=1))).all(axis=1)
    return np.asarray(((vertices @ place.normal).max(axis=1) - place.level > above_m) & ~around)


def _stands_beside(
    bodies: PosedBodies, parts: np.ndarray, place: RestingSurface, beside_m: float
) -> Bool[np.ndarray, " k"]:
    """Which parts lie outside of one of a place's sides (world)."""
    out = np.matmul(bodies.vertices[parts], place.outward.T) - place.offset
    return np.asarray(out.min(axis=1).max(axis=1) > -beside_m)
