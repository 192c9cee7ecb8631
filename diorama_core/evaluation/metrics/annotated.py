"""One annotated object compared with the object that was built from it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from diorama_core.evaluation.adapters.photo_annotations import AnnotatedObject
from diorama_core.evaluation.metrics.colour import perceptual_difference
from diorama_core.geometry.projection import box_iou
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.library.form import compare, form_at
from diorama_core.library.record import ShapeLibrary, record_of
from diorama_core.scene.types import Camera, Scene, SceneObject

FRONT_TOLERANCE_DEG = 45.0


@dataclass(frozen=True)
class ObjectResult:
    """What a build made of one annotated object; None where the annotation states nothing to compare with."""

    photo: str
    index: int
    """In the photo's list of objects."""
    word: str
    kind: str
    loose: bool
    """Whether the plain word names another kind than the true one."""
    built: str = ""
    """Category of the chosen shape; empty where nothing was built."""
    shape: str = ""
    kind_first: bool | None = None
    kind_among: bool | None = None
    """Whether any candidate is of the true kind."""
    form: Mapping[str, bool] = field(default_factory=dict)
    """For every attribute that both annotation and design state, whether they agree."""
    has_colour: bool | None = None
    """Whether it is painted in a colour of the photo; else it keeps its shape's own."""
    colour_difference: float | None = None
    """CIEDE2000, with lightness at half weight, of the material that most of it shows in the photo's view."""
    front_error_deg: float | None = None
    supporter: bool | None = None
    """Whether it stands on what carries it."""
    iou: float | None = None
    """The posed outline's box with the annotated one."""
    opening: bool = False
    """Built as a hole in a wall (an open doorway): nothing else is compared."""

    @property
    def front(self) -> bool | None:
        """Whether the front is right within 45 degrees."""
        return None if self.front_error_deg is None else self.front_error_deg <= FRONT_TOLERANCE_DEG


def not_built(photo: str, index: int, annotated: AnnotatedObject, opening: bool = False) -> ObjectResult:
    """Wrong in everything that is annotated; an opening is not judged.

    Args:
        photo: its name.
        index: of the object.
        annotated: what is known of it.
        opening: whether it is a door or a window.
    """
    wrong = None if opening else False
    return ObjectResult(
        photo,
        index,
        annotated.word,
        annotated.kind,
        annotated.loose,
        kind_first=wrong if annotated.nameable else None,
        kind_among=wrong if annotated.nameable else None,
        has_colour=wrong if annotated.colour is not None else None,
        front_error_deg=None if annotated.front is None or opening else 180.0,
        supporter=wrong if annotated.on is not None else None,
        iou=None if opening else 0.0,
        opening=opening,
    )


def measure(
    photo: str,
    index: int,
    annotated: AnnotatedObject,
    item: SceneObject,
    scene: Scene,
    library: ShapeLibrary,
    index_of: Mapping[str, int],
    shown: Float[np.ndarray, "3"] | None = None,
) -> ObjectResult:
    """Compare one annotated object with the object built from it.

    Args:
        photo: the photo's id.
        index: the object's place in the photo's list.
        annotated: the annotation, in pixels of the scene's camera.
        item: what was built.
        scene: the whole, for the camera and what carries what.
        library: where its shapes are from.
        index_of: places of the objects by object id.
        shown: sRGB 0 to 1 that the object's main visible material has in the photo's light; None where it is not seen.
    """
    shape = record_of(library, item.shape_id)
    among = {record_of(library, c.shape_id).category for c in item.candidates} | {shape.category}
    design = form_at(library, shape, item.size_m) if annotated.attributes else {}
    return ObjectResult(
        photo,
        index,
        annotated.word,
        annotated.kind,
        annotated.loose,
        built=shape.category,
        shape=shape.id,
        kind_first=shape.category == annotated.kind if annotated.nameable else None,
        kind_among=annotated.kind in among if annotated.nameable else None,
        form=compare(annotated.attributes, design),
        has_colour=None if annotated.colour is None else item.colour is not None,
        colour_difference=_colour_difference(annotated, shown),
        front_error_deg=front_error_of(annotated, item, scene.camera, shape.symmetry),
        supporter=None if annotated.on is None else carrier_of(scene, item.id, index_of) == annotated.on,
        iou=shape_iou(scene, item.id, annotated.bbox, library),
    )


def front_deg(item: SceneObject, camera: Camera) -> float:
    """Direction that an object faces: 0 toward the picture plane's side of the camera, 90 the picture's right."""
    right, forward = camera.T_world_camera[:2, 0], camera.T_world_camera[:2, 2]
    front = item.pose.R_world_object[:2, 0]
    return float(np.degrees(np.arctan2(front @ right, -(front @ forward))) % 360.0)


def _colour_difference(annotated: AnnotatedObject, shown: Float[np.ndarray, "3"] | None) -> float | None:
    if annotated.colour is None or shown is None:
        return None
    return float(perceptual_difference(np.array(annotated.colour) / 255.0, shown))


def front_error_of(annotated: AnnotatedObject, item: SceneObject, camera: Camera | None, fold: int) -> float | None:
    """Smallest angle in degrees to any of the turns that leave the shape the same.

    Args:
        annotated: with its front as seen in the photo, degrees.
        item: the object, posed in the world.
        camera: of the photo; the error is None without one, or without an annotated front.
        fold: number of turns about the up axis that leave the shape as it is.
    """
    if annotated.front is None or camera is None:
        return None
    period = 360.0 / fold
    off = (front_deg(item, camera) - annotated.front) % period
    return float(min(off, period - off))


def carrier_of(scene: Scene, object_id: str, index_of: Mapping[str, int]) -> str | int | None:
    """What carries an object, as annotations say it: the role of a plane, or the place of an object."""
    edge = scene.support_of(object_id)
    if edge is None:
        return None
    return scene.plane(edge.parent).role if scene.has_plane(edge.parent) else index_of.get(edge.parent)


def shape_iou(scene: Scene, object_id: str, box: tuple[float, float, float, float], library: ShapeLibrary) -> float:
    """Intersection over union of the box with the bounds of the posed shape's visible part; 0 without a shape.

    Args:
        scene: as it is.
        object_id: of the object.
        box: of the photo: x1, y1, x2, y2.
        library: where shapes come from.
    """
    if scene.camera is None or not scene.has_object(object_id):
        return 0.0
    item = scene.object(object_id)
    pose = PoseBatch(item.pose.R_world_object[None], item.pose.position[None], item.pose.scale[None])
    bounds = ShapeCaster(library.mesh(item.shape_id)).bounds_px(scene.camera, pose)[0]
    return 0.0 if np.isnan(bounds).any() else float(box_iou(bounds, np.array(box)))
