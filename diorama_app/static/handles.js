// Handles and measured lengths are drawn over bodies, and what a handle's ray meets comes before everything else it meets, as
// near as it looks.
(() => {
  const HANDLES = /^\/(gizmo|size)(\/|$)/, OVER = /^\/(size|tape|distances)(\/|$)/;
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
      const handle = HANDLES.test(name), over = OVER.test(name);
      if (!handle && !over) continue;
      nodes[name]?.traverse((o) => {
        if (!o.isMesh) return;
        if (handle && !o.userData.dioLifted) lift(o);
        if (!over || !o.material.depthTest) return;
        Object.assign(o.material, { depthTest: false, transparent: true }); // transparent ones are drawn last
        o.renderOrder = OVER_ALL;
        window.__viserMutable.requestRender();
      });
    }
  }, 120);
})();
