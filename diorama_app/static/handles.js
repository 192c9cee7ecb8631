// Handles win over bodies: what a handle's ray meets comes before everything else it meets, as near as it looks.
(() => {
  const HANDLES = /^\/(gizmo|size)(\/|$)/;
  const FIRST = 1e-4;
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
      if (HANDLES.test(name)) nodes[name]?.traverse((o) => { if (o.isMesh && !o.userData.dioLifted) lift(o); });
    }
  }, 120);
})();
