// The photo over the 3D view, with boxes that are drawn, selected, dragged by their corners and edges, named and deleted.
// The server tells what there is with __dioCanvas.told (viewport/annotation_canvas.py) and hears what a person does.
(() => {
  const C = window.__dioCanvas = {};
  const COLOURS = ["#2f6fd6", "#d6542f", "#1f8a55", "#a050c8", "#b07a00", "#0f8a99"];
  const NEAR_PX = 4; // a press that moves less is a click
  const HANDLES = ["nw", "n", "ne", "e", "se", "s", "sw", "w"];
  const state = { photo: null, boxes: [], selected: null, likely: [], proposals: [], mask: null, lines: [], drawn: [] };
  let root, figure, layer, drag;
  let at = null, next = 0; // the proposal that keys are for, and the one that Tab goes to after an accepted one

  const send = (what, arg) => {
    const button = document.getElementById("dio-canvas-send");
    if (!button) return;
    button.dataset.do = what;
    button.dataset.arg = JSON.stringify(arg);
    button.click();
  };
  const element = (tag, className, more = {}) => Object.assign(document.createElement(tag), { className, ...more });

  const build = () => {
    root = element("div", "dio-canvas");
    const bar = element("div", "dio-canvas-bar");
    bar.append(element("span", ""));
    bar.append(element("button", "", { type: "button", textContent: _("Done"), onclick: () => send("done", null) }));
    figure = element("div", "dio-canvas-figure");
    layer = element("div", "dio-canvas-layer", { tabIndex: -1 });
    const names = element("datalist", "", { id: "dio-canvas-names" });
    names.append(...state.photo.names.map((value) => element("option", "", { value })));
    figure.append(element("img", "", { src: state.photo.url, alt: _("The photo"), draggable: false }), layer);
    root.append(bar, figure, names);
    layer.addEventListener("pointerdown", press);
    layer.addEventListener("pointermove", move);
    layer.addEventListener("pointerup", release);
    layer.addEventListener("pointercancel", () => { drag = null; draw(); });
    layer.addEventListener("dblclick", () => layer.querySelector("input")?.select());
    document.body.append(root);
    addEventListener("dio-measured", place);
    addEventListener("resize", place);
    place();
  };
  const close = () => {
    removeEventListener("dio-measured", place);
    removeEventListener("resize", place);
    root?.remove();
    root = drag = null;
  };
  // Over what is seen of the 3D view: panels may lie over it.
  const place = () => {
    if (!root) return;
    const seen = window.__dioVisible();
    Object.assign(root.style, {
      left: `${seen.left}px`, top: `${seen.top}px`, width: `${seen.width}px`, height: `${seen.height}px`,
    });
    const [width, height] = state.photo.size, room = [seen.width - 24, seen.height - 68];
    const scale = Math.max(0.01, Math.min(room[0] / width, room[1] / height));
    Object.assign(figure.style, { width: `${width * scale}px`, height: `${height * scale}px` });
  };

  const pixel = (event) => {
    const seen = layer.getBoundingClientRect(), [width, height] = state.photo.size;
    const share = (value, low, size) => Math.min(1, Math.max(0, (value - low) / size));
    return [share(event.clientX, seen.left, seen.width) * width, share(event.clientY, seen.top, seen.height) * height];
  };
  const within = ([x, y], [x1, y1, x2, y2]) => x >= x1 && x <= x2 && y >= y1 && y <= y2;
  const area = ([x1, y1, x2, y2]) => (x2 - x1) * (y2 - y1);
  const hit = (point, rows = state.boxes) => {
    let best = null;
    rows.forEach((row, i) => {
      if (within(point, row.box) && (best === null || area(row.box) < area(rows[best].box))) best = i;
    });
    return best;
  };
  // What lies on a marked object is meant where its proposal is smaller, and with Shift where nothing is proposed.
  const click = (point, shift) => {
    const found = hit(point), proposed = hit(point, state.proposals);
    const smaller = proposed !== null && (found === null || 2 * area(state.proposals[proposed].box) < area(state.boxes[found].box));
    at = null;
    if (smaller) {
      state.selected = null;
      send("accept", [proposed, ""]);
    } else if (!shift && hit(point, state.drawn) !== null) {
      return; // it is selected as soon as it has its name
    } else if (found !== null && !shift) {
      state.selected = found;
      send("select", found);
    } else {
      state.selected = null;
      send("click", point);
    }
  };
  const spanned = (a, b) => [Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.max(a[0], b[0]), Math.max(a[1], b[1])];

  const pulled = ([x1, y1, x2, y2], side, [x, y]) => {
    if (side.includes("w")) x1 = x;
    if (side.includes("e")) x2 = x;
    if (side.includes("n")) y1 = y;
    if (side.includes("s")) y2 = y;
    return spanned([x1, y1], [x2, y2]);
  };
  const moved = ([x1, y1, x2, y2], dx, dy) => {
    const [width, height] = state.photo.size;
    const x = Math.min(Math.max(dx, -x1), width - x2), y = Math.min(Math.max(dy, -y1), height - y2);
    return [x1 + x, y1 + y, x2 + x, y2 + y];
  };

  const press = (event) => {
    if (event.button !== 0 || event.target.closest("input, .dio-canvas-name button")) return;
    document.activeElement?.blur();
    event.preventDefault();
    layer.setPointerCapture(event.pointerId);
    const from = pixel(event), at = [event.clientX, event.clientY], side = event.target.dataset.side;
    const chosen = state.selected === null ? undefined : state.boxes[state.selected];
    if (state.photo.mode === "points") drag = { kind: "point", from, at };
    else if (state.photo.mode === "one box") drag = { kind: "new", from, at }; // also where the old box is
    else if (side && chosen) drag = { kind: "pull", side, was: chosen.box, from, at };
    else if (chosen && hit(from) === state.selected) drag = { kind: "move", was: chosen.box, from, at };
    else drag = { kind: "new", from, at };
  };
  const move = (event) => {
    if (!drag) return;
    const to = pixel(event);
    drag.far = drag.far || Math.hypot(event.clientX - drag.at[0], event.clientY - drag.at[1]) >= NEAR_PX;
    if (!drag.far) return;
    if (drag.kind === "new") drag.box = spanned(drag.from, to);
    if (drag.kind === "pull") drag.box = pulled(drag.was, drag.side, to);
    if (drag.kind === "move") drag.box = moved(drag.was, to[0] - drag.from[0], to[1] - drag.from[1]);
    draw();
  };
  const release = (event) => {
    if (!drag) return;
    const { kind, box, far, from } = drag;
    drag = null;
    if (kind === "point") { if (!far) send("point", [...from, !event.shiftKey]); return; }
    if (!far && kind !== "pull") {
      if (state.photo.mode === "boxes") click(from, event.shiftKey);
    } else if (far && kind === "new") {
      if (state.photo.mode === "boxes") {
        state.selected = null;
        state.drawn.push({ box, label: "…" }); // until the server has found out what it shows
      }
      send("draw", box);
    } else if (far) {
      state.boxes[state.selected].box = box;
      send("change", [state.selected, box]);
    }
    draw();
  };

  // Names stay on the photo: below the upper edge of boxes at its top, from the right edge of boxes in its right half.
  const nameSide = ([x1, y1, x2]) => {
    const [width, height] = state.photo.size;
    return `${y1 / height < 0.06 ? " inside" : ""}${x1 + x2 > width ? " right" : ""}`;
  };
  const boxElement = (row, i) => {
    const on = i === state.selected, [width, height] = state.photo.size;
    const box = on && drag?.box && drag.kind !== "new" ? drag.box : row.box;
    const node = element("div", `dio-canvas-box${on ? " on" : ""}`);
    node.style.cssText = `left:${100 * box[0] / width}%;top:${100 * box[1] / height}%;` +
      `width:${100 * (box[2] - box[0]) / width}%;height:${100 * (box[3] - box[1]) / height}%;` +
      `--box:${COLOURS[i % COLOURS.length]}`;
    const name = element("div", `dio-canvas-name${nameSide(row.box)}`);
    if (on && state.photo.mode === "boxes") {
      const field = element("input", "", { value: row.label, ariaLabel: _("Name of the selected box") });
      field.setAttribute("list", "dio-canvas-names");
      field.size = Math.max(8, row.label.length + 1);
      field.dataset.box = i;
      const told = () => { if (field.value !== row.label) send("name", [i, field.value]); };
      field.onchange = told;
      field.onblur = () => { if (field.isConnected) told(); };
      field.onkeydown = (event) => {
        if (event.key === "Escape") field.value = row.label;
        if (event.key === "Enter" || event.key === "Escape") field.blur();
      };
      const remove = element("button", "", { type: "button", textContent: "✕", title: _("Delete this box (Delete)") });
      remove.setAttribute("aria-label", _("Delete the box of {label}").replace("{label}", row.label));
      remove.onclick = () => send("delete", i);
      const likely = state.likely.map(([word, shown], k) => {
        const choice = element("button", `likely${word === row.label ? " chosen" : ""}`, { type: "button", title: _("Key {number}").replace("{number}", k + 1) });
        choice.append(element("kbd", "", { textContent: k + 1 }), ` ${shown}`);
        choice.onclick = () => send("name", [i, word]);
        return choice;
      });
      name.append(field, remove, ...likely);
      node.append(...HANDLES.map((side) => {
        const handle = element("i", `dio-canvas-handle ${side}`);
        handle.dataset.side = side;
        return handle;
      }));
    } else {
      name.textContent = row.label;
      Object.assign(node, { tabIndex: 0, role: "button", ariaLabel: row.label });
      node.onkeydown = (event) => {
        if (event.key !== "Enter" && event.key !== " ") return;
        event.preventDefault();
        send("select", i);
      };
    }
    node.append(name);
    return node;
  };
  const proposalElement = (row, i) => {
    const [width, height] = state.photo.size, [x1, y1, x2, y2] = row.box;
    const node = element("div", `dio-canvas-proposal${i === at ? " at" : ""}`);
    Object.assign(node, { role: "button", ariaLabel: _("Proposal: {label}").replace("{label}", row.label), title: _("Click to accept") });
    node.style.cssText = `left:${100 * x1 / width}%;top:${100 * y1 / height}%;` +
      `width:${100 * (x2 - x1) / width}%;height:${100 * (y2 - y1) / height}%`;
    node.append(element("div", `dio-canvas-name${nameSide(row.box)}`, { textContent: `${row.label}?` }));
    return node;
  };
  // What a build found so far: the room and a box around each object, in space.
  const linesElement = () => {
    const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    svg.setAttribute("class", "dio-canvas-lines");
    svg.setAttribute("viewBox", `0 0 ${state.photo.size.join(" ")}`);
    const path = document.createElementNS(svg.namespaceURI, "path");
    path.setAttribute("d", state.lines.map(([x1, y1, x2, y2]) => `M${x1} ${y1}L${x2} ${y2}`).join(""));
    svg.append(path, path.cloneNode());
    return svg;
  };
  const draw = () => {
    if (!root) return;
    const field = layer.contains(document.activeElement) && document.activeElement.matches(".on input") ? document.activeElement : null;
    const typed = field && !drag && field.dataset.box === String(state.selected)
      ? { value: field.value, from: field.selectionStart, to: field.selectionEnd } : null;
    if (typed) field.onchange = null; // it goes on in the field that comes instead
    else if (field && !drag) field.blur();
    const proposals = state.photo.mode === "boxes" ? state.proposals.map(proposalElement) : [];
    const drawn = drag?.kind === "new" && drag.box ? [...state.drawn, { box: drag.box, label: "" }] : state.drawn;
    const nodes = [...proposals, ...[...state.boxes, ...drawn].map(boxElement)];
    if (state.mask) nodes.unshift(element("img", "dio-canvas-mask", { src: state.mask, alt: _("Outline") }));
    if (state.lines.length) nodes.unshift(linesElement());
    layer.replaceChildren(...nodes);
    const again = typed && layer.querySelector(".on input");
    if (!again) return;
    again.value = typed.value;
    again.focus();
    again.setSelectionRange(typed.from, typed.to);
  };

  // Tab goes from proposal to proposal, and on to the rest of the page after the last one.
  const key = (event) => {
    const digit = /^[1-4]$/.test(event.key) ? Number(event.key) - 1 : null;
    if (event.key === "Tab" && !event.shiftKey) {
      at = at === null ? next : at + 1;
      next = 0;
      if (at >= state.proposals.length) { at = null; draw(); return false; }
      if (state.selected !== null) { state.selected = null; send("select", null); }
      draw();
    } else if (event.key === "Delete" || event.key === "Backspace") {
      if (at !== null) { state.proposals.splice(at, 1); send("dismiss", at); draw(); }
      else if (state.selected !== null) send("delete", state.selected);
    } else if (event.key === "Escape" && at !== null) {
      at = null;
      draw();
    } else if (event.key === "Enter" && at !== null) {
      send("accept", [at, ""]);
      next = at;
      at = null;
    } else if (digit !== null && state.selected !== null && state.likely[digit]) {
      send("name", [state.selected, state.likely[digit][0]]);
    } else {
      return false;
    }
    return true;
  };
  addEventListener("keydown", (event) => {
    const plain = !event.ctrlKey && !event.metaKey && !event.altKey;
    if (!root || !plain || state.photo.mode !== "boxes" || event.target.closest?.("input, textarea, select")) return;
    if (key(event)) {
      event.stopImmediatePropagation();
      event.preventDefault();
    }
  }, true);

  C.told = (news) => {
    const before = state.photo?.url;
    Object.assign(state, news);
    if (!state.photo) state.drawn = [];
    const there = (row) => state.boxes.some(({ box }) => box.every((value, i) => Math.abs(value - row.box[i]) < 1));
    state.drawn = state.drawn.filter((row) => !there(row));
    if (next >= state.proposals.length) next = 0;
    if (at !== null) at = state.proposals.length ? Math.min(at, state.proposals.length - 1) : null;
    if (!state.photo) return close();
    if (root && before !== state.photo.url) close();
    if (!root) build();
    const [first, ...more] = state.photo.hint.split(/(?<=\.)/);
    const rest = element("span", "", { textContent: more.join("") });
    root.querySelector(".dio-canvas-bar span").replaceChildren(first, rest);
    draw();
  };
})();
