// What the page needs around viser's: a sign while it loads, the part of the 3D view that panels leave free, the sheet of
// a phone, and a line when the server is gone.
(() => {
  const root = document.documentElement;
  const SHEET = '#root .mantine-Paper-root[style*="position: fixed"][style*="bottom: 0px"]';
  const NARROW_PX = 565; // a view in which the tools have no room in one row
  const LOST_MS = 1500; // a connection that comes back sooner is not worth a word

  const visible = () => {
    const canvas = window.__viserMutable?.canvas?.getBoundingClientRect();
    if (!canvas) return null;
    const bar = document.getElementById("dio-toolbar")?.getBoundingClientRect();
    const top = bar ? Math.max(canvas.top, bar.bottom + 2) : canvas.top;
    return { left: canvas.left, top, width: canvas.width, height: canvas.bottom - top, above: canvas.top };
  };
  window.__dioVisible = visible;
  const measure = () => {
    const sheet = document.querySelector(SHEET);
    root.classList.toggle("dio-phone", sheet !== null);
    root.style.setProperty("--dio-sheet", `${sheet?.getBoundingClientRect().height ?? 0}px`);
    const seen = visible();
    if (!seen) return;
    root.classList.toggle("dio-narrow", seen.width < NARROW_PX);
    root.style.setProperty("--dio-left", `${seen.left}px`);
    root.style.setProperty("--dio-width", `${seen.width}px`);
    root.style.setProperty("--dio-view-top", `${seen.above}px`);
    root.style.setProperty("--dio-top", `${seen.top}px`);
    root.style.setProperty("--dio-below", `${innerHeight - seen.top - seen.height}px`);
    dispatchEvent(new Event("dio-measured"));
  };
  const sizes = new ResizeObserver(measure);
  const watched = new Set();
  const watch = () => {
    for (const node of [window.__viserMutable?.canvas, document.querySelector(SHEET),
      document.getElementById("dio-toolbar")]) {
      if (node && !watched.has(node)) { watched.add(node); sizes.observe(node); }
    }
    for (const node of watched) if (!node.isConnected) { watched.delete(node); sizes.unobserve(node); measure(); }
    if (!root.classList.contains("dio-ready") && document.getElementById("dio-toolbar")) {
      root.classList.add("dio-ready");
      measure();
    }
  };
  // viser's labels name an id that no field has: the fields get the names themselves.
  const name = () => {
    for (const label of document.querySelectorAll(".mantine-Flex-root label[for]")) {
      const words = label.textContent.trim(), row = label.closest(".mantine-Flex-root");
      for (const field of row?.querySelectorAll("input:not([type=hidden]), textarea, [role=slider]") ?? []) {
        if (field.getAttribute("aria-label") !== words) field.setAttribute("aria-label", words);
      }
    }
  };
  const BUTTONS = {
    ".mantine-ColorInput-eyeDropperButton": _("Pick a colour from the screen"),
    '[data-testid="floating-panel-handle"] button': _("Find a command (Ctrl+K)"),
    "html.dio-phone #root button.mantine-ActionIcon-root": _("Find a command"),
    '[aria-label="Collapse panel area"]': _("Collapse the panels"),
    '[aria-label="Expand panel area"]': _("Expand the panels"),
  };
  const nameButtons = () => {
    for (const [which, words] of Object.entries(BUTTONS)) {
      for (const button of document.querySelectorAll(which)) {
        if (button.ariaLabel !== words) Object.assign(button, { ariaLabel: words, title: words });
      }
    }
  };
  // The sheet of a phone holds one panel: the server is asked to put all tabs into it.
  const onePanel = () => root.classList.contains("dio-phone") && document.getElementById("dio-one-panel")?.click();
  // A panel that viser docks after it was given its width may have forgotten it: the server gives it once more.
  const twoPanels = () => {
    if (document.querySelectorAll("[data-dock-region]").length > 1) document.getElementById("dio-two-panels")?.click();
  };
  // viser knows a page by its first camera; one that is lost while the connection opens is sent again.
  const introduce = () => root.classList.contains("dio-ready") || window.__viserMutable?.sendCamera?.();
  setInterval(() => { watch(); name(); nameButtons(); onePanel(); twoPanels(); introduce(); }, 200);

  let lost;
  window.__dioConnection = (there) => {
    clearTimeout(lost);
    if (there) return root.classList.remove("dio-lost");
    lost = setTimeout(() => root.classList.add("dio-lost"), LOST_MS);
  };
  addEventListener("DOMContentLoaded", () => {
    document.body.append(
      Object.assign(document.createElement("div"), { id: "dio-loading", textContent: _("Opening Diorama…") }),
      Object.assign(document.createElement("div"), {
        id: "dio-lost", role: "alert",
        textContent: _("The server does not respond. Your work is saved up to the last change; this page continues " +
          "when the server is back."),
      }),
    );
    document.getElementById("dio-loading").setAttribute("role", "status");
  });
})();
