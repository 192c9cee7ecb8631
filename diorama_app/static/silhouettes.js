// Outlines of objects as one line around what is seen of them: viser's outline of every part is drawn behind all parts
// of its object, so that none shows inside. And what is pointed at: the name of an object, the photo of a camera.
// The page is told with __dioSilhouettes.told (panels/silhouettes.py); walls.js calls frame before every picture.
(() => {
  const O = window.__dioSilhouettes = { lines: new Map(), names: {} };
  const NODE = /^\/objects\/\d+\/v\d+$/, CAMERA = /^\/photo_camera[^/]*$/, HOVER = ["#4c8dff", 2.5];
  const POINTED_AT = 0xfbff00; // in which viser draws a camera that is pointed at
  let pointer = null, over = null;
  const outline = (node) => {
    if (node.userData.dioOutline?.parent !== node) {
      node.userData.dioOutline = node.children.find((c) => c.children[0]?.material?.uniforms?.screenspace) ?? null;
    }
    return node.userData.dioOutline;
  };
  const raise = (node, group, raised) => {
    if (node.userData.dioRaised === raised && !raised) return;
    node.userData.dioRaised = raised;
    node.traverse((o) => { if (o.isMesh && o.parent !== group) o.renderOrder = raised ? 2 : 0; });
  };
  const style = (group, [colour, px]) => {
    const k = group.children[0].material;
    if (k.transparent) { Object.assign(k, { transparent: false, depthWrite: false }); k.needsUpdate = true; }
    k.thickness = px;
    k.opacity = 1;
    k.color.set(colour);
    for (const mesh of group.children) mesh.renderOrder = 1;
  };
  // A camera's own picture would stand in the room: it is drawn beside the pointer instead, and still feels it.
  const pictureOf = (node) => {
    let picture = null, pointed = false;
    node?.traverse((o) => {
      if (o.material?.map) { o.material.visible = false; picture = o.material.map.image; }
      pointed ||= o.isLineSegments2 && o.material.color.getHex() === POINTED_AT;
    });
    return pointed && node.visible ? picture : null;
  };
  O.frame = (m) => {
    let hovered = null;
    for (const name in m.nodeRefFromName) {
      if (CAMERA.test(name)) hovered = pictureOf(m.nodeRefFromName[name]) ?? hovered;
      if (!NODE.test(name)) continue;
      const node = m.nodeRefFromName[name], group = node && outline(node);
      if (!group) continue;
      const object = name.slice(0, name.lastIndexOf("/")), pointed = group.visible;
      if (pointed) hovered = object;
      const line = node.userData.dioFaded ? null : O.lines.get(object) ?? (pointed ? HOVER : null);
      group.visible = line !== null;
      raise(node, group, line !== null);
      if (line) style(group, line);
    }
    if (hovered !== over) { over = hovered; show(); }
  };
  const drawn = (picture) => {
    const canvas = Object.assign(document.createElement("canvas"), { width: picture.width, height: picture.height });
    canvas.getContext("2d").drawImage(picture, 0, 0);
    return canvas;
  };
  const show = () => {
    let tag = document.getElementById("dio-tag");
    const shown = over && pointer && pointer.buttons === 0 ? O.names[over] ?? over : "";
    if (!shown) { if (tag) tag.hidden = true; return; }
    if (!tag) {
      tag = Object.assign(document.createElement("div"), { id: "dio-tag" });
      tag.setAttribute("aria-hidden", "true");
      document.body.append(tag);
    }
    tag.hidden = false;
    tag.replaceChildren(shown.width ? drawn(shown) : shown);
    tag.style.left = `${Math.min(pointer.x + 14, innerWidth - tag.offsetWidth - 8)}px`;
    tag.style.top = `${Math.min(pointer.y + 16, innerHeight - tag.offsetHeight - 8)}px`;
  };
  addEventListener("pointermove", (event) => {
    const onCanvas = event.target === window.__viserMutable?.canvas;
    pointer = onCanvas && event.pointerType === "mouse" ? { x: event.clientX, y: event.clientY, buttons: event.buttons } : null;
    show();
  }, true);
  O.told = (about) => {
    O.lines = new Map(about.lines.map(([name, colour, px]) => [name, [colour, px]]));
    O.names = about.names;
    window.__viserMutable?.requestRender?.();
    show();
  };
})();
