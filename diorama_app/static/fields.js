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
  const find = () => [...document.querySelectorAll(`${FIELD}, .dio .row`)]
    .find(({ dataset }) => dataset.change === last.change && dataset.arg === last.arg && dataset.do === last.do);
  const tell = () => {
    if (!last?.untold || last.typed === null) return;
    const field = last.field.isConnected ? last.field : find();
    if (!field) return;
    field.value = last.typed;
    last = { ...last, field, typed: null };
    field.dispatchEvent(new Event("change", { bubbles: true }));
  };
  // In a field with nothing half typed, and on a slider, undo and redo are meant for the scene.
  const undoKey = (event) => (event.ctrlKey || event.metaKey) && /^[zy]$/i.test(event.key);
  const undoes = (event) => undoKey(event) && event.target.matches?.("input[data-change], input[type=range]")
    && !(last?.field === event.target && last.typed !== null);
  addEventListener("focusin", (event) => {
    const field = event.target;
    if (!field.matches?.(`${FIELD}, .dio .row`) || last?.field === field) return;
    tell();
    const { change, arg, do: action } = field.dataset;
    last = { field, change, arg, do: action, at: performance.now(), typed: null };
    // Not over what was typed meanwhile: keys come before a timer that waits.
    const select = () => { if (document.activeElement === field && last?.field === field && last.typed === null) field.select(); };
    if (field.matches("input")) setTimeout(select);
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
    if (event.key === "Escape" && event.target === last?.field && event.target.matches("input")) {
      const field = event.target; // what was half typed is forgotten, and the next Escape is for the scene
      last = null;
      field.value = field.defaultValue;
      field.blur();
    }
    if (undoKey(event)) window.__dioTellSlider?.(); // what it did is undone, not done after
    if (undoes(event)) {
      event.stopImmediatePropagation();
      event.preventDefault();
      document.body.dispatchEvent(new KeyboardEvent("keydown", event));
    }
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
  // Before any key that is pressed next: it would go to the page otherwise.
  const focusAgain = () => {
    if (!last || last.field.isConnected || document.activeElement !== document.body) return;
    if (performance.now() - last.at > FOCUSED_AGAIN_MS) return;
    const field = find();
    if (!field) return;
    last.field = field;
    if (last.typed !== null) {
      field.value = last.typed;
      last.untold = true;
    }
    field.focus();
    if (last.typed === null) field.select?.();
  };
  new MutationObserver(focusAgain).observe(document.documentElement, { childList: true, subtree: true });
})();
