"""Where another photo of a scene's room was taken, by the photos and surfaces that the scene has.

Points that the new photo has in common with photos whose cameras are known lie on the scene's surfaces as these see
them, which gives the camera by its projection of points (EPnP in RANSAC: Lepetit et al. 2009, Fischler and Bolles
1981). Surfaces of a reconstruction are not where they are in the room, but the pairs of pixels are exact: the camera is
then refined so that they lie on each other's epipolar lines, and the surfaces only say how far it is from the others.
Unlike structure from motion (`found_poses`) this works with one known photo and where a wall is most of what is seen.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import cv2
import numpy as np
from jaxtyping import Bool, Float
from scipy.optimize import least_squares

from diorama_core.artefacts import FurtherPhoto, Inputs, Photo
from diorama_core.errors import InputError
from diorama_core.geometry.rotations import rotation_from_vector
from diorama_core.library.record import ShapeLibrary
from diorama_core.multiview.found_poses import LIKELY_FOV_RAD, UnposedPhoto, common_points
from diorama_core.progress import SILENT, Progress
from diorama_core.render.raycast import PinholeView
from diorama_core.render.world import scene_world
from diorama_core.scene.types import Camera, Intrinsics, Scene, rigid

GUESSED_LOG_SIGMA = 0.25

DepthAlong = Callable[[Camera, Float[np.ndarray, "n 2"]], Float[np.ndarray, "n"]]
"""Depth (m, z in camera) of the scene at pixels of a camera; not finite where nothing is hit."""


@dataclass(frozen=True)
class RegistrationSettings:
    """How a further photo is matched to a scene."""

    near_share: float = 0.025
    """Error over the photo's width within which a point of the scene's surfaces is right."""
    min_points: int = 30
    min_share: float = 0.2
    """Share of the common points whose surfaces must be right."""
    ransac_turns: int = 3000
    epipolar_px: float = 1.5
    surface_share: float = 0.01
    """Usual error of points of the surfaces, as a share of the photo's width."""
    focal_log_sigma: float = 0.03
    """Deviation of a focal length that is another photo's of the same size."""
    max_terms: int = 1500
    scales: tuple[float, float, float, float, float, float, float] = (0.1, 0.1, 0.1, 1.0, 1.0, 1.0, 0.1)
    """Scales of the unknowns: turn (rad), shift (m), logarithm of the focal length."""
    seed: int = 20


SETTINGS = RegistrationSettings()


@dataclass(frozen=True, eq=False)
class PlacedPhoto:
    """A photo whose camera in the room is known."""

    photo: UnposedPhoto
    camera: Camera


@dataclass(frozen=True, eq=False)
class CommonPoints:
    """What the new photo has in common with one known photo."""

    camera: Camera
    """Camera of the known photo."""
    known_px: Float[np.ndarray, "n 2"]
    new_px: Float[np.ndarray, "n 2"]
    points: Float[np.ndarray, "n 3"]
    """On the scene's surfaces, in the room."""

    def rows(self, which: Bool[np.ndarray, "n"]) -> CommonPoints:
        """Some of the points."""
        return replace(self, known_px=self.known_px[which], new_px=self.new_px[which], points=self.points[which])


def register_camera(
    new: UnposedPhoto, known: Sequence[PlacedPhoto], depth_along: DepthAlong, progress: Progress = SILENT
) -> Camera:
    """The camera of a new photo, in the room.

    Args:
        new: the photo; without a focal length it is taken to be of the same camera as a known one of its size.
        known: photos of the same room with their cameras.
        depth_along: how far the scene is.
        progress: reports and cancellation.

    Raises:
        UnavailableError: pycolmap is not installed.
        InputError: the photo does not join.
        Cancelled: on request.
    """
    common = [
        _surface_points(p.camera, pixels, depth_along)
        for p, pixels in zip(known, common_points(new, [p.photo for p in known], progress), strict=True)
    ]
    height, width = new.rgb.shape[:2]
    alike = [p.camera.intrinsics for p in known if p.photo.rgb.shape == new.rgb.shape]
    if new.focal_px is not None:
        focal, sigma = new.focal_px, SETTINGS.focal_log_sigma
    elif alike:
        focal, sigma = alike[0].fx, SETTINGS.focal_log_sigma
    else:
        focal, sigma = width / (2 * float(np.tan(LIKELY_FOV_RAD / 2))), GUESSED_LOG_SIGMA
    k = Intrinsics(width, height, focal, focal, width / 2, height / 2)
    camera = solve_camera([c for c in common if len(c.points)], k, sigma)
    if camera is None:
        raise InputError(
            f"{new.name} does not join: it has too little in common with the photos that are there; "
            "take it from a step or two beside one of them, with much of the same in view"
        )
    return camera


