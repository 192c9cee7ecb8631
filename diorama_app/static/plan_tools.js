// Tools of the plan: walls are split, doors and windows put into them, a room is drawn corner by corner, and a picture of
// a plan lies below, scaled by a length that is known. The picture is the project's.
(() => {
  const P = window.__dioPlan, NEAR_PX = 26, CLOSE_PX = 12, ALONG_PX = 7;
  const TOOLS = {
    split: [_("Split wall"), _("Click a wall where it should be split.")],
    door: [_("Door"), _("Click a wall where the door should be.")],
    window: [_("Window"), _("Click a wall where the window should be.")],
    room: [_("Draw room"), _("Click the corners; Enter or the first corner closes the room, Backspace removes the last one.")],
    scale: [_("Scale picture"), _("Click both ends of a known length.")],
    shift: [_("Move picture"), _("Drag the picture.")],
  };
  let tool = null, points = [], hover = null, dragged = null, hinted = null; // a hint stays until something is done

  // -- the picture below ---------------------------------------------------------------------------------------------
  let picture = null, upload = null, awaited = false;
  const remember = () => P.send("picture", picture && { at: picture.at, metres: picture.metres });
  const given = (news) => {
    [picture, upload] = [news.picture, news.upload];
    if (awaited && picture) [awaited, tool, points, hinted] = [false, "scale", [], null];
    if (P.about()) P.redraw();
  };
  const take = (file) => {
    const field = document.getElementById(`file_upload_${upload}`), one = new DataTransfer();
    if (!field) return;
    one.items.add(file);
    field.files = one.files;
    field.dispatchEvent(new Event("change", { bubbles: true }));
    awaited = true;
    hint(_("Reading {file}…").replace("{file}", file.name));
  };
  const known = (words) => {
    const found = /^\s*(\d+(?:[.,]\d+)?)\s*(mm|cm|m|ft|')?\s*$/.exec(words);
    return found && Number(found[1].replace(",", ".")) * { mm: 0.001, cm: 0.01, m: 1, ft: 0.3048, "'": 0.3048 }[found[2] ?? "m"];
  };
  const askLength = ([a, b]) => {
    const layer = document.getElementById("dio-plan"), [x, y] = P.inPlan([(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]);
    const field = Object.assign(document.createElement("input"), { placeholder: "3.20 m" });
    field.setAttribute("aria-label", _("True length between the two points"));
    [field.style.left, field.style.top] = [`${x}px`, `${y}px`];
    const end = () => { field.onblur = null; field.remove(); choose(null); };
    field.onkeydown = (event) => {
      event.stopPropagation();
      if (event.key === "Escape") return end();
      if (event.key !== "Enter") return;
      const metres = known(field.value), now = Math.hypot(b[0] - a[0], b[1] - a[1]);
      if (!(metres > 0.05)) return hint(_("Give a length such as 3.20 m."));
      const factor = metres / now; // about the first point, which stays where it is
      picture.metres *= factor;
      picture.at = picture.at.map((v, k) => a[k] + (v - a[k]) * factor);
      remember();
      end();
    };
    field.onblur = end;
    layer.append(field);
    field.focus();
  };

  // -- tools ---------------------------------------------------------------------------------------------------------
  const hint = (words) => {
    hinted = words;
    P.redraw();
  };
  const choose = (name) => {
    [tool, points, hover, dragged, hinted] = [tool === name ? null : name, [], null, null, null];
    P.redraw();
  };
  const away = (point, a, b) => {
    const d = [b[0] - a[0], b[1] - a[1]], t = ((point[0] - a[0]) * d[0] + (point[1] - a[1]) * d[1]) / (d[0] ** 2 + d[1] ** 2 || 1);
    const s = Math.min(1, Math.max(0, t));
    return Math.hypot(point[0] - a[0] - s * d[0], point[1] - a[1] - s * d[1]);
  };
  const pixels = (a, b) => { const [p, q] = [P.inPlan(a), P.inPlan(b)]; return Math.hypot(p[0] - q[0], p[1] - q[1]); };
  const onWall = (at) => {
    const near = P.about().walls.map((w) => [away(at, w.start, w.end), w]).sort((a, b) => a[0] - b[0])[0];
    if (!near || pixels(at, [at[0] + near[0], at[1]]) > NEAR_PX) return hint(`${_("No wall there.")} ${TOOLS[tool][1]}`);
    P.send(tool, [near[1].id, ...at]);
    choose(null);
  };
  // A corner is in line with the one before, or the first, where it nearly is.
  const corner = (at) => {
    const aligned = at.map(P.snapped);
    for (const other of [points[0], points[points.length - 1]]) {
      if (!other) continue;
      for (const k of [0, 1]) if (pixels([other[0], 0], [other[0] + at[k] - other[k], 0]) < ALONG_PX) aligned[k] = other[k];
    }
    return aligned;
  };
  const close = () => {
    if (points.length < 3) return hint(_("A room has at least three corners."));
    P.send("room", points);
    choose(null);
  };
  const clicked = (at) => {
    if (tool === "room") {
      if (points.length > 2 && pixels(at, points[0]) < CLOSE_PX) return close();
      points.push(corner(at));
      hinted = null;
    } else if (tool === "scale") {
      points.push(at);
      if (points.length === 2) askLength(points);
    } else if (tool !== "shift") return onWall(at);
    P.redraw();
  };

  const inside = (event) => tool && event.target.closest?.("#dio-plan svg");
  addEventListener("pointerdown", (event) => {
    if (!inside(event) || event.button !== 0) return;
    event.stopImmediatePropagation();
    if (tool === "shift") dragged = { from: P.toMetres(event), at: picture.at };
  }, true);
  addEventListener("pointermove", (event) => {
    if (!inside(event)) return;
    hover = P.toMetres(event);
    if (dragged) picture.at = dragged.at.map((v, k) => v + hover[k] - dragged.from[k]);
    if (dragged || points.length) P.redraw();
  }, true);
  addEventListener("pointerup", (event) => {
    if (!inside(event) || event.button !== 0) return;
    event.stopImmediatePropagation();
    if (dragged) remember();
    else clicked(P.toMetres(event));
    dragged = null;
  }, true);
  addEventListener("keydown", (event) => {
    if (!tool || !P.about() || event.target.matches?.("input, textarea")) return;
    const act = { Escape: () => choose(null), Enter: tool === "room" && close,
      Backspace: points.length && (() => { points.pop(); hinted = null; P.redraw(); }) }[event.key];
    if (!act) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    act();
  }, true);

  // -- drawing -------------------------------------------------------------------------------------------------------
  const buttons = () => {
    const bar = Object.assign(document.createElement("div"), { id: "dio-plan-tools", className: "dio" });
    const row = Object.assign(document.createElement("div"), { className: "bar tight" });
    const press = (words, on, act) => {
      const button = Object.assign(document.createElement("button"), { type: "button", textContent: words, onclick: act });
      button.setAttribute("aria-pressed", String(on));
      button.classList.toggle("on", on);
      row.append(button);
    };
    for (const name of ["split", "door", "window", "room"]) press(TOOLS[name][0], tool === name, () => choose(name));
    const file = Object.assign(document.createElement("input"), { type: "file", accept: "image/jpeg,image/png,image/webp,application/pdf", hidden: true });
    file.onchange = () => { if (file.files[0]) take(file.files[0]); };
    if (picture) {
      for (const name of ["scale", "shift"]) press(TOOLS[name][0], tool === name, () => choose(name));
      press(_("Remove picture"), false, () => { picture = null; remember(); choose(null); });
    } else press(_("Add picture"), false, () => file.click());
    bar.append(row, file, Object.assign(document.createElement("p"), { textContent: hinted ?? (tool ? TOOLS[tool][1] : "") }));
    bar.querySelector("p").setAttribute("role", "status");
    return bar;
  };
  const below = (svg) => {
    if (!picture) return;
    const [w, h] = picture.size.map((v) => v * picture.metres), [x, y] = P.inPlan([picture.at[0] - w / 2, picture.at[1] + h / 2]);
    const [right, low] = P.inPlan([picture.at[0] + w / 2, picture.at[1] - h / 2]);
    const image = P.add(svg, "image", { x, y, width: right - x, height: low - y, opacity: 0.55, preserveAspectRatio: "none", href: picture.url });
    image.style.pointerEvents = "none";
  };
  const over = (layer, svg) => {
    layer.querySelector("#dio-plan-tools")?.remove();
    layer.append(buttons());
    svg.classList.toggle("tool", tool !== null);
    const line = tool && points.length ? [...points, ...(hover ? [tool === "room" ? corner(hover) : hover] : [])].map(P.inPlan) : [];
    if (line.length > 1) P.add(svg, "path", { class: "ghost", d: line.map((p, k) => `${k ? "L" : "M"}${p.join(" ")}`).join("") });
    for (const [cx, cy] of points.map(P.inPlan)) P.add(svg, "circle", { class: "corner", cx, cy, r: 5 });
    if (tool === "room" && line.length > 1) {
      const [a, b] = [points[points.length - 1], corner(hover ?? points[0])], [x, y] = P.inPlan([(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]);
      const metres = Math.hypot(b[0] - a[0], b[1] - a[1]);
      if (metres > 0.05) P.add(svg, "text", { class: "length ghost-length", x, y: y - 12 }, `${metres.toFixed(2)} m`);
    }
  };
  window.__dioPlanTools = { below, over, given };
})();
