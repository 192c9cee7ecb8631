"""What is seen of a USD stage: meshes, UsdPreviewSurface materials, lights, the camera; values as USD's own types."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float
from pxr import Gf, Sdf, Usd, UsdGeom, UsdLux, UsdShade, Vt

from diorama_core.export.gathering import ExportScene, T_world_lens, rigid_inverse
from diorama_core.export.lights import ExportLight
from diorama_core.export.pictures import Picture, picture_suffix
from diorama_core.export.sharing import slug_of, unique_name
from diorama_core.geometry.rotations import quaternion_wxyz
from diorama_core.render.appearance import Material, Surface
from diorama_core.scene.types import Camera

SOFT_DEG = 15.0
"""Angle that a room's main light fills: its shadows have soft edges."""
EVEN_LIGHT_M = 0.03
"""Radius of the even light: it is in the middle of the room, where it should hardly be seen."""
_APERTURE = 0.36
"""36 mm in tenths of a scene's unit, which USD has for lenses."""
_COLOUR, _NUMBER, _VECTOR = Sdf.ValueTypeNames.Color3f, Sdf.ValueTypeNames.Float, Sdf.ValueTypeNames.Float3


class StageMaterials:
    """Materials of a stage and the files of their pictures."""

    def __init__(self, stage: Usd.Stage, folder: str) -> None:
        self._stage = stage
        self._folder = folder
        self._files: dict[int, tuple[str, Picture]] = {}

    def pictures(self) -> Iterator[tuple[str, Picture]]:
        """Names, relative to the stage's file, and pixels."""
        yield from self._files.values()

    def material(self, path: str, material: Material, *, textured: bool, coloured: bool) -> UsdShade.Material:
        """Define a material.

        Args:
            path: Where.
            material: What it is like.
            textured: Whether the mesh has texture coordinates.
            coloured: Whether the mesh has vertex colours.
        """
        made = UsdShade.Material.Define(self._stage, path)
        surface = UsdShade.Shader.Define(self._stage, f"{path}/Surface")
        surface.CreateIdAttr("UsdPreviewSurface")
        made.CreateSurfaceOutput().ConnectToSource(surface.ConnectableAPI(), "surface")
        self._plain(surface, material)
        if coloured:
            reader = self._reader(f"{path}/Colours", "UsdPrimvarReader_float3", "displayColor", _VECTOR)
            surface.GetInput("diffuseColor").ConnectToSource(reader)
        if textured and (material.texture is not None or material.maps):
            coordinates = self._reader(
                f"{path}/Coordinates", "UsdPrimvarReader_float2", "st", Sdf.ValueTypeNames.Float2
            )
            self._textures(path, surface, material, coordinates, coloured=coloured)
        return made

    def _plain(self, surface: UsdShade.Shader, material: Material) -> None:
        surface.CreateInput("diffuseColor", _COLOUR).Set(Gf.Vec3f(*material.colour))
        surface.CreateInput("metallic", _NUMBER).Set(material.metallic)
        surface.CreateInput("roughness", _NUMBER).Set(material.roughness)
        if material.alpha < 1:
            surface.CreateInput("opacity", _NUMBER).Set(material.alpha)
        if any(material.emissive):
            surface.CreateInput("emissiveColor", _COLOUR).Set(Gf.Vec3f(*material.emissive))

    def _reader(self, path: str, kind: str, primvar: str, type_name: Sdf.ValueTypeName) -> UsdShade.Output:
        reader = UsdShade.Shader.Define(self._stage, path)
        reader.CreateIdAttr(kind)
        reader.CreateInput("varname", Sdf.ValueTypeNames.String).Set(primvar)
        return reader.CreateOutput("result", type_name)

    def _textures(
        self, path: str, surface: UsdShade.Shader, material: Material, st: UsdShade.Output, *, coloured: bool
    ) -> None:
        if material.texture is not None and not coloured:
            factor = (*material.colour, material.alpha)
            base = self._texture(f"{path}/Base", material.texture, st, colour=True, factor=factor)
            surface.GetInput("diffuseColor").ConnectToSource(base.CreateOutput("rgb", _VECTOR))
            if material.alpha < 1 and material.texture.shape[2] == 4:
                surface.GetInput("opacity").ConnectToSource(base.CreateOutput("a", _NUMBER))
        if "metallicRoughnessTexture" in material.maps:
            picture = material.maps["metallicRoughnessTexture"]
            factor = (1.0, material.roughness, material.metallic, 1.0)
            both = self._texture(f"{path}/MetallicRoughness", picture, st, colour=False, factor=factor)
            surface.GetInput("roughness").ConnectToSource(both.CreateOutput("g", _NUMBER))
            surface.GetInput("metallic").ConnectToSource(both.CreateOutput("b", _NUMBER))
        if "occlusionTexture" in material.maps:
            shade = self._texture(f"{path}/Occlusion", material.maps["occlusionTexture"], st, colour=False)
            surface.CreateInput("occlusion", _NUMBER).ConnectToSource(shade.CreateOutput("r", _NUMBER))
        if "emissiveTexture" in material.maps:
            factor = (*material.emissive, 1.0)
            glow = self._texture(f"{path}/Emissive", material.maps["emissiveTexture"], st, colour=True, factor=factor)
            surface.CreateInput("emissiveColor", _COLOUR).ConnectToSource(glow.CreateOutput("rgb", _VECTOR))
        if "normalTexture" in material.maps:
            picture, factor = material.maps["normalTexture"], (2.0, 2.0, 2.0, 1.0)
            bumps = self._texture(f"{path}/Normal", picture, st, colour=False, factor=factor)
            bumps.CreateInput("bias", Sdf.ValueTypeNames.Float4).Set(Gf.Vec4f(-1.0, -1.0, -1.0, 0.0))
            normal = surface.CreateInput("normal", Sdf.ValueTypeNames.Normal3f)
            normal.ConnectToSource(bumps.CreateOutput("rgb", _VECTOR))

    def _texture(
        self,
        path: str,
        picture: Picture,
        st: UsdShade.Output,
        *,
        colour: bool,
        factor: tuple[float, ...] = (1.0, 1.0, 1.0, 1.0),
    ) -> UsdShade.Shader:
        texture = UsdShade.Shader.Define(self._stage, path)
        texture.CreateIdAttr("UsdUVTexture")
        texture.CreateInput("file", Sdf.ValueTypeNames.Asset).Set(f"./{self._file(picture)}")
        texture.CreateInput("st", Sdf.ValueTypeNames.Float2).ConnectToSource(st)
        texture.CreateInput("sourceColorSpace", Sdf.ValueTypeNames.Token).Set("sRGB" if colour else "raw")
        for side in ("wrapS", "wrapT"):
            texture.CreateInput(side, Sdf.ValueTypeNames.Token).Set("repeat")
        if factor != (1.0, 1.0, 1.0, 1.0):
            texture.CreateInput("scale", Sdf.ValueTypeNames.Float4).Set(Gf.Vec4f(*factor))
        return texture

    def _file(self, picture: Picture) -> str:
        if id(picture) not in self._files:
            name = f"{self._folder}/{len(self._files)}{picture_suffix(picture)}"
            self._files[id(picture)] = (name, picture)  # holding the picture keeps its id from being reused
        return self._files[id(picture)][0]


