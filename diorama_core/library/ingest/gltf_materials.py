"""Materials and texture coordinates of glTF brought to the plain form that every loader reads alike."""

from __future__ import annotations

from typing import Any

import numpy as np

Json = dict[str, Any]
SPECULAR_GLOSSINESS = "KHR_materials_pbrSpecularGlossiness"
TRANSFORM = "KHR_texture_transform"
METAL_SPECULAR, METAL_DIFFUSE = 0.5, 0.2
"""A dark material that reflects so much is metal."""


def use_specular_glossiness(material: Json) -> None:
    """Diffuse colour and picture as base colour, glossiness as 1 - roughness, where the material has nothing else."""
    # The loader converts what it still finds, and makes dull colours white.
    extension = material.get("extensions", {}).pop(SPECULAR_GLOSSINESS, None)
    plain = material.setdefault("pbrMetallicRoughness", {})
    if extension is None or "baseColorTexture" in plain or "baseColorFactor" in plain:
        return
    diffuse = [float(v) for v in extension.get("diffuseFactor", [1.0, 1.0, 1.0, 1.0])]
    specular = [float(v) for v in extension.get("specularFactor", [1.0, 1.0, 1.0])]
    metal = (
        "diffuseTexture" not in extension
        and "specularGlossinessTexture" not in extension
        and max(specular) > METAL_SPECULAR
        and max(diffuse[:3]) < METAL_DIFFUSE
    )
    plain["baseColorFactor"] = [*specular, diffuse[3]] if metal else diffuse
    if "diffuseTexture" in extension:
        plain["baseColorTexture"] = extension["diffuseTexture"]
    plain["metallicFactor"] = 1.0 if metal else 0.0
    plain["roughnessFactor"] = 1.0 - float(extension.get("glossinessFactor", 1.0)) * (
        0.5 if "specularGlossinessTexture" in extension else 1.0
    )


def place_textures(document: Json, rows: list[Json], views: list[bytes]) -> None:
    """Texture coordinates as the base colour's picture uses them: its set, moved, turned and scaled as it says."""
    made: dict[tuple[int, str], int] = {}
    materials = document.get("materials", [])
    for mesh in document.get("meshes", []):
        for primitive in mesh["primitives"]:
            if "material" not in primitive:
                continue
            texture = materials[primitive["material"]].get("pbrMetallicRoughness", {}).get("baseColorTexture")
            transform = (texture or {}).get("extensions", {}).get(TRANSFORM, {})
            number = transform.get("texCoord", (texture or {}).get("texCoord", 0))
            source = primitive["attributes"].get(f"TEXCOORD_{number}")
            if source is None or not (transform or number):
                continue
            key = (source, repr(sorted(transform.items())))
            if key not in made:
                made[key] = _placed(document, rows, views, source, transform)
            primitive["attributes"] = {**primitive["attributes"], "TEXCOORD_0": made[key]}


def _placed(document: Json, rows: list[Json], views: list[bytes], source: int, transform: Json) -> int:
    """A new accessor with the coordinates of another one, transformed."""
    accessor = document["accessors"][source]
    if accessor["componentType"] != 5126 or "bufferView" not in accessor:
        return source
    row = rows[accessor["bufferView"]]
    stride = row.get("byteStride", 8)
    raw = np.ndarray(
        (accessor["count"], 2), "<f4", views[accessor["bufferView"]], accessor.get("byteOffset", 0), (stride, 4)
    )
    angle = float(transform.get("rotation", 0.0))
    c, s = np.cos(angle), np.sin(angle)
    scaled = raw * np.asarray(transform.get("scale", [1.0, 1.0]), float)
    turned = scaled @ np.array([[c, -s], [s, c]])
    moved = turned + np.asarray(transform.get("offset", [0.0, 0.0]), float)
    views.append(moved.astype("<f4").tobytes())
    rows.append({"buffer": 0, "byteLength": len(views[-1])})
    plain = {"bufferView": len(views) - 1, "componentType": 5126, "count": accessor["count"], "type": "VEC2"}
    document["accessors"].append(plain)
    return len(document["accessors"]) - 1
