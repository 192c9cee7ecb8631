// The plan over the 3D view: the room from above with thick walls, lengths, door swings and furniture. What is dragged
// follows the hand at once; the server hears when it is let go of. Metres; the page's y runs down, the world's up.
(() => {
  const SVG = "http://www.w3.org/2000/svg";
  const ROOM_PX = 74, TOP_PX = 64, TOOLS_PX = 84, GRID_M = 0.05, CORNER_PX = 6, AWAY_PX = 30, CLICK_PX = 4, TEXT_PX = 12, LETTER_PX = 6.8;
  const LEAST_ZOOM = 0.2, LARGEST_ZOOM = 12, WHEEL = 0.0015;
  let about = null, view = null, held = null, zoom = 1, shift = [0, 0];

  const send = (what, arg) => {
    const button = document.getElementById("dio-plan-send");
    if (!button) return;
    button.dataset.do = what;
    button.dataset.arg = JSON.stringify(arg);
    button.click();
  };
  const add = (parent, tag, attributes = {}, words = "") => {
    const node = document.createElementNS(SVG, tag);
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    if (words) node.textContent = words;
    parent.append(node);
    return node;
  };
  const path = (points, closed) => points.map((p, k) => `${k ? "L" : "M"}${toPage(p).join(" ")}`).join("") + (closed ? "Z" : "");
  const closed = (outlines) => outlines.map((o) => path(o, true)).join("");
  const snapped = (value) => about.snap ? Math.round(value / GRID_M) * GRID_M : value;
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1];
  const plus = (a, b, by = 1) => [a[0] + by * b[0], a[1] + by * b[1]];
  const length = (metres) => about.feet ? null : `${metres.toFixed(2)} m`;

  // The whole plan fits between the tools and the edges, until it is zoomed and shifted; the scale is pixels a metre.
  const fit = (box) => {
    const [[x0, y0], [x1, y1]] = about.bounds, width = box.width - 2 * ROOM_PX, height = box.height - TOP_PX - TOOLS_PX - ROOM_PX;
    const scale = Math.max(1, Math.min(width / Math.max(x1 - x0, 0.1), height / Math.max(y1 - y0, 0.1)));
    const x = box.width / 2 - scale * (x0 + x1) / 2, y = (TOP_PX + box.height - TOOLS_PX) / 2 + scale * (y0 + y1) / 2;
    const middle = [box.width / 2, box.height / 2];
    return { scale: scale * zoom, x: middle[0] + (x - middle[0]) * zoom + shift[0], y: middle[1] + (y - middle[1]) * zoom + shift[1] };
  };
  const toPage = ([x, y]) => [view.x + view.scale * x, view.y - view.scale * y];
  const metres = (event, from) => [(event.clientX - from[0]) / view.scale, -(event.clientY - from[1]) / view.scale];

  // -- what can be dragged: what it shows while held, and what it tells when let go of -------------------------------
  const wall = (group, w) => ({
    shown: (d) => {
      const by = snapped(dot(d, w.outward)), a = plus(w.start, w.outward, by), b = plus(w.end, w.outward, by);
      ghost(group, path([a, b]), plus([(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], w.outward, -18 / view.scale),
        `${by >= 0 ? "+" : "−"}${length(Math.abs(by)) ?? ""}`);
    },
    told: (d) => { const by = snapped(dot(d, w.outward)); if (by) send("wall", [w.id, by]); },
    clicked: () => send("surface", w.id),
  });
  const corner = (group, c) => ({
    shown: (d) => {
      const at = plus(c.at, d.map(snapped)), legs = c.walls.map((id) => about.walls.find((w) => w.id === id));
      ghost(group, legs.map((w) => path([at, plus(w === legs[0] ? w.start : w.end, w.outward, dot(d.map(snapped), w.outward))])).join(""));
    },
    told: (d) => { const by = d.map(snapped); if (by[0] || by[1]) send("corner", [...c.walls, ...by]); },
  });
  const piece = (node, p) => {
    const way = (d) => (p.along ? p.along.map((v) => v * snapped(dot(d, p.along))) : d.map(snapped));
    return {
      shown: (d) => { const by = way(d); node.setAttribute("transform", `translate(${by[0] * view.scale} ${-by[1] * view.scale})`); },
      told: (d) => { const by = way(d); if (by[0] || by[1]) send("move", [p.id, ...by]); else node.removeAttribute("transform"); },
      clicked: (event) => send("select", [p.id, event.shiftKey || event.ctrlKey || event.metaKey]),
    };
  };
  const ground = (before) => ({
    shown: (d) => { shift = [before[0] + d[0] * view.scale, before[1] - d[1] * view.scale]; draw(); },
    told: () => {},
    clicked: () => send("select", [null, false]),
  });
  // The point under the pointer stays where it is.
  const zoomed = (event) => {
    event.preventDefault();
    const box = document.getElementById("dio-plan").getBoundingClientRect();
    const after = Math.min(LARGEST_ZOOM, Math.max(LEAST_ZOOM, zoom * Math.exp(-event.deltaY * WHEEL)));
    const at = [event.clientX - box.left - box.width / 2, event.clientY - box.top - box.height / 2];
    shift = shift.map((v, k) => at[k] + (v - at[k]) * after / zoom);
    zoom = after;
    if (!held) draw();
  };
  const ghost = (group, d, at, words) => {
    group.querySelectorAll(".ghost, .ghost-length").forEach((old) => old.remove());
    add(group, "path", { class: "ghost", d });
    if (at && words) label(group, at, words, "length ghost-length");
  };
  const label = (group, at, words, kind, turn = 0) =>
    add(group, "text", { class: kind, transform: `translate(${toPage(at).join(" ")}) rotate(${turn})` }, words);
  const hold = (node, what) => node.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    event.stopPropagation();
    node.setPointerCapture(event.pointerId);
    held = { node, what, from: [event.clientX, event.clientY], moved: false };
  });
  addEventListener("pointermove", (event) => {
    if (!held) return;
    held.moved ||= Math.hypot(event.clientX - held.from[0], event.clientY - held.from[1]) > CLICK_PX;
    if (held.moved) held.what.shown(metres(event, held.from));
  });
  addEventListener("pointerup", (event) => {
    const { what, from, moved } = held ?? {};
    held = null;
    if (moved) what.told(metres(event, from));
    else what?.clicked?.(event);
  });
  addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !held) return;
    event.stopImmediatePropagation();
    held = null;
    draw();
  }, true);

  const typed = (layer, w, at) => {
    const field = Object.assign(document.createElement("input"), { value: w.length });
    field.setAttribute("aria-label", _("Length of {name}").replace("{name}", w.name));
    [field.style.left, field.style.top] = toPage(at).map((v) => `${v}px`);
    const end = () => { field.onblur = null; field.remove(); };
    field.onkeydown = (event) => {
      event.stopPropagation();
      if (event.key === "Enter") send("length", [w.id, field.value]);
      if (event.key === "Enter" || event.key === "Escape") end();
    };
    field.onblur = end;
    layer.append(field);
    field.focus();
    field.select();
  };
  const measure = (layer, group, w) => {
    const away = w.inner ? -AWAY_PX / view.scale : AWAY_PX / view.scale + w.thickness, a = plus(w.start, w.outward, away), b = plus(w.end, w.outward, away);
    const tick = 5 / view.scale, middle = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    add(group, "path", { class: "measure", d: path([a, b]) + [a, b].map((p) =>
      path([plus(p, w.outward, -tick), plus(p, w.outward, tick)])).join("") });
    let turn = -Math.atan2(b[1] - a[1], b[0] - a[0]) * 180 / Math.PI;
    if (turn > 90.01) turn -= 180; else if (turn <= -89.99) turn += 180;
    const words = label(group, middle, w.length, "length", turn);
    words.dataset.wall = w.id;
    words.addEventListener("click", () => typed(layer, w, middle));
  };

  // Names lie over all furniture, the larger pieces' first; one that has no room, or would cover another, is left out.
  const names = (group) => {
    const layer = add(group, "g", { class: "names" }), taken = [];
    const size = (p) => p.room[0] * p.room[1];
    for (const p of [...about.pieces].sort((a, b) => size(b) - size(a))) {
      const [across, up] = p.room.map((v) => v * view.scale), wide = p.label.length * LETTER_PX, [x, y] = toPage(p.at);
      const turned = !(across > wide && up > 2 * TEXT_PX);
      if (turned && !(up > wide && across > 2 * TEXT_PX)) continue;
      const [w, h] = turned ? [TEXT_PX, wide] : [wide, TEXT_PX];
      if (taken.some((t) => Math.abs(t.x - x) < (t.w + w) / 2 && Math.abs(t.y - y) < (t.h + h) / 2)) continue;
      taken.push({ x, y, w, h });
      label(layer, p.at, p.label, "label", turned ? -90 : 0);
    }
  };

  // A camera with its field of view, where another photo would help most.
  const viewpoint = (group, { at, to, words }) => {
    const [x, y] = toPage(at), turn = -Math.atan2(to[1] - at[1], to[0] - at[0]) * 180 / Math.PI;
    const node = add(group, "g", { class: "viewpoint", transform: `translate(${x} ${y}) rotate(${turn})` });
    add(node, "title", {}, words);
    add(node, "path", { class: "view", d: "M0 0L54 -33L54 33Z" });
    add(node, "path", { d: "M-9 -7h4l2 -3h6l2 3h4v14h-18Z", transform: `rotate(${-turn})` });
    add(node, "circle", { r: 3.4 });
  };

  const draw = () => {
    const old = document.getElementById("dio-plan");
    if (!about) return old?.remove();
    const layer = old ?? Object.assign(document.createElement("div"), { id: "dio-plan" });
    if (!old) {
      layer.setAttribute("role", "region");
      layer.setAttribute("aria-label", _("Plan"));
      document.body.append(layer);
    }
    view = fit(layer.getBoundingClientRect());
    const svg = document.createElementNS(SVG, "svg");
    const group = add(svg, "g");
    add(group, "path", { class: "floor", d: closed(about.floors) });
    window.__dioPlanTools?.below(group);
    for (const p of about.pieces) {
      const node = add(group, "g", {
        class: ["piece", p.on && "on", p.overhead && "overhead", p.flat && "flat", p.along && "opening"].filter(Boolean).join(" "),
      });
      node.dataset.id = p.id;
      add(node, "title", {}, p.label);
      add(node, "path", { d: closed(p.outlines) });
      hold(node, piece(node, p));
    }
    for (const outline of about.spreads) add(group, "path", { class: "spread", d: closed([outline]) });
    names(group);
    for (const r of about.rooms) label(group, r.at, r.name, "label room");
    add(group, "path", { class: "wall", "fill-rule": "evenodd", d: closed(about.solid) });
    for (const line of about.swings) add(group, "path", { class: "line swing", d: path(line) });
    for (const line of about.panes) add(group, "path", { class: "line", d: path(line) });
    for (const w of about.walls) {
      const grip = add(group, "path", { class: `grip ${w.on ? "on" : ""}`, d: path([w.start, w.end].map((p) => plus(p, w.outward, w.thickness / 2))) });
      grip.dataset.wall = w.id;
      hold(grip, wall(group, w));
      measure(layer, group, w);
    }
    group.append(...group.querySelectorAll(".piece.opening"));
    if (about.photo) viewpoint(group, about.photo);
    for (const c of about.corners) {
      const node = add(group, "circle", { class: "corner", cx: toPage(c.at)[0], cy: toPage(c.at)[1], r: CORNER_PX });
      node.dataset.walls = c.walls.join(" ");
      hold(node, corner(group, c));
    }
    svg.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || !(event.target === svg || event.target.matches(".floor"))) return;
      held = { what: ground(shift), from: [event.clientX, event.clientY], moved: false };
    });
    svg.addEventListener("wheel", zoomed, { passive: false });
    layer.querySelector("svg")?.remove();
    layer.prepend(svg);
    window.__dioPlanTools?.over(layer, svg);
  };
  addEventListener("dio-measured", () => { if (about && !held) draw(); });
  const toMetres = (event) => {
    const box = document.getElementById("dio-plan").getBoundingClientRect();
    return [(event.clientX - box.left - view.x) / view.scale, (view.y - event.clientY + box.top) / view.scale];
  };
  window.__dioPlan = {
    add, send, snapped, toMetres,
    about: () => about,
    redraw: () => { if (about && !held) draw(); },
    told: (news) => {
      if (!about) [zoom, shift] = [1, [0, 0]];
      about = news;
      if (!held) draw();
    },
    inPlan: toPage,
    toPage: (point) => {
      const box = document.getElementById("dio-plan").getBoundingClientRect(), [x, y] = toPage(point);
      return [box.left + x, box.top + y];
    },
  };
})();