def vectors(values: Float[np.ndarray, "n 3"]) -> Vt.Vec3fArray:
    """Rows as single-precision vectors."""
    return Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(values, dtype=np.float32))


def integers(values: np.ndarray) -> Vt.IntArray:
    """Integers."""
    return Vt.IntArray.FromNumpy(np.ascontiguousarray(values, dtype=np.int32))


def extent(points: Float[np.ndarray, "n 3"]) -> Vt.Vec3fArray:
    """Lower and upper corner of the box around points."""
    return vectors(np.stack([points.min(axis=0), points.max(axis=0)]))


def quaternion(R: Float[np.ndarray, "3 3"]) -> Gf.Quatd:
    """A rotation matrix (acting on columns) as quaternion."""
    return Gf.Quatd(*quaternion_wxyz(R).tolist())


def note(prim: Usd.Prim, name: str, text: str) -> None:
    """Say something of a prim for when the file is read back."""
    prim.CreateAttribute(f"diorama:{name}", Sdf.ValueTypeNames.String, custom=True).Set(text)


def place(xform: UsdGeom.Xformable, T: Float[np.ndarray, "4 4"]) -> None:
    """Give a prim a rigid transform, as a translation and an orientation."""
    xform.AddTranslateOp(UsdGeom.XformOp.PrecisionDouble).Set(Gf.Vec3d(*(float(v) for v in T[:3, 3])))
    xform.AddOrientOp(UsdGeom.XformOp.PrecisionDouble).Set(quaternion(T[:3, :3]))


def add_surfaces(stage: Usd.Stage, path: str, surfaces: tuple[Surface, ...], materials: StageMaterials) -> None:
    """One mesh a surface below a prim, with its materials beside them.

    Args:
        stage: The document.
        path: Of the prim.
        surfaces: With their triangles.
        materials: Those that the document has.
    """
    UsdGeom.Scope.Define(stage, f"{path}/Materials")
    taken: set[str] = set()
    made: dict[tuple[int, bool, bool], UsdShade.Material] = {}
    for number, surface in enumerate(surfaces):
        textured, coloured = surface.uv is not None, surface.colours is not None
        key = (id(surface.material), textured, coloured)
        if key not in made:
            name = unique_name(slug_of(surface.material.name), taken, "_")
            material = materials.material(
                f"{path}/Materials/{name}", surface.material, textured=textured, coloured=coloured
            )
            made[key] = material
        mesh = _mesh(stage, f"{path}/Surface_{number}", surface)
        UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(made[key])


