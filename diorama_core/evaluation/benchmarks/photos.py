"""Photos against what a person annotated in them: kinds, form, colours, fronts, what carries what, outlines, ghosts.

Every photo is built from the annotated boxes with their plain words, or without words. Ghosts are what nobody marked
and what is smeared over the floor nevertheless: the share of its picture that differs from the floor's colour by
more than `GHOST_DIFFERENCE` (CIEDE2000): smears are dark, so lightness counts in full. It is measured twice: of the
floor as it is built, and of floors made while every second object that stands on the floor is kept back, one half after
the other, against the colour that the floor has when nothing is.
"""

from __future__ import annotations

import json
import logging
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.architecture.texture.colours import coloured
from diorama_core.architecture.texture.plane_textures import plane_textures
from diorama_core.artefacts import DetectedObject, Inputs
from diorama_core.errors import Cancelled, InputError
from diorama_core.evaluation.adapters.photo_annotations import (
    AnnotatedPhoto,
    picture_of,
    read_annotations,
    read_intrinsics,
)
from diorama_core.evaluation.metrics.annotated import ObjectResult, measured, not_built
from diorama_core.evaluation.metrics.colour import delta_e_2000, lab_of
from diorama_core.evaluation.metrics.visible_colours import visible_colours
from diorama_core.evaluation.reports.tables import Column, Row, Table, Value
from diorama_core.library.record import ShapeLibrary
from diorama_core.perception.inputs import read_inputs
from diorama_core.pipeline.run import Built, build_scene
from diorama_core.progress import Progress

log = logging.getLogger(__name__)

GHOST_DIFFERENCE = 10.0
_UNNAMED = "object"
_TEXELS = 40_000
"""Of the floor's picture that are looked at, evenly spread."""


@dataclass(frozen=True)
class PhotoResult:
    """One photo."""

    photo: str
    objects: tuple[ObjectResult, ...]
    ghosts: float | None = None
    """Share of the floor's picture; None where the floor has no picture."""
    ghosts_unmarked: float | None = None
    """The same of floors made without half of what stands on them; None where the photo shows no floor."""
    seconds: float = 0.0
    """Processor time."""
    failure: str = ""


@dataclass(frozen=True)
class PhotosBench:
    """Results of all photos."""

    results: tuple[PhotoResult, ...]
    missing: tuple[str, ...]
    """Annotated photos that the folder does not have."""
    named: bool

    @property
    def objects(self) -> tuple[ObjectResult, ...]:
        """Of all photos."""
        return tuple(annotated for result in self.results for annotated in result.objects)

    def tables(self) -> tuple[Table, ...]:
        """All photos together, loose words by themselves, every photo, and the attributes of form."""
        return (_table(self), _form_table(self.objects))

    def to_json(self) -> dict[str, object]:
        """Tables, every photo and every object."""
        return {
            "bench": "photos",
            "named": self.named,
            "missing": list(self.missing),
            "tables": [t.to_json() for t in self.tables()],
            "photos": [asdict(r) for r in self.results],
        }


def run(
    annotations: Path,
    photos: Path,
    library: ShapeLibrary,
    *,
    named: bool = True,
    only: Sequence[str] = (),
    cache: Path | None = None,
    progress: Progress | None = None,
) -> PhotosBench:
    """Build every annotated photo that the folder has; failures count as wrong.

    Args:
        annotations: file as `adapters.photo_annotations` describes it.
        photos: folder of pictures named by id, with `photos.json` for known intrinsics where there is one.
        library: where shapes come from.
        named: whether boxes come with their plain words.
        only: ids of photos to take; all where empty.
        cache: folder for stage results, one folder a photo; a later run resumes from them.
        progress: reports and cancellation.

    Raises:
        InputError: when the annotations cannot be read, or the folder has none of the photos.
    """
    progress = progress or Progress()
    known = {name: photo for name, photo in read_annotations(annotations).items() if not only or name in only}
    intrinsics = read_intrinsics(photos)
    pictures = {name: picture_of(photos, name) for name in known}
    present = {name: path for name, path in pictures.items() if path is not None}
    missing = tuple(name for name in known if name not in present)
    if not present:
        raise InputError(f"{photos}: none of the {len(known)} annotated photos is there; name pictures by their ids")
    results = []
    for k, (name, path) in enumerate(present.items()):
        folder = None if cache is None else cache / (name if named else f"{name}-{_UNNAMED}")
        part = progress.part(k / len(present), (k + 1) / len(present))
        part.report(0.0, name)
        results.append(_result(name, known[name], path, intrinsics.get(name), library, named, folder, part))
    progress.report(1.0, "done")
    return PhotosBench(tuple(results), missing, named)


def _result(
    name: str,
    photo: AnnotatedPhoto,
    path: Path,
    intrinsics: tuple[float, float, float, float] | None,
    library: ShapeLibrary,
    named: bool,
    cache: Path | None,
    progress: Progress,
) -> PhotoResult:
    begun = time.process_time()
    try:
        inputs = _inputs(photo, path, intrinsics, named)
        built = build_scene(inputs, library, cache=cache, progress=progress)
        spent = time.process_time() - begun
        objects = _objects(name, photo, built, library)
        return PhotoResult(name, objects, floor_ghosts(built), ghosts_unmarked(built), spent)
    except Cancelled:
        raise
    except Exception as error:  # whatever goes wrong, the photo counts as failed and the others go on
        log.warning("%s failed: %s", name, error)
        wrong = tuple(not_built(name, i, annotated) for i, annotated in enumerate(photo.objects))
        spent = time.process_time() - begun
        return PhotoResult(name, wrong, None, None, spent, f"{type(error).__name__}: {error}")


