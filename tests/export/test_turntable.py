"""Films of a scene, read back frame by frame."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from diorama_core.errors import Cancelled, ExportError
from diorama_core.export.turntable import orbit_cameras, write_turntable
from diorama_core.scene.types import Scene
from tests.export.scenes import stopping_at
from tests.primitives import PrimitiveLibrary, furnished_room

LIBRARY = PrimitiveLibrary()
SMALL = (96, 72)


def test_every_camera_sees_everything_from_one_distance() -> None:
    scene = furnished_room(LIBRARY)
    corners = np.concatenate([p.polygon for p in scene.architecture.planes])
    cameras = orbit_cameras(scene, 12, (320, 200))
    for camera in cameras:
        pixels = camera.project(corners)
        assert (pixels >= 0).all()
        assert (pixels <= [320, 200]).all()
    middle = corners.mean(axis=0)
    distances = [np.linalg.norm(c.position - (corners.min(axis=0) + corners.max(axis=0)) / 2) for c in cameras]
    np.testing.assert_allclose(distances, distances[0])
    assert all(c.position[2] > middle[2] for c in cameras)


def test_gif_has_every_frame_and_repeats(tmp_path) -> None:
    write_turntable(furnished_room(LIBRARY), LIBRARY, tmp_path / "room.gif", size=SMALL, frames=4)
    with Image.open(tmp_path / "room.gif") as film:
        assert (film.n_frames, film.size, film.info["loop"]) == (4, SMALL, 0)
        frames = []
        for number in range(4):
            film.seek(number)
            frames.append(np.asarray(film.convert("RGB")).astype(int))
    assert all(np.abs(a - b).mean() > 1 for a, b in zip(frames, frames[1:] + frames[:1], strict=True))


def test_mp4_is_h264_in_the_colours_of_the_scene(tmp_path) -> None:
    av = pytest.importorskip("av", reason="needs the extra [video]")
    write_turntable(furnished_room(LIBRARY), LIBRARY, tmp_path / "room.mp4", size=SMALL, frames=4)
    with av.open(str(tmp_path / "room.mp4")) as film:
        stream = film.streams.video[0]
        assert stream.codec_context.name == "h264"
        assert stream.codec_context.pix_fmt == "yuv420p"
        frames = [f.to_ndarray(format="rgb24") for f in film.decode(stream)]
    assert [f.shape for f in frames] == [(72, 96, 3)] * 4
    write_turntable(furnished_room(LIBRARY), LIBRARY, tmp_path / "room.gif", size=SMALL, frames=4)
    with Image.open(tmp_path / "room.gif") as still:
        assert np.abs(np.asarray(still.convert("RGB")).astype(int) - frames[0]).mean() < 12


def test_cancelling_leaves_nothing(tmp_path) -> None:
    for name in ("room.gif", "room.mp4"):
        how = {"size": SMALL, "frames": 3, "progress": stopping_at(0.3)}
        with pytest.raises(Cancelled):
            write_turntable(furnished_room(LIBRARY), LIBRARY, tmp_path / name, **how)
    assert list(tmp_path.iterdir()) == []


def test_other_endings_and_odd_sizes_are_refused(tmp_path) -> None:
    with pytest.raises(ExportError, match=r"\.mp4 or \.gif"):
        write_turntable(Scene(), LIBRARY, tmp_path / "room.avi")
    with pytest.raises(ExportError, match="even"):
        write_turntable(Scene(), LIBRARY, tmp_path / "room.mp4", size=(97, 72))
