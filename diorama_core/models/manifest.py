"""Every network Diorama can use: where its files come from, how large they are, under which licence.

Files are pinned by revision and sha256 where both are known; the rest is resolved at the first pull, recorded, and
held to that record from then on (`store.py`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from diorama_core.errors import InputError

Role = Literal[
    "detection", "segmentation", "geometry", "foreground", "inpainting", "features", "text and image", "pose scale"
]
Tier = Literal["tiny", "lite", "default", "paper"]
TIERS: tuple[Tier, ...] = ("tiny", "lite", "default", "paper")
"""Sets of networks, smallest first."""


@dataclass(frozen=True)
class ModelFile:
    """One file of a network."""

    path: str
    """Inside the repository, and inside the network's own folder."""
    bytes: int | None = None
    sha256: str | None = None
    also_sha256: tuple[str, ...] = ()
    """Other publications of the same weights."""


@dataclass(frozen=True)
class Network:
    """One network and everything needed to fetch it."""

    id: str
    role: Role
    title: str
    licence: str
    files: tuple[ModelFile, ...]
    repo: str = ""
    """On the hub; empty where `url` is given or where users convert their own copy of a checkpoint."""
    revision: str | None = None
    """40 hexadecimal digits; a branch name or None is resolved at the first pull."""
    url: str = ""
    """Folder of the files, for networks that are not on the hub."""
    about_mb: int = 0
    """Size where the exact number of bytes is not known."""
    conversion: str = ""
    """Script that makes the files from the user's own checkpoint."""
    tiers: tuple[Tier, ...] = ()
    side: int | None = None
    """Of the square picture it takes, where its graph leaves that open."""

    @property
    def size_bytes(self) -> int:
        """All files together, about."""
        if any(f.bytes is None for f in self.files):
            return self.about_mb * 1_000_000
        return sum(f.bytes or 0 for f in self.files)

    @property
    def checked_by(self) -> str:
        """How a download is checked, in words for people."""
        if all(f.sha256 for f in self.files):
            return "published checksum"
        known = "size checked; " if all(f.bytes for f in self.files) else ""
        return f"{known}no published checksum: held to the first download's"

    @property
    def pullable(self) -> bool:
        """Whether the files can be fetched from somewhere."""
        return bool(self.repo or self.url)


def _owl(kind: str, graph: str, size: int, sha256: str, tiers: tuple[Tier, ...]) -> Network:
    return Network(
        id=kind,
        role="detection",
        title=f"OWLv2 base{' int8' if 'int8' in kind else ''}",
        licence="Apache-2.0",
        repo="onnx-community/owlv2-base-patch16-ensemble-ONNX",
        revision="180d6ef7599bd69bb48db5c72bd49ad03ddfab80",
        files=(ModelFile(graph, size, sha256), _OWL_TOKENS),
        tiers=tiers,
    )


def _sam2(
    kind: str, title: str, repo: str, revision: str, parts: tuple[ModelFile, ...], tiers: tuple[Tier, ...] = ()
) -> Network:
    return Network(
        id=kind,
        role="segmentation",
        title=title,
        licence="Apache-2.0",
        repo=repo,
        revision=revision,
        files=parts,
        tiers=tiers,
        about_mb=328,
    )


def _moge(
    size: str, title: str, count: int, sha256: str, tiers: tuple[Tier, ...], revision: str | None = None
) -> Network:
    return Network(
        id=f"moge-2-{size}",
        role="geometry",
        title=title,
        licence="MIT",
        repo=f"Ruicheng/moge-2-{size}-normal-onnx",
        revision=revision,
        files=(ModelFile("model.onnx", count, sha256),),
        tiers=tiers,
    )


_OWL_TOKENS = ModelFile("tokenizer.json", 3642208, "e277946093d72c7748281a6a344d6c79a5226c48954d6797dc36984aea23ac60")
_SAM_DECODER_DATA = ModelFile(
    "onnx/prompt_encoder_mask_decoder.onnx_data",
    20958208,
    "bfdcd4f7ee04298a82fe1aaf1bd7b8edf544d36901e1a886f01892fb915bd63c",
)

