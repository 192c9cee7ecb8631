// How far what is dragged is from walls and neighbours: lines and words over the view, which is not drawn anew for them.
// The page is told with __dioDistances.told (viewport/client_view.py); walls.js calls frame before every picture.
(() => {
  const D = window.__dioDistances = { lines: [] };
  const SVG = "http://www.w3.org/2000/svg", LINE_AND_WORDS = ["line", "line", "text"];
  const NEAREST = 1e-3; // what is less far before the camera is not on the screen
  const layer = () => document.getElementById("dio-distances") ?? document.body.appendChild(
    Object.assign(document.createElementNS(SVG, "svg"), { id: "dio-distances" }));
  // A line is cut where it goes behind the camera.
  const project = (m, ends) => {
    const root = m.nodeRefFromName[""].matrixWorld, box = m.canvas.getBoundingClientRect();
    const seen = ends.map((end) => m.camera.position.clone().set(...end).applyMatrix4(root).applyMatrix4(m.camera.matrixWorldInverse));
    if (seen.every((p) => p.z > -NEAREST)) return null;
    for (const [p, q] of [seen, [...seen].reverse()]) if (p.z > -NEAREST) p.lerp(q, (p.z + NEAREST) / (p.z - q.z));
    return seen.map((p) => p.applyMatrix4(m.camera.projectionMatrix)).map((p) =>
      [box.left + (p.x + 1) / 2 * box.width, box.top + (1 - p.y) / 2 * box.height]);
  };
  D.frame = (m) => {
    const drawn = D.lines.map(([start, end, words]) => [project(m, [start, end]), words]).filter(([ends]) => ends);
    if (drawn.length === 0 && !document.getElementById("dio-distances")) return;
    const parts = layer();
    while (parts.children.length > 3 * drawn.length) parts.lastChild.remove();
    while (parts.children.length < 3 * drawn.length) {
      parts.append(...LINE_AND_WORDS.map((kind) => document.createElementNS(SVG, kind)));
    }
    drawn.forEach(([[[x1, y1], [x2, y2]], words], k) => {
      const [below, line, text] = [...parts.children].slice(3 * k, 3 * k + 3);
      for (const [node, name] of [[below, "below"], [line, "line"]]) {
        node.setAttribute("class", name);
        Object.entries({ x1, y1, x2, y2 }).forEach(([key, value]) => node.setAttribute(key, value));
      }
      text.setAttribute("x", (x1 + x2) / 2);
      text.setAttribute("y", (y1 + y2) / 2);
      text.textContent = words;
    });
  };
  D.told = (lines) => {
    D.lines = lines;
    const m = window.__viserMutable;
    if (m?.camera && m.nodeRefFromName?.[""]) D.frame(m);
  };
})();
