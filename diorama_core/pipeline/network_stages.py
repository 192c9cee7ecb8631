"""Each network of the manifest as what a stage uses: files and identity from the store, settings by its id."""

from __future__ import annotations

from dataclasses import replace

from diorama_core.library.record import ShapeLibrary
from diorama_core.models.clip import DuoduoClip, OpenClip
from diorama_core.models.depth import DepthAnything3, Metric3d, Moge2
from diorama_core.models.fast_depth import FastDepth
from diorama_core.models.features import Dinov2
from diorama_core.models.foreground import Foreground
from diorama_core.models.gigapose import GigaPoseScale
from diorama_core.models.grounding import GroundingDino
from diorama_core.models.inpainting import Filler, Lama, Migan
from diorama_core.models.manifest import network
from diorama_core.models.network import Network
from diorama_core.models.openshape import OpenShape
from diorama_core.models.owlv2 import SIDE, Owlv2
from diorama_core.models.seen_depth import GeometryNetwork
from diorama_core.models.segment_anything import BoxSegmenter, HqSam, Sam2, SlimSam, sam3_tracker
from diorama_core.models.store import ModelStore
from diorama_core.models.yolox import Yolox
from diorama_core.perception.foundation.detection import EverydayDetection, OpenVocabularyDetection
from diorama_core.pipeline import network_stages
from diorama_core.pipeline.stages import Stages
from diorama_core.protocols import DetectionStage
from diorama_core.retrieval.hierarchical import HierarchicalRetrieval
from diorama_core.retrieval.joint import ClipEmbedding, JointEmbedding, JointSimilarity, PointEmbedding

OPENCLIP_WIDTHS = {"openclip-bigg14": 1280}
"""Numbers of a vector of OpenCLIP, by the network's id; the others have 512."""


def detector(store: ModelStore, chosen: Network) -> DetectionStage:
    """OWLv2 and LLMDet for any words, YOLOX for everyday classes."""
    weights = store.identity(chosen)
    graph = store.path(chosen, chosen.files[0].path)
    if chosen.id.startswith("yolox"):
        return EverydayDetection(Yolox(graph, weights))
    if chosen.id.startswith("llmdet"):
        words = GroundingDino(graph, store.path(chosen, "tokenizer.json"), weights)
        return OpenVocabularyDetection(words, 0.3, template="{}")  # its examples ask for bare words, at 0.3 to 0.4
    return OpenVocabularyDetection(Owlv2(graph, store.path(chosen, "tokenizer.json"), weights, chosen.side or SIDE))


def everyday_detector(store: ModelStore) -> EverydayDetection | None:
    """What finds everyday objects in a fraction of a second, while a person marks; None where it is not here."""
    yolox = network("yolox-nano")
    if not store.has(yolox):
        return None
    return EverydayDetection(Yolox(store.path(yolox, yolox.files[0].path), store.identity(yolox)))


def segmenter(store: ModelStore, chosen: Network) -> BoxSegmenter:
    """SAM 2.1, SAM 3's tracker, HQ-SAM or SlimSAM."""
    weights = store.identity(chosen)
    encoder, decoder = (
        store.path(chosen, next(f.path for f in chosen.files if part in f.path and f.path.endswith(".onnx")))
        for part in ("encoder", "decoder")
    )
    if chosen.id == "slimsam":
        return SlimSam(encoder, decoder, weights)
    if chosen.id.startswith("hq-sam"):
        return HqSam(encoder, decoder, weights)
    if chosen.id == "sam3-tracker":
        return sam3_tracker(encoder, decoder, weights)
    return Sam2(encoder, decoder, weights)


def inpainter(store: ModelStore, chosen: Network) -> Filler:
    """LaMa or MI-GAN."""
    graph, weights = store.path(chosen, chosen.files[0].path), store.identity(chosen)
    return Lama(graph, weights) if chosen.id == "lama" else Migan(graph, weights)


def depth_network(store: ModelStore, chosen: Network) -> GeometryNetwork:
    """Metric3D v2, Depth Anything 3, MoGe-2 or FastDepth."""
    graph, weights = store.path(chosen, chosen.files[0].path), store.identity(chosen)
    if chosen.id == "fast-depth":
        return FastDepth(graph, weights)
    if chosen.id.startswith("da3"):
        return DepthAnything3(graph, weights)
    return Metric3d(graph, weights) if chosen.id.startswith("metric3d") else Moge2(graph, weights)


def foreground(store: ModelStore, chosen: Network) -> Foreground:
    """BiRefNet or MVANet."""
    return Foreground(store.path(chosen, chosen.files[0].path), store.identity(chosen))


def patch_features(store: ModelStore, chosen: Network) -> Dinov2:
    """DINOv2; of the large one the inner block that the publication reads."""
    block = 17 if chosen.id == "dinov2-large" else None
    return Dinov2(store.path(chosen, chosen.files[0].path), store.identity(chosen), block)


def open_clip(store: ModelStore, chosen: Network) -> OpenClip:
    """Words and pictures in one space."""
    places = ("textual/model.onnx", "visual/model.onnx", "textual/tokenizer.json")
    text, image, tokenizer = (store.path(chosen, place) for place in places)
    width = OPENCLIP_WIDTHS.get(chosen.id, OpenClip.width)
    return OpenClip(text, image, tokenizer, store.identity(chosen), width)


def shape_tower(store: ModelStore, chosen: Network) -> DuoduoClip:
    """Shapes in OpenCLIP's space."""
    return DuoduoClip(store.path(chosen, chosen.files[0].path), store.identity(chosen))


def point_tower(store: ModelStore, chosen: Network) -> OpenShape:
    """Shapes, by their points, in the space of OpenCLIP bigG-14."""
    return OpenShape(store.path(chosen, chosen.files[0].path), store.identity(chosen))


def scale_network(store: ModelStore, chosen: Network) -> GigaPoseScale:
    """GigaPose's second network."""
    features, regressor = (store.path(chosen, f.path) for f in chosen.files)
    return GigaPoseScale(features, regressor, store.identity(chosen))


def with_joint_retrieval(base: Stages, library: ShapeLibrary, store: ModelStore) -> Stages:
    """`base` with looks compared in OpenCLIP's space, shapes by DuoduoCLIP's tower where the user converted one."""
    clip, tower = network("openclip-b32"), network("duoduoclip")
    if not store.has(clip):
        return base
    shapes = network_stages.shape_tower(store, tower) if store.has(tower) else None
    embedding = ClipEmbedding(network_stages.open_clip(store, clip), shapes)
    return replace(base, retrieval=HierarchicalRetrieval(library, similarity=JointSimilarity(library, embedding)))


def published_embeddings(store: ModelStore) -> dict[str, JointEmbedding]:
    """The embeddings of the publication's retrieval table whose networks are here, by their names there."""
    embeddings: dict[str, JointEmbedding] = {}
    large, points = network("openclip-bigg14"), network("openshape")
    small, tower = network("openclip-b32"), network("duoduoclip")
    if store.has(large):
        clip = network_stages.open_clip(store, large)
        embeddings["CLIP"] = ClipEmbedding(clip)
        if store.has(points):
            embeddings["OS"] = PointEmbedding(clip, network_stages.point_tower(store, points))
    if store.has(small) and store.has(tower):
        embeddings["DD"] = ClipEmbedding(
            network_stages.open_clip(store, small), network_stages.shape_tower(store, tower)
        )
    return embeddings
