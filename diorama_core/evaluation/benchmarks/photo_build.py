"""One annotated photo: built, perhaps perturbed, compared with its annotation and pictured, with the ghosts of what is
smeared over the floor's picture that nobody marked.

Ghosts are the share of the floor's picture that differs from the floor's colour by more than `GHOST_DIFFERENCE`
(CIEDE2000): smears are dark, so lightness counts in full. They are measured twice: of the floor as it is built, and of
floors made while every second object that stands on the floor is kept back, one half after the other, against the
colour that the floor has when nothing is.
"""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.architecture.texture.colours import colour_planes
from diorama_core.architecture.texture.plane_textures import plane_textures
from diorama_core.artefacts import DetectedObject
from diorama_core.errors import InputError
from diorama_core.evaluation.adapters.photo_annotations import AnnotatedPhoto
from diorama_core.evaluation.benchmarks.cases import attempt_one
from diorama_core.evaluation.benchmarks.photo_perturbations import AnnotatedInputs, perturb
from diorama_core.evaluation.benchmarks.system import Show
from diorama_core.evaluation.metrics.annotated import ObjectResult, measure, not_built
from diorama_core.evaluation.metrics.colour import delta_e_2000, lab_of, visible_colours
from diorama_core.io.atomic import write_atomically
from diorama_core.io.code_key import code_key
from diorama_core.library.record import ShapeLibrary
from diorama_core.perception.inputs import read_inputs
from diorama_core.pipeline.run import Built, build_scene
from diorama_core.pipeline.settings import with_settings
from diorama_core.pipeline.stages import embedded_stages
from diorama_core.progress import SILENT, Progress
from diorama_core.render.picture import picture
from diorama_core.synthesis.truth import TruthView

GHOST_DIFFERENCE = 10.0
_TEXELS = 40_000
"""Texels of the floor's picture that are looked at, evenly spread."""


def floor_ghosts(built: Built) -> float | None:
    """Share of the floor's picture that is not of its colour; None where it has no picture."""
    floor = built.scene.architecture.floor
    picture = None if floor is None else built.textures.get(floor.id)
    return None if picture is None else ghost_share(picture, usual_colour(picture))


def ghosts_unmarked(built: Built) -> float | None:
    """Share of the floor's picture that is not of its colour when half of what stands on it was not marked.

    Mean over both halves; None where nothing stands on the floor. A floor without a picture is of its plain colour.
    """
    room = built.architecture
    floor = room.architecture.floor
    if floor is None:
        return None
    standing = [edge.child for edge in room.supports if edge.parent == floor.id]
    known = built.textures.get(floor.id)
    colour = np.array(floor.colour) if known is None else usual_colour(known)
    marked = [tuple(o for o in built.objects if o.id not in standing[k::2]) for k in (0, 1)]
    pictures = [_floor_picture(built, objects, frozenset(standing)) for objects in marked if len(standing) > 1]
    return float(np.mean([ghost_share(picture, colour) for picture in pictures])) if pictures else None


def _floor_picture(
    built: Built, objects: tuple[DetectedObject, ...], standing: frozenset[str]
) -> UInt8[np.ndarray, "_ _ 3"]:
    room, camera = built.architecture.architecture, built.geometry.camera
    photo = replace(built.inputs.photo, rgb=built.illuminant.white_balance(built.inputs.photo.rgb))
    inputs = replace(built.inputs, photo=photo)
    room = replace(room, planes=colour_planes(room.planes, inputs.photo.rgb, camera, objects))
    assert room.floor is not None
    plain = np.rint(255 * np.array(room.floor.colour)).astype(np.uint8)[None, None]
    alone = {room.floor.id}
    return plane_textures(inputs, objects, camera, room, standing=standing, only=alone).get(room.floor.id, plain)


def usual_colour(picture: UInt8[np.ndarray, "h w 3"]) -> Float[np.ndarray, "3"]:
    """Median colour, sRGB 0 to 1."""
    return np.asarray(np.median(_spread(picture), axis=0))


def ghost_share(picture: UInt8[np.ndarray, "h w 3"], colour: Float[np.ndarray, "3"]) -> float:
    """Share of a picture that differs from a colour (sRGB 0 to 1) by more than `GHOST_DIFFERENCE`."""
    pixels = lab_of(_spread(picture))
    wanted = np.broadcast_to(lab_of(colour[None]), pixels.shape)
    return float((delta_e_2000(pixels, wanted) > GHOST_DIFFERENCE).mean())


