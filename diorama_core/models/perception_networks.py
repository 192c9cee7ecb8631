"""The networks that find, outline and measure what a photo shows; `manifest.py` has the others."""

from __future__ import annotations

from diorama_core.models.network import ModelFile, Network, Tier


def _owl(kind: str, title: str, graph: ModelFile, tiers: tuple[Tier, ...] = (), half_of: str = "") -> Network:
    return Network(
        id=kind,
        role="detection",
        title=title,
        licence="Apache-2.0",
        repo="onnx-community/owlv2-base-patch16-ensemble-ONNX",
        revision="180d6ef7599bd69bb48db5c72bd49ad03ddfab80",
        files=(graph, _OWL_TOKENS),
        tiers=tiers,
        about_mb=311,
        half_of=half_of,
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
        about_mb=175 if "fp16" in kind else 328,
        half_of=kind.removesuffix("-fp16") if kind.endswith("-fp16") else "",
    )


def _with_data(*graphs: str) -> tuple[ModelFile, ...]:
    """Graphs whose weights lie beside them, of which no sizes or checksums are published."""
    return tuple(ModelFile(f"onnx/{graph}{end}") for graph in graphs for end in (".onnx", ".onnx_data"))


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

PERCEPTION_NETWORKS: tuple[Network, ...] = (
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
        tiers=("micro", "tiny", "lite", "default", "paper"),
    ),
    _owl(
        "owlv2-base-int8",
        "OWLv2 base int8",
        ModelFile(
            "onnx/model_int8.onnx", 163173570, "e9cc288738a96a5a9b730801f622b2e1a531ed2a93d02dd1227a4d35fd9690c6"
        ),
        ("tiny", "lite"),
    ),
    _owl(
        "owlv2-base",
        "OWLv2 base",
        ModelFile("onnx/model.onnx", 614219112, "ca3ea10811d55cd8763058c6eaddec514bbb91cc07ab774a0db0775346aef732"),
        ("default",),
    ),
    _owl("owlv2-base-fp16", "OWLv2 base fp16", ModelFile("onnx/model_fp16.onnx"), half_of="owlv2-base"),
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
        id="llmdet-tiny",
        role="detection",
        title="LLMDet tiny (your own converted copy)",
        licence="Apache-2.0",
        files=(ModelFile("model.onnx"), ModelFile("tokenizer.json")),
        about_mb=700,
        conversion="scripts/convert_llmdet.py",
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
        _with_data("vision_encoder", "prompt_encoder_mask_decoder"),
        ("default",),
    ),
    _sam2(
        "sam2.1-base-plus-fp16",
        "SAM 2.1 base plus fp16",
        "onnx-community/sam2.1-hiera-base-plus-ONNX",
        "bab18593f44e652f04cf18b60b3690f60e8996b0",
        _with_data("vision_encoder_fp16", "prompt_encoder_mask_decoder"),
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
    Network(
        id="hq-sam-base",
        role="segmentation",
        title="HQ-SAM base",
        licence="Apache-2.0",
        url="https://github.com/CVHub520/X-AnyLabeling/releases/download/v2.0.0",
        files=(ModelFile("sam_hq_vit_b_encoder.onnx"), ModelFile("sam_hq_vit_b_decoder.onnx")),
        about_mb=380,
    ),
    Network(
        id="sam3-tracker",  # no set pulls it: its licence is its own, and whoever names it accepts that
        role="segmentation",
        title="SAM 3 tracker (points and boxes)",
        licence="SAM License, github.com/facebookresearch/sam3",
        repo="onnx-community/sam3-tracker-ONNX",
        files=_with_data("vision_encoder_fp16", "prompt_encoder_mask_decoder"),
        about_mb=958,
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
        id="da3-metric-large",  # its half-precision file answers the same for every picture on some cards
        role="geometry",
        title="Depth Anything 3 metric large",
        licence="Apache-2.0",
        repo="Heliosoph/da3metric-large-onnx",
        revision="159aa982e543db46b672e196d3658f1d39a258b6",
        files=(
            ModelFile("model.onnx", 1337201123, "ba0fd3c613901450c60f29ca7be63512ff06d0b8cd1601a60f4918726ea1a9cb"),
        ),
    ),
)
