"""Which networks could take a stage, best first, and what each stage would use now.

Light to load: neither a network's runtime nor the pipeline is needed to say what there is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from diorama_core.errors import InputError
from diorama_core.models.manifest import network
from diorama_core.models.network import Network
from diorama_core.models.runtime import calculates_in_half
from diorama_core.models.store import ModelStore
from diorama_core.perception.language.client import LmmSettings

DETECTORS = ("owlv2-large", "owlv2-base", "owlv2-base-fp16", "llmdet-tiny", "owlv2-base-int8", "yolox-nano")
OWN_DETECTOR = "own"
"""The detector that comes with Diorama."""
SEGMENTERS = (
    "sam3-tracker",
    "sam2.1-large",
    "sam2.1-base-plus",
    "sam2.1-base-plus-fp16",
    "hq-sam-base",
    "sam2.1-tiny",
    "slimsam",
)
DEPTH_NETWORKS = (
    "moge-2-vitl",
    "moge-2-vitb",
    "moge-2-vits",
    "metric3d-large",
    "da3-metric-large",
    "metric3d-small",
)
ROUGH_DEPTH = ("fast-depth",)
"""Depth that is evidence beside lines and sizes, where none of the others is here."""
INPAINTERS = ("lama", "migan")
"""Best first."""
FOREGROUNDS = (("birefnet", "birefnet-lite"), ("mvanet",))
"""Networks by kind: of each the best is used, and all kinds together; what they find is joined (supplement A)."""
PATCH_FEATURES = ("dinov2-large", "dinov2-base", "dinov2-small")
"""Best first; the publication reads an inner block of the large one."""

JOINT_EMBEDDINGS = ("openclip-b32",)
"""Words, pictures and shapes in one space, to find shapes by."""


@dataclass(frozen=True)
class NetworkChoice:
    """Networks that the user names, by id or by an ONNX file of their own; None leaves a stage to rank."""

    detector: str | None = None
    depth: str | None = None

    @property
    def detector_file(self) -> Path | None:
        """The user's own detector."""
        return _file(self.detector)

    @property
    def depth_file(self) -> Path | None:
        """The user's own depth network."""
        return _file(self.depth)

    def detectors(self) -> tuple[str, ...]:
        """Ids to look for, best first.

        Raises:
            InputError: when the named one finds no boxes.
        """
        if self.detector is None:
            return DETECTORS
        return _select_names(self.detector, (*DETECTORS, OWN_DETECTOR), "detector")

    def depth_networks(self) -> tuple[str, ...]:
        """Ids to look for, best first.

        Raises:
            InputError: when the named one reads no depth.
        """
        return _select_names(self.depth, (*DEPTH_NETWORKS, *ROUGH_DEPTH), "depth network")


def _file(named: str | None) -> Path | None:
    return Path(named) if named is not None and named.endswith(".onnx") else None


def best_here(store: ModelStore, choices: Sequence[str]) -> Network | None:
    """The best of these networks that is on this machine; None where none is.

    Of two files of the same weights, the one in half precision is taken where a CUDA card calculates with it, and the
    full one elsewhere.
    """
    here = [network(i) for i in choices if store.has(network(i))]
    if not here:
        return None
    half = next((n for n in here if n.half_of == here[0].id), None)
    return half if half is not None and calculates_in_half() else here[0]


def _select_names(named: str | None, known: tuple[str, ...], what: str) -> tuple[str, ...]:
    if named is None:
        return known
    if named not in known:
        raise InputError(f"{named!r} is no {what}; choose {', '.join(known)}")
    return (named,)


@dataclass(frozen=True)
class StageStatus:
    """What one stage would use now, for people."""

    stage: str
    implementation: str
    """In words."""
    network_id: str | None
    """The network in use, or the one that would be pulled first; None where no network takes this stage."""
    present: bool
    """Whether that network is on this machine."""
    size_mb: int
    licence: str
    advice: str = ""
    """What to do to get a better implementation; empty where the best one is in use."""


def profile_status(*, store: ModelStore | None = None) -> tuple[StageStatus, ...]:
    """For every stage of the auto profile: what takes it now, and what would take it better."""
    store = store or ModelStore.default()
    lmm = LmmSettings.from_environment()
    return (
        _status(store, "detection", DETECTORS, "boxes drawn by you, proposals to correct"),
        _status(store, "outlines", SEGMENTERS, "outlines by the network that comes along, and by colour"),
        _status(store, "depth and camera", (*DEPTH_NETWORKS, *ROUGH_DEPTH), "lines, known sizes and the floor"),
        StageStatus(
            "support graph",
            f"language model {lmm.model} at {lmm.base_url}" if lmm else "geometry: contact, containment, usual places",
            None,
            True,
            0,
            "",
            "" if lmm else "set DIORAMA_LMM_BASE_URL and DIORAMA_LMM_MODEL to ask a language model",
        ),
        _status(store, "room behind furniture", INPAINTERS, "surfaces continued from what is seen of them"),
        _status(store, "retrieval", JOINT_EMBEDDINGS, "category, size, outline, inner edges and colour"),
        StageStatus("pose", "render and compare", None, True, 0, ""),
    )


def _status(store: ModelStore, stage: str, choices: tuple[str, ...], embedded: str) -> StageStatus:
    here = best_here(store, choices)
    wanted = network(next(i for i in choices if "default" in network(i).tiers))
    better = here is None or choices.index(here.half_of or here.id) > choices.index(wanted.id)
    shown = here or wanted
    return StageStatus(
        stage=stage,
        implementation=here.title if here else embedded,
        network_id=shown.id,
        present=here is not None,
        size_mb=round(shown.size_bytes / 1e6),
        licence=shown.licence,
        advice=f"{wanted.title}, {wanted.size_bytes / 1e6:.0f} MB: diorama models pull default" if better else "",
    )
