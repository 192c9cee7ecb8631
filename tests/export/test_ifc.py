"""IFC models, checked by IfcOpenShell's validator and its geometry kernel."""

from __future__ import annotations

import json

import numpy as np
import pytest

from diorama_core.export import export_scene
from diorama_core.export.ifc import MIN_WALL_M
from diorama_core.library.stretch import relative_scale
from tests.export.test_plan import room_with_door_and_window
from tests.primitives import PrimitiveLibrary

ifcopenshell = pytest.importorskip("ifcopenshell", reason="needs the extra [bim]")
LIBRARY = PrimitiveLibrary()


@pytest.fixture
def model(tmp_path):
    export_scene(room_with_door_and_window(), LIBRARY, tmp_path / "room.ifc", "ifc")
    return ifcopenshell.open(str(tmp_path / "room.ifc"))


def test_the_validator_finds_nothing(model) -> None:
    import ifcopenshell.validate

    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(model, logger, express_rules=True)
    assert [json.dumps(s, default=str)[:300] for s in logger.statements] == []


def test_elements_and_how_they_belong_together(model) -> None:
    assert len(model.by_type("IfcWall")) == 4
    assert len(model.by_type("IfcSlab")) == 1
    assert len(model.by_type("IfcFurniture")) == 5
    storey = model.by_type("IfcBuildingStorey")[0]
    inside = [e for rel in storey.ContainsElements for e in rel.RelatedElements]
    assert len(inside) == 4 + 2 + 2
    (space,) = (rel.RelatedObjects[0] for rel in storey.IsDecomposedBy)
    assert {e.Tag for rel in space.ContainsElements for e in rel.RelatedElements} == {
        f.Tag for f in model.by_type("IfcFurniture")
    }
    door = model.by_type("IfcDoor")[0]
    opening = door.FillsVoids[0].RelatingOpeningElement
    assert opening.VoidsElements[0].RelatingBuildingElement.Name == "back"
    table = next(f for f in model.by_type("IfcFurniture") if f.Tag == "t")
    assert (table.Name, table.ObjectType) == ("table", "table")


def test_elements_have_types_materials_and_quantities(model) -> None:
    import ifcopenshell.util.element as of

    for element in (*model.by_type("IfcFurniture"), *model.by_type("IfcDoor"), *model.by_type("IfcWindow")):
        kind = of.get_type(element)
        assert kind.is_a(f"{element.is_a()}Type")
        assert of.get_materials(element)
    assert len(model.by_type("IfcTypeProduct")) == len(model.by_type("IfcRepresentationMap"))
    wall = next(w for w in model.by_type("IfcWall") if w.Name == "back")
    assert [layer.LayerThickness for layer in of.get_material(wall).ForLayerSet.MaterialLayers] == [MIN_WALL_M]
    measured = of.get_psets(wall, qtos_only=True)["Qto_WallBaseQuantities"]
    assert (measured["Length"], measured["Height"]) == pytest.approx((4.0, 2.6))
    assert measured["NetVolume"] == pytest.approx(measured["NetSideArea"] * MIN_WALL_M)
    (space,) = model.by_type("IfcSpace")
    assert of.get_psets(space, qtos_only=True)["Qto_SpaceBaseQuantities"]["NetFloorArea"] == pytest.approx(20.0)


def test_shapes_are_shared_and_stand_where_the_scene_says(model) -> None:
    import ifcopenshell.geom

    scene = room_with_door_and_window()
    maps = model.by_type("IfcRepresentationMap")
    assert len(maps) == len({(o.shape_id, o.colour, o.finish, relative_scale(o.pose.scale)) for o in scene.objects})
    settings = ifcopenshell.geom.settings()
    settings.set("use-world-coords", True)
    for element in (*model.by_type("IfcFurniture"), *model.by_type("IfcDoor"), *model.by_type("IfcWindow")):
        shape = ifcopenshell.geom.create_shape(settings, element)
        points = np.array(shape.geometry.verts).reshape(-1, 3)
        item = scene.object(element.Tag)
        there = item.pose.apply(LIBRARY.mesh(item.shape_id).vertices)
        np.testing.assert_allclose(points.min(axis=0), there.min(axis=0), atol=1e-4)
        np.testing.assert_allclose(points.max(axis=0), there.max(axis=0), atol=1e-4)


def test_openings_are_cut_out_of_walls(model) -> None:
    import ifcopenshell.geom
    import ifcopenshell.util.shape

    wall = next(w for w in model.by_type("IfcWall") if w.Name == "back")
    shape = ifcopenshell.geom.create_shape(ifcopenshell.geom.settings(), wall)
    volume = ifcopenshell.util.shape.get_volume(shape.geometry)
    door = room_with_door_and_window().object("d")
    low = door.corners_world[:, 2].clip(0, 2.6)
    assert volume == pytest.approx(MIN_WALL_M * (4 * 2.6 - 0.88 * (low.max() - low.min())), rel=1e-3)