def _inputs(
    photo: AnnotatedPhoto, path: Path, intrinsics: tuple[float, float, float, float] | None, named: bool
) -> Inputs:
    boxes = [{"bbox": annotated.bbox, "class": annotated.word if named else _UNNAMED} for annotated in photo.objects]
    inputs = read_inputs(path, intrinsics=intrinsics, boxes=json.dumps(boxes).encode()).inputs
    if inputs.photo.original_size != photo.size:
        stated, found = ("{} x {}".format(*size) for size in (photo.size, inputs.photo.original_size))
        raise InputError(f"{path}: the annotations are of a picture of {stated} pixels, this one has {found}")
    return inputs


def _objects(name: str, photo: AnnotatedPhoto, built: Built, library: ShapeLibrary) -> tuple[ObjectResult, ...]:
    """Objects are numbered by their mask ids in the order of the boxes."""
    by_index = {o.mask_id - 1: o for o in built.scene.objects if o.mask_id is not None}
    index_of = {item.id: index for index, item in by_index.items()}
    furniture = {o.mask_id - 1 for o in built.objects}
    shown = visible_colours(built.scene, library, built.textures)
    in_light = {key: built.illuminant.lit(colour) for key, colour in shown.items()}
    return tuple(
        measured(name, i, annotated, by_index[i], built.scene, library, index_of, in_light.get(by_index[i].id))
        if i in by_index
        else not_built(name, i, annotated, opening=i not in furniture)
        for i, annotated in enumerate(photo.objects)
    )


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
    return _mean([ghost_share(picture, colour) for picture in pictures])


def _floor_picture(
    built: Built, objects: tuple[DetectedObject, ...], standing: frozenset[str]
) -> UInt8[np.ndarray, "_ _ 3"]:
    room, camera = built.architecture.architecture, built.geometry.camera
    photo = replace(built.inputs.photo, rgb=built.illuminant.balanced(built.inputs.photo.rgb))
    inputs = replace(built.inputs, photo=photo)
    room = replace(room, planes=coloured(room.planes, inputs.photo.rgb, camera, objects))
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


COLUMNS = (
    Column("objects", "d"), Column("kind first", better="↑"), Column("among", better="↑"), Column("form", better="↑"),
    Column("colour", ".1f", "↓"), Column("no colour", better="↓"), Column("front", better="↑"),
    Column("supporter", better="↑"), Column("box IoU", better="↑"), Column("ghosts", better="↓"),
    Column("unmarked", better="↓"), Column("time s", ".1f", "↓"),
)  # fmt: skip


def _table(bench: PhotosBench) -> Table:
    loose = [annotated for annotated in bench.objects if annotated.loose]
    mean_of = [r for r in bench.results if not r.failure]
    overall = _values(bench.objects)
    ghosts, unmarked = _mean([r.ghosts for r in mean_of]), _mean([r.ghosts_unmarked for r in mean_of])
    seconds = _mean([r.seconds for r in mean_of])
    rows = [
        Row("all", (*overall, ghosts, unmarked, seconds)),
        Row("loose words", (*_values(loose), None, None, None)),
        *(Row(r.photo, (*_values(r.objects), r.ghosts, r.ghosts_unmarked, r.seconds)) for r in bench.results),
    ]
    words = "plain words" if bench.named else "no words"
    notes = [f"not in the folder: {', '.join(bench.missing)}"] if bench.missing else []
    notes += [f"{r.photo} failed: {r.failure}" for r in bench.results if r.failure]
    note = "Photos that fail count as wrong. " + "; ".join(notes)
    return Table(f"Annotated photos, {words}", COLUMNS, tuple(rows), note.strip())


def _values(objects: Sequence[ObjectResult]) -> tuple[Value, ...]:
    """The columns that are of objects: colours by their median, everything else by its mean."""
    differences = [t.colour_difference for t in objects if t.colour_difference is not None]
    return (
        len(objects),
        _mean([t.kind_first for t in objects]),
        _mean([t.kind_among for t in objects]),
        _mean([right for t in objects for right in t.form.values()]),
        float(np.median(differences)) if differences else None,
        _mean([None if t.has_colour is None else not t.has_colour for t in objects]),
        _mean([t.front for t in objects]),
        _mean([t.supporter for t in objects]),
        _mean([t.iou for t in objects]),
    )


def _form_table(objects: Sequence[ObjectResult]) -> Table:
    of: dict[str, list[bool]] = {}
    for annotated in objects:
        for name, right in annotated.form.items():
            of.setdefault(name, []).append(right)
    rows = tuple(Row(name, (len(right), _mean(right))) for name, right in sorted(of.items()))
    note = "Of objects whose annotation and whose chosen shape's design both state the attribute."
    return Table("Form", (Column("objects", "d"), Column("right", better="↑")), rows, note)


def _mean(values: Sequence[float | None]) -> float | None:
    known = [v for v in values if v is not None]
    return float(np.mean(known)) if known else None
