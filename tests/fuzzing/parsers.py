"""Everything that reads bytes from outside, each with small samples and a way to damage them."""

from __future__ import annotations

import io
import json
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import trimesh
from PIL import Image

from diorama_core.artefacts import Inputs
from diorama_core.io.limited import LimitedProcess
from diorama_core.library.ingest.limits import Limits
from diorama_core.perception import exr
from diorama_core.pipeline import codec
from diorama_core.project.storage import Project
from diorama_core.scene.schema import scene_from_json, scene_to_json
from tests.app.small_room import PlainLibrary, furnished_scene, make_project, plain_photo
from tests.fuzzing import dropped_files as drops
from tests.fuzzing import form_files as forms
from tests.fuzzing import input_files as inputs
from tests.fuzzing import kept_files as kept
from tests.fuzzing import measured_files as measured
from tests.fuzzing import scene_files as files
from tests.fuzzing import words
from tests.fuzzing.mutate import Mutate, damaged, strange_glb, strange_json, strange_usd, strange_zip
from tests.fuzzing.photo_readers import as_photo, with_boxes, with_depth, with_masks

CORPUS = Path(__file__).parent / "corpus"
"""Small files that once broke a reader; a case is named after its parser."""

limited = LimitedProcess(seconds=20.0)
roomy = LimitedProcess(memory=4_000_000_000, seconds=180.0)
"""As the editor opens scenes: OpenUSD alone reserves more than a picture needs."""


@dataclass(frozen=True)
class Parser:
    """A reader of bytes from outside. It returns, or raises a `DioramaError`: anything else is a finding."""

    samples: Callable[[], tuple[bytes, ...]]
    read: Callable[[bytes], object]
    mutate: Mutate
    round: int = 60
    """Inputs of a round among the tests."""


def _picture(kind: str, size: tuple[int, int] = (96, 64), mode: str = "RGB", **options: object) -> bytes:
    buffer = io.BytesIO()
    Image.new(mode, size, (90, 120, 200) if mode == "RGB" else 90).save(buffer, kind, **options)
    return buffer.getvalue()


def _photo() -> bytes:
    rows = np.linspace(0, 255, 64)[:, None, None] * np.ones((1, 96, 3))
    buffer = io.BytesIO()
    exif = Image.Exif()
    exif[0x0112] = 6
    Image.fromarray(rows.astype(np.uint8)).save(buffer, "JPEG", exif=exif)
    return buffer.getvalue()


def _photos() -> tuple[bytes, ...]:
    kinds = ("PNG", "WEBP", "BMP", "TIFF", "GIF", "PPM")
    return (_photo(), *(_picture(kind) for kind in kinds), _picture("PNG", mode="P"), _picture("PNG", mode="I;16"))


def _depths() -> tuple[bytes, ...]:
    down = np.maximum(np.arange(64) - 24, 1)[:, None] / (0.8 * 96) * np.ones((1, 96))
    metres = np.minimum(1.4 / down, 4.0).astype(np.float32)  # a floor before a wall
    npy, png = io.BytesIO(), io.BytesIO()
    np.save(npy, metres)
    Image.fromarray((metres * 1000).astype(np.uint16)).save(png, "PNG")
    return npy.getvalue(), png.getvalue()


def _exrs() -> tuple[bytes, ...]:
    folder = Path(__file__).parents[1] / "perception" / "exr"
    return tuple(p.read_bytes() for p in sorted(folder.glob("*.exr")))


