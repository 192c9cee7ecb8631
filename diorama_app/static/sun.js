// Casts the sun's shadows: one map that fits the room, where viser's own would follow the camera and leave what is far
// off half lit. Walls and ceiling hold the sun off even while they are not drawn; panes let it through.
// The page is told with __dioSun.told (viewport/room_light.py); walls.js calls __dioSun.frame before every picture.
(() => {
  const S = window.__dioSun = { about: null };
  const MAP_PX = 2048, BIAS = -0.0006, NORMAL_BIAS = 0.015, SHADE = 0xaa8855;
  const child = (node, is) => { let found = null; node?.traverse((o) => { if (!found && is(o)) found = o; }); return found; };
  const hide = (mesh) => {
    if (!mesh || mesh.userData.dioCaster === mesh.material) return;
    mesh.userData.dioCaster = mesh.material;
    Object.assign(mesh.material, { colorWrite: false, depthWrite: false });
    mesh.raycast = () => {};
  };
  const fit = (light, about, root) => {
    if (!light.castShadow) {
      light.shadow.mapSize.set(MAP_PX, MAP_PX);
      light.shadow.bias = BIAS;
      light.shadow.normalBias = NORMAL_BIAS;
      light.castShadow = true;
    }
    const camera = light.shadow.camera, r = about.radius;
    if (camera.right !== r) {
      Object.assign(camera, { left: -r, right: r, top: r, bottom: -r, near: 0.01, far: 4 * r });
      camera.updateProjectionMatrix();
    }
    const middle = light.target.position.clone().set(...about.middle);
    root.localToWorld(middle);
    if (!light.target.position.equals(middle)) {
      light.target.position.copy(middle);
      light.target.updateMatrixWorld(true);
    }
  };
  const glow = (k, on, shade) => {
    const own = k.userData.dioGlow ??= k.emissive.clone(), isShade = k.name === shade;
    const wanted = isShade && own.getHex() === 0 ? (on ? SHADE : 0) : on ? own.getHex() : 0;
    if (k.emissive.getHex() !== wanted) k.emissive.setHex(wanted);
  };
  S.frame = (m) => {
    const about = S.about, root = m.nodeRefFromName[''];
    if (!about || !root) return;
    for (const [name, on, shade] of about.lamps || []) m.nodeRefFromName[name]?.traverse((o) => {
      if (o.isMesh && o.material.emissive) glow(o.material, on, shade);
    });
    if (!about.sun) return;
    const light = child(m.nodeRefFromName[about.sun], (o) => o.isDirectionalLight);
    if (light) fit(light, about, root);
    hide(child(m.nodeRefFromName[about.walls], (o) => o.isMesh));
    for (const name of about.panes) m.nodeRefFromName[name]?.traverse((o) => {
      if (!o.isMesh || o.userData.dioPane === o.material) return;
      o.userData.dioPane = o.material;
      const lit = o.material.emissive && o.material.emissive.getHex() !== 0;
      if (lit || o.material.transparent) o.castShadow = false;
    });
  };
  S.told = (about) => {
    const m = window.__viserMutable, told = new Set((about?.lamps || []).map((lamp) => lamp[0]));
    for (const [name] of S.about?.lamps || []) if (!told.has(name)) m?.nodeRefFromName[name]?.traverse((o) => {
      if (o.material?.userData?.dioGlow) o.material.emissive.copy(o.material.userData.dioGlow);
    });
    S.about = about;
    window.__viserMutable?.requestRender?.();
  };
})();
