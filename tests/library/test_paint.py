from __future__ import annotations

import numpy as np
import trimesh
from PIL import Image
from trimesh.visual.material import PBRMaterial

from diorama_core.library.paint import repaint


def _scene() -> trimesh.Scene:
    """A big textured box (the body) on a small plain one (the foot)."""
    body, foot = trimesh.creation.box((1, 1, 1)), trimesh.creation.box((0.1, 0.1, 0.1))
    stripes = np.full((8, 8, 3), (120, 40, 40), np.uint8)
    stripes[:, ::2] = (90, 30, 30)
    uv = np.random.default_rng(0).random((len(body.vertices), 2))
    cloth = PBRMaterial(name="cloth", baseColorTexture=Image.fromarray(stripes), roughnessFactor=0.9)
    body.visual = trimesh.visual.TextureVisuals(uv=uv, material=cloth)
    foot.visual = trimesh.visual.TextureVisuals(material=PBRMaterial(name="oak", baseColorFactor=[150, 110, 70, 255]))
    return trimesh.Scene({"body": body, "foot": foot})


def test_the_main_material_takes_the_colour_and_keeps_its_detail() -> None:
    material = repaint(_scene(), (0.1, 0.2, 0.8)).geometry["body"].visual.material
    red, _, blue, _ = material.baseColorFactor
    texture = np.asarray(material.baseColorTexture)
    assert blue > 4 * red
    assert texture[0, 0, 0] < texture[0, 1, 0]
    assert (texture[..., 0] == texture[..., 2]).all()
    assert material.roughnessFactor == 0.9


def test_small_parts_keep_their_material() -> None:
    assert repaint(_scene(), (0.1, 0.2, 0.8)).geometry["foot"].visual.material.name == "oak"


def test_the_given_shape_is_unchanged() -> None:
    scene = _scene()
    repaint(scene, (0.1, 0.2, 0.8))
    assert scene.geometry["body"].visual.material.name == "cloth"


def test_shapes_without_materials_can_be_painted() -> None:
    scene = trimesh.Scene(trimesh.creation.box((1, 1, 1)))
    mesh = next(iter(repaint(scene, (1.0, 0.0, 0.0)).geometry.values()))
    assert mesh.visual.material.baseColorFactor[0] == 255


def test_the_painted_colour_averages_to_the_asked_one() -> None:
    material = repaint(_scene(), (0.5, 0.5, 0.5)).geometry["body"].visual.material
    linear = (np.asarray(material.baseColorTexture) / 255.0) ** 2.2 * (material.baseColorFactor[0] / 255)
    assert abs(linear.mean() ** (1 / 2.2) - 0.5) < 0.05


def test_a_finish_changes_how_light_is_thrown_back_and_nothing_else() -> None:
    before = _scene().geometry["body"].visual.material
    material = repaint(_scene(), None, "metal").geometry["body"].visual.material
    assert (material.metallicFactor, material.roughnessFactor) == (0.75, 0.35)
    assert material.metallicRoughnessTexture is None
    assert (np.asarray(material.baseColorTexture) == np.asarray(before.baseColorTexture)).all()
    both = repaint(_scene(), (0.1, 0.2, 0.8), "matt").geometry
    assert both["body"].visual.material.roughnessFactor == 0.95
    assert both["foot"].visual.material.name == "oak"


def test_a_finish_alone_keeps_the_colour_of_faces() -> None:
    box = trimesh.creation.box((1, 1, 1))
    box.visual.face_colors = (200, 30, 40, 255)
    mesh = next(iter(repaint(trimesh.Scene(box), None, "gloss").geometry.values()))
    red, green, _, _ = mesh.visual.material.baseColorFactor
    assert red > 4 * green
    assert mesh.visual.material.roughnessFactor == 0.12
