"""Rigid bodies of a USD stage: a static room, bodies with convex colliders, masses, friction and welds."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from pxr import Gf, Sdf, Usd, UsdGeom, UsdPhysics, UsdShade

from diorama_core.export.bodies import MovingPart, PhysicalScene, Points, RigidBody, hull_faces
from diorama_core.export.gathering import ExportObject, ExportPlane, ExportScene, rigid_inverse
from diorama_core.export.limbs import ExportLimb
from diorama_core.export.physics import FLOOR_FRICTION, GRAVITY, Inertia
from diorama_core.export.usd_materials import extent, integers, quaternion, vectors

ROOT = "/Scene"
_FIXED, _VARYING = Sdf.VariabilityUniform, Sdf.VariabilityVarying
_COLLIDER_SCHEMAS = ["PhysicsCollisionAPI", "PhysicsMeshCollisionAPI", "MaterialBindingAPI"]


def add_physics(stage: Usd.Stage, gathered: ExportScene, physical: PhysicalScene) -> None:
    """Make the stage's objects and planes bodies."""
    scene = UsdPhysics.Scene.Define(stage, f"{ROOT}/Physics")
    up = -1.0 if UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.z else 0.0
    scene.CreateGravityDirectionAttr(Gf.Vec3f(0.0, 0.0 if up else -1.0, up))
    scene.CreateGravityMagnitudeAttr(GRAVITY)
    several = scene.GetPrim().CreateAttribute("mjc:flag:multiccd", Sdf.ValueTypeNames.Bool)
    several.Set(True)  # newton: two bodies touch at up to four points; at one alone, what lies on another tips
    grips, colliders = _Grips(stage), _Colliders()
    paths = {b.node.id: object_path(b.node) for b in physical.bodies}
    plane_of = {p.slug: plane_path(p) for p in gathered.planes}
    for slab in physical.slabs:
        path = plane_of.get(slab.slug, f"{ROOT}/Architecture/{slab.slug}")
        UsdGeom.Xform.Define(stage, path)
        colliders.add(path, slab.pieces, grips.material(FLOOR_FRICTION))
    for body in physical.bodies:
        path, grip = paths[body.node.id], grips.material(body.friction)
        colliders.add(path, body.parts, grip)
        base = _base(physical, body)
        if base.free:
            UsdPhysics.RigidBodyAPI.Apply(stage.GetPrimAtPath(path))
            _mass(stage.GetPrimAtPath(path), body.inertia)
            if body.moving or body is not base:
                UsdPhysics.ArticulationRootAPI.Apply(stage.GetPrimAtPath(paths[base.node.id]))
        if base.free and not body.free and body.carrier is not None:
            _weld(
                stage,
                paths[body.carrier],
                path,
                rigid_inverse(gathered.object(body.carrier).T_world) @ body.node.T_world,
            )
        for moving in body.moving:
            joint = _limb(stage, path, moving)
            if not base.free:  # each joint that is bolted to what cannot move is the root of an articulation
                UsdPhysics.ArticulationRootAPI.Apply(joint)
            colliders.add(limb_path(path, moving.limb), moving.parts, grip)
            colliders.let_overlap(limb_path(path, moving.limb), path)  # a part and the case it sits in touch
    colliders.write(stage.GetRootLayer())


def object_path(item: ExportObject) -> str:
    """Path of an object's prim."""
    return "/".join((ROOT, "Objects", *item.group, item.slug))


def plane_path(slab: ExportPlane) -> str:
    """Path of a plane's prim."""
    return "/".join((ROOT, "Architecture", *slab.group, slab.slug))


def _base(physical: PhysicalScene, body: RigidBody) -> RigidBody:
    """The body that carries others by welds; itself where it is welded to none."""
    by_id = {b.node.id: b for b in physical.bodies}
    while not body.free and body.carrier is not None:
        body = by_id[body.carrier]
    return body


class _Grips:
    """Physical materials, one for each coefficient of friction."""

    def __init__(self, stage: Usd.Stage) -> None:
        self._stage = stage
        self._made: dict[float, UsdShade.Material] = {}

    def material(self, friction: float) -> UsdShade.Material:
        if friction not in self._made:
            UsdGeom.Scope.Define(self._stage, f"{ROOT}/PhysicsMaterials")
            path = f"{ROOT}/PhysicsMaterials/friction_{round(100 * friction)}"
            made = UsdShade.Material.Define(self._stage, path)
            grip = UsdPhysics.MaterialAPI.Apply(made.GetPrim())
            grip.CreateStaticFrictionAttr(friction)
            grip.CreateDynamicFrictionAttr(0.9 * friction)
            grip.CreateRestitutionAttr(0.0)
            self._made[friction] = made
        return self._made[friction]


class _Colliders:
    """Convex meshes that are not drawn. A scene has thousands of them, so they are written into the layer itself, in
    one change: a stage composes all its instances anew after each."""

    def __init__(self) -> None:
        self._of: dict[str, tuple[tuple[Points, ...], Sdf.Path]] = {}
        self._apart: dict[str, list[str]] = {}

    def add(self, path: str, parts: tuple[Points, ...], grip: UsdShade.Material) -> None:
        """Those of one prim: corners of convex parts in its frame, and the friction of their surface."""
        self._of[path] = parts, grip.GetPath()

    def let_overlap(self, path: str, other: str) -> None:
        """Say of each collider of a prim that it does not meet those of another: newton reads this of no body."""
        self._apart.setdefault(path, []).append(other)

    def write(self, layer: Sdf.Layer) -> None:
        """All of them."""
        with Sdf.ChangeBlock():
            for path, (parts, grip) in self._of.items():
                scope = Sdf.CreatePrimInLayer(layer, f"{path}/Colliders")
                scope.specifier, scope.typeName = Sdf.SpecifierDef, "Scope"
                Sdf.AttributeSpec(scope, "purpose", Sdf.ValueTypeNames.Token, _FIXED).default = UsdGeom.Tokens.guide
                others = [
                    f"{b}/Colliders/Part_{k}" for b in self._apart.get(path, ()) for k in range(len(self._of[b][0]))
                ]
                for number, points in enumerate(parts):
                    _collider(scope, f"Part_{number}", points, grip, [Sdf.Path(other) for other in others])


