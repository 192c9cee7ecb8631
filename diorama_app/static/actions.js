// What is done to the panels' HTML, told through a hidden field of viser's. viser sends only the newest of values that
// change fast, so the field says everything of the last seconds, numbered.
(() => {
  const REPEATED_MS = 3000, REPEATED = 40;
  const setValue = Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value").set;
  const said = new Map();
  let number = 0;
  window.__dioSend = (id, what, argument, event) => {
    const label = document.querySelector(`label[for="${id}"]`);
    const field = label?.closest(".mantine-Flex-root").querySelector("input");
    if (!field) return;
    const now = performance.now();
    const latest = (said.get(id) ?? []).filter((action) => now - action.at < REPEATED_MS).slice(1 - REPEATED);
    const add = Boolean(event.shiftKey || event.ctrlKey || event.metaKey);
    latest.push({ do: what, arg: argument || "", add, at: now, number: ++number });
    said.set(id, latest);
    setValue.call(field, JSON.stringify(latest));
    field.dispatchEvent(new Event("input", { bubbles: true }));
  };

  // Where a redraw takes away what is pressed before it is let go, browsers send its click to what is around it: the
  // same action in the new drawing gets one instead.
  const ACTION = ".dio [data-do]";
  let pressed = null;
  addEventListener("pointerdown", (event) => {
    pressed = event.button === 0 ? (event.target.closest?.(ACTION) ?? null) : null;
  }, true);
  addEventListener("pointerup", (event) => {
    const gone = pressed && !pressed.isConnected ? pressed.dataset : null;
    pressed = null;
    const same = gone && event.target.closest?.(ACTION);
    if (!same || same.disabled || same.dataset.do !== gone.do || same.dataset.arg !== gone.arg) return;
    const { shiftKey, ctrlKey, metaKey } = event;
    same.dispatchEvent(new MouseEvent("click", { bubbles: true, cancelable: true, shiftKey, ctrlKey, metaKey }));
  }, true);
})();
