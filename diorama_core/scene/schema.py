"""The documented scene file: `scene.json`, version 1.

A JSON object with `format`, `version`, `axes`, `units`, `camera`, `architecture`, `objects` and `metrics`; every
field is described in `docs/scene-file.md`. Numbers round-trip exactly. Reading validates everything and reports the
first fault with its place; files of an older version are migrated step by step, newer ones are refused.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, FiniteFloat, ValidationError

from diorama_core.errors import SceneError
from diorama_core.io.bounded import parse_json, shorten
from diorama_core.scene.belief import Belief
from diorama_core.scene.light_settings import MAX_EXPOSURE_EV, PHOTO_LIGHT, LightSettings
from diorama_core.scene.support import check_scene
from diorama_core.scene.types import (
    Architecture,
    Camera,
    Candidate,
    FaceName,
    Finish,
    HomeRoom,
    Intrinsics,
    MaterialSource,
    PhotoMaterial,
    Plane,
    PlaneRole,
    Pose,
    Relation,
    RoomLight,
    Scene,
    SceneObject,
    Support,
    SurfaceFinish,
    SurfacePattern,
    TextureLayout,
)

FORMAT = "diorama-scene"
VERSION = 1
AXES = {
    "handedness": "right",
    "world_up": "+Z",
    "object_front": "+X",
    "object_up": "+Z",
    "camera": "x right, y down, z forward",
}

Migration = Callable[[dict[str, Any]], dict[str, Any]]
MIGRATIONS: Mapping[int, Migration] = {}
"""Entry n turns a version n document into version n + 1."""

MAX_ITEMS = 5000
"""Objects, planes, candidates of one object, corners of one polygon."""

# Wide enough for any room and any photo, narrow enough that no arithmetic on them overflows.
Number = Annotated[float, Field(ge=-1e9, le=1e9, allow_inf_nan=False)]
Sigma = Annotated[float, Field(ge=0.0, le=1e4)]
"""A standard deviation, in metres or of a logarithm."""
Metres = Annotated[float, Field(ge=-1e5, le=1e5, allow_inf_nan=False)]
Size = Annotated[float, Field(ge=1e-6, le=1e4, allow_inf_nan=False)]
Unit = Annotated[float, Field(ge=0.0, le=1.0, allow_inf_nan=False)]
Pixels = Annotated[int, Field(gt=0, le=100_000)]
Focal = Annotated[float, Field(ge=1e-3, le=1e7, allow_inf_nan=False)]
Id = Annotated[str, Field(min_length=1, max_length=200)]
Words = Annotated[str, Field(max_length=500)]
AS_TUPLE = AfterValidator(tuple)
"""Lists of a file are tuples in the scene."""

Vec3 = tuple[Metres, Metres, Metres]
Size3 = tuple[Size, Size, Size]
Colour = tuple[Unit, Unit, Unit]
Row4 = tuple[Metres, Metres, Metres, Metres]
Matrix4 = tuple[Row4, Row4, Row4, Row4]


class _Model(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class _CameraFile(_Model):
    width: Pixels
    height: Pixels
    fx: Focal
    fy: Focal
    cx: Metres
    cy: Metres
    T_world_camera: Matrix4


class _SurfaceFinishFile(_Model):
    pattern: SurfacePattern
    colour: Colour
    scale: Size
    direction_rad: Number


class _PlaneFile(_Model):
    id: Id
    role: PlaneRole
    polygon: Annotated[list[Vec3], Field(min_length=3, max_length=MAX_ITEMS)]
    thickness_m: Annotated[float, Field(ge=0.0, le=100.0, allow_inf_nan=False)]
    colour: Colour
    texture: Id | None
    confidence: Number
    finish: _SurfaceFinishFile | None = None
    photo_colour: Colour | None = None
    photo_texture: Id | None = None
    sigma_m: Sigma | None = None


class _ArchitectureFile(_Model):
    planes: Annotated[list[_PlaneFile], Field(max_length=MAX_ITEMS)]


class _CandidateFile(_Model):
    shape: Id
    shape_size_m: Size3
    score: Number
    T_world_object: Matrix4
    scale: Size3


class _SupportFile(_Model):
    parent: Id
    relation: Relation
    parent_surface: Annotated[int, Field(ge=0, le=1_000_000)] | None
    child_face: FaceName | None
    adheres_to: Annotated[list[Id], Field(max_length=MAX_ITEMS), AS_TUPLE]


class _PhotoMaterialFile(_Model):
    slot: Id
    colour: Colour
    texture: Id | None
    layout: TextureLayout
    tile_m: Size
    roughness: Unit
    metallic: Unit
    main: bool


class _BeliefFile(_Model):
    present: Unit
    kinds: Annotated[list[tuple[Words, Unit]], Field(max_length=MAX_ITEMS), AS_TUPLE]
    fronts: Annotated[list[Unit], Field(max_length=4), AS_TUPLE]
    supporters: Annotated[list[tuple[Id, Unit]], Field(max_length=MAX_ITEMS), AS_TUPLE]
    place_sigma_m: Sigma
    size_sigma: Sigma


class _ObjectFile(_Model):
    id: Id
    label: Words
    category: Words
    shape: Id
    shape_size_m: Size3
    T_world_object: Matrix4
    scale: Size3
    size_m: tuple[Number, Number, Number]
    support: _SupportFile | None
    candidates: Annotated[list[_CandidateFile], Field(max_length=MAX_ITEMS)]
    mask_id: Annotated[int, Field(ge=-1_000_000_000, le=1_000_000_000)] | None
    box_px: tuple[Number, Number, Number, Number] | None
    confidence: Number
    locked: bool
    hidden: bool
    colour: Colour | None
    finish: Finish | None = None
    photo_materials: Annotated[list[_PhotoMaterialFile], Field(max_length=100)] = []
    material_source: MaterialSource = "photo"
    open_share: Unit = 0.0
    by_hand: bool = False
    belief: _BeliefFile | None = None


class _LightFile(_Model):
    direction: tuple[Number, Number, Number]
    strength: Unit
    colour: Colour


class _LightSettingsFile(_Model):
    hour: Annotated[float, Field(ge=0.0, le=24.0)] | None = None
    north_rad: Number
    exposure_ev: Annotated[float, Field(ge=-MAX_EXPOSURE_EV, le=MAX_EXPOSURE_EV)] = 0.0
    lamps_on: Annotated[list[Words], Field(max_length=MAX_ITEMS), AS_TUPLE] | None = None


class _HomeRoomFile(_Model):
    id: Id
    name: Words
    floor: Id
    storey: Annotated[int, Field(ge=-100, le=1000)]


class _SceneFile(_Model):
    format: Literal["diorama-scene"]
    version: int
    axes: Annotated[dict[Words, Words], Field(max_length=20)]
    units: Literal["metres"]
    camera: _CameraFile | None
    architecture: _ArchitectureFile
    objects: Annotated[list[_ObjectFile], Field(max_length=MAX_ITEMS)]
    metrics: Annotated[dict[Words, FiniteFloat], Field(max_length=200)]
    light: _LightFile | None = None
    light_settings: _LightSettingsFile | None = None
    scale_sigma: Sigma | None = None
    rooms: Annotated[list[_HomeRoomFile], Field(max_length=MAX_ITEMS)] = []


def scene_file_schema() -> dict[str, Any]:
    """The JSON schema of the scene file."""
    return _SceneFile.model_json_schema()


def scene_to_json(scene: Scene) -> str:
    """The scene file's text, a line for each field, plane and object."""
    fields = {
        "format": _line(FORMAT),
        "version": _line(VERSION),
        "axes": _line(AXES),
        "units": _line("metres"),
        "camera": _line(_camera_to_file(scene.camera)),
        "architecture": f'{{"planes": {_lines(map(_plane_to_file, scene.architecture.planes))}}}',
        "objects": _lines(_object_to_file(o, scene.support_of(o.id)) for o in scene.objects),
        "metrics": _line(dict(scene.metrics)),
        "light": _line(None if scene.light is None else asdict(scene.light)),
        "light_settings": _line(asdict(scene.light_settings)),
        "scale_sigma": _line(scene.scale_sigma),
        # One room is written as programs of before homes read it.
        **({"rooms": _line([asdict(r) for r in scene.rooms])} if scene.rooms else {}),
    }
    return "{\n" + ",\n".join(f'"{name}": {text}' for name, text in fields.items()) + "\n}"


