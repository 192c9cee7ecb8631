// A walk in the first person: keys, drags, a stick for thumbs, a gamepad. Feet stay where a body fits (`Walk` in Python),
// so that nobody crosses a wall; Esc ends it. The exported page and the editor share this file.
(() => {
  const SPEED_M = 1.4, RUN = 2, STEP_M = 0.04, TURN_RAD = 2.0, DRAG_RAD = 0.004, PITCH_RAD = 1.3, DEAD = 0.15, LAG_S = 0.1;
  const FOV_RAD = 1.2;
  const WAYS = { KeyW: [1, 0], ArrowUp: [1, 0], KeyS: [-1, 0], ArrowDown: [-1, 0], KeyA: [0, -1], KeyD: [0, 1] };
  const TURNS = { ArrowLeft: 1, KeyQ: 1, ArrowRight: -1, KeyE: -1 };
  const STYLE = `
    #dio-walk { position: fixed; z-index: 60; left: 0; right: 0; bottom: 14px; display: flex; justify-content: center;
      align-items: flex-end; gap: 10px; pointer-events: none; font: 13px/1.35 system-ui, sans-serif; color: #2b2f36; }
    #dio-walk > * { pointer-events: auto; background: #fffffff2; border-radius: 10px; box-shadow: 0 2px 10px #0002; }
    #dio-walk p { margin: 0; padding: 7px 12px; }
    #dio-walk button { font: inherit; border: 0; padding: 7px 14px; color: #fff; background: #2f6fd6; cursor: pointer; }
    #dio-walk button:focus-visible { outline: 2px solid #ff7a1a; outline-offset: 2px; }
    #dio-walk .stick { display: none; position: fixed; left: 18px; bottom: 18px; width: 112px; height: 112px;
      border-radius: 50%; touch-action: none; background: #ffffff80; }
    #dio-walk .stick i { position: absolute; left: 36px; top: 36px; width: 40px; height: 40px; border-radius: 50%;
      background: #2f6fd6cc; }
    @media (pointer: coarse) { #dio-walk .stick { display: block; } #dio-walk p { display: none; } }`;
  let walk = null;

  const inside = (rings, x, y) => {
    let odd = false;
    for (const ring of rings) for (let k = 1; k < ring.length; k++) {
      const [ax, ay] = ring[k - 1], [bx, by] = ring[k];
      if (ay > y !== by > y && x < ((bx - ax) * (y - ay)) / (by - ay) + ax) odd = !odd;
    }
    return odd;
  };
  const nearest = (rings, x, y) => {
    let best = [x, y], far = Infinity;
    for (const ring of rings) for (let k = 1; k < ring.length; k++) {
      const [ax, ay] = ring[k - 1], dx = ring[k][0] - ax, dy = ring[k][1] - ay;
      const t = Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1), 0), 1);
      const away = Math.hypot(ax + t * dx - x, ay + t * dy - y);
      if (away < far) [far, best] = [away, [ax + t * dx, ay + t * dy]];
    }
    return best;
  };
  const go = (dx, dy) => { // in short steps, each back to the rim where it left the floor: one slides along walls
    const steps = Math.ceil(Math.hypot(dx, dy) / STEP_M);
    for (let k = 0; k < steps; k++) {
      const [x, y] = [walk.at[0] + dx / steps, walk.at[1] + dy / steps];
      walk.at = inside(walk.rings, x, y) ? [x, y] : nearest(walk.rings, x, y);
    }
  };
  const pad = () => {
    const one = [...(navigator.getGamepads?.() ?? [])].find((p) => p?.connected && p.axes.length >= 4);
    return (one?.axes ?? [0, 0, 0, 0]).slice(0, 4).map((v) => (Math.abs(v) < DEAD ? 0 : v));
  };
  const show = () => {
    const m = window.__viserMutable, root = m.nodeRefFromName[""], up = Math.sin(walk.pitch), on = Math.cos(walk.pitch);
    const world = (x, y, z) => root.localToWorld(m.camera.position.clone().set(x, y, z));
    const [x, y] = walk.at, a = world(x, y, walk.eye);
    const b = world(x + on * Math.cos(walk.yaw), y + on * Math.sin(walk.yaw), walk.eye + up);
    m.cameraControl.setLookAt(a.x, a.y, a.z, b.x, b.y, b.z, false);
    m.requestRender();
  };
  const frame = (now) => {
    if (walk === null) return;
    const s = Math.min((now - walk.then) / 1000, LAG_S), [px, py, qx, qy] = pad();
    let [ahead, right, turn] = [walk.stick[1] - py, walk.stick[0] + px, -qx];
    for (const key of walk.keys) {
      ahead += WAYS[key]?.[0] ?? 0;
      right += WAYS[key]?.[1] ?? 0;
      turn += TURNS[key] ?? 0;
    }
    walk.then = now;
    walk.yaw += turn * TURN_RAD * s;
    walk.pitch = Math.min(Math.max(walk.pitch - qy * s, -PITCH_RAD), PITCH_RAD);
    const way = Math.hypot(ahead, right), pace = (SPEED_M * s * (walk.keys.has("Shift") ? RUN : 1)) / Math.max(way, 1);
    const [c, n] = [Math.cos(walk.yaw), Math.sin(walk.yaw)];
    if (way) go((ahead * c + right * n) * pace, (ahead * n - right * c) * pace);
    if (way || turn || qy || walk.turned) show();
    walk.turned = false;
    requestAnimationFrame(frame);
  };

  const keyOf = (event) => (event.key === "Shift" ? "Shift" : event.code);
  const onKey = (event) => {
    if (event.target.closest?.("input, textarea, select")) return;
    const key = keyOf(event), pressed = event.target.closest?.("button, a") && [" ", "Enter"].includes(event.key);
    if (event.ctrlKey || event.metaKey || event.altKey || event.key === "Tab" || pressed) return;
    event.preventDefault();
    event.stopImmediatePropagation(); // no key is a command meanwhile, nor viser's own flight
    if (event.type === "keyup") walk.keys.delete(key);
    else if (key === "Escape") end();
    else walk.keys.add(key);
  };
  const onDrag = (event) => {
    if (event.type === "pointerdown") {
      if (event.target.closest?.("#dio-toolbar, #dio-viewer")) end(); // another view is asked for
      if (event.target.tagName !== "CANVAS" || walk === null) return;
      walk.drag = [event.pointerId, event.clientX, event.clientY];
    }
    if (walk?.drag?.[0] !== event.pointerId) return;
    event.stopImmediatePropagation();
    walk.yaw += (event.clientX - walk.drag[1]) * DRAG_RAD;
    walk.pitch = Math.min(Math.max(walk.pitch + (event.clientY - walk.drag[2]) * DRAG_RAD, -PITCH_RAD), PITCH_RAD);
    walk.turned = true;
    walk.drag = event.type === "pointerup" || event.type === "pointercancel" ? null : [event.pointerId, event.clientX, event.clientY];
  };
  const onStick = (event) => {
    const stick = event.currentTarget, box = stick.getBoundingClientRect(), held = event.buttons > 0 && event.type !== "pointerup";
    if (event.type === "pointerdown") stick.setPointerCapture(event.pointerId);
    const [x, y] = held ? [(event.clientX - box.left) / 56 - 1, 1 - (event.clientY - box.top) / 56] : [0, 0];
    const far = Math.max(Math.hypot(x, y), 1);
    walk.stick = [x / far, y / far];
    stick.firstChild.style.transform = `translate(${(36 * x) / far}px, ${(-36 * y) / far}px)`;
  };
  const listen = (add) => {
    const change = add ? addEventListener : removeEventListener;
    for (const type of ["keydown", "keyup"]) change(type, onKey, true);
    for (const type of ["pointerdown", "pointermove", "pointerup", "pointercancel"]) change(type, onDrag, true);
  };
  const bar = () => {
    const made = Object.assign(document.createElement("div"), { id: "dio-walk" });
    made.innerHTML = `<style>${STYLE}</style><p>${_("Walk with W A S D or the arrow keys; drag to look around; hold Shift to run")}</p>
      <button type="button">${_("End walk (Esc)")}</button><div class="stick" aria-label="${_("Walk")}" role="application"><i></i></div>`;
    made.querySelector("button").onclick = () => end();
    const stick = made.querySelector(".stick");
    for (const type of ["pointerdown", "pointermove", "pointerup", "pointercancel"]) stick.addEventListener(type, onStick);
    return made;
  };

  const begin = ({ rings, start, heading, eye }, ended) => {
    end();
    const m = window.__viserMutable, held = (name) => m.cameraControl[name](m.camera.position.clone());
    walk = {
      rings, eye, at: start, yaw: heading, pitch: 0, keys: new Set(), stick: [0, 0], drag: null, turned: true,
      then: performance.now(), ended, before: [held("getPosition"), held("getTarget"), m.camera.fov],
    };
    m.cameraControl.enabled = false;
    m.messageQueue.push({ type: "SetCameraFovMessage", fov: FOV_RAD, initial: false });
    document.body.append(bar());
    document.activeElement?.blur?.();
    listen(true);
    requestAnimationFrame(frame);
  };
  const end = () => {
    if (walk === null) return;
    const m = window.__viserMutable, [at, target, degrees] = walk.before, { ended } = walk;
    walk = null;
    listen(false);
    document.getElementById("dio-walk")?.remove();
    m.cameraControl.enabled = true;
    m.messageQueue.push({ type: "SetCameraFovMessage", fov: (degrees * Math.PI) / 180, initial: false });
    m.cameraControl.setLookAt(at.x, at.y, at.z, target.x, target.y, target.z, false);
    m.requestRender();
    ended?.();
  };
  window.__dioWalk = { begin, end, place: () => walk && { at: walk.at, yaw: walk.yaw } };
})();
