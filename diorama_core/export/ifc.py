"""A scene as IFC4, by IfcOpenShell: a storey with a space, walls, openings, slabs, doors, windows and furniture.

Metres, +Z up. Shapes are types with their materials: objects of one shape share its triangles. Quantities are those of
the standard's base sets. Each element's property set `Diorama` names the object's id, category, shape and supporter.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from diorama_core.export.files import whole_file
from diorama_core.export.gathering import ExportMesh, ExportObject, ExportScene
from diorama_core.export.ifc_document import IfcDocument
from diorama_core.geometry.planes import signed_area
from diorama_core.geometry.wall_lines import DrawnWall, Opening, wall_lines
from diorama_core.io.srgb import srgb_to_linear
from diorama_core.library.taxonomy import column
from diorama_core.progress import SILENT, Progress
from diorama_core.render.appearance import Material
from diorama_core.scene.types import HomeRoom, Plane

CLASSES: Mapping[str, str] = column("ifc_class")
"""Classes of categories; all others are furniture."""
MIN_WALL_M = 0.1
"""Least thickness of a wall, outward: a photo shows inner faces alone, and no partition is thinner."""
THROUGH_M = 0.05
"""Openings reach this far through their wall on both sides."""


def write_ifc(scene: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write the model, as `Writer` says."""
    builder = _Builder(scene, progress)
    with whole_file(Path(path)) as temporary, temporary.open("w", encoding="ascii", newline="\n") as stream:
        stream.writelines(builder.build().lines())