def _masks() -> tuple[bytes, ...]:
    colours = np.zeros((64, 96, 3), np.uint8)
    colours[10:30, 10:40], colours[35:60, 50:90] = (255, 0, 0), (0, 255, 0)
    buffers = [io.BytesIO() for _ in range(3)]
    Image.fromarray(colours).save(buffers[0], "PNG")
    Image.fromarray(colours).quantize(8).save(buffers[1], "PNG")
    Image.fromarray(colours[..., 0] // 255).save(buffers[2], "PNG")
    return tuple(b.getvalue() for b in buffers)


def _boxes() -> tuple[bytes, ...]:
    rows = [{"bbox": [5, 5, 40, 50], "class": "chair", "score": 0.5}, {"bbox": [45, 8, 90, 60], "class": "night_stand"}]
    return (json.dumps(rows).encode(),)


def _scenes() -> tuple[bytes, ...]:
    return (scene_to_json(furnished_scene()).encode(),)


def _stages() -> tuple[bytes, ...]:
    inputs = Inputs(plain_photo(48, 36), depth_m=np.ones((36, 48), np.float32))
    return codec.dump(inputs), codec.dump((furnished_scene(), ())), codec.dump((np.zeros((4, 5), bool),))


def _stage(data: bytes) -> object:
    return codec.load(data, Inputs)


def _inside(read: Callable[[bytes], object]) -> Callable[[bytes], object]:
    """In the decoding process, so that a crash is a line there too."""
    return lambda data: limited.call("the file", read, data)


def _in_process(read: Callable[[bytes], object]) -> Callable[[bytes], object]:
    """As `_inside`, for readers whose own leaks are told apart from the process's lines."""

    def through(data: bytes) -> object:
        value = roomy.call("the file", read, data)
        if isinstance(value, files.Leaked):
            raise RuntimeError(f"{value.what}\n{value.where}")
        return value

    return through


@cache
def _project() -> Project:
    folder = Path(tempfile.mkdtemp(prefix="fuzz-"))
    return make_project(folder / "demo")


def _infos() -> tuple[bytes, ...]:
    return ((_project().folder / "project.json").read_bytes(),)


def _as_info(data: bytes) -> object:
    project = _project()
    path = project.folder / "project.json"
    good = path.read_bytes()
    try:
        path.write_bytes(data)
        opened = Project.open(project.folder)
        json.dumps([opened.name], ensure_ascii=False).encode()
        opened.update_info(note="x")
        return opened
    finally:
        path.write_bytes(good)


def _as_inputs(data: bytes) -> object:
    path = _project().stages_folder / "inputs.zip"
    path.write_bytes(data)
    return _project().load_inputs()


def _inputs() -> tuple[bytes, ...]:
    return (codec.dump(Inputs(plain_photo(48, 36), depth_m=np.ones((36, 48), np.float32))),)


def _textures() -> tuple[bytes, ...]:
    return _photo(), _picture("PNG"), _picture("WEBP")


def _as_texture(data: bytes) -> object:
    path = _project().folder / "textures" / "floor.jpg"
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(data)
    return _project().texture("floor")


def _used_scene(data: bytes) -> object:
    """Whatever passes the schema can be written, shown and exported."""
    from diorama_app.panels.outliner import tree_html
    from diorama_core.export.gltf import glb_bytes

    scene = scene_from_json(data)
    scene_to_json(scene).encode()
    tree_html(scene, ()).encode()
    return glb_bytes(scene, PlainLibrary())


def _model(suffix: str) -> Callable[[bytes], object]:
    def read(data: bytes) -> object:
        from diorama_core.library.ingest.models import read_model
        from diorama_core.library.ingest.repair import repair

        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"model{suffix}"
            path.write_bytes(data)
            (Path(folder) / "model.mtl").write_bytes(_MTL)
            return repair(read_model(path, Path(folder), Limits()).scene, Limits())

    return read


_MTL = b"newmtl wood\nKd 0.5 0.4 0.3\nNs 10\nmap_Kd wood.png\n"
_OBJ = b"""mtllib model.mtl
o seat
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
vt 0 0
vt 1 0
vt 1 1
vn 0 0 1
usemtl wood
f 1/1/1 2/2/1 3/3/1
f 1 3 4
f 1 2 5
"""


def _mesh(kind: str) -> bytes:
    return bytes(trimesh.creation.box((0.5, 0.4, 0.9)).export(file_type=kind))


def _mtl(data: bytes) -> object:
    from diorama_core.library.ingest.models import read_model
    from diorama_core.library.ingest.repair import repair

    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "model.obj").write_bytes(_OBJ)
        (Path(folder) / "model.mtl").write_bytes(data)
        (Path(folder) / "wood.png").write_bytes(_picture("PNG"))
        return repair(read_model(Path(folder) / "model.obj", Path(folder), Limits()).scene, Limits())


def _language(data: bytes) -> object:
    from diorama_core.perception.language.replies import json_in

    return json_in(data.decode("utf-8", "replace"))


def _archives() -> tuple[bytes, ...]:
    buffers = [io.BytesIO() for _ in range(2)]
    values = {"a": np.arange(60, dtype=np.float32).reshape(3, 20), "b": np.array(["chair", "table"])}
    np.savez(buffers[0], **values)
    np.savez_compressed(buffers[1], **values)
    return tuple(b.getvalue() for b in buffers)


def _cached(data: bytes) -> object:
    """Files that can be made again: they are read or they are absent, and nothing is raised."""
    from diorama_core.io.derived import read_arrays

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "file.npz"
        path.write_bytes(data)
        return read_arrays(path, "a", "b")


def _records() -> tuple[bytes, ...]:
    from diorama_core.library.record import shape_to_json

    return tuple(shape_to_json(PlainLibrary().shape(name)).encode() for name in ("table_a", "lamp_a"))


def _record(data: bytes) -> object:
    from diorama_core.library.record import shape_from_json

    return shape_from_json(data.decode("utf-8", "replace"))


def _metadata(data: bytes) -> object:
    import gzip

    from diorama_core.library.datasets import read_json

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "models.json.gz"
        path.write_bytes(gzip.compress(data, 1) if data[:1] in b"[{" else data)
        return read_json(path)