def _spread(picture: UInt8[np.ndarray, "h w 3"]) -> Float[np.ndarray, "n 3"]:
    """At most about `_TEXELS` pixels, evenly spread, 0 to 1."""
    return np.asarray(picture.reshape(-1, 3)[:: max(picture.shape[0] * picture.shape[1] // _TEXELS, 1)] / 255.0)


SIZE = (320, 240)
JPEG_QUALITY = 82


def case_writer(folder: Path, library: ShapeLibrary) -> Show:
    """What the system bench calls to have every case written into a folder, as `living-3-0.jpg`."""
    folder.mkdir(parents=True, exist_ok=True)

    def show(name: str, view: TruthView, results: tuple[Built | None, ...]) -> None:
        write_picture(folder / f"{name}.jpg", case_picture(view, results, library))

    return show


def case_picture(view: TruthView, results: Sequence[Built | None], library: ShapeLibrary) -> UInt8[np.ndarray, "h w 3"]:
    """The photo, then every result through its own camera and from outside; grey where nothing was built."""
    return _strip(view.inputs.photo.rgb, results, library, SIZE)


def _strip(
    photo: UInt8[np.ndarray, "_ _ 3"], results: Sequence[Built | None], library: ShapeLibrary, size: tuple[int, int]
) -> UInt8[np.ndarray, "h w 3"]:
    strip = cv2.resize(photo, size, interpolation=cv2.INTER_AREA)
    for built in results:
        for look in ("photo", "orbit:30"):
            seen = np.full((size[1], size[0], 3), 128, np.uint8)
            if built is not None and (look != "photo" or built.scene.camera is not None):
                seen = picture(built.scene, library, view=look, size=size, textures=built.textures)
            strip = side_by_side(strip, seen, gap=4)
    return strip


def side_by_side(
    photo: UInt8[np.ndarray, "h w 3"], rendering: UInt8[np.ndarray, "k m 3"], gap: int = 8
) -> UInt8[np.ndarray, "h n 3"]:
    """The photo and a rendering of the same height next to one another."""
    height = photo.shape[0]
    width = max(1, round(rendering.shape[1] * height / rendering.shape[0]))
    resized = cv2.resize(rendering, (width, height), interpolation=cv2.INTER_AREA)
    return np.concatenate([photo, np.full((height, gap, 3), 255, np.uint8), resized], axis=1)


def grid(tiles: Sequence[UInt8[np.ndarray, "_ _ 3"]], columns: int) -> UInt8[np.ndarray, "_ _ 3"]:
    """Pictures of one size in rows of so many; white where there is none."""
    filled = [*tiles, *[np.full_like(tiles[0], 255)] * (-len(tiles) % columns)]
    rows = [np.concatenate(filled[k : k + columns], axis=1) for k in range(0, len(filled), columns)]
    return np.concatenate(rows)


def write_picture(path: Path, rgb: UInt8[np.ndarray, "h w 3"]) -> None:
    """A PNG or JPEG, as the name says."""
    if path.suffix.lower() not in (".png", ".jpg", ".jpeg"):
        raise InputError(f"{path}: a picture is written as .png or .jpg; give such a name")
    quality = [] if path.suffix.lower() == ".png" else [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY]
    _, data = cv2.imencode(path.suffix.lower(), rgb[..., ::-1], quality)
    write_atomically(path, data.tobytes(), error=InputError)


_UNNAMED = "object"
TILE_PX = (400, 300)
"""Size of the photo and of its scene in a sheet."""


@dataclass(frozen=True)
class PhotoTask:
    """One build: a photo, its annotation, and what is changed."""

    name: str
    path: Path
    annotation: AnnotatedPhoto
    """In pixels of the original file."""
    intrinsics: tuple[float, float, float, float] | None = None
    named: bool = True
    """Whether boxes come with their plain words."""
    perturbation: str = ""
    """A name of `PERTURBATIONS`; none where empty."""
    settings: Mapping[str, float] = field(default_factory=dict)
    """Fields of the stages' settings that have other values, as `pipeline.settings` names them."""
    cache: Path | None = None
    """Folder for stage results."""
    tile: Path | None = None
    """Where the photo beside its scene is written."""

    @property
    def title(self) -> str:
        """The photo with its perturbation."""
        return _title(self.name, self.perturbation)

    def key(self) -> str:
        """Names the result: changes with the photo, the annotation, what is changed, and the code."""
        picture = hashlib.sha256(self.path.read_bytes()).hexdigest()
        changed = (self.named, self.perturbation, sorted(self.settings.items()), self.intrinsics)
        text = f"{code_key(__name__)} {picture} {self.annotation.model_dump_json()} {changed}"
        return hashlib.sha256(text.encode()).hexdigest()[:24]


@dataclass(frozen=True)
class PhotoScores:
    """One photo."""

    photo: str
    objects: tuple[ObjectResult, ...]
    ghosts: float | None = None
    """Share of the floor's picture; None where the floor has no picture."""
    ghosts_unmarked: float | None = None
    """Ghosts of floors made without half of what stands on them; None where the photo shows no floor."""
    seconds: float = 0.0
    """Processor time."""
    failure: str = ""
    perturbation: str = ""
    key: str = ""
    """`PhotoTask.key` of the build."""

    @property
    def title(self) -> str:
        """The photo with its perturbation."""
        return _title(self.photo, self.perturbation)


def _title(photo: str, perturbation: str) -> str:
    return f"{photo}, {perturbation}" if perturbation else photo


def build_photo(task: PhotoTask, library: ShapeLibrary, progress: Progress = SILENT) -> PhotoScores:
    """Build and compare one photo; whatever goes wrong, it counts as failed and everything in it as wrong.

    Raises:
        Cancelled: on request.
    """
    begun, key = time.process_time(), task.key()

    def compare() -> PhotoScores:
        case = read_annotated_inputs(task)
        stages = with_settings(embedded_stages(case.inputs, library), task.settings)
        built = build_scene(case.inputs, library, stages=stages, cache=task.cache, progress=progress)
        spent = time.process_time() - begun
        objects = _objects(task.name, case, built, library)
        if task.tile is not None:
            write_picture(task.tile, _strip(case.inputs.photo.rgb, (built,), library, TILE_PX))
        ghosts = floor_ghosts(built), ghosts_unmarked(built)
        return PhotoScores(task.name, objects, *ghosts, spent, "", task.perturbation, key)

    result, failure = attempt_one(task.title, compare)
    if result is not None:
        return result
    wrong = tuple(not_built(task.name, i, annotated) for i, annotated in enumerate(task.annotation.objects))
    spent = time.process_time() - begun
    return PhotoScores(task.name, wrong, None, None, spent, failure, task.perturbation, key)


def read_annotated_inputs(task: PhotoTask) -> AnnotatedInputs:
    """Read what the build is given, with the annotation in the same pixels.

    Raises:
        InputError: the picture cannot be read, or is not of the annotated size.
    """
    stated = task.annotation
    boxes = [{"bbox": o.bbox, "class": o.word if task.named else _UNNAMED} for o in stated.objects]
    inputs = read_inputs(task.path, intrinsics=task.intrinsics, boxes=json.dumps(boxes).encode()).inputs
    if inputs.photo.original_size != stated.size:
        expected, actual = ("{} x {}".format(*size) for size in (stated.size, inputs.photo.original_size))
        raise InputError(f"{task.path}: the annotations are of a picture of {expected} pixels, this one has {actual}")
    size = (inputs.photo.width, inputs.photo.height)
    case = AnnotatedInputs(inputs, stated.resize(size), tuple(range(len(stated.objects))))
    return perturb(case, task.perturbation) if task.perturbation else case


def _objects(name: str, case: AnnotatedInputs, built: Built, library: ShapeLibrary) -> tuple[ObjectResult, ...]:
    """Objects are numbered by their mask ids in the order of the boxes, results as in the photo's own annotation."""
    by_index = {o.mask_id - 1: o for o in built.scene.objects if o.mask_id is not None}
    index_of = {item.id: index for index, item in by_index.items()}
    furniture = {o.mask_id - 1 for o in built.objects}
    shown = visible_colours(built.scene, library, built.textures)
    in_light = {key: built.illuminant.illuminate(colour) for key, colour in shown.items()}
    results = (
        measure(name, i, annotated, by_index[i], built.scene, library, index_of, in_light.get(by_index[i].id))
        if i in by_index
        else not_built(name, i, annotated, opening=i not in furniture)
        for i, annotated in enumerate(case.annotation.objects)
    )
    return tuple(replace(result, index=k) for k, result in zip(case.indices, results, strict=True))
