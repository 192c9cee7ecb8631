// While a question is open, digits give its answers; everywhere else they keep their meaning.
(() => {
  addEventListener("keydown", (event) => {
    const plain = !event.ctrlKey && !event.metaKey && !event.altKey;
    if (!plain || !/^[1-9]$/.test(event.key) || event.target.closest?.("input, textarea, select")) return;
    const tile = document.querySelector(`.dio .review [data-digit="${event.key}"]`);
    if (!tile?.offsetParent) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    tile.click();
  }, true);
})();