def _mesh(stage: Usd.Stage, path: str, surface: Surface) -> UsdGeom.Mesh:
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    mesh.CreatePointsAttr(vectors(surface.vertices))
    mesh.CreateExtentAttr(extent(surface.vertices))
    mesh.CreateFaceVertexCountsAttr(integers(np.full(len(surface.faces), 3)))
    mesh.CreateFaceVertexIndicesAttr(integers(surface.faces.reshape(-1)))
    mesh.CreateNormalsAttr(vectors(surface.normals))
    mesh.SetNormalsInterpolation(UsdGeom.Tokens.vertex)
    mesh.CreateDoubleSidedAttr(surface.material.double_sided)
    primvars = UsdGeom.PrimvarsAPI(mesh)
    if surface.uv is not None:
        values = Vt.Vec2fArray.FromNumpy(np.ascontiguousarray(surface.uv, dtype=np.float32))
        primvars.CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.vertex).Set(values)
    if surface.colours is not None:
        mesh.CreateDisplayColorPrimvar(UsdGeom.Tokens.vertex).Set(vectors(surface.colours))
    return mesh


def add_camera(stage: Usd.Stage, path: str, camera: Camera) -> None:
    """The photo's camera; the aperture's offset keeps a principal point off the centre."""
    k = camera.intrinsics
    made = UsdGeom.Camera.Define(stage, path)
    place(made, T_world_lens(camera))
    made.CreateFocalLengthAttr(k.fx / k.width * _APERTURE)
    made.CreateHorizontalApertureAttr(_APERTURE)
    made.CreateVerticalApertureAttr(_APERTURE * (k.height / k.fy) / (k.width / k.fx))
    made.CreateHorizontalApertureOffsetAttr(_APERTURE * (0.5 - k.cx / k.width))
    made.CreateVerticalApertureOffsetAttr(_APERTURE * (k.cy / k.height - 0.5) * (k.height / k.fy) / (k.width / k.fx))
    made.CreateClippingRangeAttr(Gf.Vec2f(0.01, 1000.0))


def add_lights(stage: Usd.Stage, root: str, gathered: ExportScene) -> None:
    """The photo's main light, infinitely far away and a little soft, and small spheres for the light from all sides."""
    main, even = gathered.main_light, gathered.even_light
    if main is not None:
        made = UsdLux.DistantLight.Define(stage, f"{root}/MainLight")
        made.CreateIntensityAttr(gathered.strength(main) * main.lux)
        made.CreateAngleAttr(SOFT_DEG)
        made.CreateNormalizeAttr(True)
        made.CreateColorAttr(Gf.Vec3f(*main.colour))
        place(made, main.T_world)
    if even is None:
        return
    for number, position in enumerate(even.positions, 1):
        nits = even.candela / (np.pi * EVEN_LIGHT_M**2)
        sphere = _sphere(stage, f"{root}/EvenLight{number}", EVEN_LIGHT_M, nits)
        sphere.AddTranslateOp(UsdGeom.XformOp.PrecisionDouble).Set(Gf.Vec3d(*(float(v) for v in position)))


def add_light(stage: Usd.Stage, owner: str, gathered: ExportScene, light: ExportLight) -> None:
    """A sphere that glows, or a window's rectangle, below its object.

    Args:
        stage: The document.
        owner: Path of the object.
        gathered: The scene.
        light: Lamp or window.
    """
    lumens = gathered.strength(light) * light.lumens
    if light.kind == "lamp":
        nits = lumens / (4.0 * np.pi**2 * light.radius_m**2)
        made: UsdLux.SphereLight | UsdLux.RectLight = _sphere(stage, f"{owner}/Light", light.radius_m, nits)
    else:
        width, height = light.size_m
        made = UsdLux.RectLight.Define(stage, f"{owner}/Light")
        made.CreateWidthAttr(width)
        made.CreateHeightAttr(height)
        made.CreateIntensityAttr(lumens / (np.pi * width * height))
        made.CreateExtentAttr(extent(np.array([[-width, -height, 0.0], [width, height, 0.0]]) / 2))
    made.CreateColorAttr(Gf.Vec3f(*light.colour))
    place(made, rigid_inverse(gathered.object(light.owner).T_world) @ light.T_world)


def _sphere(stage: Usd.Stage, path: str, radius_m: float, nits: float) -> UsdLux.SphereLight:
    made = UsdLux.SphereLight.Define(stage, path)
    made.CreateRadiusAttr(radius_m)
    made.CreateIntensityAttr(nits)
    made.CreateExtentAttr(extent(np.array([[-1.0] * 3, [1.0] * 3]) * radius_m))
    return made
