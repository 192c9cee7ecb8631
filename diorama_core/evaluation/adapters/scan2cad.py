"""ScanNet frames (the 25k subset) with Scan2CAD's alignments of ShapeNet models.

Frames: `<scans>/<scene>/{color,depth,instance,pose}/<frame>.*` and `intrinsic/intrinsic_depth.txt` as the ScanNet
exporter writes them (depth in millimetres, `pose` camera to world). `full_annotations.json` is Scan2CAD's own.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import Inputs
from diorama_core.errors import InputError
from diorama_core.evaluation.adapters.files import existing, read_json, read_matrix
from diorama_core.geometry.rotations import rotation_from_quaternion
from diorama_core.perception.inputs import read_inputs
from diorama_core.scene.types import Camera

SHAPENET_CATEGORIES: dict[str, str] = {
    "02747177": "trash can", "02808440": "bathtub", "02818832": "bed", "02871439": "bookshelf", "02933112": "cabinet",
    "03001627": "chair", "03211117": "monitor", "04256520": "sofa", "04379243": "table",
}  # fmt: skip
"""Scan2CAD's nine classes by WordNet offset; every other one is "object"."""


@dataclass(frozen=True, eq=False)
class AlignedModel:
    """One ShapeNet model where Scan2CAD put it."""

    category: str
    R_world_object: Float[np.ndarray, "3 3"]
    """Object frame as ours: +X front, +Z up (ShapeNet's are -Z front, +Y up)."""
    centre: Float[np.ndarray, "3"]
    """World of the scan: +Z up."""
    size_m: Float[np.ndarray, "3"]
    """Along the object's own axes: depth, width, height."""
    symmetry: int


@dataclass(frozen=True, eq=False)
class ScanFrame:
    """One picture of a scan with the models in it."""

    name: str
    inputs: Inputs
    camera: Camera
    models: tuple[AlignedModel, ...]


_SYMMETRY = {"__SYM_NONE": 1, "__SYM_ROTATE_UP_2": 2, "__SYM_ROTATE_UP_4": 4, "__SYM_ROTATE_UP_INF": 36}
_R_SHAPENET_OBJECT = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]])
"""Our object axes (front, left, up) as ShapeNet's (right, up, backward)."""


def read_scan2cad(scans: Path, annotations: Path, scene: str, frame: str) -> ScanFrame:
    """Read one frame of a scan and its aligned models; `InputError` says what is missing.

    Args:
        scans: folder of ScanNet's scans.
        annotations: Scan2CAD's file.
        scene: id of the scan.
        frame: number of the picture.
    """
    root = scans / scene
    record = next((r for r in read_json(annotations) if r["id_scan"] == scene), None)
    if record is None:
        raise InputError(f"{annotations}: scan {scene} is not annotated")
    K = read_matrix(root / "intrinsic" / "intrinsic_depth.txt", 4, 4)
    pose = read_matrix(root / "pose" / f"{frame}.txt", 4, 4)
    if not np.isfinite(pose).all():
        raise InputError(f"{root}/pose/{frame}.txt: the camera was lost in this frame; take another")
    photo = existing(root / "color", f"{frame}.jpg", f"{frame}.png")
    inputs = read_inputs(
        photo,
        depth=existing(root / "depth", f"{frame}.png"),
        intrinsics=(K[0, 0], K[1, 1], K[0, 2], K[1, 2]),
        masks=existing(root / "instance", f"{frame}.png"),
    ).inputs
    if inputs.intrinsics is None:
        raise InputError(f"{root}/intrinsic/intrinsic_depth.txt: no intrinsics could be read")
    world = _matrix(record["trs"])
    models = tuple(_model(m, world) for m in record["aligned_models"])
    return ScanFrame(f"{scene}/{frame}", inputs, Camera(inputs.intrinsics, pose), models)


def _matrix(trs: dict[str, list[float]]) -> Float[np.ndarray, "4 4"]:
    """Translation, rotation (w, x, y, z) and scale as one matrix."""
    M = np.eye(4)
    M[:3, :3] = rotation_from_quaternion(np.array(trs["rotation"])) * np.array(trs["scale"])
    M[:3, 3] = trs["translation"]
    return M


def _model(record: dict[str, Any], scan: Float[np.ndarray, "4 4"]) -> AlignedModel:
    """Scan2CAD aligns to its own world; `scan` maps the ScanNet scan into that world."""
    M = np.linalg.inv(scan) @ _matrix(record["trs"])
    box = np.eye(4)
    box[:3, 3] = np.array(record["center"], dtype=np.float64)
    M = M @ box
    scale = np.linalg.norm(M[:3, :3], axis=0)
    half = np.array(record["bbox"], dtype=np.float64)
    sizes = 2 * half * scale
    category = SHAPENET_CATEGORIES.get(str(record["catid_cad"]), "object")
    return AlignedModel(
        category=category,
        R_world_object=(M[:3, :3] / scale) @ _R_SHAPENET_OBJECT,
        centre=M[:3, 3],
        size_m=sizes[[2, 0, 1]],
        symmetry=_SYMMETRY.get(str(record.get("sym", "__SYM_NONE")), 1),
    )