def _collider(scope: Sdf.PrimSpec, name: str, points: Points, grip: Sdf.Path, apart: list[Sdf.Path]) -> None:
    """One convex mesh with its collision, which may overlap the colliders `apart`."""
    vertices, faces = hull_faces(points)
    prim = Sdf.PrimSpec(scope, name, Sdf.SpecifierDef, "Mesh")
    schemas = [*_COLLIDER_SCHEMAS, *(["PhysicsFilteredPairsAPI"] if apart else [])]
    prim.SetInfo("apiSchemas", Sdf.TokenListOp.Create(prependedItems=schemas))
    types = Sdf.ValueTypeNames
    for attribute, kind, variability, value in (
        ("subdivisionScheme", types.Token, _FIXED, UsdGeom.Tokens.none),
        ("points", types.Point3fArray, _VARYING, vectors(vertices)),
        ("extent", types.Float3Array, _VARYING, extent(vertices)),
        ("faceVertexCounts", types.IntArray, _VARYING, integers(np.full(len(faces), 3))),
        ("faceVertexIndices", types.IntArray, _VARYING, integers(faces.reshape(-1))),
        ("physics:approximation", types.Token, _FIXED, UsdPhysics.Tokens.convexHull),
    ):
        Sdf.AttributeSpec(prim, attribute, kind, variability).default = value
    binding = Sdf.RelationshipSpec(prim, "material:binding:physics", custom=False)
    binding.targetPathList.explicitItems = [grip]
    if apart:
        pairs = Sdf.RelationshipSpec(prim, "physics:filteredPairs", custom=False)
        pairs.targetPathList.explicitItems = apart


def _mass(prim: Usd.Prim, inertia: Inertia) -> None:
    moments, axes = inertia.principal
    mass = UsdPhysics.MassAPI.Apply(prim)
    mass.CreateMassAttr(inertia.mass_kg)
    mass.CreateCenterOfMassAttr(Gf.Vec3f(*(float(v) for v in inertia.centre)))
    mass.CreateDiagonalInertiaAttr(Gf.Vec3f(*(float(v) for v in moments)))
    mass.CreatePrincipalAxesAttr(Gf.Quatf(quaternion(axes)))


def _limb(stage: Usd.Stage, owner: str, moving: MovingPart) -> Usd.Prim:
    """A body of its own beside its object, on a joint with limits, which is returned.

    Its frame is the object's when closed, so the joint is in one place of both; their poses tell how far it is open.
    """
    path = limb_path(owner, moving.limb)
    prim = stage.GetPrimAtPath(path)
    UsdPhysics.RigidBodyAPI.Apply(prim)
    _mass(prim, moving.inertia)
    limb = moving.limb
    slide = limb.kind == "slide"
    kind = UsdPhysics.PrismaticJoint if slide else UsdPhysics.RevoluteJoint
    joint = kind.Define(stage, f"{path}/Joint")
    joint.CreateBody0Rel().AddTarget(Sdf.Path(owner))
    joint.CreateBody1Rel().AddTarget(Sdf.Path(path))
    joint.CreateAxisAttr(UsdPhysics.Tokens.x)
    turn, origin = Gf.Quatf(quaternion(_frame_along(limb.axis))), Gf.Vec3f(*(float(v) for v in limb.origin))
    for side in ("0", "1"):
        getattr(joint, f"CreateLocalPos{side}Attr")(origin)
        getattr(joint, f"CreateLocalRot{side}Attr")(turn)
    if limb.kind != "swivel":
        unit = 1.0 if slide else 180.0 / np.pi
        joint.CreateLowerLimitAttr(limb.lower * unit)
        joint.CreateUpperLimitAttr(limb.upper * unit)
    return joint.GetPrim()


def limb_path(owner: str, limb: ExportLimb) -> str:
    """Where the prim of a moving part is: beside its object, because bodies must not be nested."""
    return f"{owner}__{limb.slug}"


def _frame_along(axis: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3 3"]:
    """A rotation whose first column is the axis."""
    other = np.eye(3)[int(np.abs(axis).argmin())]
    second = np.cross(axis, other)
    second /= np.linalg.norm(second)
    return np.stack([axis, second, np.cross(axis, second)], axis=1)


def _weld(stage: Usd.Stage, carrier: str, path: str, T: Float[np.ndarray, "4 4"]) -> None:
    joint = UsdPhysics.FixedJoint.Define(stage, f"{path}/Weld")
    joint.CreateBody0Rel().AddTarget(Sdf.Path(carrier))
    joint.CreateBody1Rel().AddTarget(Sdf.Path(path))
    joint.CreateLocalPos0Attr(Gf.Vec3f(*T[:3, 3].tolist()))
    joint.CreateLocalRot0Attr(Gf.Quatf(quaternion(T[:3, :3])))
