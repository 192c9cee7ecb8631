"""Photos annotated by hand: boxes, kinds, form, colours, what carries what, and fronts.

One JSON object: photo id -> `{"size": [w, h], "things": [...]}`; each object has `bbox` (pixels of the original),
`class` (the plain word), `kind`, `attributes`, `colour` (sRGB 0 to 255), `on` ("floor", "wall", "ceiling" or the index
of another object), `front` (degrees: 0 toward the camera, 90 to the picture's right, 180 away, 270 left), `occluded`.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Literal, TypeVar

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from diorama_core.errors import InputError
from diorama_core.evaluation.adapters.files import read_json
from diorama_core.library.taxonomy import ARCHITECTURE_WORDS

T = TypeVar("T")
PICTURES = (".jpg", ".jpeg", ".png")
_Channel = Annotated[float, Field(ge=0, le=255)]


class AnnotatedObject(BaseModel):
    """One object in a photo."""

    model_config = ConfigDict(frozen=True, populate_by_name=True, extra="ignore")

    bbox: tuple[float, float, float, float]
    """Visible extent x1, y1, x2, y2 in pixels of the original file."""
    word: Annotated[str, Field(alias="class")]
    """The plain word that a person types."""
    kind: str
    """The finest category of the library that is true; "object" where none is."""
    attributes: dict[str, str | int] = {}
    colour: tuple[_Channel, _Channel, _Channel] | None = None
    """sRGB 0 to 255 of the main visible material."""
    on: Literal["floor", "wall", "ceiling"] | int | None = None
    """What carries it; a number is the index of an object."""
    front: float | None = None
    """Degrees from toward the camera, anticlockwise seen from above: 90 is the picture's right."""
    occluded: float = 0.0

    @property
    def loose(self) -> bool:
        """Whether the plain word is not the name of the true kind; also for synonyms, whatever the taxonomy knows."""
        return self.nameable and self.word.lower() != self.kind

    @property
    def nameable(self) -> bool:
        """Whether the library has a kind for it."""
        return self.kind != "object"


class AnnotatedPhoto(BaseModel):
    """One photo's objects."""

    model_config = ConfigDict(frozen=True, populate_by_name=True, extra="ignore")

    size: tuple[int, int]
    """Width and height of the original file."""
    objects: Annotated[tuple[AnnotatedObject, ...], Field(alias="things")]

    def resize(self, size: tuple[int, int]) -> AnnotatedPhoto:
        """The annotation of the photo resized to a width and height."""
        sx, sy = size[0] / self.size[0], size[1] / self.size[1]
        boxes = [(x1 * sx, y1 * sy, x2 * sx, y2 * sy) for x1, y1, x2, y2 in (o.bbox for o in self.objects)]
        objects = [o.model_copy(update={"bbox": box}) for o, box in zip(self.objects, boxes, strict=True)]
        return self.model_copy(update={"size": size, "objects": tuple(objects)})


class PhotoRecord(BaseModel):
    """What a `photos.json` beside the photos says of one."""

    model_config = ConfigDict(frozen=True, extra="ignore")

    id: str
    K: tuple[float, float, float, float] | None = None
    """fx, fy, cx, cy in pixels of the original file."""


_ANNOTATIONS = TypeAdapter(dict[str, AnnotatedPhoto])
_RECORDS = TypeAdapter(list[PhotoRecord])


def read_annotations(path: Path) -> dict[str, AnnotatedPhoto]:
    """The annotated photos by id; words for the room itself (walls, the floor) are no objects.

    Raises:
        InputError: one line, where the file is not laid out as the module says.
    """
    photos = _validate(_ANNOTATIONS.validate_python, path)
    for name, photo in photos.items():
        for index, annotated in enumerate(photo.objects):
            if isinstance(annotated.on, int) and not 0 <= annotated.on < len(photo.objects):
                raise InputError(
                    f"{path}: {name}, object {index}: on {annotated.on}, but there are {len(photo.objects)} objects"
                )
            if annotated.word.lower() in ARCHITECTURE_WORDS:
                raise InputError(f"{path}: {name}, object {index} is part of the room ('{annotated.word}'); remove it")
    return photos


def read_intrinsics(folder: Path) -> dict[str, tuple[float, float, float, float]]:
    """fx, fy, cx, cy by photo id from the folder's `photos.json`; nothing where it has none."""
    path = folder / "photos.json"
    if not path.is_file():
        return {}
    return {record.id: record.K for record in _validate(_RECORDS.validate_python, path) if record.K is not None}


def picture_of(folder: Path, name: str) -> Path | None:
    """The picture whose file name without ending is the photo's id, if the folder has one."""
    named = (folder / f"{name}{ending}" for ending in (*PICTURES, *(e.upper() for e in PICTURES)))
    return next((path for path in named if path.is_file()), None)


def _validate(validate: Callable[[object], T], path: Path) -> T:
    try:
        return validate(read_json(path))
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        place = ", ".join(str(p) for p in first["loc"])
        raise InputError(f"{path}: {place}: {first['msg'].lower()}; see the annotations' format") from error