PARSERS: dict[str, Parser] = {
    "photo": Parser(_photos, _inside(as_photo), damaged),
    "depth": Parser(_depths, _inside(with_depth), damaged),
    "exr": Parser(_exrs, exr.read_depth_channels, damaged),
    "masks": Parser(_masks, _inside(with_masks), damaged),
    "boxes": Parser(_boxes, with_boxes, strange_json),
    "boxforms": Parser(inputs.box_samples, inputs.read_boxes, inputs.strange_text),
    "depths": Parser(inputs.depth_samples, _inside(inputs.read_depth), inputs.strange_masks, round=30),
    "maskforms": Parser(inputs.mask_samples, _inside(inputs.read_masks), inputs.strange_masks),
    "photoforms": Parser(inputs.photo_samples, _inside(as_photo), damaged),
    "sorting": Parser(inputs.sorting_samples, _inside(inputs.read_sort), inputs.strange_masks),
    "dropped": Parser(drops.dropped_samples, _in_process(drops.read_dropped), damaged, round=15),
    "drops": Parser(lambda: drops.dropped_samples()[-3:], _in_process(drops.read_dropped), strange_zip, round=15),
    "confidence": Parser(drops.confidence_samples, _inside(drops.read_confidence), damaged),
    "scene": Parser(_scenes, _used_scene, strange_json),
    "stage": Parser(_stages, _stage, strange_zip),
    "project": Parser(_infos, _as_info, strange_json),
    "inputs": Parser(_inputs, _as_inputs, strange_zip),
    "texture": Parser(_textures, _as_texture, damaged),
    "glb": Parser(lambda: (_mesh("glb"),), _model(".glb"), strange_glb),
    "obj": Parser(lambda: (_OBJ,), _model(".obj"), damaged),
    "ply": Parser(lambda: (_mesh("ply"),), _model(".ply"), damaged),
    "stl": Parser(lambda: (_mesh("stl"),), _model(".stl"), damaged),
    "language": Parser(
        lambda: (b"Here it is:\n```json\n" + _boxes()[0] + b"\n```", b'{"a": {"b": [1]}}'), _language, damaged
    ),
    "mtl": Parser(lambda: (_MTL,), _mtl, damaged),
    "cached": Parser(_archives, _cached, strange_zip),
    "record": Parser(_records, _record, strange_json),
    "metadata": Parser(lambda: (b'[{"id": "a", "category": "chair", "size": [1, 2.5]}]',), _metadata, strange_json),
    "nerfstudio": Parser(files.nerfstudio_samples, files.read_nerfstudio, strange_json),
    "colmap": Parser(lambda: files.colmap_samples(".txt"), files.colmap_reader(".txt"), files.one_damaged),
    "colmapbin": Parser(lambda: files.colmap_samples(".bin"), files.colmap_reader(".bin"), files.one_damaged),
    "arkit": Parser(files.arkit_samples, files.read_arkit, strange_json),
    "roomplan": Parser(files.roomplan_samples, files.read_roomplan, strange_json),
    "camera": Parser(files.side_camera_samples, files.read_side_camera, strange_json),
    "marked": Parser(files.marked_samples, files.read_marked, strange_glb),
    "usd": Parser(files.usd_samples, _in_process(files.read_usd), strange_usd),
    "home": Parser(files.home_samples, files.read_home, strange_zip),
    "cloud": Parser(measured.cloud_samples, _in_process(measured.read_cloud), measured.strange_cloud, round=15),
    "frame": Parser(measured.frame_samples, _in_process(measured.read_frame), measured.strange_frame, round=15),
    "plan": Parser(measured.plan_samples, _in_process(measured.read_plan), damaged),
    "compressed": Parser(forms.compressed_samples, _in_process(forms.read_as_model(".glb")), strange_glb, round=15),
    "backwards": Parser(lambda: (forms.OBJ_BACKWARDS,), forms.read_as_model(".obj"), damaged),
    "dae": Parser(lambda: (forms.box("dae"),), _in_process(forms.read_as_model(".dae")), damaged, round=15),
    "threemf": Parser(lambda: (forms.three_mf(),), _in_process(forms.read_as_model(".3mf")), strange_zip, round=15),
    "threeds": Parser(lambda: (forms.three_ds(),), forms.read_as_model(".3ds"), damaged),
    "off": Parser(lambda: (forms.box("off"),), forms.read_as_model(".off"), damaged),
    "archive": Parser(forms.archives, _in_process(forms.read_archive), strange_zip, round=15),
    "arrays": Parser(forms.array_clouds, _in_process(forms.read_array_points), damaged, round=15),
    "text": Parser(forms.text_clouds, _in_process(forms.read_text_points), damaged, round=15),
    "splats": Parser(forms.splat_samples, _in_process(forms.read_splats), damaged, round=15),
    "table": Parser(measured.table_samples, measured.read_models_table, damaged),
    "further": Parser(kept.further_samples, kept.read_further, strange_zip),
    "placed": Parser(kept.placed_samples, kept.read_placed, strange_json),
    "rooms": Parser(words.room_samples, words.read_room_words, words.strange_words),
    "commands": Parser(words.command_samples, words.read_command, words.strange_words),
    "edits": Parser(files.edit_samples, files.read_edits, strange_json),
}
