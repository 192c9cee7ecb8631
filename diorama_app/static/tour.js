// A tour of six steps for newcomers: each points at a part of the page. It can be left at any step, and does not come again
// by itself in this browser.
(() => {
  const SEEN = "diorama-tour", WANTED = "diorama-tour-wanted";
  const tab = (name) => [...document.querySelectorAll("[role=tab]")].find((t) => t.textContent.trim() === name);
  const tool = (id) => document.querySelector(`#dio-toolbar [data-arg="${id}"]`);
  const view = () => {
    const seen = window.__dioVisible?.();
    if (!seen) return null;
    const [w, h] = [seen.width * 0.5, seen.height * 0.5];
    return new DOMRect(seen.left + (seen.width - w) / 2, seen.top + (seen.height - h) / 2, w, h);
  };
  const box = (...nodes) => {
    const rects = nodes.filter(Boolean).map((n) => n.getBoundingClientRect()).filter((r) => r.width > 0);
    if (!rects.length) return null;
    const left = Math.min(...rects.map((r) => r.left)), top = Math.min(...rects.map((r) => r.top));
    return new DOMRect(left, top, Math.max(...rects.map((r) => r.right)) - left,
      Math.max(...rects.map((r) => r.bottom)) - top);
  };
  const STEPS = [
    [_("Look around"), _("Drag the background to turn the view, drag with the right button to pan, and scroll to zoom. " +
      "Walls that block the view fade automatically."), view],
    [_("Move furniture"), _("Drag a piece of furniture to where it should be. Move, Free and Size choose the handles of what " +
      "is selected; Snap and No overlaps help you to place it."), () => box(tool("gizmo_floor"), tool("slide"))],
    [_("Change what is selected"), _("The Object tab shows alternatives to swap with one click, and colours, sizes and " +
      "numbers. Click a wall or the floor to paint it, or to cover it with paper, tiles or boards."), () => box(tab(_("Object")))],
    [_("Add furniture"), _("The Library tab finds furniture by name and puts it into the room. You can add your own models."),
      () => box(tab(_("Library")))],
    [_("Use your own photo"), _("The Photo tab takes a photo of a room: mark each piece of furniture with one click, and " +
      "build the scene."), () => box(tab(_("Photo")))],
    [_("Nothing is lost"), _("Every change is saved as you make it, and every change can be undone. The Export tab writes the " +
      "room for Blender, Unity, simulators and floor plans. Press ? for all keys."),
      () => box(tool("undo"), tool("redo"), tool("help"))],
  ];
  let tour = null, at = 0;
  const store = (storage, key, value) => {
    try { return value === null ? storage.removeItem(key) : storage.setItem(key, value); } catch { return null; }
  };
  const read = (storage, key) => { try { return storage.getItem(key); } catch { return "not remembered"; } };
  const end = () => {
    tour?.remove();
    tour = null;
    store(localStorage, SEEN, "seen");
    store(sessionStorage, WANTED, null);
  };
  const place = () => {
    const hole = tour.querySelector(".hole"), card = tour.querySelector(".card"), on = STEPS[at][2]();
    const r = on ?? new DOMRect(innerWidth / 2, innerHeight / 2, 0, 0), pad = on ? 6 : 0, gap = 16;
    Object.assign(hole.style, { left: `${r.left - pad}px`, top: `${r.top - pad}px`, width: `${r.width + 2 * pad}px`,
      height: `${r.height + 2 * pad}px` });
    const { width: w, height: h } = card.getBoundingClientRect();
    const below = r.bottom + gap + h < innerHeight, above = r.top - gap - h > 0;
    const top = below ? r.bottom + gap : above ? r.top - gap - h : innerHeight - h - 12;
    const left = Math.min(Math.max(12, r.left + r.width / 2 - w / 2), innerWidth - w - 12);
    Object.assign(card.style, { left: `${left}px`, top: `${Math.max(12, top)}px` });
  };
  const go = (step) => {
    if (step < 0) return;
    if (step >= STEPS.length) return end();
    at = step;
    const [title, words] = STEPS[at];
    tour.querySelector("h2").textContent = title;
    tour.querySelector("p").textContent = words;
    tour.querySelector("nav .step").textContent = _("{step} of {count}").replace("{step}", at + 1).replace("{count}", STEPS.length);
    tour.querySelector(".back").hidden = at === 0;
    tour.querySelector(".main").textContent = at + 1 === STEPS.length ? _("Done") : _("Next");
    place();
    tour.querySelector(".main").focus();
  };
  window.__dioTour = () => {
    tour?.remove();
    tour = document.createElement("div");
    tour.id = "dio-tour";
    tour.innerHTML = '<div class="hole"></div><div class="card" role="dialog" aria-modal="true">' +
      '<h2></h2><p></p><nav><span class="step"></span><button type="button" class="skip"></button>' +
      '<button type="button" class="back"></button><button type="button" class="main"></button></nav></div>';
    tour.querySelector(".card").ariaLabel = _("Tour");
    tour.querySelector(".skip").textContent = _("Skip");
    tour.querySelector(".back").textContent = _("Back");
    tour.querySelector(".skip").onclick = end;
    tour.querySelector(".back").onclick = () => go(at - 1);
    tour.querySelector(".main").onclick = () => go(at + 1);
    document.body.append(tour);
    go(0);
  };
  addEventListener("keydown", (event) => {
    if (!tour) return;
    if (event.key === "Escape") { event.stopImmediatePropagation(); end(); }
    if (event.key === "ArrowRight") go(at + 1);
    if (event.key === "ArrowLeft") go(at - 1);
    if (event.key === "Tab") {
      event.preventDefault();
      const buttons = [...tour.querySelectorAll("button:not([hidden])")];
      const next = buttons.indexOf(document.activeElement) + (event.shiftKey ? -1 : 1);
      buttons[(next + buttons.length) % buttons.length].focus();
    }
  }, true);
  addEventListener("resize", () => tour && place());
  let calm = 0; // checks in a row that found the page ready
  const OPENS_WITHIN = 30; // checks: the room that was chosen opens first, or is the one that is open
  setInterval(() => {
    const job = document.getElementById("dio-job"), busy = job !== null && !job.hidden;
    const ready = document.getElementById("dio-toolbar") && !document.getElementById("dio-start") && !busy;
    const typing = document.activeElement?.matches("input, textarea"); // the tour takes the keyboard: it waits
    const from = read(sessionStorage, WANTED);
    calm = !tour && ready && from && !typing ? calm + 1 : 0;
    if (calm < (from === location.search ? OPENS_WITHIN : 4)) return;
    if (read(localStorage, SEEN)) store(sessionStorage, WANTED, null);
    else window.__dioTour(); // it stays wanted until it ends: should the page load again, it comes again
  }, 300);
})();