def _surface_points(camera: Camera, pixels: Float[np.ndarray, "n 4"], depth_along: DepthAlong) -> CommonPoints:
    depth = depth_along(camera, pixels[:, :2])
    hit = np.isfinite(depth) & (depth > 0)
    points = camera.position + depth[hit, None] * camera.rays(pixels[hit, :2])
    return CommonPoints(camera, pixels[hit, :2], pixels[hit, 2:], points)


def solve_camera(common: Sequence[CommonPoints], k: Intrinsics, focal_log_sigma: float) -> Camera | None:
    """The camera that sees common points where they are seen; None where too few agree on one.

    Args:
        common: by known photo.
        k: intrinsics to begin with; only the focal length may change.
        focal_log_sigma: how sure it is.
    """
    if sum(len(c.points) for c in common) < SETTINGS.min_points:
        return None
    points, pixels = _stack(common)
    best: tuple[int, Intrinsics, np.ndarray, np.ndarray, np.ndarray] | None = None
    is_sure = focal_log_sigma <= SETTINGS.focal_log_sigma
    for factor in (1.0,) if is_sure else np.exp(np.linspace(-1.5, 1.5, 7) * focal_log_sigma):
        tried = replace(k, fx=k.fx * float(factor), fy=k.fy * float(factor))
        cv2.setRNGSeed(SETTINGS.seed)
        is_solved, turn, shift, inliers = cv2.solvePnPRansac(
            points,
            pixels,
            tried.matrix,
            None,
            iterationsCount=SETTINGS.ransac_turns,
            reprojectionError=SETTINGS.near_share * k.width,
            flags=cv2.SOLVEPNP_EPNP,
        )
        if is_solved and inliers is not None and (best is None or len(inliers) > best[0]):
            best = (len(inliers), tried, turn.ravel(), shift.ravel(), inliers.ravel())
    if best is None or best[0] < max(SETTINGS.min_points, SETTINGS.min_share * len(points)):
        return None
    _, tried, turn, shift, inliers = best
    right = np.zeros(len(points), bool)
    right[inliers] = True
    ends = np.cumsum([0, *(len(c.points) for c in common)])
    supported = [right[a:b] for a, b in pairwise(ends)]
    return _refine_camera(common, supported, tried, turn, shift, focal_log_sigma)


def _stack(common: Sequence[CommonPoints]) -> tuple[Float[np.ndarray, "n 3"], Float[np.ndarray, "n 2"]]:
    """All points on surfaces, and where the new photo shows them."""
    return np.vstack([c.points for c in common]), np.vstack([c.new_px for c in common])


