"""Depth pictures with known cameras as data sets lay them out: 7-Scenes, ScanNet's older export, Replica, Matterport3D.

Each form is a small function from a folder to frames; `DATA_SET_FORMS` is their table.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from diorama_core.errors import InputError
from diorama_core.importing.depth_frames import (
    UP_Z,
    DepthFrame,
    FrameForm,
    Frames,
    first_of,
    numbers_of,
    size_of,
    text_of,
)
from diorama_core.io.contained import ContainedFiles
from diorama_core.io.file_heads import FileHead
from diorama_core.multiview.posed_photos import OPENCV_FROM_OPENGL
from diorama_core.scene.types import Camera, Intrinsics

SEVEN_SCENES = Intrinsics(640, 480, 585.0, 585.0, 320.0, 240.0)
"""What 7-Scenes' page gives for its depth."""
REPLICA = Intrinsics(1200, 680, 600.0, 600.0, 599.5, 339.5)
"""Intrinsics of NICE-SLAM's renderings of Replica, used where `cam_params.json` is absent."""
REPLICA_STEPS, MATTERPORT_STEPS = 6553.5, 4000.0
"""Steps of depth a metre."""


def seven_scenes_frames(folder: Path) -> Frames:
    """`frame-000000.depth.png` (or .pgm) in millimetres with `frame-000000.pose.txt`, also in folders `seq-01`."""
    files, frames = ContainedFiles(folder, InputError), []
    info = text_of(folder / "_info.txt") or text_of(folder / "info.txt")
    stated = re.search(r"m_calibrationDepthIntrinsic\s*=([^\n]*)", info)
    known = None if stated is None else np.array(stated[1].split(), float)
    for depth in _find(folder, files, "*.depth.png", "*.depth.pgm"):
        stem = depth.name.split(".")[0]
        pose = depth.with_name(f"{stem}.pose.txt")
        T = numbers_of(pose) if files.holds(pose) else np.full((4, 4), np.nan)
        if T.shape != (4, 4) or not np.isfinite(T).all():
            continue
        size = size_of(depth)
        k = SEVEN_SCENES.resize(*size)
        if known is not None and len(known) >= 7:
            k = Intrinsics(*size, known[0], known[5], known[2], known[6])
        pictures = (depth.with_name(f"{stem}.color.{ending}") for ending in ("png", "jpg"))
        frames.append(DepthFrame(depth, Camera(k, T), None, first_of(files, *pictures)))
    return Frames(tuple(frames), None, () if known is not None else ("the camera is 7-Scenes' own (585 pixels)",))


def replica_frames(folder: Path) -> Frames:
    """`results/depth000000.png` with a row of 16 numbers each in `traj.txt`; the scale in `cam_params.json`."""
    files = ContainedFiles(folder, InputError)
    rows = numbers_of(folder / "traj.txt")
    if rows.shape[1:] != (16,):
        raise InputError(f"{folder / 'traj.txt'} has not 16 numbers a row; take the one beside the pictures")
    k, steps = REPLICA, REPLICA_STEPS
    text = text_of(folder / "cam_params.json")
    if text:
        given = json.loads(text)["camera"]
        k = Intrinsics(given["w"], given["h"], *(float(given[key]) for key in ("fx", "fy", "cx", "cy")))
        steps = float(given["scale"])
    frames = []
    for depth, row in zip(_find(folder, files, "results/depth*.png"), rows, strict=False):
        picture = first_of(files, *depth.parent.glob(depth.stem.replace("depth", "frame") + ".*"))
        camera = Camera(k.resize(*size_of(depth)), row.reshape(4, 4))
        frames.append(DepthFrame(depth, camera, None, picture, 1 / steps))
    notes = () if text else ("the camera is that of NICE-SLAM's Replica (600 of 1200 pixels)",)
    return Frames(tuple(frames), None, notes)


def matterport_frames(folder: Path) -> Frames:
    """`undistorted_depth_images` in 1/4000 m, with cameras that look along -z in `undistorted_camera_parameters`."""
    files, frames = ContainedFiles(folder, InputError), []
    depths = {p.name: p for p in _find(folder, files, "undistorted_depth_images/**/*.png")}
    pictures = {p.name: p for p in _find(folder, files, "undistorted_color_images/**/*.jpg")}
    k = np.eye(3)
    for conf in _find(folder, files, "undistorted_camera_parameters/**/*.conf"):
        for words in (line.split() for line in text_of(conf).splitlines()):
            if words[:1] == ["intrinsics_matrix"]:
                k = np.array(words[1:10], float).reshape(3, 3)
            if words[:1] != ["scan"] or len(words) < 19 or words[1] not in depths:
                continue
            depth = depths[words[1]]
            T = np.array(words[3:19], float).reshape(4, 4) @ OPENCV_FROM_OPENGL
            camera = Camera(Intrinsics(*size_of(depth), k[0, 0], k[1, 1], k[0, 2], k[1, 2]), T)
            frames.append(DepthFrame(depth, camera, None, pictures.get(words[2]), 1 / MATTERPORT_STEPS))
    return Frames(tuple(frames), UP_Z, ("depth of Matterport3D, in 1/4000 m",))


def _find(folder: Path, files: ContainedFiles, *patterns: str) -> Iterator[Path]:
    return filter(files.holds, sorted(path for pattern in patterns for path in folder.rglob(pattern)))


def _has(head: FileHead, *words: str) -> bool:
    return head.is_folder and all(any(word in f"/{name}" for name in head.names) for word in words)


DATA_SET_FORMS = (
    FrameForm("7-Scenes, ScanNet frames", lambda h: _has(h, ".depth.p", ".pose.txt"), seven_scenes_frames),
    FrameForm("Replica frames", lambda h: _has(h, "/traj.txt", "/results/depth"), replica_frames),
    FrameForm(
        "Matterport3D frames",
        lambda h: _has(h, "/undistorted_depth_images/", "/undistorted_camera_parameters/"),
        matterport_frames,
    ),
)
"""The first that tells a folder is its form."""