def _line(value: Any) -> str:
    return json.dumps(value, allow_nan=False)  # Python's encoder with indentation takes four times as long


def _lines(values: Iterable[Any]) -> str:
    return "[" + ",\n".join(map(_line, values)) + "]"


def scene_from_json(text: str | bytes, *, migrations: Mapping[int, Migration] = MIGRATIONS) -> Scene:
    """Read a scene file's text.

    Raises:
        SceneError: not JSON, not a scene file, of a newer version, or inconsistent; says where.
    """
    document = parse_json(text, "the scene file", SceneError, advice="restore a backup")
    document = _migrate(document, migrations)
    try:
        parsed = _SceneFile.model_validate(document)
        scene = _scene_from_file(parsed)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        where = shorten(".".join(str(part) for part in first["loc"]))
        raise SceneError(f"the scene file is wrong at {where}: {shorten(first['msg'].lower())}") from error
    except (ValueError, TypeError, ArithmeticError) as error:
        raise SceneError(f"the scene file is wrong: {shorten(str(error))}") from error
    check_scene(scene)
    return scene


def check_limits(scene: Scene, known: Scene | None = None) -> None:
    """Whether the scene can be read back once it is written.

    Args:
        scene: any.
        known: an earlier one; what is the same value in both is not looked at again.

    Raises:
        SceneError: a number or a name is beyond what a scene file may hold; says which.
    """
    before = set() if known is None else {id(v) for v in (*known.objects, *known.architecture.planes)}
    try:
        for plane in scene.architecture.planes:
            if id(plane) not in before:
                _PlaneFile.model_validate(_plane_to_file(plane))
        for item in scene.objects:
            if id(item) not in before:
                _ObjectFile.model_validate(_object_to_file(item, scene.support_of(item.id)))
                json.dumps([item.id, item.label, item.category, item.shape_id], ensure_ascii=False).encode()
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        where = shorten(" ".join(str(part) for part in first["loc"]), 60)
        raise SceneError(f"{where}: {shorten(first['msg'].lower())}; give a value that fits a room") from error
    except UnicodeEncodeError as error:
        raise SceneError("a name holds half a character; type it again") from error
    if len(scene.objects) > MAX_ITEMS:
        raise SceneError(f"a scene holds at most {MAX_ITEMS} objects")


