"""An IFC4 file under construction, by IfcOpenShell: entities, placements, solids, styles, materials and quantities."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from diorama_core.export.physics import substance_of
from diorama_core.io.srgb import linear_to_srgb
from diorama_core.render.appearance import Material, Surface

SCHEMA = "IFC4"
ONE_POINT, ONE_TRIANGLE = "((0.,0.,0.))", "((1,2,3))"
"""What IfcOpenShell is told of long lists, and writes: it takes a microsecond and more for every number."""


class IfcDocument:
    """Entities of one file. Lengths are metres."""

    def __init__(self) -> None:
        import ifcopenshell
        import ifcopenshell.guid

        self._new_guid = ifcopenshell.guid.new
        self._file = ifcopenshell.file(schema=SCHEMA)
        self.origin = self.frame(np.eye(4))
        self.context, self._body = self._contexts()
        self._lists: dict[str, Float[np.ndarray, "n 3"] | Int[np.ndarray, "m 3"]] = {}
        self._styles: dict[int, Any] = {}
        self._materials: dict[str, Any] = {}

    def lines(self) -> Iterator[str]:
        """The whole file as text, its long lists written here."""
        for line in self._file.to_string().splitlines(keepends=True):
            rows = self._lists.get(line.partition("=")[0])
            if rows is None:
                yield line
            else:
                whole = np.issubdtype(rows.dtype, np.integer)
                yield line.replace(ONE_TRIANGLE if whole else ONE_POINT, _list_text(rows, "%d" if whole else "%.6f"))

    def add(self, kind: str, *values: Any, **named: Any) -> Any:
        """An entity with its attributes."""
        return self._file.create_entity(kind, *values, **named)

    def entity(self, kind: str, **named: Any) -> Any:
        """An entity that has an identifier of its own."""
        return self.add(kind, GlobalId=self._new_guid(), **named)

    def point(self, values: Sequence[float] | Float[np.ndarray, "n"]) -> Any:
        """A point of two or three coordinates."""
        return self.add("IfcCartesianPoint", [float(v) for v in values])

    def direction(self, values: Float[np.ndarray, "n"]) -> Any:
        """A unit direction."""
        return self.add("IfcDirection", [float(v) for v in values])

    def frame(self, T: Float[np.ndarray, "4 4"]) -> Any:
        """A placement from a rigid transform."""
        return self.add("IfcAxis2Placement3D", self.point(T[:3, 3]), self.direction(T[:3, 2]), self.direction(T[:3, 0]))

    def placement(self, T: Float[np.ndarray, "4 4"], below: Any = None) -> Any:
        """An element's place in that of another."""
        return self.add("IfcLocalPlacement", below, self.frame(T))

    def _contexts(self) -> tuple[Any, Any]:
        model = self.add("IfcGeometricRepresentationContext", None, "Model", 3, 1e-5, self.origin, None)
        about = {"ContextIdentifier": "Body", "ContextType": "Model", "TargetView": "MODEL_VIEW"}
        return model, self.add("IfcGeometricRepresentationSubContext", ParentContext=model, **about)

    def box(self, low: Sequence[float], size: Sequence[float]) -> Any:
        """A box along the axes, from its lower corner."""
        corners = np.array([(0.0, 0.0), (size[0], 0.0), (size[0], size[1]), (0.0, size[1])])
        return self.extrude(corners + np.array(low[:2]), low[2], float(size[2]))

    def extrude(self, outline: Float[np.ndarray, "n 2"], bottom_m: float, height_m: float) -> Any:
        """A level outline drawn upward.

        Args:
            outline: corners in order, x and y in metres.
            bottom_m: height at which it begins.
            height_m: by which it rises.
        """
        corners = self.add("IfcPolyline", [self.point(p) for p in (*outline, outline[0])])
        profile = self.add("IfcArbitraryClosedProfileDef", "AREA", None, corners)
        T = np.eye(4)
        T[2, 3] = bottom_m
        up = self.direction(np.array([0.0, 0.0, 1.0]))
        return self.add("IfcExtrudedAreaSolid", profile, self.frame(T), up, height_m)

    def solid(self, kind: str, solid: Any, below: Any, **named: Any) -> Any:
        """An element that is one solid, at the place of another."""
        place, shape = self.placement(np.eye(4), below), self.shape([solid], "SweptSolid")
        return self.entity(kind, ObjectPlacement=place, Representation=shape, **named)

    def define(self, element: Any, definition: Any) -> None:
        """Give an element a set of properties or quantities."""
        self.entity("IfcRelDefinesByProperties", RelatedObjects=[element], RelatingPropertyDefinition=definition)

    def shape(self, items: list[Any], kind: str) -> Any:
        """An element's representation by items of one kind."""
        body = self.add("IfcShapeRepresentation", self._body, "Body", kind, items)
        return self.add("IfcProductDefinitionShape", None, None, [body])

    def style(self, item: Any, material: Material) -> None:
        """Give an item the colour of a material."""
        if id(material) not in self._styles:
            srgb = np.clip(linear_to_srgb(np.asarray(material.colour, dtype=np.float64)), 0, 1)
            colour = self.add("IfcColourRgb", None, *srgb.tolist())
            shading = self.add("IfcSurfaceStyleShading", colour, float(1.0 - material.alpha))
            style = self.add("IfcSurfaceStyle", material.name, "BOTH", [shading])
            self._styles[id(material)] = (style, material)  # holding the material keeps its id from being reused
        self.add("IfcStyledItem", item, [self._styles[id(material)][0]], None)

    def material(self, material: Material, name: str) -> Any:
        """A material by name, of the substance that its name says."""
        if name not in self._materials:
            self._materials[name] = self.add("IfcMaterial", name, None, substance_of(material).name)
        return self._materials[name]

    def set_material(self, element: Any, material: Any) -> None:
        """Say which material, layers or constituents an element or a type is made of."""
        self.entity("IfcRelAssociatesMaterial", RelatedObjects=[element], RelatingMaterial=material)

    def measure(self, element: Any, of: str, **measured: Mapping[str, float]) -> None:
        """The base quantities of an element.

        Args:
            element: What is measured.
            of: Its name in that of the set, such as Wall.
            **measured: By names of the set, under `height` (any length), `area` and `volume`, in metres.
        """
        kinds = {"height": "IfcQuantityLength", "area": "IfcQuantityArea", "volume": "IfcQuantityVolume"}
        quantities = [
            self.add(kinds[kind], name, None, None, float(value))
            for kind, values in measured.items()
            for name, value in values.items()
        ]
        name = f"Qto_{of}BaseQuantities"
        self.define(element, self.entity("IfcElementQuantity", Name=name, Quantities=quantities))

    def tessellate(self, surfaces: Sequence[Surface]) -> Any:
        """Triangles in their materials' styles, as what types and elements map."""
        sets = []
        for surface in surfaces:
            points = self.add("IfcCartesianPointList3D", [[0.0, 0.0, 0.0]])
            faces = self.add("IfcTriangulatedFaceSet", Coordinates=points, CoordIndex=[[1, 2, 3]])
            self._lists[f"#{points.id()}"], self._lists[f"#{faces.id()}"] = surface.vertices, surface.faces + 1
            self.style(faces, surface.material)
            sets.append(faces)
        body = self.add("IfcShapeRepresentation", self._body, "Body", "Tessellation", sets)
        return self.add("IfcRepresentationMap", self.origin, body)

    def type(self, kind: str, **named: Any) -> Any:
        """A type, whose enumerations that have to be said are not defined."""
        from ifcopenshell import ifcopenshell_wrapper

        entity = ifcopenshell_wrapper.schema_by_name(SCHEMA).declaration_by_name(kind).as_entity()
        assert entity is not None, kind
        missing = {a.name(): "NOTDEFINED" for a in entity.all_attributes() if not a.optional()}
        return self.entity(kind, **{k: v for k, v in missing.items() if k != "GlobalId"}, **named)


def _list_text(rows: Float[np.ndarray, "n 3"] | Int[np.ndarray, "n 3"], number: str) -> str:
    """Rows of three as ISO 10303-21 writes them."""
    row = f"({number},{number},{number})"
    return "(" + ",".join([row] * len(rows)) % tuple(rows.ravel().tolist()) + ")"