NETWORKS: tuple[Network, ...] = (
    Network(
        id="yolox-nano",
        role="detection",
        title="YOLOX nano (80 everyday classes)",
        licence="Apache-2.0",
        url="https://github.com/Megvii-BaseDetection/YOLOX/releases/download/0.1.1rc0",
        files=(
            ModelFile(
                "yolox_nano.onnx",
                3659407,
                "c789161ed43c8269fcd4e67c67eeeb4e80c622da2eb296a20bc6007bd18a0b7d",
                ("e8af074932d4ed7e232278e3055cefcdea3edf178874a3694ae292649fb464dd",),
            ),
        ),
        tiers=("tiny", "lite", "default", "paper"),
    ),
    _owl(
        "owlv2-base-int8",
        "onnx/model_int8.onnx",
        163173570,
        "e9cc288738a96a5a9b730801f622b2e1a531ed2a93d02dd1227a4d35fd9690c6",
        ("tiny", "lite"),
    ),
    _owl(
        "owlv2-base",
        "onnx/model.onnx",
        614219112,
        "ca3ea10811d55cd8763058c6eaddec514bbb91cc07ab774a0db0775346aef732",
        ("default",),
    ),
    Network(
        id="owlv2-large",
        role="detection",
        title="OWLv2 large",
        licence="Apache-2.0",
        repo="onnx-community/owlv2-large-patch14-ensemble-ONNX",
        files=(ModelFile("onnx/model.onnx"), ModelFile("tokenizer.json")),
        about_mb=1744,
        tiers=("paper",),
        side=1008,
    ),
    Network(
        id="slimsam",
        role="segmentation",
        title="SlimSAM (points and boxes)",
        licence="Apache-2.0",
        repo="Xenova/slimsam-77-uniform",
        revision="points-and-boxes",
        files=(ModelFile("onnx/vision_encoder.onnx"), ModelFile("onnx/prompt_encoder_mask_decoder.onnx")),
        about_mb=40,
        tiers=("tiny", "lite"),
    ),
    _sam2(
        "sam2.1-tiny",
        "SAM 2.1 tiny",
        "onnx-community/sam2.1-hiera-tiny-ONNX",
        "814a066640debee5a91e70aa401fb8e17e030503",
        (
            ModelFile(
                "onnx/vision_encoder_fp16.onnx",
                314925,
                "7773e79d589dada8e1e630cc7eb18b17b2c5b4faeb1eaab5ebf9df618ecbd50a",
            ),
            ModelFile(
                "onnx/vision_encoder_fp16.onnx_data",
                67005504,
                "a4dd3759e9b6a476d991fb3493787992e78777e51462695e1bede71ae258103e",
            ),
            ModelFile(
                "onnx/prompt_encoder_mask_decoder.onnx",
                213114,
                "874414704c5d686db7d206a35f6e15d26563d50c8c4468fccc6739bd7e491dcf",
            ),
            ModelFile(
                "onnx/prompt_encoder_mask_decoder.onnx_data",
                20958208,
                "e9874d900dd4134ed60eab1e97910327c2419e0b2954485d8fd6e7f1a1470f47",
            ),
        ),
    ),
    _sam2(
        "sam2.1-base-plus",
        "SAM 2.1 base plus",
        "onnx-community/sam2.1-hiera-base-plus-ONNX",
        "bab18593f44e652f04cf18b60b3690f60e8996b0",
        tuple(
            ModelFile(f"onnx/{part}")
            for part in (
                "vision_encoder.onnx",
                "vision_encoder.onnx_data",
                "prompt_encoder_mask_decoder.onnx",
                "prompt_encoder_mask_decoder.onnx_data",
            )
        ),
        ("default",),
    ),
    _sam2(
        "sam2.1-large",
        "SAM 2.1 large",
        "onnx-community/sam2.1-hiera-large-ONNX",
        "3c23431f721e69cae82dbfd0c28fd692cc714021",
        (
            ModelFile(
                "onnx/vision_encoder.onnx",
                1350487,
                "ad3a8161c6bd6d8beea811300c60e20d626035feaa3c19622ace27b22e25bec8",
            ),
            ModelFile(
                "onnx/vision_encoder.onnx_data",
                888587456,
                "88c501a65b6aaeac99b65a275f3f559727404283930d107d499fda8714ba7e5a",
            ),
            ModelFile(
                "onnx/prompt_encoder_mask_decoder.onnx",
                213114,
                "a21b3b09f6e5f5838d630d92a150914ca58f8f58b603b8f53fc32b03da982203",
            ),
            _SAM_DECODER_DATA,
        ),
        ("paper",),
    ),
    _moge(
        "vits",
        "MoGe-2 small",
        140852051,
        "24eacb5dc7a2c54c7bc98f7de085ffbed79ad006ea5b664c2c2cdc02ff3a52f0",
        ("tiny", "lite"),
        "e50ffda41565591092adea54c6ac83d6212e1e23",
    ),
    _moge(
        "vitb",
        "MoGe-2 base",
        419411850,
        "bbf14e07a30f11e69d36ab861590123f5598ababcbc8946a063eb4a966f35a21",
        ("default",),
    ),
    _moge("vitl", "MoGe-2 large", 1324265014, "afbc4ccc3450298f3afb35b90f015f4c4f552dea21dc6470d5f7b78b77e2d751", ()),
    Network(
        id="metric3d-small",
        role="geometry",
        title="Metric3D v2 small",
        licence="BSD-2-Clause",
        repo="onnx-community/metric3d-vit-small",
        files=(
            ModelFile(
                "onnx/model_fp16.onnx", 75778144, "4afcc0893dbb3c0c63e270f8bb24bfa63ccf2dc68ab9c0c3601fdae4f0aafd9b"
            ),
        ),
    ),
    Network(
        id="metric3d-large",
        role="geometry",
        title="Metric3D v2 large",
        licence="BSD-2-Clause",
        repo="onnx-community/metric3d-vit-large",
        files=(
            ModelFile(
                "onnx/model_fp16.onnx", 825204259, "bede661725a7e1808f2cd69d07f3d2a6e5b011a1bde4128e5df9d21232224d8e"
            ),
        ),
        tiers=("paper",),
    ),
    Network(
        id="birefnet-lite",
        role="foreground",
        title="BiRefNet lite",
        licence="MIT",
        repo="onnx-community/BiRefNet_lite-ONNX",
        revision="de15b22ba131738a16dff04aab8bdf8dc32e3ac1",
        files=(
            ModelFile("onnx/model.onnx", 224005088, "5600024376f572a557870a5eb0afb1e5961636bef4e1e22132025467d0f03333"),
        ),
        tiers=("default",),
    ),
    Network(
        id="birefnet",
        role="foreground",
        title="BiRefNet",
        licence="MIT",
        repo="onnx-community/BiRefNet-ONNX",
        revision="534d3c82d3bb8b2f0867db6dfbc3a525b8e42f67",
        files=(ModelFile("onnx/model.onnx", 972666916),),
        tiers=("paper",),
    ),
    Network(
        id="mvanet",
        role="foreground",
        title="MVANet (your own converted copy)",
        licence="MIT",
        files=(ModelFile("model.onnx"),),
        about_mb=380,
    ),
    Network(
        id="migan",
        role="inpainting",
        title="MI-GAN",
        licence="MIT",
        repo="andraniksargsyan/migan",
        revision="406830d0fa60666da0071c342ad2fbc8f30c5c64",
        files=(
            ModelFile(
                "migan_pipeline_v2.onnx", 28079181, "6f1f3530a1a2324b19752018ce756088b07973cda8d7d890034ace5c8a48c40b"
            ),
        ),
        tiers=("lite",),
    ),
    Network(
        id="lama",
        role="inpainting",
        title="LaMa",
        licence="Apache-2.0",
        repo="Carve/LaMa-ONNX",
        revision="c3c0c9e468934d62e79c329e35d82dd09ff8c444",
        files=(
            ModelFile("lama_fp32.onnx", 208044816, "1faef5301d78db7dda502fe59966957ec4b79dd64e16f03ed96913c7a4eb68d6"),
        ),
        tiers=("default", "paper"),
    ),
    Network(
        id="dinov2-small",
        role="features",
        title="DINOv2 small",
        licence="Apache-2.0",
        repo="onnx-community/dinov2-small-ONNX",
        revision="08c606e3123472a388efa59181b677d428f69bbd",
        files=(ModelFile("onnx/model.onnx"),),
        about_mb=88,
    ),
    Network(
        id="dinov2-base",
        role="features",
        title="DINOv2 base",
        licence="Apache-2.0",
        repo="onnx-community/dinov2-base",
        revision="31ef06cac16d5d301c5930d147002a058c85a5e4",
        files=(
            ModelFile("onnx/model.onnx", 346627111, "320d1012a6fc65b101fc85ca30ee7a47b2e4f6a2e8bd78fb9d7036def0e30cb0"),
        ),
        tiers=("default",),
    ),
    Network(
        id="dinov2-large",
        role="features",
        title="DINOv2 large",
        licence="Apache-2.0",
        repo="onnx-community/dinov2-large",
        files=(ModelFile("onnx/model.onnx"),),
        about_mb=1218,
        tiers=("paper",),
    ),
    Network(
        id="openclip-b32",
        role="text and image",
        title="OpenCLIP ViT-B-32 (laion2b)",
        licence="MIT",
        repo="immich-app/ViT-B-32__laion2b-s34b-b79k",
        files=(
            ModelFile("textual/model.onnx"),
            ModelFile("textual/tokenizer.json"),
            ModelFile("visual/model.onnx"),
        ),
        about_mb=605,
        tiers=("lite", "default", "paper"),
    ),
    Network(
        id="duoduoclip",
        role="text and image",
        title="DuoduoCLIP shape tower (your own converted copy)",
        licence="MIT",
        files=(ModelFile("visual.onnx"),),
        about_mb=350,
        conversion="scripts/convert_duoduoclip.py",
    ),
    Network(
        id="gigapose-scale",
        role="pose scale",
        title="GigaPose scale and in-plane network (your own converted copy)",
        licence="MIT",
        files=(ModelFile("features.onnx"), ModelFile("regressor.onnx")),
        about_mb=60,
        conversion="scripts/convert_gigapose.py",
    ),
)


def network(network_id: str) -> Network:
    """The network of this id.

    Raises:
        InputError: when there is none.
    """
    for known in NETWORKS:
        if known.id == network_id:
            return known
    raise InputError(f"there is no network {network_id!r}; `diorama models list` names them")


def networks_of(tier: str) -> tuple[Network, ...]:
    """The networks that a tier pulls.

    Raises:
        InputError: when there is no such tier.
    """
    if tier not in TIERS:
        raise InputError(f"there is no set {tier!r} of networks; choose {', '.join(TIERS)}")
    return tuple(n for n in NETWORKS if tier in n.tiers)
