"""What files that were dropped together are: a photo with what belongs to it, photos, models, a scan; by their content.

Runs in the decoding process. Where two readings are likely both are given, for a person to choose from.
"""

from __future__ import annotations

import io
import tempfile
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np

from diorama_app.projects.folder_photos import DATA, PHOTOS
from diorama_app.projects.packing import is_packed
from diorama_app.projects.reading_again import with_depth
from diorama_app.projects.uploads import Upload
from diorama_core.errors import DioramaError, InputError
from diorama_core.importing.array_clouds import is_array_cloud
from diorama_core.io.contained import content_of, unpack
from diorama_core.io.file_heads import FileHead, head_of, what_else
from diorama_core.perception.inputs.sorting import Recognised, Sort, recognise, recognise_alone
from diorama_core.perception.inputs.source import Source
from diorama_core.progress import Progress

if TYPE_CHECKING:
    from diorama_core.importing.forms import SceneForm, SceneParts
    from diorama_core.library.ingest.models import ModelForm

Action = Literal["photo", "inputs", "photos", "room", "models", "scene", "project"]
"""A project of a photo; more about the open photo; a project each; one room of all; furniture; a project of a scene; a
packed project."""

MAX_FILES, MAX_BYTES, MAX_NAMED = 2000, 1_000_000_000, 6
"""Largest number of dropped files, of bytes they may unpack to, and of file names in a message."""
MIN_ROOM_M = (1.8, 1.8, 1.5)
"""Extents from which several parts in one file may be a room."""
_REFER_TO_PICTURES = ("glTF", "OBJ", "FBX", "USD", "Collada", "3DS")
_SCAN_FILES = ("/raw.glb", "/export.obj", "/export_refined.obj", "/textured_output.obj")
"""By which the folder of a scanner app is told from one of models."""
_FLAT = (b"\xff\xd8\xff", b"\x89PNG", b"GIF8", b"II", b"MM", b"BM", b"\x93NUMPY", b"\x76\x2f\x31\x01", b"RIFF")
"""Beginnings of pictures and arrays, which are no models."""
_FLAT_SUFFIXES = (PHOTOS | DATA) - {".ply", ".zip"}
_POSES = ("transforms.json", "transforms_train.json", "cameras.txt", "cameras.bin")
_BESIDE_POSES = ("images.txt", "images.bin", "points3D.txt", "points3D.bin", "classes.txt", "data.yaml")


@dataclass(frozen=True)
class DroppedPhoto:
    """A photo and the files that belong to it, by their paths in what was dropped."""

    file: str
    beside: tuple[tuple[Sort, str], ...] = ()


@dataclass(frozen=True)
class Reading:
    """One way to take what was dropped."""

    action: Action
    words: str
    """For people, as in "a photo with boxes (LabelMe)"."""
    photos: tuple[DroppedPhoto, ...] = ()
    inputs: tuple[tuple[Sort, str], ...] = ()
    """Inputs of the open photo."""
    poses: str = ""
    """File or folder of the photos' cameras; empty where there is none."""


@dataclass(frozen=True)
class Dropped:
    """What was dropped."""

    readings: tuple[Reading, ...]
    """Likeliest first."""
    left_out: tuple[str, ...] = ()

    def unread(self) -> str:
        """What is not read, for people; empty where everything is."""
        more = f" and {len(self.left_out) - MAX_NAMED} more" if len(self.left_out) > MAX_NAMED else ""
        return f"Left out: {', '.join(self.left_out[:MAX_NAMED])}{more}" if self.left_out else ""


def interpret(content: bytes, name: str, photo_size: tuple[int, int] | None) -> Dropped:
    """What a file, or a zip archive of several, is; beside an open photo of a size, if any.

    Raises:
        InputError: nothing of it is read; says what it is and what to do.
    """
    with tempfile.TemporaryDirectory(prefix="dropped-") as folder:
        path = Path(folder) / (Path(name).name or "file")
        path.write_bytes(content)
        head = head_of(path)
        if not head.is_zip or is_one_file(head):
            return Dropped(_file_readings(path, path.name, photo_size))
        with unpack(path, MAX_BYTES) as inside:
            return _classify_folder(inside, path.name, photo_size)