def _refine_camera(
    common: Sequence[CommonPoints],
    supported: Sequence[Bool[np.ndarray, "_"]],
    k: Intrinsics,
    turn: Float[np.ndarray, "3"],
    shift: Float[np.ndarray, "3"],
    focal_log_sigma: float,
) -> Camera:
    """The camera by epipolar lines and, much less, by the surfaces; robust against what is wrong of either."""
    thin = [max(1, len(c.points) * len(common) // SETTINGS.max_terms) for c in common]
    lines = [c.rows(np.arange(len(c.points)) % t == 0) for c, t in zip(common, thin, strict=True)]
    anchors = _stack([c.rows(s) for c, s in zip(common, supported, strict=True)])
    count = sum(len(c.points) for c in lines)
    # The surfaces' errors are alike over whole pieces of furniture: together they count as a few dozen points.
    weight = np.sqrt(SETTINGS.min_points / len(anchors[0]))

    def off(unknowns: np.ndarray) -> np.ndarray:
        camera = _camera(k, unknowns)
        seen = camera.to_camera(anchors[0])
        kc = camera.intrinsics
        pixels = seen[:, :2] / np.maximum(seen[:, 2:], 0.05) * [kc.fx, kc.fy] + [kc.cx, kc.cy]
        surface = weight * ((pixels - anchors[1]) / (SETTINGS.surface_share * k.width)).ravel()
        epipolar = (
            np.concatenate([sampson_px(c.camera, camera, c.known_px, c.new_px) for c in lines]) / SETTINGS.epipolar_px
        )
        return np.concatenate([epipolar, surface, [unknowns[6] / focal_log_sigma * np.sqrt(count) * 0.1]])

    unknowns = np.array([*turn, *shift, 0.0])
    for loss in ("soft_l1", "cauchy"):  # what is still far off then is another place
        unknowns = least_squares(off, unknowns, loss=loss, x_scale=SETTINGS.scales, max_nfev=40).x
    return _camera(k, unknowns)


def _camera(k: Intrinsics, unknowns: Float[np.ndarray, "7"]) -> Camera:
    T, focal = rigid(rotation_from_vector(unknowns[:3]), unknowns[3:6]), float(np.exp(unknowns[6]))
    return Camera(replace(k, fx=k.fx * focal, fy=k.fy * focal), np.linalg.inv(T))


def sampson_px(
    a: Camera, b: Camera, pixels_a: Float[np.ndarray, "n 2"], pixels_b: Float[np.ndarray, "n 2"]
) -> Float[np.ndarray, "n"]:
    """Signed distance (px, first order) of pairs of pixels from being views of one place (Sampson).

    Args:
        a: one camera.
        b: the other.
        pixels_a: in the one picture.
        pixels_b: in the other.
    """
    T = np.linalg.inv(b.T_world_camera) @ a.T_world_camera
    x, y, z = T[:3, 3]
    E = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]) @ T[:3, :3]
    F = np.linalg.inv(b.intrinsics.matrix).T @ E @ np.linalg.inv(a.intrinsics.matrix)
    one = np.ones((len(pixels_a), 1))
    p, q = np.hstack([pixels_a, one]), np.hstack([pixels_b, one])
    line_b, line_a = p @ F.T, q @ F
    steep = (line_b[:, :2] ** 2).sum(axis=1) + (line_a[:, :2] ** 2).sum(axis=1)
    return (q * line_b).sum(axis=1) / np.sqrt(np.maximum(steep, 1e-18))


OWN = "/"
"""Name of the scene's own photo: no file's."""


def photos_of_scene(scene: Scene, inputs: Inputs, further: Sequence[FurtherPhoto]) -> tuple[FurtherPhoto, ...]:
    """All photos whose cameras are known, the scene's own first."""
    seen = tuple((o.id, o.box_px) for o in scene.objects if o.box_px is not None)
    return (FurtherPhoto(OWN, inputs, scene.camera, seen), *(p for p in further if p.camera is not None))


def camera_of(
    photo: FurtherPhoto,
    known: Sequence[FurtherPhoto],
    scene: Scene,
    library: ShapeLibrary,
    progress: Progress = SILENT,
) -> Camera:
    """The camera of a photo in a scene.

    Args:
        photo: the photo.
        known: those whose cameras are known, the scene's own first (`photos_of_scene`).
        scene: its surfaces tell metres.
        library: where its shapes are.
        progress: reports and cancellation.

    Raises:
        UnavailableError: pycolmap is not installed.
        InputError: the photo does not join.
        Cancelled: on request.
    """
    caster = scene_world(scene, library).caster

    def depth_along(camera: Camera, pixels: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, "n"]:
        return caster.first_hits(PinholeView(camera).rays(pixels)).distance.astype(np.float64)

    placed = [_place_photo(p.name, p.inputs.photo, p.camera) for p in known if p.camera is not None]
    given = photo.inputs.intrinsics
    focal = photo.inputs.photo.exif_focal_px if given is None else given.fx
    if focal is None:
        # Photos of one room are usually of one phone: of one size, they have one focal length.
        alike = [p.photo.focal_px for p in placed if p.photo.rgb.shape == photo.inputs.photo.rgb.shape]
        focal = alike[0] if alike else None
    return register_camera(UnposedPhoto(photo.name, photo.inputs.photo.rgb, focal), placed, depth_along, progress)


def _place_photo(name: str, photo: Photo, camera: Camera) -> PlacedPhoto:
    focal = camera.intrinsics.resize(photo.width, photo.height).fx
    return PlacedPhoto(UnposedPhoto(name, photo.rgb, focal), camera)
