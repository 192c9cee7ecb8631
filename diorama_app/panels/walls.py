"""Walls that stand between the eye and the room fade, and what hangs on them with them, in every frame the page draws.

The page is told where planes are and what hangs on them; it fades by itself, so that turning the view needs no server.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

import viser

from diorama_app.guest import Guest
from diorama_app.page import run_once
from diorama_app.viewport import MESH_NAMES
from diorama_core.scene.types import Plane, Scene

FADE_MS = 200
GHOST = {"wall": 0.13, "floor": 0.13, "ceiling": 0.0}
"""What is left of a plane seen from behind. A ceiling goes: it would lie over the whole room seen from above."""
PHOTO_NEAR_M = 0.03
"""Nearer to the photo's camera the model is compared with the photo, and nothing is laid over it."""

_FADER = """
const W = window.__dioWalls = window.__dioWalls || {};
W.shares = W.shares || {};
const plain = (o) => o.isMesh && o.material && !o.material.isShaderMaterial && o.material.type !== 'ShadowMaterial';
const glass = (m, share) => W.glass = W.glass || new m.backgroundMaterial.constructor({
  vertexShader: 'void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }',
  fragmentShader: 'void main() { gl_FragColor = vec4(0.80, 0.78, 0.74, ' + share.toFixed(3) + '); }',
  transparent: true, depthWrite: false, side: 2,
});
const glaze = (m, node, share) => node.traverse((o) => {
  const own = o.userData.own || o.material;
  if (!o.isMesh || !own) return;
  const faded = share < 1;
  o.visible = share > 0 && (!faded || own.type !== 'ShadowMaterial');
  if (!o.visible || faded === !!o.userData.own || own.type === 'ShadowMaterial') return;
  o.userData.own = faded ? own : null;
  o.material = faded ? glass(m, share) : own;
});
const paint = (node, share, plane) => node.traverse((o) => {
  if (o.material && o.material.type === 'ShadowMaterial') { o.visible = share === 1; return; }
  if (!plain(o)) return;
  const k = o.material, faded = share < 1;
  if (faded !== !!k.userData.faded) {
    if (faded) k.userData.before = [k.transparent, k.depthWrite, k.side, k.opacity];
    k.forceSinglePass = faded;
    const b = k.userData.before;
    k.userData.faded = faded;
    k.transparent = faded || b[0]; k.depthWrite = !faded && b[1]; k.side = faded && plane ? 2 : b[2];
    k.opacity = b[3];
    k.needsUpdate = true;
  }
  if (faded !== !!o.userData.faded) {
    o.userData.faded = faded;
    if (faded) { o.userData.casts = o.castShadow; o.raycast = () => {}; } else delete o.raycast;
    o.castShadow = !faded && o.userData.casts;
  }
  if (faded) k.opacity = share * k.userData.before[3];
  o.visible = share > 0;
});
const meshes = (m, name, versions) =>
  [...Array(versions).keys()].map((v) => m.nodeRefFromName[name + '/v' + v]).filter((node) => node);
const frame = (m) => {
  const d = W.room, root = m.nodeRefFromName[''];
  if (!d || !root) return;
  const now = performance.now(), step = Math.min(now - (W.last || 0), 60) / d.ms;
  W.last = now;
  const p = root.worldToLocal(m.camera.position.clone()), eye = [p.x, p.y, p.z];
  const dot = (n) => n[0] * eye[0] + n[1] * eye[1] + n[2] * eye[2];
  const photo = !!d.photo && Math.hypot(...d.photo.map((v, i) => v - eye[i])) < d.near;
  let busy = false;
  const towards = (name, aim) => {
    const was = W.shares[name];
    const share = was === undefined || photo || !d.ms ? aim : was + Math.max(-step, Math.min(step, aim - was));
    busy = busy || share !== aim;
    return W.shares[name] = share;
  };
  for (const [name, n, offset, ghost] of d.planes) {
    const node = m.nodeRefFromName[name];
    if (!node) continue;
    const share = towards(name, dot(n) > offset ? 1 : photo ? 0 : ghost);
    if (d.ms || !m.backgroundMaterial) paint(node, share, true); else glaze(m, node, share);
  }
  for (const [name, n, offset, ghost] of d.hung) {
    const share = towards(name, photo || dot(n) > offset ? 1 : ghost);
    for (const node of meshes(m, name, d.versions)) paint(node, share, false);
  }
  if (busy) setTimeout(() => m.requestRender());
};
const hook = () => {
  const m = window.__viserMutable;
  if (!m || !m.scene) { requestAnimationFrame(hook); return; }
  m.scene.onBeforeRender = () => frame(m);
  m.requestRender();
};
W.told = (room) => {
  const m = window.__viserMutable, still = new Set(room.hung.map((row) => row[0]));
  for (const [name] of W.room ? W.room.hung : []) if (!still.has(name)) {
    delete W.shares[name];
    for (const node of meshes(m, name, W.room.versions)) paint(node, 1, false);
  }
  W.room = room;
  if (m && m.requestRender) m.requestRender();
};
if (W.waiting) W.told(W.waiting);
hook();
"""
"""Draws each plane, and what hangs on it, in its share. Runs before every frame, which costs nothing while none is."""

