// Where on the canvas an object is, and pictures of a part of the canvas only: the rest stays as it was drawn before, which
// viser's canvas keeps. Rectangles are [left, bottom, right, top] in pixels of the page, from the canvas's lower left.
(() => {
  const R = window.__dioRegion = {};
  const LINE_PX = 16; // around an object: its outline, and what rounding takes
  const LABEL_PX = [240, 60]; // around the point that a label stands at, to each side
  const drawn = (o) => (o.isMesh || o.isLine || o.isPoints) && o.geometry;

  R.union = (a, b) =>
    !a ? b : !b ? a : [Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.max(a[2], b[2]), Math.max(a[3], b[3])];
  R.share = (m, [left, bottom, right, top]) => {
    const { clientWidth: width, clientHeight: height } = m.canvas;
    const across = Math.min(right, width) - Math.max(left, 0), up = Math.min(top, height) - Math.max(bottom, 0);
    return (Math.max(across, 0) * Math.max(up, 0)) / (width * height);
  };

  const seenFrom = (m) => m.camera.projectionMatrix.clone().multiply(m.camera.matrixWorldInverse);
  const pixel = (m, e, x, y, z) => {
    const w = e[3] * x + e[7] * y + e[11] * z + e[15];
    if (w < 1e-3) return null; // beside or behind the eye
    const right = (e[0] * x + e[4] * y + e[8] * z + e[12]) / w, up = (e[1] * x + e[5] * y + e[9] * z + e[13]) / w;
    return [((right + 1) / 2) * m.canvas.clientWidth, ((up + 1) / 2) * m.canvas.clientHeight];
  };
  // Of what one mesh or line covers; null where that cannot be told.
  const cover = (m, seen, o) => {
    if (!o.geometry.boundingBox) o.geometry.computeBoundingBox();
    const box = o.geometry.boundingBox;
    if (!box || box.isEmpty()) return null;
    const e = seen.clone().multiply(o.matrixWorld).elements;
    let rectangle = null;
    for (let k = 0; k < 8; k += 1) {
      const at = pixel(m, e, ...["x", "y", "z"].map((axis, bit) => box[(k >> bit) & 1 ? "max" : "min"][axis]));
      if (!at) return null;
      rectangle = R.union(rectangle, [at[0] - LINE_PX, at[1] - LINE_PX, at[0] + LINE_PX, at[1] + LINE_PX]);
    }
    return rectangle;
  };

  // Of what a node and all that is below it covers in the place that it was last drawn in; null where that cannot be
  // told, as of a lamp, which is seen on everything around it.
  R.of = (m, name) => {
    const node = m.nodeRefFromName[name], seen = seenFrom(m);
    let rectangle = null, known = Boolean(node);
    node?.traverse((o) => {
      if (o.isLight || o.isSkinnedMesh || o.isInstancedMesh) known = false;
      if (!known || !drawn(o)) return;
      const covered = cover(m, seen, o);
      if (covered) rectangle = R.union(rectangle, covered);
      else known = false;
    });
    for (const below in m.nodePoseData) {
      if (!known || !below.startsWith(`${name}/`) || !/\/mark\/tag$/.test(below)) continue;
      const foot = node.position.clone().set(...(m.nodePoseData[below]?.position ?? [0, 0, 0])).applyMatrix4(node.matrixWorld);
      const at = pixel(m, seen.elements, foot.x, foot.y, foot.z);
      if (!at) known = false;
      else rectangle = R.union(rectangle, [...at.map((v, k) => v - LABEL_PX[k]), ...at.map((v, k) => v + LABEL_PX[k])]);
    }
    return known ? rectangle : null;
  };

  R.draw = (m, renderer, render, scene, camera, rectangle) => {
    const [left, bottom] = rectangle.slice(0, 2).map((v) => Math.max(0, Math.floor(v)));
    const [right, top] = [Math.max(left + 1, Math.ceil(rectangle[2])), Math.max(bottom + 1, Math.ceil(rectangle[3]))];
    const seen = seenFrom(m), elsewhere = [];
    scene.traverseVisible((o) => {
      if (!drawn(o) || !o.frustumCulled || o.isInstancedMesh || o.isSkinnedMesh) return;
      const covered = cover(m, seen, o);
      if (!covered) return;
      if (covered[2] > left && covered[0] < right && covered[3] > bottom && covered[1] < top) return;
      elsewhere.push([o, o.layers.mask]);
      o.layers.mask = 0; // itself, and not what is below it
    });
    renderer.setScissor(left, bottom, right - left, top - bottom);
    renderer.setScissorTest(true);
    try {
      render(scene, camera);
    } finally {
      renderer.setScissorTest(false);
      for (const [o, mask] of elsewhere) o.layers.mask = mask;
    }
  };
})();
