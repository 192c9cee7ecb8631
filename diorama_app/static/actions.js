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

  // Browsers send a click to what is around the places of both press and release. A redraw in between takes away what is
  // pressed: the same action in the new drawing gets the click. A change of the layout moves what is pressed away from a
  // pointer that stands still: it gets the click itself.
  const ACTION = ".dio [data-do]", BUTTON = `button, [role=tab], ${ACTION}`, STILL_PX = 3;
  let press = null, clicked = false;
  const heir = ({ action, node, x, y }, event) => {
    const under = document.elementFromPoint(event.clientX, event.clientY);
    if (action && !action.isConnected) {
      const same = under?.closest(ACTION);
      return same?.dataset.do === action.dataset.do && same.dataset.arg === action.dataset.arg ? same : null;
    }
    const still = Math.hypot(event.clientX - x, event.clientY - y) <= STILL_PX;
    return still && node?.isConnected && !node.contains(under) ? node : null;
  };
  addEventListener("pointerdown", (event) => {
    const { target, button, clientX: x, clientY: y } = event;
    press = button === 0 ? { action: target.closest?.(ACTION), node: target.closest?.(BUTTON), x, y } : null;
  }, true);
  addEventListener("pointerup", (event) => {
    const node = press && heir(press, event), { shiftKey, ctrlKey, metaKey } = event;
    press = null;
    if (!node || node.disabled) return;
    node.dispatchEvent(new MouseEvent("click", { bubbles: true, cancelable: true, shiftKey, ctrlKey, metaKey }));
    clicked = true;
    setTimeout(() => { clicked = false; }, 100); // the browser's own comes at once or never
  }, true);
  addEventListener("click", (event) => {
    if (clicked && event.isTrusted) event.stopImmediatePropagation();
  }, true);
})();