_TOLD = "const W=window.__dioWalls=window.__dioWalls||{},r=%s;if(W.told)W.told(r);else W.waiting=r"


class Walls:
    """Tells one page where the walls are."""

    def __init__(self, gui: viser.GuiApi, guest: Guest) -> None:
        self._guest = guest
        self._told = ""
        gui.add_html(run_once(_FADER))
        self._html = gui.add_html("")

    def refresh(self) -> None:
        """Tell the page what differs from what it knows."""
        room, guest = self._guest.room, self._guest
        ms, view = 0 if room.low_graphics else FADE_MS, room.viewport
        about = what_fades(room.scene, view.plane_name, view.node_name, guest.selection, ms)
        told = json.dumps({**about, "versions": MESH_NAMES}, separators=(",", ":"))
        if told != self._told:
            self._told = told
            self._html.content = run_once(_TOLD % told)


def what_fades(
    scene: Scene,
    plane_name: Callable[[str], str | None],
    object_name: Callable[[str], str | None],
    selection: tuple[str, ...],
    fade_ms: int,
) -> dict[str, Any]:
    """What a page needs to know to fade walls.

    Args:
        scene: as it is shown.
        plane_name: node of a plane, by id.
        object_name: node of an object, by id.
        selection: what stays solid because a person holds it.
        fade_ms: how long a fade takes; 0: at once.

    Returns:
        Rows (node, normal into the room, offset, what is left when seen from behind) of planes, and likewise of what
        hangs on walls; the photo's camera (world, metres).
    """
    planes = {p.id: p for p in scene.architecture.planes}
    rows = [[plane_name(i), *_sides(p)] for i, p in planes.items() if plane_name(i) is not None]
    parents = {s.child: s.parent for s in scene.supports}
    hung = []
    for item in scene.objects:
        wall = planes.get(_held_by(parents, item.id))
        if wall is not None and wall.role == "wall":
            normal, offset, ghost = _sides(wall)
            hung.append([object_name(item.id), normal, offset, 1.0 if item.id in selection else ghost])
    photo = None if scene.camera is None else _rounded(scene.camera.position)
    return {"planes": rows, "hung": hung, "photo": photo, "near": PHOTO_NEAR_M, "ms": fade_ms}


def _sides(plane: Plane) -> list[Any]:
    return [_rounded(plane.normal), round(float(plane.offset), 4), GHOST[plane.role]]


def _rounded(vector: Any) -> list[float]:
    return [round(float(v), 4) for v in vector]


def _held_by(parents: Mapping[str, str], object_id: str) -> str:
    """The plane at the root of what holds an object up; empty for what nothing holds."""
    held = parents.get(object_id, "")
    while held in parents:
        held = parents[held]
    return held
