"""Whether the networks on this machine work: each is loaded, looks at a known photo, and its result is compared.

The bounds are coarse on purpose: half-precision and eight-bit files must pass; a wrong file, a wrong scale or swapped
channels must not.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from diorama_core.artefacts import Inputs
from diorama_core.errors import UnavailableError
from diorama_core.models.boxes import overlaps
from diorama_core.models.manifest import NETWORKS
from diorama_core.models.network import Network, Role
from diorama_core.models.runtime import SHARED_SESSIONS
from diorama_core.models.store import ModelStore
from diorama_core.pipeline import network_stages
from diorama_core.progress import SILENT, Progress


@dataclass(frozen=True)
class NetworkCheck:
    """What the trial of one network found."""

    network: Network
    ok: bool
    words: str
    """What was measured beside what is expected, or what is wrong."""
    device: str = ""
    seconds: float = 0.0


@dataclass(frozen=True)
class Measurement:
    """One number and the range in which it lies where the network works."""

    name: str
    value: float
    expected: tuple[float, float]

    @property
    def ok(self) -> bool:
        """Whether it lies within the range."""
        return bool(np.isfinite(self.value)) and self.expected[0] <= self.value <= self.expected[1]

    def __str__(self) -> str:
        low, high = self.expected
        expected = f"at least {low:g}" if np.isinf(high) else f"{low:g} to {high:g}"
        return f"{self.name} {self.value:.3g} (expected {expected})"


def check_networks(store: ModelStore, known: Inputs, progress: Progress = SILENT) -> tuple[NetworkCheck, ...]:
    """Try every network that is on this machine.

    `known` is a photo of a room with boxes and intrinsics that are known to be right.
    """
    return tuple(_check_all(store, [n for n in NETWORKS if store.has(n)], known, progress, "{}"))


def delete_failing_networks(
    store: ModelStore, network_ids: Sequence[str], known: Inputs, progress: Progress = SILENT
) -> tuple[NetworkCheck, ...]:
    """Try networks that just arrived without published checksums, and delete those that do not work.

    Args:
        store: where they lie.
        network_ids: what arrived; networks that their checksums identify are not tried.
        known: a photo of a room with boxes and intrinsics that are known to be right.
        progress: reported for each network; honours cancelling.

    Returns:
        What was found of those that were deleted.
    """
    unverified = [n for n in NETWORKS if n.id in network_ids and not n.has_checksums]
    failed = []
    for check in _check_all(store, unverified, known, progress, "Trying {}"):
        if not check.ok:
            for file in check.network.files:
                SHARED_SESSIONS.release(store.folder_of(check.network) / file.path)
            store.forget(check.network)
            failed.append(check)
    return tuple(failed)


def _check_all(
    store: ModelStore, networks: Sequence[Network], known: Inputs, progress: Progress, words: str
) -> Iterator[NetworkCheck]:
    for k, network in enumerate(networks):
        part = progress.part(k / len(networks), (k + 1) / len(networks))
        part.report(0.0, words.format(network.title))
        yield _check(store, network, known, part)


def _check(store: ModelStore, network: Network, known: Inputs, progress: Progress) -> NetworkCheck:
    begun = time.perf_counter()
    try:
        measurements = _TRIALS[network.role](store, network, known, progress)
    except UnavailableError as error:
        return NetworkCheck(network, False, str(error), seconds=time.perf_counter() - begun)
    except (ValueError, IndexError, KeyError, TypeError) as error:  # outputs of another form than the network's
        reason = " ".join(str(error).split())[:160]
        return NetworkCheck(
            network, False, f"its outputs are not as expected ({reason})", seconds=time.perf_counter() - begun
        )
    folder = store.folder_of(network).resolve()
    loaded = [n for n in SHARED_SESSIONS.report() if folder in n.path.parents]
    words = "; ".join([*map(str, measurements), *(n.note for n in loaded if n.note)])
    device = ", ".join(sorted({n.device for n in loaded}))
    return NetworkCheck(network, all(m.ok for m in measurements), words, device, time.perf_counter() - begun)


Trial = Callable[[ModelStore, Network, Inputs, Progress], tuple[Measurement, ...]]


def _detection(store: ModelStore, network: Network, known: Inputs, progress: Progress) -> tuple[Measurement, ...]:
    boxes = network_stages.detector(store, network).detect(known.photo, (), progress)
    predicted, true = (np.array([b.box for b in some], dtype=float).reshape(-1, 4) for some in (boxes, known.boxes))
    hits = int((overlaps(predicted, true).max(axis=0, initial=0.0) >= 0.5).sum())
    return Measurement("boxes", len(boxes), (2, 40)), Measurement("known objects found", hits, (1, np.inf))


def _segmentation(store: ModelStore, network: Network, known: Inputs, progress: Progress) -> tuple[Measurement, ...]:
    boxes = np.array([b.box for b in known.boxes[:4]], dtype=float)
    masks = network_stages.segmenter(store, network).masks(known.photo.rgb, boxes)
    shares = []
    for (x1, y1, x2, y2), mask in zip(boxes.astype(int), masks, strict=True):
        progress.check()
        shares.append(float(mask.mask[y1:y2, x1:x2].mean()))
    # All of a box is the answer of a network that sees no outline.
    return (Measurement("share of a box within its mask", float(np.median(shares)), (0.2, 0.97)),)


def _geometry(store: ModelStore, network: Network, known: Inputs, progress: Progress) -> tuple[Measurement, ...]:
    seen = network_stages.depth_network(store, network).predict(known.photo.rgb, None)
    valid = seen.depth_m > 0
    median_m = float(np.median(seen.depth_m[valid])) if valid.any() else np.nan
    measured = [
        Measurement("share of pixels with depth", float(valid.mean()), (0.3, 1.0)),
        Measurement("median depth, metres", median_m, (0.8, 8.0)),
    ]
    tells_focal_length = not network.id.startswith(("metric3d", "da3", "fast-depth"))
    if known.intrinsics is not None and seen.intrinsics is not None and tells_focal_length:
        ratio = seen.intrinsics.fx / known.intrinsics.fx
        measured.append(Measurement("focal length over the true one", ratio, (0.6, 1.6)))
    return tuple(measured)


def _foreground(store: ModelStore, network: Network, known: Inputs, progress: Progress) -> tuple[Measurement, ...]:
    mask = network_stages.foreground(store, network).mask(known.photo.rgb)
    return (Measurement("share of foreground", float(mask.mean()), (0.01, 0.9)),)


def _inpainting(store: ModelStore, network: Network, known: Inputs, progress: Progress) -> tuple[Measurement, ...]:
    rgb = known.photo.rgb
    h, w = rgb.shape[:2]
    hole, rim = np.zeros((h, w), dtype=bool), np.zeros((h, w), dtype=bool)
    y, x, half = h // 4, w // 4, max(4, min(h, w) // 20)
    rim[y - 2 * half : y + 2 * half, x - 2 * half : x + 2 * half] = True
    hole[y - half : y + half, x - half : x + half] = True
    filled = network_stages.inpainter(store, network).fill(rgb, hole).astype(float)
    difference = np.abs(filled[hole].mean(axis=0) - rgb[rim & ~hole].mean(axis=0)).mean()
    return (Measurement("difference of a filled hole from its rim", float(difference), (0.0, 60.0)),)


def _features(store: ModelStore, network: Network, known: Inputs, progress: Progress) -> tuple[Measurement, ...]:
    patches = network_stages.patch_features(store, network).patches(known.photo.rgb)
    return (Measurement("spread of the features", float(patches.std(axis=(0, 1)).mean()), (1e-3, 1e3)),)


def _text_and_image(store: ModelStore, network: Network, known: Inputs, progress: Progress) -> tuple[Measurement, ...]:
    if network.id == "duoduoclip":
        return (_vector_length(network_stages.shape_tower(store, network).shape([known.photo.rgb])),)
    if network.id == "openshape":
        ball = np.random.default_rng(0).standard_normal((2000, 3))
        ball /= np.linalg.norm(ball, axis=1, keepdims=True)
        return (_vector_length(network_stages.point_tower(store, network).shape(ball, np.full((2000, 3), 0.5))),)
    clip = network_stages.open_clip(store, network)
    picture = clip.images([known.photo.rgb])[0]
    # The cosines are alike where a network ignores its input.
    right, wrong = clip.texts(["a photo of a room with furniture", "a photo of the sea"]) @ picture
    return (Measurement("cosine with the right words over wrong ones", float(right - wrong), (0.02, 2.0)),)


def _vector_length(vector: np.ndarray) -> Measurement:
    return Measurement("length of a shape's vector", float(np.linalg.norm(vector)), (0.99, 1.01))


def _pose_scale(store: ModelStore, network: Network, known: Inputs, progress: Progress) -> tuple[Measurement, ...]:
    x1, y1, x2, y2 = (int(v) for v in known.boxes[0].box)
    crop = known.photo.rgb[y1:y2, x1:x2]
    scale = network_stages.scale_network(store, network)
    template, photo = scale.maps([crop, crop])
    cells = np.array([[4, 4], [8, 8], [10, 6]])
    turns = scale.turns(template, photo, cells, cells)
    return (
        Measurement("scale of a crop against itself", float(np.median(turns.scale)), (0.5, 2.0)),
        Measurement("turn of a crop against itself, radians", float(np.median(np.abs(turns.angle_rad))), (0.0, 0.8)),
    )


_TRIALS: Mapping[Role, Trial] = {
    "detection": _detection,
    "segmentation": _segmentation,
    "geometry": _geometry,
    "foreground": _foreground,
    "inpainting": _inpainting,
    "features": _features,
    "text and image": _text_and_image,
    "pose scale": _pose_scale,
}