def is_one_file(head: FileHead) -> bool:
    """Whether a zip archive is a format of its own."""
    if is_packed(head.names):
        return True
    arrays = bool(head.names) and all(n.endswith(".npy") for n in head.names)
    if arrays or _is_flat(head):
        return arrays
    return _model_form(head) is not None or _scene_form(head) is not None or what_else(head) is not None


def _is_flat(head: FileHead) -> bool:
    """Whether photos and small files lie side by side, as in no scan: told without the readers of scans and models."""
    paths = [Path(name) for name in head.names]
    if not paths or any(p.parent != paths[0].parent or p.name.startswith(("frame_", "frame-")) for p in paths):
        return False
    return all(p.suffix.lower() in _FLAT_SUFFIXES for p in paths)


def _model_form(head: FileHead) -> ModelForm | None:
    from diorama_core.library.ingest.models import form_of  # seconds; photos, boxes and depth do without it

    return form_of(head)


def _scene_form(head: FileHead) -> SceneForm | None:
    from diorama_core.importing.forms import SCENE_FORMS  # as above

    return next((form for form in SCENE_FORMS if form.tells(head)), None)


# -- one file -------------------------------------------------------------------------------------------------------


def _file_readings(path: Path, name: str, photo_size: tuple[int, int] | None) -> tuple[Reading, ...]:
    """The readings of a file.

    Raises:
        InputError: it is none that is read.
    """
    head = head_of(path)
    if is_packed(head.names):
        return (Reading("project", "a packed project, as a new one"),)
    flat = (head.head.startswith(_FLAT) and not is_array_cloud(head)) or head.head[4:8] == b"ftyp"
    solid = () if flat or head.text[:1] in ("[", "{", "<") else _solid_readings(path, head)
    if solid and not head.text:
        return solid
    try:
        readings = recognise(path.read_bytes(), name, photo_size)
    except InputError as error:
        solid = solid or (() if flat else _solid_readings(path, head))
        other = what_else(head)
        if not solid and other is not None and other.name != "a picture":
            raise InputError(f"{name} is {other.name}: {other.advice}") from error
        if not solid:
            raise
        return solid
    return (
        *(_sort_reading(what, name) for what in readings),
        *(r for r in solid if r.action != "scene" or _is_readable(path)),
    )


def _sort_reading(what: Recognised, name: str) -> Reading:
    if what.sort == "photo":
        return Reading("photo", what.words, (DroppedPhoto(name),))
    return Reading("inputs", f"{what.words} of the open photo", inputs=((what.sort, name),))


def _solid_readings(path: Path, head: FileHead) -> tuple[Reading, ...]:
    """A model, a scene or a scan; both where a file may be either; none where it is neither."""
    from diorama_core.importing.forms import SceneParts
    from diorama_core.importing.marked import MarkedFile

    model, scene = _model_form(head), _scene_form(head)
    as_model = () if model is None else (Reading("models", f"a model ({model.name}) for the library"),)
    if scene is None:
        return as_model
    as_scene = Reading("scene", f"a scene or scan ({scene.name}), as a new project")
    if model is None:
        return (as_scene,)
    try:
        content = scene.read(path, Progress(), None)
    except (DioramaError, MemoryError):
        return as_model  # taking it in says what is wrong
    if isinstance(content, MarkedFile):
        single = len(content.nodes) == 1 and not content.planes
        return as_model if single else (as_scene,)
    if not isinstance(content, SceneParts):
        return (as_scene,)
    return (as_scene, *as_model) if _may_be_room(content) else as_model


def _is_readable(path: Path) -> bool:
    """Whether a text that may be points has enough of them."""
    scene = _scene_form(head_of(path))
    try:
        return scene is not None and scene.read(path, Progress(), None) is not None
    except (DioramaError, MemoryError):
        return False


def _may_be_room(content: SceneParts) -> bool:
    bounds = np.array([part.whole.bounds for part in content.parts if len(part.whole.vertices)])
    if len(bounds) < 2:
        return False
    return bool((np.sort(bounds[:, 1].max(axis=0) - bounds[:, 0].min(axis=0)) >= sorted(MIN_ROOM_M)).all())


