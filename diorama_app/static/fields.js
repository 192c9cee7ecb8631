// Fields of the panels: what is clicked is selected whole, and a panel that is drawn anew keeps the focus and what was
// being typed. A field that is taken away tells the browser's `change` of words half typed: these are not sent. The
// browser sees no change in the field that comes instead: what was typed into it is told from here.
(() => {
  const FIELD = ".dio [data-change]", FOCUSED_AGAIN_MS = 20000;
  let last = null, leaving = false;
  const leave = () => {
    leaving = true;
    setTimeout(() => { leaving = false; });
  };
  const find = (drawn) => [...drawn.querySelectorAll(`${FIELD}, .dio .row`)]
    .find((field) => field.dataset.change === last.change && field.dataset.arg === last.arg);
  const tell = () => {
    if (!last?.untold || last.typed === null) return;
    const field = last.field.isConnected ? last.field : find(document);
    if (!field) return;
    field.value = last.typed;
    last = { ...last, field, typed: null };
    field.dispatchEvent(new Event("change", { bubbles: true }));
  };
  addEventListener("focusin", (event) => {
    const field = event.target;
    if (!field.matches?.(`${FIELD}, .dio .row`) || last?.field === field) return;
    tell();
    last = { field, change: field.dataset.change, arg: field.dataset.arg, at: performance.now(), typed: null };
    if (field.matches("input")) setTimeout(() => document.activeElement === field && field.select());
  });
  addEventListener("input", (event) => {
    if (last?.field === event.target) Object.assign(last, { typed: event.target.value, at: performance.now(), untold: false });
  });
  addEventListener("change", (event) => {
    if (last?.field !== event.target) return;
    if (event.isTrusted && !leaving && event.target.matches("input")) {
      event.stopImmediatePropagation();
      last.untold = true;
    } else {
      last.typed = null;
    }
  }, true);
  addEventListener("keydown", (event) => {
    if (event.key === "Enter" || event.key === "Tab") leave();
    if (event.key === "Enter" && event.target === last?.field) tell();
  }, true);
  addEventListener("focusout", (event) => {
    const field = event.target;
    setTimeout(() => {
      if (field.isConnected && document.activeElement !== field && last?.field === field) tell();
    });
  });
  addEventListener("pointerdown", (event) => {
    leave();
    if (event.target.closest?.(`${FIELD}, .dio .row`)) return;
    tell();
    if (last?.typed === null) last = null;
  }, true);
  window.__dioRefocus = (drawn) => {
    if (!last || last.field.isConnected || document.activeElement !== document.body) return;
    if (performance.now() - last.at > FOCUSED_AGAIN_MS) return;
    const field = find(drawn);
    if (!field) return;
    last.field = field;
    if (last.typed !== null) {
      field.value = last.typed;
      last.untold = true;
    }
    field.focus();
    if (last.typed === null) field.select?.();
  };
})();
