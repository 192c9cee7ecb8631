"""A scene as IFC4, by IfcOpenShell: a storey with walls, openings, slabs, doors, windows and furniture. Metres, +Z up.

Shapes are mapped: objects of one shape share its triangles. Each element's property set `Diorama` names the object's
id, category, shape and supporter.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from diorama_core.export.files import whole_file
from diorama_core.export.gathering import ExportMesh, ExportObject, ExportScene
from diorama_core.export.wall_lines import DrawnWall, Opening, wall_lines
from diorama_core.io.srgb import linear_to_srgb, srgb_to_linear
from diorama_core.library.taxonomy import column
from diorama_core.progress import Progress
from diorama_core.render.appearance import Material
from diorama_core.scene.types import Plane

CLASSES: Mapping[str, str] = column("ifc_class")
"""Classes of categories; all others are furniture."""
THROUGH_M = 0.05
"""Openings reach this far through their wall on both sides."""
ONE_POINT, ONE_TRIANGLE = "((0.,0.,0.))", "((1,2,3))"
"""What IfcOpenShell is told of long lists, and writes: it takes a microsecond and more for every number."""


def write_ifc(scene: ExportScene, path: Path, progress: Progress | None = None) -> None:
    """Write the model, whole or not at all.

    Raises:
        ExportError: when it cannot be written.
        Cancelled: when asked to stop; what was there stays.
    """
    builder = _Builder(scene, progress or Progress())
    with whole_file(Path(path)) as temporary, temporary.open("w", encoding="ascii", newline="\n") as stream:
        stream.writelines(builder.lines())


class _Builder:
    """Adds a gathered scene to a file."""

    def __init__(self, scene: ExportScene, progress: Progress) -> None:
        import ifcopenshell
        import ifcopenshell.guid

        self._scene, self._progress = scene, progress
        self._new_guid = ifcopenshell.guid.new
        self._file = ifcopenshell.file(schema="IFC4")
        self._origin = self._frame(np.eye(4))
        self._context, self._body = self._contexts()
        self._maps: dict[str, Any] = {}
        self._lists: dict[str, Float[np.ndarray, "n 3"] | Int[np.ndarray, "m 3"]] = {}
        self._styles: dict[int, Any] = {}

    def lines(self) -> Iterator[str]:
        """The whole model as text, its long lists written here."""
        for line in self._built().to_string().splitlines(keepends=True):
            rows = self._lists.get(line.partition("=")[0])
            if rows is None:
                yield line
            else:
                whole = np.issubdtype(rows.dtype, np.integer)
                yield line.replace(ONE_TRIANGLE if whole else ONE_POINT, _list_text(rows, "%d" if whole else "%.6f"))

    def _built(self) -> Any:
        storey = self._storey()
        walls = wall_lines([p.plane for p in self._scene.planes], self._items, self._scene.scene)
        elements: list[Any] = []
        holes: dict[str, Any] = {}
        for wall in walls:
            elements.append(self._wall(wall, storey, holes))
        for slab in self._scene.planes:
            if slab.plane.role != "wall":
                elements.append(self._slab(slab.plane, slab.name, storey))
        for number, item in enumerate(self._scene.objects):
            self._progress.report(number / len(self._scene.objects), f"writing {item.name}")
            element = self._object(item, storey)
            elements.append(element)
            if item.id in holes:
                self._rooted(
                    "IfcRelFillsElement", RelatingOpeningElement=holes[item.id], RelatedBuildingElement=element
                )
        if elements:
            self._rooted("IfcRelContainedInSpatialStructure", RelatedElements=elements, RelatingStructure=storey)
        return self._file

    @property
    def _items(self) -> Sequence[Any]:
        return [o.item for o in self._scene.objects]

    def _add(self, kind: str, *values: Any, **named: Any) -> Any:
        return self._file.create_entity(kind, *values, **named)

    def _rooted(self, kind: str, **named: Any) -> Any:
        return self._add(kind, GlobalId=self._new_guid(), **named)

    def _point(self, values: Sequence[float] | Float[np.ndarray, "n"]) -> Any:
        return self._add("IfcCartesianPoint", [float(v) for v in values])

    def _direction(self, values: Float[np.ndarray, "n"]) -> Any:
        return self._add("IfcDirection", [float(v) for v in values])

    def _frame(self, T: Float[np.ndarray, "4 4"]) -> Any:
        """A placement from a rigid transform."""
        return self._add(
            "IfcAxis2Placement3D", self._point(T[:3, 3]), self._direction(T[:3, 2]), self._direction(T[:3, 0])
        )

    def _placement(self, T: Float[np.ndarray, "4 4"], below: Any = None) -> Any:
        return self._add("IfcLocalPlacement", below, self._frame(T))

    def _contexts(self) -> tuple[Any, Any]:
        model = self._add("IfcGeometricRepresentationContext", None, "Model", 3, 1e-5, self._origin, None)
        body = self._add(
            "IfcGeometricRepresentationSubContext",
            ContextIdentifier="Body",
            ContextType="Model",
            ParentContext=model,
            TargetView="MODEL_VIEW",
        )
        return model, body

    def _storey(self) -> Any:
        """Project, site, building and storey, each inside the one before."""
        units = [
            self._add("IfcSIUnit", None, "LENGTHUNIT", None, "METRE"),
            self._add("IfcSIUnit", None, "AREAUNIT", None, "SQUARE_METRE"),
            self._add("IfcSIUnit", None, "VOLUMEUNIT", None, "CUBIC_METRE"),
            self._add("IfcSIUnit", None, "PLANEANGLEUNIT", None, "RADIAN"),
        ]
        assignment = self._add("IfcUnitAssignment", units)
        parent = self._rooted(
            "IfcProject", Name=self._scene.name, RepresentationContexts=[self._context], UnitsInContext=assignment
        )
        below = None
        for kind, name in (("IfcSite", "Site"), ("IfcBuilding", "Building"), ("IfcBuildingStorey", "Storey")):
            below = self._placement(np.eye(4), below)
            child = self._rooted(kind, Name=name, ObjectPlacement=below, CompositionType="ELEMENT")
            self._rooted("IfcRelAggregates", RelatingObject=parent, RelatedObjects=[child])
            parent = child
        return parent

    def _wall(self, wall: DrawnWall, storey: Any, holes: dict[str, Any]) -> Any:
        T = np.eye(4)
        T[:2, 0], T[:2, 1], T[:2, 3], T[2, 3] = wall.along, wall.outward, wall.start, wall.bottom_m
        place = self._placement(T, storey.ObjectPlacement)
        t, height = wall.plane.thickness, wall.top_m - wall.bottom_m
        box = self._box((0.0, 0.0, 0.0), (wall.length_m, t, height))
        self._style(box, _plain(wall.plane.colour))
        element = self._rooted(
            "IfcWall", Name=wall.plane.id, ObjectPlacement=place, Representation=self._shape([box], "SweptSolid")
        )
        for opening in wall.openings:
            hole = self._opening(opening, wall, place)
            self._rooted("IfcRelVoidsElement", RelatingBuildingElement=element, RelatedOpeningElement=hole)
            if opening.object_id is not None:
                holes[opening.object_id] = hole
        return element

    def _opening(self, opening: Opening, wall: DrawnWall, place: Any) -> Any:
        low = (opening.from_m, -THROUGH_M, opening.bottom_m - wall.bottom_m)
        size = (opening.to_m - opening.from_m, wall.plane.thickness + 2 * THROUGH_M, opening.top_m - opening.bottom_m)
        return self._rooted(
            "IfcOpeningElement",
            Name=opening.id,
            ObjectPlacement=self._placement(np.eye(4), place),
            Representation=self._shape([self._box(low, size)], "SweptSolid"),
            PredefinedType="OPENING",
        )

    def _slab(self, plane: Plane, name: str, storey: Any) -> Any:
        """Floor or ceiling: its polygon, thick away from the room."""
        points = plane.polygon[:, :2] if plane.role == "floor" else plane.polygon[::-1, :2]
        outline = self._add("IfcPolyline", [self._point(p) for p in (*points, points[0])])
        profile = self._add("IfcArbitraryClosedProfileDef", "AREA", None, outline)
        T = np.eye(4)
        T[2, 3] = float(plane.centre[2]) - (plane.thickness if plane.role == "floor" else 0.0)
        up = self._direction(np.array([0.0, 0.0, 1.0]))
        solid = self._add("IfcExtrudedAreaSolid", profile, self._frame(T), up, float(plane.thickness))
        self._style(solid, _plain(plane.colour))
        kind, predefined = ("IfcSlab", "FLOOR") if plane.role == "floor" else ("IfcCovering", "CEILING")
        return self._rooted(
            kind,
            Name=name,
            ObjectPlacement=self._placement(np.eye(4), storey.ObjectPlacement),
            Representation=self._shape([solid], "SweptSolid"),
            PredefinedType=predefined,
        )

    def _box(self, low: Sequence[float], size: Sequence[float]) -> Any:
        corners = [(0, 0), (size[0], 0), (size[0], size[1]), (0, size[1]), (0, 0)]
        outline = self._add("IfcPolyline", [self._point((low[0] + x, low[1] + y)) for x, y in corners])
        profile = self._add("IfcArbitraryClosedProfileDef", "AREA", None, outline)
        T = np.eye(4)
        T[2, 3] = low[2]
        up = self._direction(np.array([0.0, 0.0, 1.0]))
        return self._add("IfcExtrudedAreaSolid", profile, self._frame(T), up, float(size[2]))

    def _object(self, item: ExportObject, storey: Any) -> Any:
        source = self._map(self._scene.meshes[item.mesh])
        target = self._add(
            "IfcCartesianTransformationOperator3DnonUniform",
            LocalOrigin=self._point((0.0, 0.0, 0.0)),
            Scale=float(item.scale[0]),
            Scale2=float(item.scale[1]),
            Scale3=float(item.scale[2]),
        )
        mapped = self._add("IfcMappedItem", source, target)
        kind = CLASSES.get(item.item.category, "IfcFurniture")
        element = self._rooted(
            kind,
            Name=item.item.label,
            ObjectType=item.item.category,
            Tag=item.id,
            ObjectPlacement=self._placement(item.T_world, storey.ObjectPlacement),
            Representation=self._shape([mapped], "MappedRepresentation"),
        )
        if kind in ("IfcDoor", "IfcWindow"):
            element.OverallWidth, element.OverallHeight = float(item.item.size_m[1]), float(item.item.size_m[2])
        self._describe(element, item)
        return element

    def _map(self, mesh: ExportMesh) -> Any:
        if mesh.key not in self._maps:
            sets = []
            for surface in mesh.surfaces:
                points = self._add("IfcCartesianPointList3D", [[0.0, 0.0, 0.0]])
                faces = self._add("IfcTriangulatedFaceSet", Coordinates=points, CoordIndex=[[1, 2, 3]])
                self._lists[f"#{points.id()}"], self._lists[f"#{faces.id()}"] = surface.vertices, surface.faces + 1
                self._style(faces, surface.material)
                sets.append(faces)
            body = self._add("IfcShapeRepresentation", self._body, "Body", "Tessellation", sets)
            self._maps[mesh.key] = self._add("IfcRepresentationMap", self._origin, body)
        return self._maps[mesh.key]

    def _shape(self, items: list[Any], kind: str) -> Any:
        body = self._add("IfcShapeRepresentation", self._body, "Body", kind, items)
        return self._add("IfcProductDefinitionShape", None, None, [body])

    def _style(self, item: Any, material: Material) -> None:
        if id(material) not in self._styles:
            red, green, blue = (
                float(c) for c in np.clip(linear_to_srgb(np.asarray(material.colour, dtype=np.float64)), 0, 1)
            )
            colour = self._add("IfcColourRgb", None, red, green, blue)
            shading = self._add("IfcSurfaceStyleShading", colour, float(1.0 - material.alpha))
            style = self._add("IfcSurfaceStyle", material.name, "BOTH", [shading])
            self._styles[id(material)] = (style, material)  # holding the material keeps its id from being reused
        self._add("IfcStyledItem", item, [self._styles[id(material)][0]], None)

    def _describe(self, element: Any, item: ExportObject) -> None:
        said = {"Id": item.id, "Category": item.item.category, "Shape": item.item.shape_id}
        if item.support is not None:
            said |= {"Supporter": item.support.parent, "Relation": item.support.relation}
        self._rooted(
            "IfcRelDefinesByProperties",
            RelatedObjects=[element],
            RelatingPropertyDefinition=self._rooted("IfcPropertySet", Name="Diorama", HasProperties=self._values(said)),
        )

    def _values(self, said: Mapping[str, str]) -> list[Any]:
        return [
            self._add("IfcPropertySingleValue", name, None, self._add("IfcLabel", value[:255]), None)
            for name, value in said.items()
        ]


def _list_text(rows: Float[np.ndarray, "n 3"] | Int[np.ndarray, "n 3"], number: str) -> str:
    """Rows of three as ISO 10303-21 writes them."""
    row = f"({number},{number},{number})"
    return "(" + ",".join([row] * len(rows)) % tuple(rows.ravel().tolist()) + ")"


def _plain(colour_srgb: tuple[float, float, float]) -> Material:
    red, green, blue = (float(c) for c in srgb_to_linear(np.asarray(colour_srgb)))
    return Material(name="plain", colour=(red, green, blue))
