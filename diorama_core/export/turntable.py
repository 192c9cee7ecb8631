"""A film of the scene seen from all around, as MP4 (H.264, by PyAV) or as GIF (by Pillow)."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import chain
from pathlib import Path

import numpy as np
from jaxtyping import Float, UInt8
from PIL import Image

from diorama_core.errors import ExportError, UnavailableError
from diorama_core.export.files import whole_file
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import SILENT, Progress
from diorama_core.render.lighting import Lighting, studio
from diorama_core.render.picture import ORBIT_ELEVATION_RAD, looking_along, picture
from diorama_core.scene.types import Camera, Intrinsics, Scene, SceneObject

Frame = UInt8[np.ndarray, "h w 3"]
SIZE = (640, 480)
FRAMES, FRAMES_PER_S = 96, 24
FOV_RAD = float(np.radians(32.0))
MARGIN = 0.05


def write_turntable(
    scene: Scene,
    library: ShapeLibrary,
    path: Path,
    *,
    size: tuple[int, int] = SIZE,
    frames: int = FRAMES,
    textures: Mapping[str, UInt8[np.ndarray, "_ _ _"]] | None = None,
    progress: Progress = SILENT,
) -> None:
    """Write a turntable video that loops seamlessly.

    Args:
        scene: What to show; hidden objects are left out.
        library: Where its shapes are.
        path: Ends in .mp4 or .gif; an existing file is replaced when everything went well.
        size: Width and height; H.264 asks for even numbers.
        frames: Pictures in one turn, at `FRAMES_PER_S`.
        textures: Pictures of the planes by `Plane.texture`.
        progress: Where frames are counted and cancelling is noticed.

    Raises:
        ExportError: the ending or the size cannot be used, or the file cannot be written.
        UnavailableError: PyAV is missing for an MP4.
        Cancelled: when asked to stop.
    """
    path = Path(path)
    writers: dict[str, Callable[[Iterator[Frame], Path], None]] = {".mp4": _write_mp4, ".gif": _write_gif}
    write = writers.get(path.suffix.lower())
    if write is None:
        raise ExportError(f"{path}: turntables are written as .mp4 or .gif; choose such a name")
    if write is _write_mp4 and importlib.util.find_spec("av") is None:
        raise UnavailableError("MP4 needs an optional library: pip install 'diorama[video]' (or choose a .gif)")
    if write is _write_mp4 and (size[0] % 2 or size[1] % 2):
        raise ExportError(f"a film of {size[0]}x{size[1]} cannot be made; both sides must be even")

    def pictures() -> Iterator[Frame]:
        light = _steady_light(scene)
        for number, camera in enumerate(orbit_cameras(scene, frames, size)):
            progress.report(number / frames, f"frame {number + 1} of {frames}")
            yield picture(replace(scene, camera=camera), library, textures=textures, light=light)
        progress.report(1.0, "finishing the film")

    with whole_file(path) as temporary:
        write(pictures(), temporary)


def orbit_cameras(scene: Scene, count: int, size: tuple[int, int]) -> tuple[Camera, ...]:
    """Cameras on a circle around the scene, all at one distance, from which everything is in the picture."""
    every = _corners(scene, [o for o in scene.objects if not o.hidden])
    centre = (every.min(axis=0) + every.max(axis=0)) / 2
    width, height = size
    focal = 0.5 * min(size) / float(np.tan(0.5 * FOV_RAD))
    slope = np.array([width, height]) * (0.5 - MARGIN) / focal
    turns = [_axes(angle) for angle in np.linspace(0, 2 * np.pi, count, endpoint=False)]
    distance = max(_distance((every - centre) @ R, slope) for R in turns)
    intrinsics = Intrinsics(width, height, focal, focal, width / 2, height / 2)
    cameras = []
    for R in turns:
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = R, centre - distance * R[:, 2]
        cameras.append(Camera(intrinsics, T))
    return tuple(cameras)


def _corners(scene: Scene, objects: Iterable[SceneObject]) -> Float[np.ndarray, "n 3"]:
    """Corners of the room and of objects; those of a box where there are none."""
    points = [*(p.polygon for p in scene.architecture.planes), *(o.corners_world for o in objects)]
    return np.concatenate(points) if points else np.array([[-0.5, -0.5, 0.0], [0.5, 0.5, 1.0]])


def _axes(angle_rad: float) -> Float[np.ndarray, "3 3"]:
    flat = np.array([-np.sin(angle_rad), np.cos(angle_rad), 0.0]) * np.cos(ORBIT_ELEVATION_RAD)
    return looking_along(flat - np.array([0.0, 0.0, np.sin(ORBIT_ELEVATION_RAD)]))


def _distance(points_camera: Float[np.ndarray, "n 3"], slope: Float[np.ndarray, "2"]) -> float:
    """How far to stand back so that all points are within the slopes."""
    return float((np.abs(points_camera[:, :2]) / slope - points_camera[:, 2:]).max())


def _steady_light(scene: Scene) -> Lighting:
    """Light that stays where it is while the viewer walks around."""
    every = _corners(scene, scene.objects)
    return studio(np.stack([every.min(axis=0), every.max(axis=0)]), np.array([0.0, -1.0, 0.0]))


def _write_mp4(frames: Iterator[Frame], path: Path) -> None:
    import av

    first = next(frames)
    with av.open(str(path), "w", format="mp4", options={"movflags": "faststart"}) as film:
        stream = film.add_stream("libx264", rate=Fraction(FRAMES_PER_S), options={"crf": "20", "preset": "medium"})
        stream.height, stream.width = first.shape[:2]
        stream.pix_fmt = "yuv420p"
        for pixels in chain([first], frames):
            film.mux(stream.encode(av.VideoFrame.from_ndarray(np.ascontiguousarray(pixels), format="rgb24")))
        film.mux(stream.encode(None))


def _write_gif(frames: Iterator[Frame], path: Path) -> None:
    """One palette for all frames, so that still parts do not flicker."""
    first = Image.fromarray(next(frames)).quantize(255, dither=Image.Dither.NONE)
    later = (Image.fromarray(f).quantize(palette=first, dither=Image.Dither.NONE) for f in frames)
    duration = round(1000 / FRAMES_PER_S)
    first.save(path, "GIF", save_all=True, append_images=later, duration=duration, loop=0, optimize=False)
