"""FBX through the optional importer, from an ASCII file that the test writes."""

from __future__ import annotations

import struct
import sys
from pathlib import Path

import pytest

from diorama_core.errors import LibraryError, UnavailableError
from diorama_core.library.ingest.fbx import unit_scale_m
from diorama_core.library.ingest.models import read_model

FBX = """; FBX 7.3.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7300
}
GlobalSettings:  {
	Version: 1000
	Properties70:  {
		P: "UpAxis", "int", "Integer", "",2
		P: "UpAxisSign", "int", "Integer", "",1
		P: "FrontAxis", "int", "Integer", "",1
		P: "FrontAxisSign", "int", "Integer", "",-1
		P: "CoordAxis", "int", "Integer", "",0
		P: "CoordAxisSign", "int", "Integer", "",1
		P: "UnitScaleFactor", "double", "Number", "",1
	}
}
Definitions:  {
	Version: 100
	Count: 3
	ObjectType: "Geometry" {
		Count: 1
	}
	ObjectType: "Model" {
		Count: 1
	}
	ObjectType: "Material" {
		Count: 1
	}
}
Objects:  {
	Geometry: 1000, "Geometry::", "Mesh" {
		Vertices: *24 {
			a: 0,0,0,100,0,0,100,50,0,0,50,0,0,0,30,100,0,30,100,50,30,0,50,30
		}
		PolygonVertexIndex: *24 {
			a: 0,3,2,-2,4,5,6,-8,0,1,5,-5,1,2,6,-6,2,3,7,-7,3,0,4,-8
		}
		GeometryVersion: 124
		LayerElementMaterial: 0 {
			Version: 101
			Name: ""
			MappingInformationType: "AllSame"
			ReferenceInformationType: "IndexToDirect"
			Materials: *1 {
				a: 0
			}
		}
		Layer: 0 {
			Version: 100
			LayerElement:  {
				Type: "LayerElementMaterial"
				TypedIndex: 0
			}
		}
	}
	Model: 2000, "Model::my table", "Mesh" {
		Version: 232
		Properties70:  {
			P: "Lcl Translation", "Lcl Translation", "", "A",10,20,30
		}
		Shading: T
		Culling: "CullingOff"
	}
	Material: 3000, "Material::oak", "" {
		Version: 102
		ShadingModel: "phong"
		MultiLayer: 0
		Properties70:  {
			P: "DiffuseColor", "Color", "", "A",0.6,0.4,0.2
		}
	}
}
Connections:  {
	C: "OO",2000,0
	C: "OO",1000,2000
	C: "OO",3000,2000
}
"""
"""A slab of 100 x 50 x 30 at (10, 20, 30), +Z up, in a unit of one centimetre, of a brown material."""


def test_an_fbx_is_turned_to_its_declared_up_and_unit(tmp_path: Path) -> None:
    pytest.importorskip("assimp_py", reason="needs the optional FBX importer")
    path = tmp_path / "slab.fbx"
    path.write_text(FBX)
    raw = read_model(path, tmp_path)
    assert raw.names == ("my table", "oak")
    assert raw.scene.extents.tolist() == pytest.approx([100, 30, 50])  # its z is y now
    assert raw.convention.up == {"+y": 0.9}
    assert list(raw.convention.unit) == [0.01]
    (mesh,) = raw.scene.geometry.values()
    assert mesh.visual.material.main_color[:3].tolist() == pytest.approx([153, 102, 51], abs=2)


def test_a_broken_fbx_is_refused(tmp_path: Path) -> None:
    pytest.importorskip("assimp_py", reason="needs the optional FBX importer")
    path = tmp_path / "slab.fbx"
    path.write_bytes(b"Kaydara FBX Binary  \x00" + b"\xff" * 300)
    with pytest.raises(LibraryError):
        read_model(path, tmp_path)


def test_without_the_importer_the_reason_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "assimp_py", None)
    path = tmp_path / "slab.fbx"
    path.write_text(FBX)
    with pytest.raises(UnavailableError, match="diorama\\[fbx\\]"):
        read_model(path, tmp_path)


def test_the_unit_is_read_from_text_and_from_binary() -> None:
    binary = b"S\x0f\0\0\0UnitScaleFactorS\x06\0\0\0doubleS\x06\0\0\0NumberS\0\0\0\0D" + struct.pack("<d", 100.0)
    assert unit_scale_m(binary) == pytest.approx(1.0)
    assert unit_scale_m(b'P: "UnitScaleFactor", "double", "Number", "",2.54\n') == pytest.approx(0.0254)
    assert unit_scale_m(b"nothing") == pytest.approx(0.01)
