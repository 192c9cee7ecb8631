// What is done to the panels' HTML, told as the value of a hidden field of viser's. The message goes out at once: viser's
// own fields share one sender, which keeps only the newest of what all of them say within 50 ms. The program may read the
// field after the next message, so each says everything of the last seconds, numbered.
(() => {
  const REPEATED_MS = 3000, REPEATED = 40;
  const said = new Map();
  let number = 0;
  window.__dioSend = (uuid, what, argument, event) => {
    const now = performance.now();
    const latest = (said.get(uuid) ?? []).filter((action) => now - action.at < REPEATED_MS).slice(1 - REPEATED);
    const add = Boolean(event.shiftKey || event.ctrlKey || event.metaKey);
    latest.push({ do: what, arg: argument || "", add, at: now, number: ++number });
    said.set(uuid, latest);
    const updates = { value: JSON.stringify(latest) };
    window.__viserMutable.sendMessage({ type: "GuiUpdateMessage", uuid, updates });
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
