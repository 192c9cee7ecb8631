// Draws each plane, and what hangs on it, in its share, right before every picture; costs nothing while none is drawn.
// The page is told the room with __dioWalls.told (panels/walls.py).
(() => {
  const W = window.__dioWalls = { shares: {} };
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
  const paint = (node, share, plane) => {
    node.userData.dioFaded = share < 1;
    node.traverse((o) => paintOne(o, share, plane));
  };
  const paintOne = (o, share, plane) => {
    if (o.material?.uniforms?.screenspace) {  // its outline: what is faded is not pointed at
      if (share < 1) o.raycast = () => {}; else delete o.raycast;
      return;
    }
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
  };
  const meshes = (m, name, versions) =>
    [...Array(versions).keys()].map((v) => m.nodeRefFromName[name + '/v' + v]).filter((node) => node);
  const frame = (m) => {
    window.__dioSun?.frame(m);
    window.__dioSilhouettes?.frame(m);
    window.__dioDistances?.frame(m);
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
  hook();
})();
