"""Arrays and transforms as USD's own types."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from pxr import Gf, Sdf, Usd, UsdGeom, Vt
from scipy.spatial.transform import Rotation


def vectors(values: Float[np.ndarray, "n 3"]) -> Vt.Vec3fArray:
    """Rows as single-precision vectors."""
    return Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(values, dtype=np.float32))


def integers(values: np.ndarray) -> Vt.IntArray:
    """Integers."""
    return Vt.IntArray.FromNumpy(np.ascontiguousarray(values, dtype=np.int32))


def extent(points: Float[np.ndarray, "n 3"]) -> Vt.Vec3fArray:
    """Lower and upper corner of the box around points."""
    return vectors(np.stack([points.min(axis=0), points.max(axis=0)]))


def quaternion(R: Float[np.ndarray, "3 3"]) -> Gf.Quatd:
    """A rotation matrix (acting on columns) as quaternion."""
    w, x, y, z = (float(v) for v in Rotation.from_matrix(R).as_quat(canonical=True, scalar_first=True))
    return Gf.Quatd(w, x, y, z)


def note(prim: Usd.Prim, name: str, text: str) -> None:
    """Say something of a prim for when the file is read back."""
    prim.CreateAttribute(f"diorama:{name}", Sdf.ValueTypeNames.String, custom=True).Set(text)


def place(xform: UsdGeom.Xformable, T: Float[np.ndarray, "4 4"]) -> None:
    """Give a prim a rigid transform, as a translation and an orientation."""
    xform.AddTranslateOp(UsdGeom.XformOp.PrecisionDouble).Set(Gf.Vec3d(*(float(v) for v in T[:3, 3])))
    xform.AddOrientOp(UsdGeom.XformOp.PrecisionDouble).Set(quaternion(T[:3, :3]))
