"""Every network Diorama can use: where its files come from, how large they are, under which licence.

Files are pinned by revision and sha256 where both are known; the rest is resolved at the first pull, recorded, and
held to that record from then on (`store.py`).
"""

from __future__ import annotations

from diorama_core.errors import InputError
from diorama_core.models.network import TIERS, ModelFile, Network
from diorama_core.models.perception_networks import PERCEPTION_NETWORKS

NETWORKS: tuple[Network, ...] = (
    *PERCEPTION_NETWORKS,
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
        files=(
            ModelFile("onnx/model.onnx", 972666916, "58f621f00f5d756097615970a88a791584600dcf7c45b18a0a6267535a1ebd3c"),
        ),
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
        revision="19a057a0fb927cf239541300e74237cd56c7ffe2",
        files=(
            ModelFile(
                "textual/model.onnx", 254193396, "48c25be37b352398f2533c9426dab6f9340535e14e46f884cc894236a5060722"
            ),
            ModelFile("textual/tokenizer.json"),
            ModelFile(
                "visual/model.onnx", 351613724, "b9ce24b91a8c62ef8d40ea786051709c93140104cbf2b6b4a2cc270df3838f9c"
            ),
        ),
        about_mb=608,
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
        id="openclip-bigg14",
        role="text and image",
        title="OpenCLIP ViT-bigG-14 (your own converted copy)",
        licence="MIT",
        files=(
            ModelFile("textual/model.onnx"),
            ModelFile("textual/model.onnx_data"),
            ModelFile("textual/tokenizer.json"),
            ModelFile("visual/model.onnx"),
            ModelFile("visual/model.onnx_data"),
        ),
        about_mb=5080,
        conversion="scripts/convert_openclip.py",
    ),
    Network(
        id="openshape",
        role="text and image",
        title="OpenShape's point encoder for bigG-14 (your own converted copy)",
        licence="Apache-2.0",
        files=(ModelFile("points.onnx"),),
        about_mb=130,
        conversion="scripts/convert_openshape.py",
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


def in_half(networks: tuple[Network, ...]) -> tuple[Network, ...]:
    """The networks in half precision, where such files are published."""
    halves = {n.half_of: n for n in NETWORKS if n.half_of}
    return tuple(halves.get(n.id, n) for n in networks)


def networks_of(tier: str) -> tuple[Network, ...]:
    """The networks that a tier pulls.

    Raises:
        InputError: when there is no such tier.
    """
    if tier not in TIERS:
        raise InputError(f"there is no set {tier!r} of networks; choose {', '.join(TIERS)}")
    return tuple(n for n in NETWORKS if tier in n.tiers)