def _migrate(document: Any, migrations: Mapping[int, Migration]) -> dict[str, Any]:
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise SceneError(f"this is not a scene file: its 'format' is not '{FORMAT}'")
    version = document.get("version")
    if not isinstance(version, int) or isinstance(version, bool):
        raise SceneError("the scene file has no version number; it cannot be read safely")
    if version > VERSION:
        raise SceneError(f"the scene file has version {version}, this program reads up to {VERSION}; update Diorama")
    while version < VERSION:
        if version not in migrations:
            raise SceneError(f"the scene file has version {version}, which can no longer be read")
        document = migrations[version](document)
        version += 1
        document["version"] = version
    return document


def _rows(matrix: np.ndarray) -> list[list[float]]:
    return [[float(v) for v in row] for row in matrix]


def _numbers(vector: Any) -> list[float]:
    return [float(v) for v in vector]


def _camera_to_file(camera: Camera | None) -> dict[str, Any] | None:
    if camera is None:
        return None
    return {**asdict(camera.intrinsics), "T_world_camera": _rows(camera.T_world_camera)}


def _plane_to_file(plane: Plane) -> dict[str, Any]:
    return {
        "id": plane.id,
        "role": plane.role,
        "polygon": _rows(plane.polygon),
        "thickness_m": plane.thickness,
        "colour": _numbers(plane.colour),
        "texture": plane.texture,
        "confidence": plane.confidence,
        "finish": None if plane.finish is None else asdict(plane.finish),
        "photo_colour": None if plane.photo_colour is None else _numbers(plane.photo_colour),
        "photo_texture": plane.photo_texture,
        "sigma_m": plane.sigma_m,
    }


def _pose_to_file(pose: Pose) -> dict[str, Any]:
    return {"T_world_object": _rows(pose.T_world_object), "scale": _numbers(pose.scale)}


