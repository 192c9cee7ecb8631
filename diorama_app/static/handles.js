// Handles win over bodies: they are drawn over them, and what a handle's ray meets comes before everything else it meets,
// as near as it looks.
(() => {
  const HANDLES = /^\/(gizmo|size)(\/|$)/;
  const FIRST = 1e-4, OVER_ALL = 1000;
  const lift = (mesh) => {
    const own = mesh.raycast;
    mesh.userData.dioLifted = true;
    mesh.raycast = function (ray, hits) {
      const mine = [];
      own.call(this, ray, mine);
      for (const hit of mine) hits.push({ ...hit, distance: hit.distance * FIRST });
    };
  };
  setInterval(() => {
    const nodes = window.__viserMutable?.nodeRefFromName ?? {};
    for (const name of Object.keys(nodes)) {
      if (!HANDLES.test(name)) continue;
      nodes[name]?.traverse((o) => {
        if (!o.isMesh) return;
        if (!o.userData.dioLifted) lift(o);
        if (!name.startsWith("/size") || !o.material.depthTest) return;
        Object.assign(o.material, { depthTest: false, transparent: true }); // transparent ones are drawn last
        o.renderOrder = OVER_ALL;
        window.__viserMutable.requestRender();
      });
    }
  }, 120);
})();