# -- several files --------------------------------------------------------------------------------------------------


def _classify_folder(folder: Path, name: str, photo_size: tuple[int, int] | None) -> Dropped:
    root = content_of(folder)
    if root.is_file():
        return Dropped(_file_readings(root, root.relative_to(folder).as_posix(), photo_size))
    head = head_of(root)
    flat = _is_flat(head)
    scene = None if flat else _scene_form(head)
    if scene is not None and (scene.name != "the mesh of a scanner app" or head.has(*_SCAN_FILES)):
        return Dropped((Reading("scene", f"a scan ({scene.name}), as a new project"),))
    if len(head.names) > MAX_FILES:
        raise InputError(f"{name} holds {len(head.names)} files, more than the {MAX_FILES} that are read at once")
    prefix = root.relative_to(folder).as_posix()
    names = [n if prefix == "." else f"{prefix}/{n}" for n in head.names]
    heads = {n: head_of(folder / n) for n in names}
    models = [] if flat else [n for n, h in heads.items() if h.size and _model_form(h) is not None]
    if models:
        return _classify_models(models, heads, names)
    return _classify_photos(folder, name, names, photo_size)


def _classify_models(models: Sequence[str], heads: dict[str, FileHead], names: Sequence[str]) -> Dropped:
    forms = {form.name for n in models if (form := _model_form(heads[n])) is not None}
    textured = any(f in _REFER_TO_PICTURES for f in forms)
    beside = (".mtl", ".bin", ".jpg", ".jpeg", ".png", ".tga", ".webp", ".ktx2", ".bmp", ".tif") if textured else ()
    out = [Path(n).name for n in names if n not in models and heads[n].suffix not in beside]
    count = "a model" if len(models) == 1 else f"{len(models)} models"
    return Dropped((Reading("models", f"{count} ({', '.join(sorted(forms))}) for the library"),), tuple(out))


def _classify_photos(folder: Path, name: str, names: Sequence[str], photo_size: tuple[int, int] | None) -> Dropped:
    poses = next((n for n in names if Path(n).name in _POSES), "")
    sorts: dict[str, tuple[Recognised, ...]] = {}
    out: list[str] = []
    for file in names:
        if file == poses or Path(file).name in (*_POSES, *_BESIDE_POSES):
            continue
        try:
            sorts[file] = _alone(folder / file)
        except InputError:
            out.append(Path(file).name)
    photos = [n for n, found in sorts.items() if found[0].sort == "photo"]
    inputs = {n: found[0] for n, found in sorts.items() if found[0].sort != "photo"}
    if not photos and not (photo_size and inputs):
        what = "holds no photo, model or scan that can be read"
        raise InputError(f"{name} {what} (in it: {', '.join(Path(n).name for n in names[:3])})")
    if not photos:
        words = _list_of(list(dict.fromkeys(what.words for what in inputs.values())))
        given = tuple((what.sort, n) for n, what in inputs.items())
        return Dropped((Reading("inputs", f"{words} of the open photo", inputs=given),), tuple(out))
    unsure = {n: sorts[n][1] for n in photos if len(sorts[n]) > 1}
    readings = _photo_readings([_group(p, photos, inputs) for p in photos], inputs, poses)
    if len(unsure) == len(photos) - 1 == 1:  # a grey picture beside a photo is its depth, or another photo
        (photo,) = set(photos) - set(unsure)
        readings = (*_photo_readings([_group(photo, [photo], inputs | unsure)], inputs | unsure, ""), *readings)
    used = {n for reading in readings for p in reading.photos for n in (p.file, *(n for _, n in p.beside))}
    out += [Path(n).name for n in inputs if n not in used]
    return Dropped(readings, tuple(out))


def _alone(path: Path) -> tuple[Recognised, ...]:
    """What a file of several is: a picture is depth or masks where it looks so by itself."""
    readings = recognise_alone(path.read_bytes(), path.name)
    words = f"{path.parent.name} {path.stem}".lower()
    hinted = [what for what in readings if what.sort.removesuffix("s") in words]
    return tuple(dict.fromkeys((*hinted, *readings)))