class _Builder:
    """Adds a gathered scene to a file."""

    def __init__(self, scene: ExportScene, progress: Progress) -> None:
        self._scene, self._progress, self._to = scene, progress, IfcDocument()
        self._maps: dict[str, Any] = {}
        self._types: dict[tuple[str, str], Any] = {}
        self._typed: dict[Any, list[Any]] = {}
        self._storeys: dict[int, Any] = {}

    def build(self) -> IfcDocument:
        """The whole model."""
        building = self._building()
        rooms = self._scene.scene.rooms
        numbers = sorted({r.storey for r in rooms}) or [0]
        self._storeys = {n: self._storey(building, n) for n in numbers}
        self._to.entity("IfcRelAggregates", RelatingObject=building, RelatedObjects=[*self._storeys.values()])
        walls = wall_lines([p.plane for p in self._scene.planes], self._items, self._scene.scene)
        contents: dict[Any, list[Any]] = {}
        holes: dict[str, Any] = {}
        spaces = {r.id: self._space(self._storeys[r.storey], r) for r in rooms}
        whole = None if rooms else self._space(self._storeys[0], None)
        for wall in walls:
            storey = self._storey_of(wall.plane.id)
            contents.setdefault(storey, []).append(self._wall(wall, storey, holes))
        for slab in self._scene.planes:
            if slab.plane.role != "wall":
                storey = self._storey_of(slab.id)
                contents.setdefault(storey, []).append(self._slab(slab.plane, slab.name, storey))
        for number, item in enumerate(self._scene.objects):
            self._progress.report(number / len(self._scene.objects), f"writing {item.name}")
            storey, room = self._storey_of(item.id), self._scene.room_of.get(item.id)
            element = self._object(item, storey)
            space = whole if room is None else spaces[room.id]
            place = storey if element.is_a() in ("IfcDoor", "IfcWindow") else space or storey
            contents.setdefault(place, []).append(element)
            if item.id in holes:
                self._to.entity(
                    "IfcRelFillsElement", RelatingOpeningElement=holes[item.id], RelatedBuildingElement=element
                )
        for kind, alike in self._typed.items():
            self._to.entity("IfcRelDefinesByType", RelatedObjects=alike, RelatingType=kind)
        for place, inside in contents.items():
            self._to.entity("IfcRelContainedInSpatialStructure", RelatedElements=inside, RelatingStructure=place)
        return self._to

    def _storey_of(self, part: str) -> Any:
        """The storey of a plane or an object; of what is in no room the lowest."""
        room = self._scene.room_of.get(part)
        return self._storeys[min(self._storeys) if room is None else room.storey]

    @property
    def _items(self) -> Sequence[Any]:
        return [o.item for o in self._scene.objects]

    def _storey(self, building: Any, number: int) -> Any:
        rooms = [r for r in self._scene.scene.rooms if r.storey == number]
        heights = [float(self._scene.scene.plane(r.floor).centre[2]) for r in rooms]
        return self._to.entity(
            "IfcBuildingStorey",
            Name=f"Storey {number}" if rooms else "Storey",
            ObjectPlacement=self._to.placement(np.eye(4), building.ObjectPlacement),
            CompositionType="ELEMENT",
            Elevation=min(heights, default=None),
        )

    def _building(self) -> Any:
        """Project, site and building, each inside the one before."""
        units = {"LENGTH": "METRE", "AREA": "SQUARE_METRE", "VOLUME": "CUBIC_METRE", "PLANEANGLE": "RADIAN"}
        made = [self._to.add("IfcSIUnit", None, f"{kind}UNIT", None, name) for kind, name in units.items()]
        assignment = self._to.add("IfcUnitAssignment", made)
        parent = self._to.entity(
            "IfcProject", Name=self._scene.name, RepresentationContexts=[self._to.context], UnitsInContext=assignment
        )
        below = None
        for kind, name in (("IfcSite", "Site"), ("IfcBuilding", "Building")):
            below = self._to.placement(np.eye(4), below)
            child = self._to.entity(kind, Name=name, ObjectPlacement=below, CompositionType="ELEMENT")
            self._to.entity("IfcRelAggregates", RelatingObject=parent, RelatedObjects=[child])
            parent = child
        return parent

    def _space(self, storey: Any, room: HomeRoom | None) -> Any | None:
        """A room as a space from its floor to its ceiling, or the whole scene; None without a floor."""
        floors = [p.plane for p in self._scene.planes if p.plane.role == "floor"]
        floor = next((f for f in floors if room is None or f.id == room.floor), None)
        if floor is None:
            return None
        planes = self._scene.scene.architecture.planes
        top = max(float(p.polygon[:, 2].max()) for p in planes if self._scene.room_of.get(p.id) is room)
        height, area = top - float(floor.centre[2]), abs(signed_area(floor.polygon[:, :2]))
        if height <= 0.0:
            return None
        solid = self._to.extrude(floor.polygon[:, :2], float(floor.centre[2]), height)
        name = self._scene.name if room is None else room.name
        kinds = {"CompositionType": "ELEMENT", "PredefinedType": "INTERNAL"}
        space = self._to.solid("IfcSpace", solid, storey.ObjectPlacement, Name=name, **kinds)
        self._to.entity("IfcRelAggregates", RelatingObject=storey, RelatedObjects=[space])
        self._to.measure(
            space, "Space", height={"Height": height}, area={"NetFloorArea": area}, volume={"NetVolume": area * height}
        )
        return space

    def _wall(self, wall: DrawnWall, storey: Any, holes: dict[str, Any]) -> Any:
        T = np.eye(4)
        T[:2, 0], T[:2, 1], T[:2, 3], T[2, 3] = wall.direction, wall.outward, wall.start, wall.bottom_m
        place = self._to.placement(T, storey.ObjectPlacement)
        t, height = max(wall.plane.thickness, MIN_WALL_M), wall.top_m - wall.bottom_m
        box = self._to.box((0.0, 0.0, 0.0), (wall.length_m, t, height))
        self._to.style(box, _plain(wall.plane.colour))
        element = self._to.entity(
            "IfcWall", Name=wall.plane.id, ObjectPlacement=place, Representation=self._to.shape([box], "SweptSolid")
        )
        for opening in wall.openings:
            hole = self._opening(opening, wall, place)
            self._to.entity("IfcRelVoidsElement", RelatingBuildingElement=element, RelatedOpeningElement=hole)
            if opening.object_id is not None:
                holes[opening.object_id] = hole
        layer = self._to.add("IfcMaterialLayer", self._to.material(_plain(wall.plane.colour), "wall"), t, None)
        layers = self._to.add("IfcMaterialLayerSet", [layer], "wall")
        self._to.set_material(element, self._to.add("IfcMaterialLayerSetUsage", layers, "AXIS2", "POSITIVE", 0.0))
        side = wall.length_m * height - sum((o.to_m - o.from_m) * (o.top_m - o.bottom_m) for o in wall.openings)
        self._to.measure(
            element,
            "Wall",
            height={"Length": wall.length_m, "Width": t, "Height": height},
            area={"NetSideArea": side},
            volume={"NetVolume": side * t},
        )
        return element

    def _opening(self, opening: Opening, wall: DrawnWall, place: Any) -> Any:
        low = (opening.from_m, -THROUGH_M, opening.bottom_m - wall.bottom_m)
        size = (
            opening.to_m - opening.from_m,
            max(wall.plane.thickness, MIN_WALL_M) + 2 * THROUGH_M,
            opening.top_m - opening.bottom_m,
        )
        hole = self._to.box(low, size)
        return self._to.solid("IfcOpeningElement", hole, place, Name=opening.id, PredefinedType="OPENING")

    def _slab(self, plane: Plane, name: str, storey: Any) -> Any:
        """Floor or ceiling: its polygon, thick away from the room."""
        points = plane.polygon[:, :2] if plane.role == "floor" else plane.polygon[::-1, :2]
        bottom = float(plane.centre[2]) - (plane.thickness if plane.role == "floor" else 0.0)
        solid = self._to.extrude(points, bottom, float(plane.thickness))
        self._to.style(solid, _plain(plane.colour))
        kind, predefined = ("IfcSlab", "FLOOR") if plane.role == "floor" else ("IfcCovering", "CEILING")
        element = self._to.solid(kind, solid, storey.ObjectPlacement, Name=name, PredefinedType=predefined)
        self._to.set_material(element, self._to.material(_plain(plane.colour), plane.role))
        area = abs(signed_area(plane.polygon[:, :2]))
        self._to.measure(
            element, kind.removeprefix("Ifc"), height={"Width": float(plane.thickness)}, area={"NetArea": area}
        )
        return element

    def _object(self, item: ExportObject, storey: Any) -> Any:
        source = self._map(self._scene.meshes[item.mesh])
        target = self._to.add(
            "IfcCartesianTransformationOperator3DnonUniform",
            LocalOrigin=self._to.point((0.0, 0.0, 0.0)),
            Scale=float(item.scale[0]),
            Scale2=float(item.scale[1]),
            Scale3=float(item.scale[2]),
        )
        mapped = self._to.add("IfcMappedItem", source, target)
        kind = CLASSES.get(item.item.category, "IfcFurniture")
        element = self._to.entity(
            kind,
            Name=item.item.label,
            ObjectType=item.item.category,
            Tag=item.id,
            ObjectPlacement=self._to.placement(item.T_world, storey.ObjectPlacement),
            Representation=self._to.shape([mapped], "MappedRepresentation"),
        )
        if kind in ("IfcDoor", "IfcWindow"):
            width, height = (float(v) for v in item.item.size_m[1:])
            element.OverallWidth, element.OverallHeight = width, height
            self._to.measure(
                element,
                kind.removeprefix("Ifc"),
                height={"Width": width, "Height": height},
                area={"Area": width * height},
            )
        self._typed.setdefault(self._type(kind, item), []).append(element)
        self._describe(element, item)
        return element

    def _type(self, kind: str, item: ExportObject) -> Any:
        """The type of all elements of one class that have one shape, with its materials."""
        key = (kind, item.mesh)
        if key not in self._types:
            mesh = self._scene.meshes[item.mesh]
            made = self._to.type(f"{kind}Type", Name=mesh.name, RepresentationMaps=[self._map(mesh)])
            parts = {m.name: m for m in (s.material for s in mesh.surfaces)}
            constituents = [
                self._to.add("IfcMaterialConstituent", name, None, self._to.material(m, name))
                for name, m in parts.items()
            ]
            self._to.set_material(made, self._to.add("IfcMaterialConstituentSet", mesh.name, None, constituents))
            self._types[key] = made
        return self._types[key]

    def _map(self, mesh: ExportMesh) -> Any:
        if mesh.key not in self._maps:
            self._maps[mesh.key] = self._to.tessellate(mesh.surfaces)
        return self._maps[mesh.key]

    def _describe(self, element: Any, item: ExportObject) -> None:
        properties = {"Id": item.id, "Category": item.item.category, "Shape": item.item.shape_id}
        if item.support is not None:
            properties |= {"Supporter": item.support.parent, "Relation": item.support.relation}
        values = [
            self._to.add("IfcPropertySingleValue", name, None, self._to.add("IfcLabel", value[:255]), None)
            for name, value in properties.items()
        ]
        self._to.define(element, self._to.entity("IfcPropertySet", Name="Diorama", HasProperties=values))


def _plain(colour_srgb: tuple[float, float, float]) -> Material:
    red, green, blue = (float(c) for c in srgb_to_linear(np.asarray(colour_srgb)))
    return Material(name="plain", colour=(red, green, blue))
