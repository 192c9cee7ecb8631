// The sliders and the compass of the light (panels/light.py): the page moves them at once and tells the server what is
// set, several times a second while a hand is on them; what is told from there is drawn unless a hand is on it.
(() => {
  const L = window.__dioLight = { set: null };
  const TELL_MS = 120;
  const NAMES = [_("east"), _("north-east"), _("north"), _("north-west"), _("west"), _("south-west"), _("south"), _("south-east")];
  let held = null, waiting = 0, last = 0;
  const root = () => document.querySelector(".dio-light");
  const clock = (h) => {
    const minutes = Math.round(h * 60);
    return `${String(Math.floor(minutes / 60)).padStart(2, "0")}:${String(minutes % 60).padStart(2, "0")}`;
  };
  const signed = (ev) => (Math.abs(ev) < 0.05 ? "0" : `${ev > 0 ? "+" : "−"}${Math.abs(ev).toFixed(1)}`);
  const tell = (field, value) => {
    const send = () => {
      last = performance.now();
      field.value = value;
      field.dispatchEvent(new Event("change", { bubbles: true }));
    };
    clearTimeout(waiting);
    waiting = setTimeout(send, Math.max(0, TELL_MS - (performance.now() - last)));
  };
  const line = (points, about) => `<polygon points="${points.map((p) => p.join(",")).join(" ")}" ${about}/>`;
  const draw = () => {
    const set = L.set, box = root();
    if (!set || !box) return;
    box.querySelector(".dio-daylight").hidden = !set.day;
    const hour = box.querySelector('[data-change="hour"]'), exposure = box.querySelector('[data-change="exposure"]');
    if (held !== hour && set.hour !== null) hour.value = set.hour;
    if (held !== exposure) exposure.value = set.exposure;
    box.querySelector("[data-exposure]").textContent = signed(Number(exposure.value));
    if (!set.day) return;
    box.querySelector("[data-clock]").textContent = clock(Number(hour.value));
    hour.setAttribute("aria-valuetext", clock(Number(hour.value)));
    const points = set.outline.concat(set.windows.flatMap((w) => [[w[0], w[1]], [w[2], w[3]]]));
    const xs = points.map((p) => p[0]), ys = points.map((p) => p[1]);
    const middle = points.length ? [(Math.min(...xs) + Math.max(...xs)) / 2, (Math.min(...ys) + Math.max(...ys)) / 2] : [0, 0];
    const reach = Math.max(0.5, ...points.map((p) => Math.hypot(p[0] - middle[0], p[1] - middle[1])));
    const at = (x, y) => [((x - middle[0]) / reach * 26).toFixed(1), (-(y - middle[1]) / reach * 26).toFixed(1)];
    const around = (angle, radius) => [radius * Math.cos(angle), -radius * Math.sin(angle)].map((v) => v.toFixed(1));
    const [nx, ny] = around(set.north, 44), [sx, sy] = around(set.azimuth, 38), up = set.up > 0;
    const dial = box.querySelector("[data-dial]");
    dial.innerHTML = '<circle r="38" class="ring"/>' +
      (set.outline.length ? line(set.outline.map((p) => at(...p)), 'class="room"') : "") +
      set.windows.map((w) => { const a = at(w[0], w[1]), b = at(w[2], w[3]);
        return `<line x1="${a[0]}" y1="${a[1]}" x2="${b[0]}" y2="${b[1]}" class="window"/>`; }).join("") +
      `<text x="${nx}" y="${Number(ny) + 3}" class="north">${_("N")}</text>` +
      (up ? `<line x1="${sx}" y1="${sy}" x2="0" y2="0" class="ray"/>` : "") +
      `<circle cx="${sx}" cy="${sy}" r="7" class="sun ${up ? "" : "down"}"/>`;
    const degrees = ((Math.round(set.azimuth * 180 / Math.PI) % 360) + 360) % 360;
    dial.setAttribute("aria-valuenow", degrees);
    const turn = ((set.azimuth - set.north) * 180 / Math.PI + 90 + 720) % 360;
    const side = NAMES[Math.round(turn / 45) % 8];
    const high = Math.round(Math.asin(Math.max(-1, Math.min(1, set.up))) * 180 / Math.PI);
    dial.setAttribute("aria-valuetext", _("from the {side}").replace("{side}", side));
    box.querySelector("[data-about]").textContent = up
      ? _("The sun is {angle}° above the horizon in the {side}. Drag it around the room (seen from above).")
        .replace("{angle}", high).replace("{side}", side)
      : _("The sun is below the horizon. Switch on lamps below.");
  };
  const turned = (azimuth) => {
    if (L.set?.azimuth == null) return;
    const set = L.set;
    L.set = { ...set, north: set.north + azimuth - set.azimuth, azimuth };
    draw();
    tell(root().querySelector('[data-change="sun"]'), (azimuth * 180 / Math.PI).toFixed(1));
  };
  addEventListener("input", (event) => {
    const field = event.target;
    if (field.type !== "range" || !field.closest?.(".dio-light")) return;
    held = field;
    draw();
    tell(field, field.value);
  });
  addEventListener("change", (event) => { if (event.isTrusted && event.target === held) held = null; }, true);
  // Sliders of other panels are drawn anew with what they tell: they tell it when the hand is off them.
  let down = false, late = 0, untold = null;
  const tellNow = () => { if (untold?.isConnected) untold.dispatchEvent(new Event("change", { bubbles: true })); };
  const rest = (field) => {
    clearTimeout(late);
    untold = field;
    late = setTimeout(() => down || tellNow(), 200);
  };
  addEventListener("change", (event) => { if (!event.isTrusted && event.target === untold) untold = null; }, true);
  window.__dioTellSlider = tellNow;
  let moved = null;
  addEventListener("pointerdown", () => { down = true; }, true);
  addEventListener("pointerup", () => { down = false; if (moved) rest(moved); moved = null; }, true);
  addEventListener("input", (event) => {
    const field = event.target;
    if (field.type !== "range" || !field.closest?.(".dio") || field.closest(".dio-light")) return;
    moved = field;
    const words = field.parentElement.querySelector("b");
    if (words) words.textContent = field.value + (field.dataset.unit ?? "");
    rest(field);
  });
  // Undo is meant for the room, also while a slider has the focus.
  addEventListener("keydown", (event) => {
    if (event.target.type !== "range" || !(event.ctrlKey || event.metaKey) || !/^[zy]$/i.test(event.key)) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    event.target.blur();
    const { key, code, ctrlKey, metaKey, shiftKey } = event;
    document.body.dispatchEvent(new KeyboardEvent("keydown", { key, code, ctrlKey, metaKey, shiftKey, bubbles: true }));
  }, true);
  const follow = (event) => {
    const box = root().querySelector("[data-dial]").getBoundingClientRect();
    const x = event.clientX - box.left - box.width / 2, y = event.clientY - box.top - box.height / 2;
    turned(Math.atan2(-y, x));
  };
  addEventListener("pointerdown", (event) => {
    const dial = event.target.closest?.(".dio-light [data-dial]");
    if (!dial) return;
    event.preventDefault();
    dial.focus();
    held = dial;
    follow(event);
    const end = () => { held = null; removeEventListener("pointermove", follow); };
    addEventListener("pointermove", follow);
    addEventListener("pointerup", end, { once: true });
    addEventListener("pointercancel", end, { once: true });
  });
  addEventListener("keydown", (event) => {
    if (!event.target.closest?.(".dio-light [data-dial]")) return;
    const step = { ArrowLeft: 5, ArrowUp: 5, ArrowRight: -5, ArrowDown: -5 }[event.key];
    if (!step) return;
    event.preventDefault();
    event.stopPropagation();
    turned(L.set.azimuth + step * Math.PI / 180);
  }, true);
  L.told = (set) => {
    if (held && held.matches("[data-dial]")) set = { ...set, north: L.set.north, azimuth: L.set.azimuth };
    L.set = set;
    const night = set.day ? Math.min(1, Math.max(0, (0.25 - set.up) / 0.39)) : 0;
    document.documentElement.style.setProperty("--dio-night", night.toFixed(3));
    const wait = (left) => (root() ? draw() : left && setTimeout(() => wait(left - 1), 50));
    wait(40);
  };
})();