def _object_to_file(item: SceneObject, support: Support | None) -> dict[str, Any]:
    return {
        "id": item.id,
        "label": item.label,
        "category": item.category,
        "shape": item.shape_id,
        "shape_size_m": _numbers(item.shape_size_m),
        **_pose_to_file(item.pose),
        "size_m": _numbers(item.size_m),
        "support": None if support is None else {k: v for k, v in asdict(support).items() if k != "child"},
        "candidates": [_candidate_to_file(c) for c in item.candidates],
        "mask_id": item.mask_id,
        "box_px": None if item.box_px is None else _numbers(item.box_px),
        "confidence": item.confidence,
        "locked": item.locked,
        "hidden": item.hidden,
        "colour": None if item.colour is None else _numbers(item.colour),
        "finish": item.finish,
        "photo_materials": [asdict(m) for m in item.photo_materials],
        "material_source": item.material_source,
        "open_share": item.open_share,
        "by_hand": item.by_hand,
        "belief": None if item.belief is None else asdict(item.belief),
    }


def _candidate_to_file(candidate: Candidate) -> dict[str, Any]:
    return {
        "shape": candidate.shape_id,
        "shape_size_m": _numbers(candidate.shape_size_m),
        "score": candidate.score,
        **_pose_to_file(candidate.pose),
    }


def _scene_from_file(file: _SceneFile) -> Scene:
    floors = {p.id for p in file.architecture.planes if p.role == "floor"}
    if lost := [r for r in file.rooms if r.floor not in floors]:
        raise ValueError(f"room {lost[0].id!r} has no floor {lost[0].floor!r}; name one of architecture.planes")
    return Scene(
        camera=_camera_from_file(file.camera),
        architecture=Architecture(tuple(_plane_from_file(p) for p in file.architecture.planes)),
        objects=tuple(_object_from_file(o) for o in file.objects),
        supports=tuple(Support(o.id, **dict(o.support)) for o in file.objects if o.support is not None),
        metrics=tuple(file.metrics.items()),
        light=None if file.light is None else RoomLight(**dict(file.light)),
        scale_sigma=file.scale_sigma,
        light_settings=PHOTO_LIGHT if file.light_settings is None else LightSettings(**dict(file.light_settings)),
        rooms=tuple(HomeRoom(**dict(r)) for r in file.rooms),
    )


def _camera_from_file(file: _CameraFile | None) -> Camera | None:
    if file is None:
        return None
    k = Intrinsics(file.width, file.height, file.fx, file.fy, file.cx, file.cy)
    T = np.array(file.T_world_camera)
    if not (np.abs(T[:3, :3] @ T[:3, :3].T - np.eye(3)).max() < 1e-5 and np.linalg.det(T[:3, :3]) > 0):
        raise ValueError("the camera's rotation must be orthonormal and right-handed")
    return Camera(k, T)


def _plane_from_file(file: _PlaneFile) -> Plane:
    return Plane(
        id=file.id,
        role=file.role,
        polygon=np.array(file.polygon),
        thickness=file.thickness_m,
        colour=file.colour,
        texture=file.texture,
        confidence=file.confidence,
        finish=None if file.finish is None else SurfaceFinish(**dict(file.finish)),
        photo_colour=file.photo_colour,
        photo_texture=file.photo_texture,
        sigma_m=file.sigma_m,
    )


def _pose_from_file(T_world_object: Matrix4, scale: Vec3) -> Pose:
    T = np.array(T_world_object)
    return Pose(T[:3, :3], T[:3, 3], np.array(scale))


def _object_from_file(file: _ObjectFile) -> SceneObject:
    return SceneObject(
        id=file.id,
        label=file.label,
        category=file.category,
        shape_id=file.shape,
        shape_size_m=file.shape_size_m,
        pose=_pose_from_file(file.T_world_object, file.scale),
        candidates=tuple(
            Candidate(c.shape, c.shape_size_m, c.score, _pose_from_file(c.T_world_object, c.scale))
            for c in file.candidates
        ),
        mask_id=file.mask_id,
        box_px=file.box_px,
        confidence=file.confidence,
        locked=file.locked,
        hidden=file.hidden,
        colour=file.colour,
        finish=file.finish,
        photo_materials=tuple(PhotoMaterial(**dict(m)) for m in file.photo_materials),
        material_source=file.material_source,
        open_share=file.open_share,
        by_hand=file.by_hand,
        belief=None if file.belief is None else Belief(**dict(file.belief)),
    )