def _group(photo: str, photos: Sequence[str], inputs: dict[str, Recognised]) -> DroppedPhoto:
    """A photo with the files of its name, or with all where it is the only photo; of a sort the first."""
    stem = Path(photo).stem
    own = [n for n in inputs if len(photos) == 1 or Path(n).stem.split(".")[0] == stem]
    beside: list[tuple[Sort, str]] = []
    for n in own:
        sort = inputs[n].sort
        if sort == "masks" or all(sort != other for other, _ in beside):  # an object each, in files of its own
            beside.append((sort, n))
    return DroppedPhoto(photo, tuple(beside))


def _photo_readings(photos: Sequence[DroppedPhoto], inputs: dict[str, Recognised], poses: str) -> tuple[Reading, ...]:
    if len(photos) == 1:
        beside = list(dict.fromkeys(inputs[n].words for _, n in photos[0].beside))
        words = f"a photo ({Path(photos[0].file).name})" + (f" with {_list_of(beside)}" if beside else "")
        return (Reading("photo", words, tuple(photos)),)
    counts = [(sort, sum(any(s == sort for s, _ in p.beside) for p in photos)) for sort in ("boxes", "masks", "depth")]
    beside = [f"{sort} of {count}" for sort, count in counts if count]
    several = f"{len(photos)} photos" + (f" with {_list_of(beside)}" if beside else "")
    cameras = f", cameras from {Path(poses).name}" if poses else ""
    room = Reading("room", f"{several} of one room{cameras}", tuple(photos), poses=poses)
    each = Reading("photos", f"{several} of different rooms, a project each", tuple(photos))
    return (room, each)


def _list_of(words: Sequence[str]) -> str:
    return ", ".join(words[:-1]) + (" and " if len(words) > 1 else "") + words[-1]


_NAMES_CLASSES = (".txt", ".names", ".yaml", ".yml", ".json")
"""Endings of files that may name the classes of boxes."""


def files_of(name: str, content: bytes) -> dict[str, bytes]:
    """The files of an archive by the names that readings have; of any other file itself.

    Raises:
        InputError: the archive is damaged.
    """
    if not content.startswith(b"PK\x03\x04"):
        return {Path(name).name: content}
    with tempfile.TemporaryDirectory(prefix="dropped-") as folder:
        path = Path(folder) / (Path(name).name or "file")
        path.write_bytes(content)
        if is_one_file(head_of(path)):
            return {path.name: content}
        with unpack(path, MAX_BYTES) as inside:
            return {p.relative_to(inside).as_posix(): p.read_bytes() for p in inside.rglob("*") if p.is_file()}


def upload_of(photo: DroppedPhoto, files: Mapping[str, bytes]) -> Upload:
    """A photo with the files that belong to it, each with what lies beside it."""
    sources = with_depth(sources_of(photo.beside, files), None)
    return Upload(
        files[photo.file], Path(photo.file).name, sources.get("depth"), sources.get("boxes"), sources.get("masks")
    )


def sources_of(chosen: Sequence[tuple[Sort, str]], files: Mapping[str, bytes]) -> dict[Sort, Source]:
    """Files by their sort; masks in several files are packed into one."""
    masks = [name for sort, name in chosen if sort == "masks"]
    by_sort = {sort: _source(name, files) for sort, name in chosen}
    if len(masks) > 1:
        packed = io.BytesIO()
        with zipfile.ZipFile(packed, "w") as archive:
            for name in masks:
                archive.writestr(Path(name).name, files[name])
        by_sort["masks"] = Source(packed.getvalue(), "masks.zip")
    return by_sort


def _source(name: str, files: Mapping[str, bytes]) -> Source:
    """A file with the small text files that came with it, which may name its classes."""
    beside = [n for n in files if n != name and Path(n).suffix.lower() in _NAMES_CLASSES]
    return Source(files[name], Path(name).name, companions=tuple(Source(files[n], Path(n).name) for n in beside))
