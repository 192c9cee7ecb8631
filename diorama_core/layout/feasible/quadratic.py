"""Least-distance programs: the smallest move that satisfies linear inequalities, by the dual."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float
from scipy.linalg import solve_triangular
from scipy.optimize import nnls

HARD = 1e-9
SOFT = 1e-5
"""Compliance of soft rows: how far (metres, per unit of dual force) a row yields when it conflicts with others."""
_TINY = 1e-10


def least_distance(
    G: Float[np.ndarray, "m v"], h: Float[np.ndarray, " m"], compliance: Float[np.ndarray, " m"]
) -> Float[np.ndarray, " v"]:
    """The y of least norm with G y >= h, where row k may yield at the cost of its compliance.

    Solves min |y|^2 + sum s_k^2 / compliance_k subject to G y + s >= h: always feasible. Rows enter only once they
    are violated, so the cost follows the number of active rows.
    """
    y = np.zeros(G.shape[1])
    active = np.flatnonzero(h > _TINY)
    if not len(active):
        return y
    passive = np.ones(len(active), dtype=bool)
    for _ in range(30):
        rows = G[active]
        force = _nonnegative(rows @ rows.T + np.diag(compliance[active]), h[active], passive)
        y = rows.T @ force
        short = h - G @ y
        short[active] = 0.0
        fresh = np.flatnonzero(short > 1e-9)
        if not len(fresh):
            break
        passive = np.concatenate([force > 0, np.ones(len(fresh), dtype=bool)])
        active = np.concatenate([active, fresh])
    return y


def _nonnegative(
    Q: Float[np.ndarray, "m m"], h: Float[np.ndarray, " m"], passive: Bool[np.ndarray, " m"]
) -> Float[np.ndarray, " m"]:
    """The f >= 0 with Q f >= h and complementarity (Q positive definite), by block principal pivoting.

    Júdice and Pires 1994: exchange all infeasible indices at once. Where that stops helping, non-negative least squares
    (Lawson and Hanson 1974), which never cycles and takes far fewer solves than exchanging one index at a time.
    """
    m, patience, fewest = len(h), 3, len(h) + 1
    passive = passive.copy()
    f = np.zeros(m)
    while patience >= 0:
        f[:] = 0.0
        chosen = np.flatnonzero(passive)
        if len(chosen):
            f[chosen] = np.linalg.solve(Q[np.ix_(chosen, chosen)], h[chosen])
        slack = Q @ f - h
        wrong = (passive & (f < -_TINY)) | (~passive & (slack < -_TINY))
        count = int(wrong.sum())
        if count == 0:
            return np.maximum(f, 0.0)
        fewest, patience = (count, 3) if count < fewest else (fewest, patience - 1)
        passive ^= wrong
    L = np.linalg.cholesky(Q)
    return np.asarray(nnls(L.T, solve_triangular(L, h, lower=True), maxiter=30 * m)[0])
