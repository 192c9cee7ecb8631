// What is being placed follows the pointer: the page is told what and onto which surfaces (panels/ghost.py), and moves it by
// itself. A click is told to the server, which puts it where it is seen; so is the drop of a tile of the catalogue.
(() => {
  let told = null, at = null;
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const glass = (node) => node.traverse((o) => {
    if (!o.material || o.userData.ghost) return;
    o.userData.ghost = true;
    o.raycast = () => {};
    o.material = o.material.clone();
    Object.assign(o.material, { transparent: true, opacity: 0.62, depthWrite: false });
  });
  const ray = (m, root) => {
    const box = m.canvas.getBoundingClientRect(), far = m.camera.position.clone();
    far.set((at[0] - box.left) / box.width * 2 - 1, 1 - (at[1] - box.top) / box.height * 2, 0.5).unproject(m.camera);
    const from = root.worldToLocal(m.camera.position.clone()), to = root.worldToLocal(far);
    return [[from.x, from.y, from.z], [to.x - from.x, to.y - from.y, to.z - from.z]];
  };
  const hit = (eye, ahead) => {
    let best = null;
    for (const s of told.surfaces) {
      const slope = dot(s.normal, ahead);
      if (slope > -1e-9 || (!s.up && !told.hung)) continue;
      const t = (s.level - dot(s.normal, eye)) / slope;
      const p = eye.map((v, i) => v + t * ahead[i]);
      if (t > 0 && (!best || t < best.t) && s.outward.every((n, k) => dot(n, p) <= s.offset[k] + 1e-6)) best = { t, s, p };
    }
    return best;
  };
  // Before walls, not through them, as editing/clear_of_walls.py puts it.
  const clear = (at, yaw) => {
    const [depth, width] = told.size, c = Math.cos(yaw), s = Math.sin(yaw);
    for (const wall of told.surfaces) {
      const n = wall.normal;
      if (Math.abs(n[2]) > 0.3) continue;
      const reach = (Math.abs(n[0] * c + n[1] * s) * depth + Math.abs(n[1] * c - n[0] * s) * width) / 2;
      const gap = dot(n, at) - wall.level, foot = [at[0] - gap * n[0], at[1] - gap * n[1], Math.max(at[2], wall.foot + 0.3)];
      if (-reach < gap && gap < reach && wall.outward.every((m, k) => dot(m, foot) <= wall.offset[k] + 1e-6))
        at = at.map((v, i) => v + (reach - gap) * n[i]);
    }
    return at;
  };
  const move = () => {
    const m = window.__viserMutable, node = told && m?.nodeRefFromName[told.node];
    if (!node || !at) return;
    glass(node);
    const root = m.nodeRefFromName[""], [eye, ahead] = ray(m, root), found = hit(eye, ahead);
    node.visible = found !== null && document.elementFromPoint(...at)?.tagName === "CANVAS";
    if (found) {
      const { s, p } = found, [depth, , height] = told.size, n = s.normal;
      const flat = Math.abs(n[2]) > 0.7;
      const quarter = (x, y) => Math.round(Math.atan2(y, x) / (Math.PI / 2)) * Math.PI / 2;
      const yaw = !flat ? Math.atan2(n[1], n[0]) : told.camera ? quarter(told.camera[0] - p[0], told.camera[1] - p[1])
        : -Math.PI / 2;
      const away = flat ? height / 2 : depth / 2;
      const z = told.door && !flat ? s.foot + height / 2 : p[2] + n[2] * away;
      const at3 = clear([p[0] + n[0] * away, p[1] + n[1] * away, z], yaw);
      node.position.set(...at3);
      node.quaternion.set(0, 0, Math.sin(yaw / 2), Math.cos(yaw / 2));
      node.updateMatrixWorld(true);
    }
    window.__dioGhostAt = found ? node.position.toArray() : null;
    m.requestRender();
  };
  addEventListener("pointermove", (event) => {
    at = [event.clientX, event.clientY];
    if (told) requestAnimationFrame(move);
  });
  const onView = (event) => told && event.target === window.__viserMutable?.canvas;
  addEventListener("dragover", (event) => {
    at = [event.clientX, event.clientY];
    if (told) requestAnimationFrame(move);
    if (onView(event)) event.preventDefault();
  });
  addEventListener("drop", (event) => {
    const button = document.getElementById("dio-ghost-drop"), m = window.__viserMutable;
    if (!onView(event) || !button) return;
    event.preventDefault();
    button.dataset.arg = JSON.stringify(ray(m, m.nodeRefFromName[""]));
    button.click();
  });
  window.__dioGhost = (what) => {
    told = what;
    window.__dioGhostAt = null;
    if (!told) return;
    let tries = 60; // the model is still being read
    const wait = () => {
      if (told !== what) return;
      move();
      if (window.__viserMutable?.nodeRefFromName[told.node] === undefined && tries--) setTimeout(wait, 100);
    };
    wait();
  };
})();
